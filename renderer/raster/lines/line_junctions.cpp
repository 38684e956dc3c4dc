// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <tuple>
#include <utility>

#include "renderer/raster/lines/close_pairs.h"
#include "renderer/raster/lines/line_candidates.h"

namespace tilelight::lines {
namespace {

// Faces whose planes meet at a smaller angle (sine) touch or miss each other, they do not cross.
constexpr double kParallelSine = 1e-9;

using Segment = std::pair<Vec3, Vec3>;

bool is_before(const Vec3& a, const Vec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); }

// Where a polygon crosses a plane. A corner in the plane counts as under it: so of the faces around an edge that lies
// in the plane those above it cross there, once.
std::optional<Segment> crossing(const Polygon& polygon, const HalfSpace& plane, double touch) {
  std::array<double, 5> height{};
  for (int c = 0; c < polygon.corners; ++c) height[c] = plane.height(polygon.corner[c]);
  std::array<Vec3, 2> ends;
  int found = 0;
  for (int c = 0; c < polygon.corners && found < 2; ++c) {
    const int next = (c + 1) % polygon.corners;
    if ((height[c] > touch) == (height[next] > touch)) continue;
    // The same bits for both faces of an edge.
    const bool is_first = is_before(polygon.corner[c], polygon.corner[next]);
    const int a = is_first ? c : next, b = is_first ? next : c;
    const double t = std::clamp(height[a] / (height[a] - height[b]), 0.0, 1.0);
    ends[found++] = between(polygon.corner[a], polygon.corner[b], t);
  }
  return found == 2 ? std::optional(Segment(ends[0], ends[1])) : std::nullopt;
}

HalfSpace plane_of(const LineBody& body, uint32_t face) {
  const Vec3& normal = body.normals[face];
  return {normal, glm::dot(normal, body.points[body.shape->faces[face].vertex[0]])};
}

// What two segments on one line have in common.
std::optional<Segment> overlap(Segment a, Segment b, const Vec3& way, double least) {
  const auto at = [&](const Vec3& p) { return glm::dot(way, p); };
  for (Segment* s : {&a, &b})
    if (at(s->first) > at(s->second)) std::swap(s->first, s->second);
  const Vec3& from = at(a.first) >= at(b.first) ? a.first : b.first;
  const Vec3& to = at(a.second) <= at(b.second) ? a.second : b.second;
  if (!(at(to) - at(from) > least)) return std::nullopt;
  return Segment(from, to);
}

class Junctions {
 public:
  Junctions(const LineBodies& bodies, const LineView& view, bool with_hidden)
      : bodies_(bodies), view_(view), with_hidden_(with_hidden) {}

  // By faces of the first body, then of the second.
  std::vector<Candidate> of_bodies(uint32_t first, uint32_t second) const {
    const LineBody &a = bodies_.finite[first], &b = bodies_.finite[second];
    std::vector<std::pair<uint32_t, uint32_t>> pairs;
    visit_close_pairs(face_boxes(a), face_boxes(b), [&](uint32_t f, uint32_t g) { pairs.emplace_back(f, g); });
    std::sort(pairs.begin(), pairs.end());
    std::vector<Candidate> out;
    for (const auto& [f, g] : pairs) {
      const HalfSpace plane_a = plane_of(a, f), plane_b = plane_of(b, g);
      const Vec3 way = glm::cross(plane_a.normal, plane_b.normal);
      const double sine = glm::length(way);
      if (!(sine > kParallelSine)) continue;
      const auto in_a = crossing(a.polygon(f), plane_b, view_.touch());
      if (!in_a) continue;
      const auto in_b = crossing(b.polygon(g), plane_a, view_.touch());
      if (!in_b) continue;
      if (const auto both = overlap(*in_a, *in_b, way / sine, view_.touch()))
        add(out, *both, {FaceId{first, f}, FaceId{second, g}});
    }
    return out;
  }

