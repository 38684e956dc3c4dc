// SPDX-License-Identifier: Apache-2.0
// LineOccluders: which parts of a segment the bodies hide. Immutable after construction; any thread may read.
#pragma once

#include <vector>

#include "renderer/raster/lines/line_candidates.h"
#include "renderer/raster/lines/screen_grid.h"

namespace tilelight::lines {

// What a convex body hides: the points inside all the planes through the eye and its outline, and behind all of its
// faces that the eye sees (Roberts 1963).
struct Shadow {
  std::vector<HalfSpace> sides;   // a point in one of these planes is hidden: it lies behind the outline itself
  std::vector<HalfSpace> fronts;  // a point in one of these touches the body, and is seen
};

class LineOccluders {
 public:
  LineOccluders(const LineBodies& bodies, const LineView& view);

  // Adds the hidden parts of a candidate, in no order. Returns how many convex bodies, faces and planes were asked.
  // from, to: its ends in the image, pixels.
  int64_t hide(const Candidate& line, const Vec2& from, const Vec2& to, std::vector<Span>& hidden) const;

  int64_t whole_bodies() const { return whole_bodies_; }

 private:
  Span hidden_by(const Shadow& shadow, const Candidate& line) const;
  Span hidden_by(const FaceId& face, const Candidate& line) const;
  Span hidden_by(const LinePlane& plane, const Candidate& line) const;
  void clip_behind(Span& span, const HalfSpace& front, const Candidate& line) const;
  void clip_inside(Span& span, const HalfSpace& side, const Candidate& line) const;

  const LineBodies& bodies_;
  const LineView& view_;
  std::vector<Shadow> shadows_;  // by finite body; empty where it hides by its faces
  std::vector<FaceId> items_;    // whole bodies (no face) and faces
  ScreenGrid grid_;              // over items_
  int64_t whole_bodies_ = 0;
};

}  // namespace tilelight::lines
