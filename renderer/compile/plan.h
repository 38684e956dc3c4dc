// SPDX-License-Identifier: Apache-2.0
// The plan: what a scene and a view need, what was left out and why. To a render what EXPLAIN is to a query.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/base/vec.h"
#include "renderer/scene/scene.h"

namespace tilelight {

// What a kernel may have to do. Bits of a FeatureSet; stored in reports by name.
enum class Feature : uint32_t {
  spheres,
  boxes,
  planes,
  triangles,
  smooth_normals,
  checker,
  point_lights,
  directional_lights,
  specular,
  shadows,
  tinted_shadows,
  reflection,
  transmission,
  nested_media,
  fresnel,
  attenuation,
  count_
};
inline constexpr int kFeatureCount = static_cast<int>(Feature::count_);
std::string_view feature_name(Feature feature);

class FeatureSet {
 public:
  constexpr bool has(Feature f) const { return bits_ >> static_cast<uint32_t>(f) & 1u; }
  constexpr void add(Feature f) { bits_ |= 1u << static_cast<uint32_t>(f); }
  constexpr void remove(Feature f) { bits_ &= ~(1u << static_cast<uint32_t>(f)); }
  constexpr uint32_t bits() const { return bits_; }
  constexpr bool operator==(const FeatureSet&) const = default;

 private:
  uint32_t bits_ = 0;
};

// The kernel variants, leanest first: what each can do is compiled into it and nothing else.
enum class KernelVariant { local, local_shadows, mirrors, mirrors_shadows, glass, glass_shadows };
KernelVariant choose_variant(const FeatureSet& features);
std::string_view variant_name(KernelVariant variant);

// One thing that costs nothing because this scene or this view cannot show it.
struct LeftOut {
  enum class Kind { feature, light, other };
  std::string what = {};  // "light lights/2", "feature reflection", "material ivory", ...
  std::string why = {};   // a sentence
  std::string cost = {};  // what it would have cost, counted in this scene or view or measured by a bench; empty where
                          // neither can tell
  Kind kind = Kind::other;
  Feature feature = {};  // kind feature only
};

inline LeftOut left_out_feature(Feature feature, std::string why, std::string cost = {}) {
  return {"feature " + std::string(feature_name(feature)), std::move(why), std::move(cost), LeftOut::Kind::feature,
          feature};
}

// How far the scene's numbers lie apart: where it is hard on floating point.
struct Stiffness {
  double extent = 0.0;           // diagonal of the finite bodies' box, scene units
  double offset_ratio = 0.0;     // how far their middle lies from the origin, over the extent
  double size_ratio = 1.0;       // the largest body's diagonal over the smallest one's
  double shininess = 0.0;        // the largest exponent
  double intensity_ratio = 1.0;  // the brightest light over the dimmest
};

struct Plan {
  FeatureSet features;  // what the kernel does
  std::string kernel;   // the variant's name, e.g. "mirrors+shadows"
  std::string isa;      // instruction set the kernel is dispatched to, e.g. "AVX3"
  std::vector<LeftOut> left_out;
  std::vector<SceneWarning> warnings;  // what only compiling and planning find
  int64_t bodies = 0, triangles_stored = 0, triangles_instanced = 0, lights = 0;
  int64_t memory_bytes = 0;               // of the compiled scene
  Vec3 bounds_min{0.0}, bounds_max{0.0};  // of the finite bodies, scene units
  Stiffness stiffness;
  double compile_ms = 0.0, plan_ms = 0.0;
};

// The plan as a JSON object.
std::string plan_json(const Plan& plan);

// What reading the document found, then what compiling and planning found, as a JSON array.
std::string warnings_json(const std::vector<SceneWarning>& read, const std::vector<SceneWarning>& planned);

}  // namespace tilelight
