// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_view.h"

#include <utility>

namespace tilelight::lines {
namespace {

bool is_ordered(const Vec3& a, const Vec3& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z <= b.z; }

}  // namespace

LineView::LineView(const ViewPlan& plan)
    : is_perspective_(plan.eye.projection == Projection::perspective),
      width_(plan.view.image.width),
      height_(plan.view.image.height),
      start_(plan.eye.start),
      lead_(is_perspective_ ? plan.eye.lead : 0.0),
      px_(glm::length(plan.eye.step_x)) {
  const Vec3 right = plan.eye.step_x / px_, down = plan.eye.step_y / px_;
  world_from_view_ = Mat3(right, down, plan.eye.forward);
  corner_ = {glm::dot(plan.eye.corner, right), glm::dot(plan.eye.corner, down)};
  // Points lie within [-1, 1] of the scene's centre. A point is some 10 roundings of its distance off; 2^-42 leaves a
  // hundredfold for the products it goes into.
  const double size = 1.0 + glm::length(start_);
  rounding_ = 0x1p-42 * size;
  touch_ = 1e-9 + rounding_;
  least_depth_ = 0x1p-40;
}

int LineView::facing(const Vec3& normal, const Vec3& point) const {
  const double reach = is_perspective_ ? glm::length(eye() - point) : 1.0;
  const double height = snapped(eye_height(normal, point), 0x1p-42 * reach);
  return height > 0.0 ? 1 : height < 0.0 ? -1 : 0;
}

HalfSpace LineView::through_eye(const Vec3& a, const Vec3& b) const {
  const bool is_turned = !is_ordered(a, b);
  const Vec3 &first = is_turned ? b : a, &second = is_turned ? a : b;
  const Vec3 way = second - first;
  const Vec3 normal = is_perspective_ ? glm::cross(first - eye(), way) : Vec3(-way.y, way.x, 0.0);
  const double length = glm::length(normal);
  if (!(length > 0.0)) return {};
  const Vec3 unit = normal / length;
  const double offset = glm::dot(unit, first);
  return is_turned ? HalfSpace{-unit, -offset} : HalfSpace{unit, offset};
}

Span LineView::in_image(const Vec3& from, const Vec3& to) const {
  Span span;
  const auto keep = [&](auto beyond) { clip(span, beyond(from), beyond(to), Rim::in); };
  const double right = corner_.x + width_ * px_, bottom = corner_.y + height_ * px_;
  keep([&](const Vec3& p) { return corner_.x * depth(p) - p.x; });
  keep([&](const Vec3& p) { return p.x - right * depth(p); });
  keep([&](const Vec3& p) { return corner_.y * depth(p) - p.y; });
  keep([&](const Vec3& p) { return p.y - bottom * depth(p); });
  keep([&](const Vec3& p) { return is_perspective_ ? least_depth_ - depth(p) : -p.z; });
  return span;
}

}  // namespace tilelight::lines
