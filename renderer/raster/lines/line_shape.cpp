// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_shape.h"

#include <algorithm>
#include <numeric>

#include "renderer/base/facet.h"

namespace tilelight::lines {
namespace {

// A user's normals are rarely exact, and those of patches that meet smoothly differ by rounding of another kind.
constexpr double kSmoothCosine = 0.996;  // 5 degrees

// A mesh's local space is normalised: a vertex this little over a face of a convex solid is rounding.
constexpr double kFlat = 1e-9;

struct HalfEdge {
  uint32_t low, high;  // vertices
  uint32_t face;
  uint8_t corner;     // the face's corner from which it starts
  bool is_ascending;  // from low to high
};

std::vector<HalfEdge> sorted_half_edges(const std::vector<LineFace>& faces) {
  std::vector<HalfEdge> out;
  out.reserve(faces.size() * 3);
  for (uint32_t f = 0; f < faces.size(); ++f) {
    const LineFace& face = faces[f];
    for (uint32_t c = 0; c < face.corners; ++c) {
      const uint32_t a = face.vertex[c], b = face.vertex[(c + 1) % face.corners];
      out.push_back({std::min(a, b), std::max(a, b), f, static_cast<uint8_t>(c), a < b});
    }
  }
  std::sort(out.begin(), out.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.face < b.face;
  });
  return out;
}

// Of two faces at their common edge, by the corner normals there.
Sharpness sharpness_of(const CompiledMesh* mesh, const HalfEdge& a, const HalfEdge& b) {
  if (!mesh || mesh->corner_normals.empty()) return Sharpness::by_angle;
  const auto normal_at = [&](const HalfEdge& h, bool at_low) {
    const int corner = h.is_ascending == at_low ? h.corner : (h.corner + 1) % 3;
    return mesh->corner_normals[h.face][corner];
  };
  for (const bool at_low : {true, false}) {
    const uint32_t i = normal_at(a, at_low), j = normal_at(b, at_low);
    if (i != j && glm::dot(mesh->normals[i], mesh->normals[j]) < kSmoothCosine) return Sharpness::sharp;
  }
  return Sharpness::smooth;
}

// mesh: for its normals; may be null.
std::vector<LineEdge> edges_of(const std::vector<LineFace>& faces, const CompiledMesh* mesh) {
  const std::vector<HalfEdge> halves = sorted_half_edges(faces);
  std::vector<LineEdge> edges;
  edges.reserve(halves.size() / 2);
  for (size_t begin = 0, end = 0; begin < halves.size(); begin = end) {
    const HalfEdge& first = halves[begin];
    while (end < halves.size() && halves[end].low == first.low && halves[end].high == first.high) ++end;
    LineEdge& edge = edges.emplace_back();
    edge.vertex = {first.low, first.high};
    edge.face[0] = first.face;
    if (end - begin != 2) continue;
    const HalfEdge& second = halves[begin + 1];
    edge.face[1] = second.face;
    edge.is_turned = first.is_ascending == second.is_ascending;
    edge.sharpness = sharpness_of(mesh, first, second);
  }
  return edges;
}

// The parts of a mesh that hang together by edges, by their first face.
std::vector<uint32_t> parts_of(const LineShape& shape) {
  std::vector<uint32_t> root(shape.faces.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](uint32_t f) {
    while (root[f] != f) f = root[f] = root[root[f]];
    return f;
  };
  for (const LineEdge& edge : shape.edges) {
    if (edge.face[1] == kNoFace) continue;
    const uint32_t a = find(edge.face[0]), b = find(edge.face[1]);
    root[std::max(a, b)] = std::min(a, b);
  }
  for (uint32_t f = 0; f < root.size(); ++f) root[f] = find(f);
  return root;
}

bool are_parts_outward(const CompiledMesh& mesh, const std::vector<uint32_t>& parts) {
  std::vector<double> volume(parts.size(), 0.0);
  for (size_t f = 0; f < parts.size(); ++f) {
    const auto& [a, b, c] = mesh.triangles[f];
    volume[parts[f]] += glm::dot(mesh.positions[a], glm::cross(mesh.positions[b], mesh.positions[c]));
  }
  for (size_t f = 0; f < parts.size(); ++f)
    if (parts[f] == f && !(volume[f] > 0.0)) return false;
  return true;
}

// A solid in one part of the sphere's kind (V - E + F = 2) whose edges are all convex: its map of normals covers the
// sphere (V - E + F) / 2 times and folds nowhere, so it is one to one and the solid is convex.
bool is_convex_solid(const CompiledMesh& mesh, const LineShape& shape, const std::vector<uint32_t>& parts) {
  if (std::any_of(parts.begin(), parts.end(), [](uint32_t part) { return part != 0; })) return false;
  std::vector<bool> is_used(mesh.positions.size(), false);
  for (const auto& triangle : mesh.triangles)
    for (const uint32_t v : triangle) is_used[v] = true;
  const auto vertices = std::count(is_used.begin(), is_used.end(), true);
  if (vertices + static_cast<int64_t>(shape.faces.size()) != static_cast<int64_t>(shape.edges.size()) + 2) return false;
  return std::all_of(shape.edges.begin(), shape.edges.end(), [&](const LineEdge& edge) {
    const auto& [a, b, c] = mesh.triangles[edge.face[0]];
    const Vec3 normal = geometric_normal(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
    const auto& other = mesh.triangles[edge.face[1]];
    return std::all_of(other.begin(), other.end(), [&](uint32_t v) {
      return glm::dot(normal, mesh.positions[v] - mesh.positions[edge.vertex[0]]) <= kFlat;
    });
  });
}

}  // namespace

LineShape make_mesh_shape(const CompiledMesh& mesh) {
  LineShape shape;
  shape.faces.reserve(mesh.triangles.size());
  for (const auto& [a, b, c] : mesh.triangles) shape.faces.push_back({{a, b, c, 0}, 3});
  shape.edges = edges_of(shape.faces, &mesh);
  if (!mesh.is_manifold || shape.faces.empty()) return shape;
  const std::vector<uint32_t> parts = parts_of(shape);
  shape.is_outward = are_parts_outward(mesh, parts);
  shape.is_convex = shape.is_outward && is_convex_solid(mesh, shape, parts);
  return shape;
}

LineShape make_box_shape() {
  LineShape shape;
  for (uint32_t axis = 0; axis < 3; ++axis) {
    const uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, w = 1u << axis;
    shape.faces.push_back({{0, v, u + v, u}, 4});
    shape.faces.push_back({{w, w + u, w + u + v, w + v}, 4});
  }
  shape.edges = edges_of(shape.faces, nullptr);
  for (LineEdge& edge : shape.edges) edge.sharpness = Sharpness::sharp;
  shape.is_outward = shape.is_convex = true;
  return shape;
}

}  // namespace tilelight::lines
