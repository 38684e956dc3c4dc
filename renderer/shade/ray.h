// SPDX-License-Identifier: Apache-2.0
// Ray and Hit: what travels between the kernels and the shading. Normalised world space, double.
#pragma once

#include <cstdint>
#include <limits>

#include "renderer/base/vec.h"

namespace tilelight {

inline constexpr uint32_t kNone = ~uint32_t{0};

// The primitive a ray has just left. Convex analytic bodies and planar triangles are skipped or answered by their other
// root, so no offset of the origin is needed.
struct Departure {
  uint32_t body = kNone;  // index into CompiledScene::bodies
  uint32_t prim = kNone;
};

// What a ray that leaves a surface does with other bodies' surfaces in the very same place. There surfaces lie in
// layers (CompiledBody::rank): films, then what is opaque, then media. A ray that goes on from a film meets those of a
// higher rank, one that goes back the films of a lower one. The surfaces of media in one place are crossed all at once,
// so that a ray that goes on from there meets none.
enum class Coincident : uint8_t { none, after, before };

struct Ray {
  Vec3 origin{0.0};
  Vec3 direction{0.0};  // unit
  Departure left;
  Coincident coincident = Coincident::none;
};

struct BoundedRay {
  Ray ray;
  double t_max = std::numeric_limits<double>::infinity();  // hits at or beyond it do not count
};

struct Hit {
  double t = std::numeric_limits<double>::infinity();  // along the ray
  uint32_t body = kNone;                               // index into CompiledScene::bodies; kNone: a miss
  uint32_t prim = 0;          // triangle of a mesh; face of a box (2 * axis + (1 on the upper side)); else 0
  double b0 = 0.0, b1 = 0.0;  // triangle: barycentric weights of vertices 0 and 1
  bool is_hit() const { return body != kNone; }
};

}  // namespace tilelight