  std::vector<Candidate> of_plane(uint32_t body, const LinePlane& plane) const {
    std::vector<Candidate> out;
    const LineBody& a = bodies_.finite[body];
    if (a.points.empty()) return out;
    const auto [low, high] = std::minmax_element(a.points.begin(), a.points.end(), [&](const Vec3& p, const Vec3& q) {
      return plane.above.height(p) < plane.above.height(q);
    });
    if (plane.above.height(*low) > view_.touch() || plane.above.height(*high) <= view_.touch()) return out;
    for (uint32_t f = 0; f < a.shape->faces.size(); ++f) {
      if (glm::length(glm::cross(a.normals[f], plane.above.normal)) <= kParallelSine) continue;
      if (const auto found = crossing(a.polygon(f), plane.above, view_.touch()))
        add(out, *found, {FaceId{body, f}, FaceId{plane.body, kNoFace}});
    }
    return out;
  }

 private:
  std::vector<NamedBox> face_boxes(const LineBody& body) const {
    std::vector<NamedBox> out;
    for (uint32_t f = 0; f < body.shape->faces.size(); ++f) {
      if (!with_hidden_ && is_back(body, f)) continue;
      NamedBox& named = out.emplace_back();
      named.name = f;
      const LineFace& face = body.shape->faces[f];
      for (uint32_t c = 0; c < face.corners; ++c) named.box.grow(body.points[face.vertex[c]]);
      named.box.lo -= view_.touch(), named.box.hi += view_.touch();
    }
    return out;
  }

  static bool is_back(const LineBody& body, uint32_t face) { return body.hides_backs && body.facing[face] < 0; }

  void add(std::vector<Candidate>& out, const Segment& segment, const std::array<FaceId, 2>& faces) const {
    bool is_behind = false;
    for (const FaceId& id : faces)
      is_behind = is_behind || (id.face != kNoFace && is_back(bodies_.finite[id.body], id.face));
    if (is_behind && !with_hidden_) return;
    const auto& [from, to] = segment;
    const Span span = view_.in_image(from, to);
    if (span.is_empty() || !(glm::length(to - from) > view_.touch())) return;
    out.push_back({from, to, span, LineKind::junction, is_behind, faces[0].body, faces[1].body, faces});
  }

  const LineBodies& bodies_;
  const LineView& view_;
  bool with_hidden_;
};

// Each pair of finite bodies that may meet, lower one first, in order.
std::vector<std::pair<uint32_t, uint32_t>> close_bodies(const LineBodies& bodies, double touch) {
  std::vector<NamedBox> boxes;
  for (uint32_t i = 0; i < bodies.finite.size(); ++i) {
    const LineBody& body = bodies.finite[i];
    if (!body.points.empty()) boxes.push_back({{body.lo - touch, body.hi + touch}, i});
  }
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  visit_close_pairs(boxes, boxes, [&](uint32_t a, uint32_t b) {
    if (a < b) pairs.emplace_back(a, b);
  });
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<Candidate> junction_candidates(const LineBodies& bodies, const LineView& view, TilePool& pool,
                                           bool with_hidden, const std::atomic<bool>* stop) {
  const Junctions junctions(bodies, view, with_hidden);
  const auto pairs = close_bodies(bodies, view.touch());
  const auto bodies_and_planes = static_cast<int64_t>(bodies.finite.size() * bodies.planes.size());
  const auto pair_count = static_cast<int64_t>(pairs.size());
  std::vector<std::vector<Candidate>> found(pair_count + bodies_and_planes);
  pool.parallel_for(
      static_cast<int64_t>(found.size()), Priority::normal,
      [&](int64_t i) {
        if (i < pair_count) {
          found[i] = junctions.of_bodies(pairs[i].first, pairs[i].second);
        } else {
          const auto at = static_cast<size_t>(i - pair_count);
          found[i] = junctions.of_plane(static_cast<uint32_t>(at % bodies.finite.size()),
                                        bodies.planes[at / bodies.finite.size()]);
        }
      },
      stop);
  std::vector<Candidate> out;
  for (const auto& part : found) out.insert(out.end(), part.begin(), part.end());
  return out;
}

}  // namespace tilelight::lines
