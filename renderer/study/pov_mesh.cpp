// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/pov_mesh.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/safe_length.h"
#include "renderer/compile/normalise.h"
#include "renderer/study/pov_text.h"

namespace tilelight {
namespace {

// POV-Ray takes a triangle for flat whose normals differ by less than 1e-5, whatever they are.
constexpr double kStillSmooth = 4e-5;

std::array<Vec3, 3> kept_smooth(std::array<Vec3, 3> normals) {
  const auto is_near = [&](int i) { return glm::length(normals[i] - normals[0]) < kStillSmooth; };
  if (!is_near(1) || !is_near(2)) return normals;
  const Vec3& n = normals[0];
  const Vec3 aside = std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  normals[1] = n + kStillSmooth * glm::normalize(glm::cross(n, aside));
  return normals;
}

void add_normals(PovText& text, const TriMesh& mesh) {
  text.add("normal_vectors { %zu", 3 * mesh.corner_normals.size());
  for (const auto& corners : mesh.corner_normals) {
    for (const Vec3& n : kept_smooth(corners)) text.add(","), text.vector(n);
  }
  text.add(" }\n");
}

}  // namespace

void for_each_smooth_corner(const Body& body, const PovCorner& visit) {
  if (body.kind != BodyKind::mesh) return;
  const TriMesh& mesh = *body.mesh;
  const Mat3 of_normals = glm::transpose(glm::inverse(Mat3(body.world_from_local)));
  for (size_t t = 0; t < mesh.corner_normals.size(); ++t) {
    const auto place = [&](size_t corner) { return mesh.positions[mesh.triangles[t][corner]]; };
    const Vec3 facet = glm::cross(place(1) - place(0), place(2) - place(0));
    for (size_t corner = 0; corner < 3; ++corner) {
      const Vec3& normal = mesh.corner_normals[t][corner];
      const double side = glm::dot(facet, normal) < 0.0 ? -1.0 : 1.0;
      visit(Vec3(body.world_from_local * Vec4(place(corner), 1.0)), of_normals * facet, of_normals * (side * normal));
    }
  }
}

PovMeshSpace pov_mesh_space(const TriMesh& mesh, double size) {
  Box box;
  for (const Vec3& p : mesh.positions) box.grow(p);
  const Normalisation to = normalise(box);
  PovMeshSpace out;
  for (int i = 0; i < 3; ++i) {
    out.mesh_from_local[i][i] = size / to.units, out.local_from_mesh[i][i] = to.units / size;
    out.mesh_from_local[3][i] = -to.center[i] * size / to.units, out.local_from_mesh[3][i] = to.center[i];
  }
  return out;
}

int dominant_axis(const TriMesh& mesh, size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Vec3 n = glm::abs(cross_of(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]));
  const double nearly = (1.0 - 0x1p-20) * std::max({n.x, n.y, n.z});
  return n.x >= nearly ? 0 : n.y >= nearly ? 1 : 2;
}

std::string pov_mesh(const TriMesh& mesh, const PovMeshSpace& space, const std::optional<PovFaceTextures>& textures) {
  const double scale = space.mesh_from_local[0][0];
  const Vec3 center(space.local_from_mesh[3]);
  PovText text;
  text.add("mesh2 { vertex_vectors { %zu", mesh.positions.size());
  for (const Vec3& p : mesh.positions) text.add(","), text.vector((p - center) * scale);
  text.add(" }\n");
  const bool is_smooth = !mesh.corner_normals.empty();
  if (is_smooth) add_normals(text, mesh);
  if (textures) {
    text.add("texture_list { 3");
    for (const std::string& texture : *textures) text.add(", texture { " + texture + " }");
    text.add(" }\n");
  }
  text.add("face_indices { %zu", mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& corners = mesh.triangles[t];
    text.add(",<%u,%u,%u>", corners[0], corners[1], corners[2]);
    if (textures) text.add(",%d", dominant_axis(mesh, t));
  }
  text.add(" }\n");
  if (is_smooth) {
    text.add("normal_indices { %zu", mesh.triangles.size());
    for (size_t t = 0; t < mesh.triangles.size(); ++t) text.add(",<%zu,%zu,%zu>", 3 * t, 3 * t + 1, 3 * t + 2);
    text.add(" }\n");
  }
  // How POV-Ray finds out whether the eye is inside: by counting crossings along a direction that meets no edge.
  if (mesh.closed) text.add("inside_vector <0.31415,0.59265,0.35897>\n");
  text.add("}");
  return text.str();
}

TriMesh box_mesh(const Vec3& half) {
  TriMesh mesh;
  for (int corner = 0; corner < 8; ++corner)
    mesh.positions.push_back(half * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t across = 1u << axis, u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3;
    if (half[static_cast<int>((axis + 1) % 3)] * half[static_cast<int>((axis + 2) % 3)] == 0.0) continue;
    const bool is_flat = half[static_cast<int>(axis)] == 0.0;
    for (const uint32_t side : {0u, across}) {
      if (is_flat && side == 0) continue;
      mesh.triangles.push_back({side, side | (side ? u : v), side | u | v});
      mesh.triangles.push_back({side, side | u | v, side | (side ? v : u)});
    }
  }
  mesh.closed = half.x > 0.0 && half.y > 0.0 && half.z > 0.0;
  return mesh;
}

}  // namespace tilelight
