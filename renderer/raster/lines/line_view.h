// SPDX-License-Identifier: Apache-2.0
// LineView: the space in which lines are clipped and hidden. View space is the scene's normalised space, turned so
// that x runs to the right in the image, y down and z away from the eye, with the origin at the start of the eye's
// rays; lengths keep. Planes through the eye are formed here, so that perspective and orthographic eyes are one to all
// others. Immutable; any thread may read.
#pragma once

#include "renderer/compile/compile.h"
#include "renderer/raster/lines/half_space.h"

namespace tilelight::lines {

class LineView {
 public:
  explicit LineView(const ViewPlan& plan);

  Vec3 from_world(const Vec3& world) const { return (world - start_) * world_from_view_; }
  Vec3 direction_from_world(const Vec3& world) const { return world * world_from_view_; }
  Vec3 to_world(const Vec3& p) const { return start_ + world_from_view_ * p; }
  int width() const { return width_; }
  int height() const { return height_; }
  bool is_perspective() const { return is_perspective_; }

  // Heights of points over planes that are smaller are rounding.
  double rounding() const { return rounding_; }
  // A surface nearer than this to a point is the point's own: it touches and does not hide it. 1e-9 of the scene.
  double touch() const { return touch_; }

  // The eye, in view space; of an orthographic one only what lies behind its image plane is cut off.
  Vec3 eye() const { return {0.0, 0.0, -lead_}; }
  // How far the eye lies over a plane through `point`; of an orthographic eye the cosine alone counts.
  double eye_height(const Vec3& normal, const Vec3& point) const {
    return is_perspective_ ? glm::dot(normal, eye() - point) : -normal.z;
  }
  // +1 where the plane turns this side to the eye, -1 where the other, 0 where the eye lies in the plane.
  int facing(const Vec3& normal, const Vec3& point) const;

  // The plane through the eye and two points, the same bits (negated) for both orders. Zero normal where there is
  // none.
  HalfSpace through_eye(const Vec3& a, const Vec3& b) const;

  // The part of a segment that the image shows. In front of the eye.
  Span in_image(const Vec3& from, const Vec3& to) const;
  // REQUIRES: is_in_front(p).
  Vec2 pixel(const Vec3& p) const {
    const double w = depth(p);
    return {(p.x / w - corner_.x) / px_, (p.y / w - corner_.y) / px_};
  }
  bool is_in_front(const Vec3& p) const { return is_perspective_ ? depth(p) > least_depth_ : p.z >= 0.0; }

 private:
  double depth(const Vec3& p) const { return is_perspective_ ? lead_ + p.z : 1.0; }

  bool is_perspective_;
  int width_, height_;
  Mat3 world_from_view_{1.0};
  Vec3 start_;
  double lead_;
  Vec2 corner_{0.0};  // of the image, on the image plane
  double px_;         // edge of a pixel there
  double rounding_, touch_, least_depth_;
};

}  // namespace tilelight::lines
