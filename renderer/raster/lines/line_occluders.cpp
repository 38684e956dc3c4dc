// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_occluders.h"

#include <algorithm>
#include <span>

namespace tilelight::lines {
namespace {

std::vector<Shadow> make_shadows(const LineBodies& bodies, const LineView& view) {
  std::vector<Shadow> shadows(bodies.finite.size());
  for (size_t i = 0; i < shadows.size(); ++i) {
    const LineBody& body = bodies.finite[i];
    if (!body.is_whole) continue;
    Vec3 middle(0.0);
    for (const Vec3& p : body.points) middle += p / static_cast<double>(body.points.size());
    for (const LineEdge& edge : body.shape->edges) {
      if ((body.facing[edge.face[0]] > 0) == (body.facing[edge.face[1]] > 0)) continue;
      HalfSpace side = view.through_eye(body.points[edge.vertex[0]], body.points[edge.vertex[1]]);
      if (side.normal == Vec3(0.0)) continue;
      if (side.height(middle) > 0.0) side = {-side.normal, -side.offset};
      shadows[i].sides.push_back(side);
    }
    for (size_t f = 0; f < body.shape->faces.size(); ++f) {
      const Vec3& normal = body.normals[f];
      if (body.facing[f] > 0)
        shadows[i].fronts.push_back({normal, glm::dot(normal, body.points[body.shape->faces[f].vertex[0]])});
    }
  }
  return shadows;
}

std::vector<FaceId> make_items(const LineBodies& bodies) {
  std::vector<FaceId> items;
  for (uint32_t i = 0; i < bodies.finite.size(); ++i) {
    const LineBody& body = bodies.finite[i];
    if (!body.shape) continue;
    if (body.is_whole) {
      items.push_back({i, kNoFace});
      continue;
    }
    for (uint32_t f = 0; f < body.shape->faces.size(); ++f)
      if (body.hides_backs ? body.facing[f] > 0 : body.facing[f] != 0) items.push_back({i, f});
  }
  return items;
}

ScreenBox box_of(std::span<const Vec3> points, const LineView& view) {
  const auto in_front = std::count_if(points.begin(), points.end(), [&](const Vec3& p) { return view.is_in_front(p); });
  if (in_front == 0) return {};
  if (in_front < static_cast<std::ptrdiff_t>(points.size())) return {Vec2(0.0), Vec2(view.width(), view.height())};
  ScreenBox box;
  for (const Vec3& p : points) box.grow(view.pixel(p));
  return box;
}

std::vector<ScreenBox> boxes_of(const std::vector<FaceId>& items, const LineBodies& bodies, const LineView& view) {
  std::vector<ScreenBox> boxes;
  boxes.reserve(items.size());
  for (const FaceId& item : items) {
    const LineBody& body = bodies.finite[item.body];
    if (item.face == kNoFace) {
      boxes.push_back(box_of(body.points, view));
    } else {
      const Polygon polygon = body.polygon(item.face);
      boxes.push_back(box_of({polygon.corner.data(), static_cast<size_t>(polygon.corners)}, view));
    }
  }
  return boxes;
}

}  // namespace

LineOccluders::LineOccluders(const LineBodies& bodies, const LineView& view)
    : bodies_(bodies),
      view_(view),
      shadows_(make_shadows(bodies, view)),
      items_(make_items(bodies)),
      grid_(view.width(), view.height(), boxes_of(items_, bodies, view)),
      whole_bodies_(std::count_if(items_.begin(), items_.end(), [](const FaceId& i) { return i.face == kNoFace; })) {}

int64_t LineOccluders::hide(const Candidate& line, const Vec2& from, const Vec2& to, std::vector<Span>& hidden) const {
  int64_t asked = 0;
  // Whether nothing is left to hide.
  const auto add = [&](const Span& span) {
    ++asked;
    if (!span.is_empty()) hidden.push_back(span);
    return span.from <= line.in_image.from && span.to >= line.in_image.to;
  };
  for (const LinePlane& plane : bodies_.planes)
    if (plane.body != line.other && add(hidden_by(plane, line))) return asked;
  // Of a convex body nothing lies before a face that the eye sees.
  const auto lies_on_front_of = [&](uint32_t body) {
    return std::any_of(line.faces.begin(), line.faces.end(), [&](const FaceId& id) {
      return id.body == body && id.face != kNoFace && bodies_.finite[body].facing[id.face] > 0;
    });
  };
  grid_.visit(from, to, [&](uint32_t i) {
    const FaceId& item = items_[i];
    if (item.face == kNoFace) return !lies_on_front_of(item.body) && add(hidden_by(shadows_[item.body], line));
    return item != line.faces[0] && item != line.faces[1] && add(hidden_by(item, line));
  });
  return asked;
}

void LineOccluders::clip_behind(Span& span, const HalfSpace& front, const Candidate& line) const {
  const double touch = view_.touch();
  clip(span, snapped(front.height(line.from), touch), snapped(front.height(line.to), touch), Rim::out);
}

void LineOccluders::clip_inside(Span& span, const HalfSpace& side, const Candidate& line) const {
  const double rounding = view_.rounding();
  clip(span, snapped(side.height(line.from), rounding), snapped(side.height(line.to), rounding), Rim::in);
}

Span LineOccluders::hidden_by(const Shadow& shadow, const Candidate& line) const {
  Span span = line.in_image;
  for (const HalfSpace& side : shadow.sides) {
    clip_inside(span, side, line);
    if (span.is_empty()) return span;
  }
  for (const HalfSpace& front : shadow.fronts) {
    clip_behind(span, front, line);
    if (span.is_empty()) return span;
  }
  return span;
}

Span LineOccluders::hidden_by(const FaceId& face, const Candidate& line) const {
  const LineBody& body = bodies_.finite[face.body];
  Span span = line.in_image;
  const Vec3 normal = body.normals[face.face] * static_cast<double>(body.facing[face.face]);
  const Vec3& point = body.points[body.shape->faces[face.face].vertex[0]];
  clip_behind(span, {normal, glm::dot(normal, point)}, line);
  if (span.is_empty()) return span;
  const Polygon polygon = body.polygon(face.face);
  for (int c = 0; c < polygon.corners; ++c) {
    const HalfSpace side = view_.through_eye(polygon.corner[c], polygon.corner[(c + 1) % polygon.corners]);
    clip_inside(span, side, line);
    if (span.is_empty()) return span;
  }
  return span;
}

// Hidden is what the plane parts from the start of the eye's ray through it.
Span LineOccluders::hidden_by(const LinePlane& plane, const Candidate& line) const {
  Span span = line.in_image;
  const Vec3& normal = plane.above.normal;
  const int facing = view_.facing(normal, plane.above.offset * normal);
  const HalfSpace front{normal * static_cast<double>(facing), plane.above.offset * facing};
  if (facing == 0) return {0.0, 0.0};
  clip_behind(span, front, line);
  if (span.is_empty() || view_.is_perspective()) return span;
  clip_inside(span, {-Vec3(front.normal.x, front.normal.y, 0.0), -front.offset}, line);
  return span;
}

}  // namespace tilelight::lines
