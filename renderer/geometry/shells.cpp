// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/shells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "renderer/base/elementary.h"
#include "renderer/geometry/edge_pairs.h"
#include "renderer/geometry/extent.h"

namespace tilelight {
namespace {

// Volumes below this part of the terms they are summed of are rounding.
constexpr double kNoVolume = 0x1p-40;

struct UsedEdge {
  uint32_t low, high, triangle;
  bool is_upward;
  bool is_same_as(const UsedEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<UsedEdge> sorted_edges(const TriMesh& mesh) {
  std::vector<UsedEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t from = mesh.triangles[t][k], to = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const UsedEdge& a, const UsedEdge& b) {
    return a.low != b.low ? a.low < b.low : a.high != b.high ? a.high < b.high : a.triangle < b.triangle;
  });
  return edges;
}

class Groups {
 public:
  explicit Groups(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t of(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) { parent_[of(a)] = of(b); }

 private:
  std::vector<uint32_t> parent_;
};

// visit(first, last) for the uses of every edge.
template <class Visit>
void for_each_edge(const std::vector<UsedEdge>& edges, const Visit& visit) {
  for (size_t first = 0, last = 0; first < edges.size(); first = last) {
    while (last < edges.size() && edges[last].is_same_as(edges[first])) ++last;
    visit(first, last);
  }
}

// The groups whose edges do not come out even: none of them is closed by itself.
std::vector<bool> find_open(const std::vector<UsedEdge>& edges, Groups& groups, size_t triangles) {
  std::vector<bool> is_open(triangles, false);
  std::vector<std::pair<uint32_t, int>> sums;  // by group, of one edge
  for_each_edge(edges, [&](size_t first, size_t last) {
    if (last - first == 2) return;
    sums.clear();
    for (size_t i = first; i < last; ++i) {
      const uint32_t group = groups.of(edges[i].triangle);
      auto sum = std::find_if(sums.begin(), sums.end(), [&](const auto& s) { return s.first == group; });
      if (sum == sums.end()) sum = sums.insert(sums.end(), {group, 0});
      sum->second += edges[i].is_upward ? 1 : -1;
    }
    for (const auto& [group, sum] : sums) {
      if (sum != 0) is_open[group] = true;
    }
  });
  return is_open;
}

// Of triangles with the same corners that are wound the same way: a number for each, from 0 on.
std::vector<uint32_t> number_copies(const TriMesh& mesh) {
  const auto rotated = [&](uint32_t t) {
    std::array<uint32_t, 3> facet = mesh.triangles[t];
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    return facet;
  };
  std::vector<uint32_t> order(mesh.triangles.size()), copies(mesh.triangles.size(), 0);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return std::pair(rotated(a), a) < std::pair(rotated(b), b); });
  for (size_t i = 1; i < order.size(); ++i) {
    if (rotated(order[i]) == rotated(order[i - 1])) copies[order[i]] = copies[order[i - 1]] + 1;
  }
  return copies;
}

// Joins the groups that are not closed by themselves, edge by edge with those that close them.
void join_open(const TriMesh& mesh, const std::vector<UsedEdge>& edges, Groups& groups) {
  const std::vector<bool> is_open = find_open(edges, groups, mesh.triangles.size());
  if (std::find(is_open.begin(), is_open.end(), true) == is_open.end()) return;
  std::vector<uint32_t> group_of(mesh.triangles.size());
  for (uint32_t t = 0; t < group_of.size(); ++t) group_of[t] = groups.of(t);
  const std::vector<uint32_t> copies = number_copies(mesh);
  std::vector<EdgeUse> uses;
  for_each_edge(edges, [&](size_t first, size_t last) {
    if (last - first == 2) return;
    uses.clear();
    const Vec3 &low = mesh.positions[edges[first].low], &high = mesh.positions[edges[first].high];
    for (size_t i = first; i < last; ++i) {
      const uint32_t t = edges[i].triangle;
      if (!is_open[group_of[t]]) continue;
      const auto& [a, b, c] = mesh.triangles[t];
      const uint32_t third = a ^ b ^ c ^ edges[i].low ^ edges[i].high;
      uses.push_back({mesh.positions[third] - low, t, edges[i].is_upward, copies[t]});
    }
    if (uses.empty()) return;
    for (const auto& [a, b] : pair_uses(high - low, uses)) groups.join(a, b);
  });
}

// Its part of all directions that a triangle takes as seen from a point, in full turns about it; positive from the
// inner side (van Oosterom and Strackee 1983). Summed over a closed surface: its winding number.
double turns_about(const Vec3& from, const Vec3& v0, const Vec3& v1, const Vec3& v2) {
  constexpr double kWhole = 6.283185307179586;
  const Vec3 a = v0 - from, b = v1 - from, c = v2 - from;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double volume = glm::dot(a, glm::cross(b, c));
  const double under = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return elementary::atan2(volume, under) / kWhole;
}

// Which shells are cavities, asked for one after the other.
class CavityFinder {
 public:
  CavityFinder(const TriMesh& mesh, const Shells& shells)
      : mesh_(mesh), triangles_(shells.volume.size()), extents_(shells.volume.size()) {
    for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const uint32_t shell = shells.of_triangle[t];
      triangles_[shell].push_back(t);
      for (const uint32_t v : mesh.triangles[t]) extents_[shell].grow(mesh.positions[v]);
    }
  }

