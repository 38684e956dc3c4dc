// SPDX-License-Identifier: Apache-2.0
// CompiledScene: what runs. World space here is *normalised*: the scene's centre at the origin and a power of two as
// scale, so that its finite bodies fit in [-1, 1]. Every mesh has a normalised local space of its own. Rays and hits
// live in double; boxes and the first test of triangles are float and only ever discard what certainly misses.
// Immutable after compile_scene; any thread may read.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "renderer/compile/bodies.h"
#include "renderer/compile/plan.h"
#include "renderer/compile/triangle_tree.h"

namespace tilelight {

struct CompiledMesh {
  // The exact triangles, local normalised space.
  std::vector<Vec3> positions;
  std::vector<std::array<uint32_t, 3>> triangles;
  std::vector<Vec3> normals;                            // shared corner normals, unit
  std::vector<std::array<uint32_t, 3>> corner_normals;  // into `normals`; empty = flat
  bool is_manifold = false, is_known_outward = false;   // see TriMesh
  Mat4 mesh_from_local{1.0};                            // undoes the normalisation
  std::array<Box, 8> octants{};  // around the positions in each octant; together they fit closely

  int64_t memory_bytes() const;
};

struct CompiledBody {
  BodyKind kind = BodyKind::sphere;
  bool has_solid_pattern = false;  // a checker counts its cells in three dimensions: spheres, also tessellated
  bool has_inside = true;          // it has one (sphere, box of some thickness, closed mesh)
  bool may_touch_itself = false;   // see Body
  bool may_touch_media = false;    // a medium whose surface may lie in one place with one of its own or another's
  Layer layer = Layer::opaque;     // see Body
  MaterialId material = 0;         // into CompiledScene::materials
  uint32_t body = 0;               // index into make_bodies' list: the public id
  uint32_t rank = 0;               // see Body
  const CompiledMesh* mesh = nullptr;
  const TriangleTree* tree = nullptr;  // of the mesh, in local space; null: its triangles are in the scene's tree
  Vec3 half{1.0};
  Vec3 rounding{0.0};          // of a box's faces, see Body; local units
  double face_rounding = 0.0;  // how far a surface may lie from where the document puts it, normalised units
  Mat4 local_from_world{1.0};
  Mat4 world_from_local{1.0};
  Mat3 world_from_normal{1.0};  // cofactor matrix, sign by determinant: takes outward to outward
  Mat4 pattern_from_local{1.0};
  std::string name;
};

// A light in normalised space. Intensities are colour * intensity.
struct CompiledLight {
  LightKind kind = LightKind::point;
  Vec3 position{0.0};
  Vec3 to_light{0.0};  // directional: unit
  Color intensity{0.0};
  bool shadow = true;
  uint32_t light = 0;  // index into Scene::lights
};

// A material with what it does not do taken away.
struct CompiledMaterial {
  Material source;
  bool is_specular = false, is_reflective = false, is_transmissive = false;
};

struct CompiledScene {
  std::vector<CompiledBody> bodies;  // finite ones first; `tree` is over them
  size_t finite_bodies = 0;          // bodies[finite_bodies..] are planes
  TriangleTree tree;                 // over bodies[0..finite_bodies)
  std::vector<std::shared_ptr<const CompiledMesh>> meshes;
  std::vector<std::shared_ptr<const TriangleTree>> mesh_trees;
  std::vector<CompiledMaterial> materials;
  size_t media = 0;  // bodies that are solid and transparent
  std::vector<CompiledLight> lights;
  Background background;
  Color ambient{0.0};
  Attenuation attenuation;
  Vec3 center{0.0};           // of the scene, user's units
  double units = 1.0;         // user's units a normalised unit; a power of two
  Vec3 bounding_center{0.0};  // of a sphere about the finite bodies, user's units
  double bounding_radius = 1.0;
  double passed_on = 0.0;        // no surface mirrors and lets through more than this part of the light, in sum
  double radiance_bound = -1.0;  // no ray brings more than this in any channel; negative: no finite bound is known
  Plan plan;
};

// A solid that lets light through; rays remember which of them they are in.
inline bool is_medium(const CompiledScene& scene, uint32_t body) {
  return scene.bodies[body].has_inside && scene.materials[scene.bodies[body].material].is_transmissive;
}

}  // namespace tilelight
