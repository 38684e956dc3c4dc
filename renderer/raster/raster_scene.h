// SPDX-License-Identifier: Apache-2.0
// RasterScene: a scene's triangles as one view sees them: clipped, projected, their corners on a grid of 1/256 pixel
// (24.8 fixed point), sorted into windows of the image. Made once a render; immutable; any thread may read. Everything
// the z-buffer and Warnock's subdivision decide, they decide by the same exact numbers that stand here.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "renderer/compile/compile.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/film/film.h"
#include "renderer/raster/projection.h"
#include "renderer/shade/ray.h"

namespace tilelight {

inline constexpr int kWindowPx = 32;  // edge of the windows: samples, depths and owners of one stay in L1

// An edge of a triangle: at[0] + at[1] * x + at[2] * y, x and y in steps of the grid, is no less than 0 inside. Whole
// numbers under 2^53, so exact. A sample on an edge belongs to the triangle to which that edge is its top or left one.
using Edge = Affine;

struct RasterPrim {
  std::array<Edge, 3> edges;
  Affine nearness;     // how near it is at a place of the grid
  double slack = 0.0;  // what rounding may have done to that
  // A triangle is never nearer or farther than its corners. A plane, which has no edges and no corners, is there where
  // its nearness is above the first of its range and up to the second.
  double least = -std::numeric_limits<double>::infinity(), most = std::numeric_limits<double>::infinity();
  double plane_above = 0.0, plane_up_to = 0.0;
  bool is_plane = false;
  TileRect box;                 // pixels that it may meet
  uint32_t body = 0, prim = 0;  // as a Hit has them
  uint32_t order = 0;           // its place among all, by rank of the body
};

// The sample rule: of the primitives that cover a sample, each is surely as near as one number and maybe as near as
// another. The front is the largest nearness that some primitive surely has; of those that may be as near, all in one
// place for what numbers can tell, the lowest rank (CompiledBody::rank, then primitive) is seen. No order matters.
// x, y: the sample, in steps of the grid.
bool covers(const RasterPrim& prim, double x, double y);
inline double value_at(const Affine& f, double x, double y) { return f.at[0] + f.at[1] * x + f.at[2] * y; }
inline double surely_as_near(const RasterPrim& prim, double nearness) {
  return std::clamp(nearness - prim.slack, prim.least, prim.most);
}
inline double maybe_as_near(const RasterPrim& prim, double nearness) {
  return std::clamp(nearness + prim.slack, prim.least, prim.most);
}
// The sample rule, by looking at every primitive: the place in the list of the one that is seen; kNone: none. REQUIRES:
// a list in the order of ranks.
uint32_t seen_at(std::span<const RasterPrim* const> prims, double x, double y);

// What making one has counted.
struct RasterCounts {
  int64_t triangles = 0;    // of the scene
  int64_t turned_away = 0;  // of solid bodies, whose inner sides the eye cannot see
  int64_t outside = 0;      // of the picture
  int64_t clipped = 0;      // by the eye's plane or by what the grid can hold
  int64_t drawn = 0;        // primitives, with the parts that clipping has made
  int64_t placements = 0;   // of primitives in windows
};

// What is drawn is kept, some 200 bytes a triangle in view, while rays share the meshes of instances.
inline constexpr int64_t kMostRasterTriangles = 8'000'000;

class RasterScene {
 public:
  // REQUIRES: a scene without spheres (drawn_scene). Runs on the calling thread and on idle threads of the pool. Throws
  // as make_method does.
  RasterScene(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool,
              const std::atomic<bool>* stop = nullptr);

  const CompiledScene& scene() const { return scene_; }
  const ViewPlan& plan() const { return plan_; }
  int reach_px() const { return reach_px_; }  // how far a pixel's samples may lie outside it
  const RasterCounts& counts() const { return counts_; }
  int64_t memory_bytes() const;

  // The primitives that may meet a window, in the order of their ranks. x, y: its pixels over kWindowPx.
  std::span<const RasterPrim* const> in_window(int x, int y) const;
  // All of them.
  std::vector<const RasterPrim*> all() const;

 private:
  // Neighbours in order of rank, set up by one thread.
  struct Chunk {
    uint32_t body = 0, first = 0, last = 0;  // of its triangles
    std::vector<RasterPrim> prims;
    RasterCounts counts;
  };

  void set_up(Chunk& chunk) const;
  void place_in_windows();

  const CompiledScene& scene_;
  const ViewPlan& plan_;
  int reach_px_ = 0, windows_across_ = 0, windows_down_ = 0;
  std::vector<Chunk> chunks_;
  std::vector<size_t> begins_;  // of the windows in placed_, row by row
  std::vector<const RasterPrim*> placed_;
  RasterCounts counts_;
};

}  // namespace tilelight
