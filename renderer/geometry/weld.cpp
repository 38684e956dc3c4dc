// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/weld.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "renderer/base/elementary.h"
#include "renderer/base/hash.h"

namespace tilelight {
namespace {

uint64_t position_hash(const Vec3& p) {
  uint64_t h = 0;
  for (int k = 0; k < 3; ++k) h = mix64(h ^ std::bit_cast<uint64_t>(p[k] + 0.0));  // -0 + 0 = +0
  return h;
}

// One edge that leaves a vertex, seen from one of the facets beside it.
struct Spoke {
  uint32_t far_end;
  uint32_t corner;  // place of the facet's corner in the vertex's list
};

uint32_t find_root(std::vector<uint32_t>& parent, uint32_t i) {
  while (parent[i] != i) i = parent[i] = parent[parent[i]];
  return i;
}

// Corners sorted by vertex: those of vertex v are corners[start[v]] .. corners[start[v + 1] - 1], each 3 * triangle +
// k.
struct CornersByVertex {
  std::vector<uint32_t> start, corners;
  explicit CornersByVertex(const TriMesh& mesh)
      : start(mesh.positions.size() + 1, 0), corners(3 * mesh.triangles.size()) {
    for (const auto& tri : mesh.triangles)
      for (uint32_t v : tri) ++start[v + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<uint32_t> next(start.begin(), start.end() - 1);
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (uint32_t k = 0; k < 3; ++k) corners[next[mesh.triangles[t][k]]++] = 3 * t + k;
  }
};

double corner_angle(const TriMesh& mesh, uint32_t corner) {
  const auto& tri = mesh.triangles[corner / 3];
  const Vec3& apex = mesh.positions[tri[corner % 3]];
  const Vec3 a = unit_or_zero(mesh.positions[tri[(corner % 3 + 1) % 3]] - apex);
  const Vec3 b = unit_or_zero(mesh.positions[tri[(corner % 3 + 2) % 3]] - apex);
  return elementary::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Groups the corners of one vertex: those joined through edges whose facets turn by no more than the crease get one
// root. On an edge of more than two facets only neighbours in order of index are compared, so that the cost stays
// linear.
void join_smooth_corners(const TriMesh& mesh, std::span<const uint32_t> corners, std::span<const Vec3> facet_normals,
                         double min_dot, std::vector<Spoke>& spokes, std::vector<uint32_t>& parent) {
  spokes.clear();
  parent.resize(corners.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (uint32_t c = 0; c < corners.size(); ++c) {
    const auto& tri = mesh.triangles[corners[c] / 3];
    spokes.push_back({tri[(corners[c] % 3 + 1) % 3], c});
    spokes.push_back({tri[(corners[c] % 3 + 2) % 3], c});
  }
  std::sort(spokes.begin(), spokes.end(), [](const Spoke& a, const Spoke& b) {
    return a.far_end != b.far_end ? a.far_end < b.far_end : a.corner < b.corner;
  });
  for (size_t s = 1; s < spokes.size(); ++s) {
    if (spokes[s].far_end != spokes[s - 1].far_end) continue;
    const Vec3& n0 = facet_normals[corners[spokes[s - 1].corner] / 3];
    const Vec3& n1 = facet_normals[corners[spokes[s].corner] / 3];
    if (glm::dot(n0, n1) < min_dot) continue;
    parent[find_root(parent, spokes[s].corner)] = find_root(parent, spokes[s - 1].corner);
  }
}

// Whether every corner has the normal of its facet, up to rounding: the mesh needs no others.
bool is_faceted(const TriMesh& mesh, const std::vector<Vec3>& facet_normals) {
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const Vec3& normal : mesh.corner_normals[t]) {
      if (!(glm::dot(normal, facet_normals[t]) > 1.0 - 0x1p-40)) return false;
    }
  }
  return true;
}

}  // namespace

Weld weld_positions(std::span<const Vec3> source) {
  Weld weld;
  weld.from_source.resize(source.size());
  constexpr uint32_t kEmpty = std::numeric_limits<uint32_t>::max();
  const size_t slots = std::bit_ceil(std::max<size_t>(16, 2 * source.size()));
  std::vector<uint32_t> table(slots, kEmpty);  // open addressing: at most half full
  for (size_t i = 0; i < source.size(); ++i) {
    size_t slot = position_hash(source[i]) & (slots - 1);
    while (table[slot] != kEmpty && weld.positions[table[slot]] != source[i]) slot = (slot + 1) & (slots - 1);
    if (table[slot] == kEmpty) {
      table[slot] = static_cast<uint32_t>(weld.positions.size());
      weld.positions.push_back(source[i] + Vec3(0.0));
    }
    weld.from_source[i] = table[slot];
  }
  return weld;
}

void set_crease_normals(TriMesh& mesh, double crease_deg) {
  std::vector<Vec3> facet_normals(mesh.triangles.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& tri = mesh.triangles[t];
    facet_normals[t] = geometric_normal(mesh.positions[tri[0]], mesh.positions[tri[1]], mesh.positions[tri[2]]);
  }
  // A little slack, so that an edge of exactly the crease angle is smooth whatever its rounding.
  const double min_dot =
      crease_deg >= 180.0 ? -2.0 : elementary::cos(elementary::rad_from_deg(std::max(crease_deg, 0.0))) - 1e-9;
  const CornersByVertex by_vertex(mesh);
  mesh.corner_normals.assign(mesh.triangles.size(), {});
  std::vector<Spoke> spokes;
  std::vector<uint32_t> parent;
  std::vector<Vec3> sums;
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const std::span<const uint32_t> corners(by_vertex.corners.data() + by_vertex.start[v],
                                            by_vertex.start[v + 1] - by_vertex.start[v]);
    join_smooth_corners(mesh, corners, facet_normals, min_dot, spokes, parent);
    sums.assign(corners.size(), Vec3(0.0));
    for (uint32_t c = 0; c < corners.size(); ++c)
      sums[find_root(parent, c)] += facet_normals[corners[c] / 3] * corner_angle(mesh, corners[c]);
    for (uint32_t c = 0; c < corners.size(); ++c) {
      const Vec3& sum = sums[find_root(parent, c)];
      const bool vanishes = !(glm::dot(sum, sum) > 1e-24);  // facets that cancel leave only rounding
      mesh.normals_repaired += vanishes;
      mesh.corner_normals[corners[c] / 3][corners[c] % 3] =
          vanishes ? facet_normals[corners[c] / 3] : unit_or_zero(sum);
    }
  }
  if (is_faceted(mesh, facet_normals)) mesh.corner_normals.clear();
}

}  // namespace tilelight
