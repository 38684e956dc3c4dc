// SPDX-License-Identifier: Apache-2.0
// Surface: a hit made ready for the light equation: place, normals turned to the viewer, material at the place.
#pragma once

#include "renderer/base/safe_length.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"

namespace tilelight {

struct Surface {
  Vec3 position{0.0};          // normalised world, reprojected onto the primitive
  Vec3 geometric_normal{0.0};  // unit, towards the viewer
  Vec3 normal{0.0};            // for shading: unit, on the side of the geometric one
  bool from_outside = true;    // the ray meets the outer side: sign of Ng . d
  const CompiledBody* body = nullptr;
  const CompiledMaterial* material = nullptr;
  Color ambient{0.0}, diffuse{0.0};  // at this place
  Departure here;                    // for rays that leave from here
};

Surface make_surface(const CompiledScene& scene, const Ray& ray, const Hit& hit);

// The least cosine between a facet's normal and those of its corners: how far the curved surface that it stands for may
// be turned from it. 1 on what is flat or no mesh.
double facet_cosine(const Surface& surface);

// The unit way from a place to a viewer: xyz his place and w 1, or xyz the way to him and w 0.
inline Vec3 way_to_viewer(const Vec4& viewer, const Vec3& place) { return unit_of(Vec3(viewer) - viewer.w * place); }

// A place on a body's surface, in its local space. Normals outward and of any length.
struct LocalPoint {
  Vec3 position{0.0};
  Vec3 geometric{0.0};
  Vec3 shading{0.0};       // of what is smooth alone
  bool is_smooth = false;  // else it is shaded by its geometric normal
};
// The point with these weights of the first two corners, which need not lie in the triangle. REQUIRES: a mesh.
LocalPoint triangle_point(const CompiledMesh& mesh, uint32_t prim, double b0, double b1);
// A place on the primitive of a hit, seen along its ray.
Surface make_surface_at(const CompiledScene& scene, const Ray& ray, const Hit& hit, const LocalPoint& local);

}  // namespace tilelight
