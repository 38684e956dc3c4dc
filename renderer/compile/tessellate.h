// SPDX-License-Identifier: Apache-2.0
// Tessellation: spheres become triangles, as fine as a view needs. Boxes are made of flat faces already and planes have
// no end; both stay what they are.
#pragma once

#include <memory>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"

namespace tilelight {

// The least detail, of a few, with which a sphere's mesh lies within chord_error_px of it, as seen from the eye. The
// eye counts as no nearer to its surface than a sixteenth of the radius. kMaxSphereDetail where none suffices.
// REQUIRES: a sphere.
int sphere_detail(const CompiledBody& sphere, const Eye& eye, double chord_error_px);

// How the spheres of a scene are cut for a view: to the error that it asks for, or to twice, four times, ... that, so
// that they come to no more than kMostSphereTriangles. Many spheres of the coarsest cut may be more.
inline constexpr int64_t kMostSphereTriangles = 2'000'000;
struct SphereCut {
  double chord_error_px = 0.0;
  int64_t triangles = 0;
};
SphereCut sphere_cut(const CompiledScene& scene, const Eye& eye, double chord_error_px);

// What the view is drawn from: the same scene with its spheres as meshes, if the view asks for triangles; bodies keep
// their places. The scene itself where nothing changes.
std::shared_ptr<const CompiledScene> drawn_scene(const std::shared_ptr<const CompiledScene>& scene,
                                                 const ViewPlan& plan, TilePool& pool);

}  // namespace tilelight
