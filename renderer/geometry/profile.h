// SPDX-License-Identifier: Apache-2.0
// Profile: the outline that a turner follows, from the middle of the foot outwards and up to the top, in the half plane
// (r, y). Made of lines, circular arcs and cubic curves; where their directions differ the corner is sharp.
#pragma once

#include <vector>

#include "renderer/base/vec.h"

namespace tilelight {

struct ProfilePoint {
  Vec2 position;  // (r, y)
  Vec2 normal;    // unit, to the right of the way: outward
};
using ProfileRun = std::vector<ProfilePoint>;  // smooth; the next run starts at the position where this one ends

// A cubic Bezier curve, 0 <= t <= 1.
struct Cubic {
  Vec2 p0, p1, p2, p3;
  Vec2 position(double t) const;
  Vec2 tangent(double t) const;  // not of unit length
};

class Profile {
 public:
  // `detail` as in make_chess_piece. Curves are cut into a number of pieces that grows with its square root, so that
  // the whole mesh grows with its power of 1.5.
  Profile(Vec2 start, int detail);

  Profile& line_to(Vec2 end);
  // A circular arc that turns by turn_deg in all, counter-clockwise if positive: it bulges outwards on the way up.
  Profile& arc_to(Vec2 end, double turn_deg);
  Profile& ball_to(Vec2 end, double turn_deg);  // the same, cut finer: the eye knows a ball's outline
  Profile& curve_to(Vec2 control0, Vec2 control1, Vec2 end);

  Vec2 end() const { return runs_.back().back().position; }
  const std::vector<ProfileRun>& runs() const { return runs_; }
  int segments() const;

 private:
  int segments_of(double length, double turn_rad) const;
  void add_arc(Vec2 end, double turn_rad, double fineness);
  void start_element(Vec2 tangent);
  void add(Vec2 position, Vec2 tangent);

  int detail_;
  std::vector<ProfileRun> runs_;
};

}  // namespace tilelight
