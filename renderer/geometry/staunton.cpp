// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/staunton.h"

namespace tilelight {

void add_bead(Profile& profile, double r, double y) { profile.arc_to({r, y}, 180.0); }

void add_collar(Profile& profile, double reach, double y, double thickness, double r_after) {
  const double r = profile.end().x, lip = 0.16 * thickness;
  profile.curve_to({r + 0.35 * (reach - r), y - 0.50 * thickness}, {reach - 0.2 * (reach - r), y - 0.26 * thickness},
                   {reach - lip, y - lip});
  profile.arc_to({reach - lip, y + lip}, 170.0);
  profile.curve_to({reach - 0.2 * (reach - r_after), y + 0.22 * thickness},
                   {r_after + 0.35 * (reach - r_after), y + 0.40 * thickness}, {r_after, y + 0.5 * thickness});
}

Profile turned_foot(const Foot& foot, int detail) {
  const double r = foot.radius, h = foot.height;
  Profile profile({0.0, 0.0}, detail);
  profile.line_to({r - 0.020, 0.0});
  profile.arc_to({r - 0.016, 0.28 * h}, 120.0);  // the base's round
  profile.line_to({r - 0.036, 0.29 * h}).line_to({r - 0.036, 0.325 * h});
  // The plinth: a dome that sweeps into a hollow under the ring.
  profile.curve_to({r - 0.040, 0.54 * h}, {0.80 * r, 0.62 * h}, {0.68 * r, 0.70 * h});
  profile.curve_to({0.63 * r, 0.735 * h}, {0.595 * r, 0.76 * h}, {0.59 * r, 0.80 * h});
  profile.line_to({0.605 * r, 0.80 * h});
  add_bead(profile, 0.605 * r, 0.88 * h);
  profile.line_to({0.575 * r, 0.88 * h}).line_to({0.575 * r, 0.90 * h});
  profile.curve_to({0.50 * r, 0.91 * h}, {foot.stem_radius + 0.012, 0.94 * h}, {foot.stem_radius, h});
  return profile;
}

}  // namespace tilelight
