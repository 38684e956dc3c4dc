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

// What a body is where surfaces lie in one place.
enum class Layer : uint8_t {
  film,    // transparent and without an inside: planes, open meshes, flat boxes
  opaque,  // lets no light through
  medium   // transparent, with an inside
};

struct Body {
  BodyKind kind = BodyKind::sphere;
  Mat4 world_from_local{1.0};  // never singular
  Vec3 half{1.0};              // kind box only
  // Kind box only: how far its faces lie from where the numbers of the scene put them, by the rounding of its middle,
  // its half sides and its place; scene units, by axis of the world.
  Vec3 rounding{0.0};
  // The frame in which a checker counts its cells: unit lengths are scene units, before the user's transform.
  // pattern = pattern_from_local * local point.
  Mat4 pattern_from_local{1.0};
  MaterialId material = 0;
  uint32_t object = 0;                  // index into Scene::objects
  std::shared_ptr<const TriMesh> mesh;  // kind mesh only; shared by all instances
  bool has_inside = true;
  bool is_turned = false;  // a transparent mesh that was wound inside out, as a whole or in part; `mesh` is not
  // A transparent mesh of several shells, of some that share edges, or of one whose facets lie on each other.
  bool may_touch_itself = false;
  Layer layer = Layer::opaque;
  // Of surfaces in one place the one of the lowest rank is met first. Films come first, then what is opaque, by id,
  // then media: the higher priority first, then the higher ior; then what else tells materials, shapes and placements
  // apart, so that the order of a scene's objects does not count. No two bodies have the same.
  uint32_t rank = 0;
  std::string name;  // "objects/3", or "objects/0/e4" for a man of a chess position
};

// Ids of bodies are their places in this list.
std::vector<Body> make_bodies(const Scene& scene);

// Sets layer and rank. REQUIRES: everything else; materials of the scene.
void set_ranks(const Scene& scene, std::vector<Body>& bodies);

}  // namespace tilelight
