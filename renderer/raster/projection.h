// SPDX-License-Identifier: Apache-2.0
// Projection: places of the normalised world to places of the image, in double and homogeneous: what lies before the
// eye, beside it or behind it has a place all the same, and is clipped before anything is divided. Nearness stands for
// depth: the larger, the nearer, and affine over the image for every plane. It is 1 / depth ("reversed z"), or, where
// rays start elsewhere than in one point, less the distance from there. Plain value; any thread.
#pragma once

#include "renderer/compile/eye.h"

namespace tilelight {

// A place of the image, homogeneous: (x / w, y / w) pixels from the top left corner.
struct ImagePoint {
  double w = 1.0, x = 0.0, y = 0.0;
  double nearness = 0.0;  // times w
};
inline ImagePoint operator+(const ImagePoint& a, const ImagePoint& b) {
  return {a.w + b.w, a.x + b.x, a.y + b.y, a.nearness + b.nearness};
}
inline ImagePoint operator*(double f, const ImagePoint& p) { return {f * p.w, f * p.x, f * p.y, f * p.nearness}; }

// A function of the image: at[0] + at[1] * x + at[2] * y, pixels.
struct Affine {
  double at[3] = {0.0, 0.0, 0.0};
};

class ImageProjection {
 public:
  explicit ImageProjection(const Eye& eye)
      : eye_(eye),
        px_(glm::length(eye.step_x)),
        right_(eye.step_x / px_),
        down_(eye.step_y / px_),
        corner_x_(glm::dot(eye.corner, right_)),
        corner_y_(glm::dot(eye.corner, down_)) {}

  bool is_perspective() const { return eye_.projection == Projection::perspective; }
  // True if nearness is 1 / depth, which nothing but the eye's own plane bounds.
  bool is_inverse() const { return is_perspective() && eye_.lead == 0.0; }

  ImagePoint of(const Vec3& place) const {
    const Vec3 from_start = place - eye_.start;
    const double along = glm::dot(from_start, eye_.forward);
    ImagePoint out;
    out.w = is_perspective() ? eye_.lead + along : 1.0;
    out.x = (glm::dot(from_start, right_) - out.w * corner_x_) / px_;
    out.y = (glm::dot(from_start, down_) - out.w * corner_y_) / px_;
    out.nearness = is_inverse() ? 1.0 : -along;
    return out;
  }

  // The range of nearness of what primary rays can meet: above the first, up to the second.
  double least_nearness() const;
  double most_nearness() const;

  // The nearness of a plane through `place` with this normal, wherever a primary ray meets it.
  Affine nearness_of_plane(const Vec3& place, const Vec3& normal) const;

 private:
  Eye eye_;
  double px_;  // edge of a pixel at w 1
  Vec3 right_, down_;
  double corner_x_, corner_y_;
};

// Through three places that see one plane; `slack` is how far rounding may have moved it anywhere in the image. False
// where the plane is seen edge on.
bool nearness_through(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c, double width, double height,
                      Affine& out, double& slack);

}  // namespace tilelight
