// SPDX-License-Identifier: Apache-2.0
// compile_scene: Scene -> CompiledScene, immutable and independent of the camera, by named passes. plan_view: with a
// View -> ViewPlan in under a millisecond. The one gate between what was asked for and what runs.
#pragma once

#include <memory>
#include <string_view>

#include "renderer/compile/eye.h"
#include "renderer/compile/plan.h"
#include "renderer/scene/scene.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight {

struct CompiledScene;  // renderer/compile/compiled_scene.h, for kernels

// Never fails on a parsed Scene. Runs on the calling thread and, for large meshes, on idle threads of the pool.
std::shared_ptr<const CompiledScene> compile_scene(const Scene& scene, TilePool& pool);

// What compiling left out, counted and measured. The same for every view.
const Plan& scene_plan(const CompiledScene& scene);

// Everything one render needs to know beside the compiled scene.
struct ViewPlan {
  View view;      // with the camera filled in
  Camera camera;  // as used, user's units
  Eye eye;        // the camera in normalised space
  FeatureSet features;
  KernelVariant variant = KernelVariant::local;
  Plan plan;  // the scene's plan and what this view adds to it
};
// isa: the instruction set the kernels are dispatched to; render.h has a plan_view that knows it.
ViewPlan plan_view(const CompiledScene& scene, const View& view, std::string_view isa);

// A camera that frames the finite bodies from azimuth 30, elevation 25 degrees with 5 % margin.
Camera framed_camera(const CompiledScene& scene, int width, int height);

}  // namespace tilelight