  // Whether the others, wound by these signs, fill the place of a shell: the middle one of its places' answers.
  bool is_cavity(uint32_t shell, const std::vector<double>& signs) {
    constexpr size_t kPlaces = 5;
    constexpr double kFilled = 0.75;  // 0.5 is on a surface
    const std::vector<uint32_t>& own = triangles_[shell];
    const size_t count = std::min(kPlaces, own.size());
    std::vector<double> windings(count, 0.0);
    for (uint32_t other = 0; other < triangles_.size(); ++other) {
      if (!spend(1)) return true;
      if (other == shell || !extents_[other].holds(extents_[shell])) continue;
      for (size_t i = 0; i < count; ++i) {
        if (!spend(kCostOfTurns * static_cast<int64_t>(triangles_[other].size()))) return true;
        windings[i] += signs[other] * winding(other, middle_of(own[i * own.size() / count]));
      }
    }
    std::sort(windings.begin(), windings.end());
    return windings[count / 2] > kFilled;
  }

 private:
  // Thousands of shells inside each other would take the square of their number: when this much is spent, what is left
  // is taken as it is wound.
  static constexpr int64_t kMostWork = 100'000'000, kCostOfTurns = 50;
  bool spend(int64_t work) { return (spent_ += work) <= kMostWork; }

  Vec3 middle_of(uint32_t triangle) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return mesh_.positions[a] / 3.0 + mesh_.positions[b] / 3.0 + mesh_.positions[c] / 3.0;
  }
  double winding(uint32_t shell, const Vec3& place) const {
    double sum = 0.0;
    for (const uint32_t t : triangles_[shell]) {
      const auto& [a, b, c] = mesh_.triangles[t];
      sum += turns_about(place, mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]);
    }
    return sum;
  }

  const TriMesh& mesh_;
  std::vector<std::vector<uint32_t>> triangles_;
  std::vector<Extent> extents_;
  int64_t spent_ = 0;
};

}  // namespace

Shells find_shells(const TriMesh& mesh) {
  const std::vector<UsedEdge> edges = sorted_edges(mesh);
  Groups groups(mesh.triangles.size());
  for_each_edge(edges, [&](size_t first, size_t last) {
    if (last - first == 2) groups.join(edges[first].triangle, edges[first + 1].triangle);
  });
  join_open(mesh, edges, groups);

  Shells out;
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> number(mesh.triangles.size(), kNone);
  std::vector<Vec3> origin;
  std::vector<double> terms;
  double size = 0.0;
  for (const Vec3& p : mesh.positions) size = std::max({size, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    uint32_t& shell = number[groups.of(t)];
    const auto& [a, b, c] = mesh.triangles[t];
    if (shell == kNone) {
      shell = static_cast<uint32_t>(origin.size());
      origin.push_back(mesh.positions[a]);
      out.volume.push_back(0.0), terms.push_back(0.0);
    }
    const Vec3 u = (mesh.positions[a] - origin[shell]) / size, v = (mesh.positions[b] - origin[shell]) / size,
               w = (mesh.positions[c] - origin[shell]) / size;
    const double term = glm::dot(u, glm::cross(v, w));
    out.volume[shell] += term, terms[shell] += std::abs(term);
    out.of_triangle.push_back(shell);
  }
  for (size_t shell = 0; shell < terms.size(); ++shell) {
    if (std::abs(out.volume[shell]) <= kNoVolume * terms[shell]) out.volume[shell] = 0.0;
  }
  return out;
}

bool holds_volume(const Shells& shells) {
  return std::any_of(shells.volume.begin(), shells.volume.end(), [](double volume) { return volume != 0.0; });
}

std::vector<bool> find_inside_out(const TriMesh& mesh, const Shells& shells) {
  const double whole = std::accumulate(shells.volume.begin(), shells.volume.end(), 0.0);
  std::vector<double> signs(shells.volume.size(), whole < 0.0 ? -1.0 : 1.0);
  const auto is_negative = [&](uint32_t shell) { return signs[shell] * shells.volume[shell] < 0.0; };
  std::vector<uint32_t> negative;
  for (uint32_t shell = 0; shell < signs.size(); ++shell) {
    if (is_negative(shell)) negative.push_back(shell);
  }
  if (!negative.empty()) {
    // The largest first: what holds a shell is decided before it.
    std::stable_sort(negative.begin(), negative.end(),
                     [&](uint32_t a, uint32_t b) { return std::abs(shells.volume[a]) > std::abs(shells.volume[b]); });
    CavityFinder finder(mesh, shells);
    for (const uint32_t shell : negative) {
      if (!finder.is_cavity(shell, signs)) signs[shell] = -signs[shell];
    }
  }
  if (std::all_of(signs.begin(), signs.end(), [](double sign) { return sign > 0.0; })) return {};
  std::vector<bool> is_turned;
  for (const uint32_t shell : shells.of_triangle) is_turned.push_back(signs[shell] < 0.0);
  return is_turned;
}

TriMesh with_turned(const TriMesh& mesh, const std::vector<bool>& is_turned) {
  TriMesh out = mesh;
  for (size_t t = 0; t < out.triangles.size(); ++t) {
    if (!is_turned[t]) continue;
    std::swap(out.triangles[t][0], out.triangles[t][2]);
    if (!out.corner_normals.empty()) std::swap(out.corner_normals[t][0], out.corner_normals[t][2]);
  }
  return out;
}

}  // namespace tilelight
