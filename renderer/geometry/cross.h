// SPDX-License-Identifier: Apache-2.0
// The king's cross pattee: four arms that widen towards straight ends, with chamfered edges; the lowest stands on a
// turned disc and is one surface with it.
#pragma once

#include <cstdint>

#include "renderer/geometry/lathe.h"

namespace tilelight {

struct CrossShape {
  double center_y;
  double reach;    // from the centre to the ends of the arms
  double neck;     // half the width of an arm at the centre
  double tip;      // and at its end
  double depth;    // half the thickness
  double chamfer;  // of the edges
};

// Adds the cross and the flat ring between its foot and the circle of radius disc_radius around it, whose points are
// those of `columns`.
void add_cross(MeshBuilder& mesh, const CrossShape& shape, double disc_radius, const Columns& columns, int detail);

int64_t cross_triangles(int detail, int columns);

}  // namespace tilelight
