// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/staunton.h"

namespace tilelight {

void add_bead(Profile& profile, double r, double y) { profile.arc_to({r, y}, 180.0); }

Profile turned_foot(const Foot& foot, int detail) {
  const double r = foot.radius, h = foot.height;
  Profile profile({0.0, 0.0}, detail);
  profile.line_to({0.95 * r, 0.0});
  profile.arc_to({0.95 * r, 0.30 * h}, 110.0);                                         // the base's round
  profile.line_to({0.90 * r, 0.33 * h}).line_to({0.90 * r, 0.37 * h});                 // a step
  profile.curve_to({0.90 * r, 0.56 * h}, {0.74 * r, 0.68 * h}, {0.60 * r, 0.74 * h});  // the dome
  profile.line_to({0.60 * r, 0.77 * h});
  add_bead(profile, 0.58 * r, 0.89 * h);  // a ring
  profile.line_to({0.54 * r, 0.89 * h});
  profile.curve_to({0.48 * r, 0.92 * h}, {foot.stem_radius, 0.94 * h}, {foot.stem_radius, h});
  return profile;
}

}  // namespace tilelight
