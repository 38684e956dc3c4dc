// SPDX-License-Identifier: Apache-2.0
// Meshes for the catalogue, as values and as text of the scene language.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/rays.h"
#include "renderer/scene/scene.h"

namespace tilelight::check {

// A plane along no axis: unit vectors in it and across it, right-handed.
inline const Vec3 kAcross(2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0), kAlong(6.0 / 7.0, 2.0 / 7.0, -3.0 / 7.0),
    kNormal(-3.0 / 7.0, 6.0 / 7.0, -2.0 / 7.0);

// An icosahedron subdivided `levels` times onto the unit sphere: closed, 20 * 4^levels triangles.
MeshData icosphere(int levels);

// A square of that plane with sides of 2 * half, cut into steps * steps cells of two triangles.
MeshData sheet(double half, int steps, bool other_diagonal = false);
// Of an object: the turn that takes the axes x, y, z to kAlong, kNormal and their cross product.
std::string turn_text();

// Every position p becomes size * (p + offset).
MeshData placed(MeshData mesh, double size, const Vec3& offset);

// {"positions": [...], "indices": [...], <more>}
std::string mesh_text(const MeshData& mesh, const std::string& more = {});
// A document of this one mesh, without lights; object: more keys of the object, each with its comma before it.
std::string mesh_document(const MeshData& mesh, const std::string& object = {});

// Where rays are aimed: a point of the edge between two vertices, or a vertex itself (a == b).
struct Target {
  Vec3 at{0.0};
  uint32_t a = 0, b = 0;
};

// A mesh whose triangles can be asked for by vertex.
class Rimmed {
 public:
  explicit Rimmed(MeshData mesh);
  const MeshData& mesh() const { return mesh_; }
  size_t triangle_count() const { return mesh_.indices.size() / 3; }
  const Vec3& corner(size_t triangle, int k) const {
    return mesh_.positions[mesh_.indices[3 * triangle + static_cast<size_t>(k)]];
  }

  Target on_edge(Random& random) const;
  Target on_vertex(Random& random) const;

  // Whether test(triangle) holds for any triangle; those around the target are asked first.
  template <class Test>
  bool any(const Target& target, const Test& test) const {
    for (const uint32_t v : {target.a, target.b})
      for (const uint32_t t : around_[v])
        if (test(t)) return true;
    for (size_t t = 0; t < triangle_count(); ++t)
      if (test(t)) return true;
    return false;
  }

 private:
  MeshData mesh_;
  std::vector<std::vector<uint32_t>> around_;  // triangles by vertex
};

// Moeller and Trumbore over the mesh as it stands, in float. epsilon: of the determinant.
bool textbook_hits(const Rimmed& mesh, const Target& target, const Vec3& origin, const Vec3& direction,
                   float epsilon = 1e-6f);

}  // namespace tilelight::check
