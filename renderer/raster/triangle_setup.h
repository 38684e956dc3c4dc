// SPDX-License-Identifier: Apache-2.0
// From a triangle in homogeneous image space to what is drawn of it: clipped to what lies before the eye and to what
// the grid can hold, cut into triangles again, corners on the grid. Two triangles that share an edge share what
// clipping and rounding make of it, so they stay without a gap or an overlap. Pure; any thread.
#pragma once

#include <vector>

#include "renderer/raster/raster_scene.h"

namespace tilelight {

class TriangleSetup {
 public:
  // Inside where this function of a place is no less than 0.
  struct Clip {
    double w = 0.0, x = 0.0, y = 0.0, nearness = 0.0, constant = 0.0;
  };

  TriangleSetup(const ImageProjection& projection, int width, int height, int reach_px);

  // Appends what is drawn. body, prim: as a Hit has them.
  void add(const ImagePoint (&corners)[3], uint32_t body, uint32_t prim, std::vector<RasterPrim>& out,
           RasterCounts& counts) const;
  // The plane through a place.
  void add_plane(const Vec3& place, const Vec3& normal, uint32_t body, std::vector<RasterPrim>& out) const;

 private:
  bool add_part(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c, RasterPrim prim,
                std::vector<RasterPrim>& out) const;

  const ImageProjection& projection_;
  double width_, height_;
  int reach_px_;
  std::array<Clip, 5> clips_;
};

}  // namespace tilelight
