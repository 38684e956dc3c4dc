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

// Triangles that the spheres of a scene become.
int64_t tessellated_triangles(const CompiledScene& scene, const Eye& eye, double chord_error_px);

// What the view is drawn from: the same scene with its spheres as meshes, if the view asks for triangles; bodies keep
// their places. The scene itself where nothing changes.
std::shared_ptr<const CompiledScene> drawn_scene(const std::shared_ptr<const CompiledScene>& scene,
                                                 const ViewPlan& plan, TilePool& pool);

}  // namespace tilelight
