// SPDX-License-Identifier: Apache-2.0
// Many hits made ready and lit side by side, in columns: what make_surface, sample_light and mirror_direction say of
// each, to the last bit. One thread a set of columns.
#pragma once

#include <span>
#include <vector>

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"
#include "renderer/shade/surface.h"

namespace tilelight {

// A number, or a vector, by hit. There is room for a register's width beyond the last.
using Column = std::vector<double>;
struct Column3 {
  Column x, y, z;
  Vec3 operator[](size_t i) const { return {x[i], y[i], z[i]}; }
  void set(size_t i, const Vec3& v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

struct SurfaceOptions {
  Shading shading = Shading::phong;
  bool smooth_terminator = true;  // light and shadow of rounded surfaces are those of what they stand for
  bool casts_shadows = true;      // SurfaceColumns::curve is asked for
  const Vec4* viewer = nullptr;   // whoever looks at all of them, as way_to_viewer has him; null: along the rays
};

// The fields of Surface, and what the light equation needs beside. What a miss has there is of no meaning.
struct SurfaceColumns {
  Column3 direction;  // of the ray
  Column3 position, geometric_normal, normal, ambient, diffuse;
  Column3 curve;  // where light comes over a curve: the place above the facet, on the curved surface; else the position
  Column3 specular;  // ks; this, shininess and is_specular in scenes that have the feature alone
  Column shininess;
  std::vector<uint8_t> from_outside, is_specular;  // 0 or 1
  // 0 or 1: the facet stands for a curved surface, and this shading has the light end where that one does.
  std::vector<uint8_t> is_lit_over_curve;
};
// REQUIRES: equal sizes.
void make_surfaces(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<const Hit> hits,
                   const SurfaceOptions& options, SurfaceColumns& out);

// One of them, alone.
Surface surface_of(const CompiledScene& scene, const SurfaceColumns& surfaces, const Hit& hit, size_t index);

// What one light brings to each surface before it is known whether something stands between.
struct LightColumns {
  Column3 light;                       // diffuse and specular part; 0 where not lit
  Column3 to_light;                    // unit, from where shadow rays start
  Column distance;                     // likewise; normalised units, infinite for a directional light
  std::vector<uint8_t> is_at_light;    // the light lies at the very place
  std::vector<uint8_t> is_from_curve;  // 0 or 1: shadow rays start on the curved surface, see terminator.h
};
// casts_shadow: to_light and distance are those of shadow rays; else of the place itself. REQUIRES: surfaces of the
// scene, and their number.
void light_surfaces(const CompiledScene& scene, const CompiledLight& light, const SurfaceColumns& surfaces,
                    size_t count, bool casts_shadow, LightColumns& out);

// The mirror directions.
void mirror_surfaces(const SurfaceColumns& surfaces, size_t count, Column3& out);

}  // namespace tilelight
