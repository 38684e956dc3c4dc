// SPDX-License-Identifier: Apache-2.0
// Bodies: the objects of a scene with chess positions set up and every shape reduced to one of four kinds. The last
// form in which the scene is still exact; the fast renderer and the double-precision reference both start here.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/geometry/tri_mesh.h"
#include "renderer/scene/scene.h"

namespace tilelight {

enum class BodyKind : uint8_t {
  sphere,  // unit sphere about the local origin
  box,     // [-half, half] in the local frame; a half extent may be 0
  plane,   // y = 0 in the local frame, infinite
  mesh     // triangles of *mesh
};

struct Body {
  BodyKind kind = BodyKind::sphere;
  Mat4 world_from_local{1.0};  // never singular
  Vec3 half{1.0};              // kind box only
  // Kind box only: how far its faces lie from where the document puts them, by the rounding of its middle, its half
  // sides and its place; scene units, by axis of the world.
  Vec3 rounding{0.0};
  // The frame in which a checker counts its cells: unit lengths are scene units, before the user's transform.
  // pattern = pattern_from_local * local point.
  Mat4 pattern_from_local{1.0};
  MaterialId material = 0;
  uint32_t object = 0;                  // index into Scene::objects
  std::shared_ptr<const TriMesh> mesh;  // kind mesh only; shared by all instances
  std::string name;                     // "objects/3", or "objects/0/e4" for a man of a chess position
};

// Ids of bodies are their places in this list; ties between surfaces go to the lower id.
std::vector<Body> make_bodies(const Scene& scene);

}  // namespace tilelight
