// SPDX-License-Identifier: Apache-2.0
// The passes of compile_scene, in the order in which they run. Each is pure: values in, values out; what it leaves out
// it says in the list it is given.
#pragma once

#include <vector>

#include "renderer/compile/compiled_scene.h"

namespace tilelight {

using LeftOutList = std::vector<LeftOut>;

// Keeps the materials that some body wears and points the bodies at their new places.
std::vector<CompiledMaterial> drop_unused_materials(const Scene& scene, std::vector<Body>& bodies,
                                                    LeftOutList& left_out);

// Keeps the lights that can light something: not black, and some material reflects light at all.
std::vector<CompiledLight> drop_dead_lights(const Scene& scene, const std::vector<CompiledMaterial>& materials,
                                            LeftOutList& left_out);

// Compiles every mesh once, sets all bodies in the scene's normalised space, planes last, and measures the bounds.
// Fills bodies, finite_bodies, meshes, center, units, bounding sphere and the plan's bounds and counts.
void rebase_and_normalise(const std::vector<Body>& bodies, CompiledScene& out);

// What the kernel has to do for this scene, and the reasons for what it need not do.
FeatureSet find_features(const CompiledScene& scene, LeftOutList& left_out);

// Transparent meshes without an inside, and those that were wound inside out. One warning a body.
std::vector<SceneWarning> find_odd_glass(const std::vector<Body>& bodies);

// The scene's tree over the finite bodies, and the trees of meshes that keep one of their own.
void build_trees(TilePool& pool, CompiledScene& out);

// Sets may_touch_media: where rays have to ask what else lies in the place of a surface. REQUIRES: the trees.
void find_touching_media(CompiledScene& scene);

// The largest part of the light that reaches a surface which it mirrors or lets through, every channel.
double find_passed_on(const CompiledScene& scene);

// An upper bound of the light any ray brings, every channel: B of the truncation bound w * B. Negative if none is
// finite. REQUIRES: scene.passed_on.
double find_radiance_bound(const CompiledScene& scene);

// REQUIRES: the plan's bounds.
Stiffness find_stiffness(const CompiledScene& scene);

// World-space box of a finite body, in the scene's normalised space.
Box body_bounds(const CompiledBody& body);

}  // namespace tilelight
