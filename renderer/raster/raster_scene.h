// SPDX-License-Identifier: Apache-2.0
// RasterScene: a scene's triangles as one view sees them: clipped, projected, their corners on a grid of 1/256 pixel
// (24.8 fixed point), sorted into windows of the image. Made once a render; immutable; any thread may read. Everything
// the z-buffer and Warnock's subdivision decide, they decide by the same exact numbers that stand here.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
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
  // How near it is at a place of the grid, up to `slack`. A triangle's is never outside of that of its corners; a
  // plane, which has no edges, is there where its own is above the first of the range and up to the second.
  Affine nearness;
  double nearness_min = 0.0, nearness_max = 0.0;
  double slack = 0.0;
  TileRect box;  // pixels that it may meet
  bool is_plane = false;
  uint32_t body = 0, prim = 0;  // as a Hit has them
  uint32_t order = 0;           // its place among all, by id
};

// The sample rule: of the primitives that cover a sample, each is as near as its nearness says, give or take its slack.
// The front is the largest nearness that some primitive has for certain; of those that may be as near, all in one place
// for what numbers can tell, the lowest id (public id of the body, then primitive) is seen. No order matters.
// x, y: the sample, in steps of the grid.
bool covers(const RasterPrim& prim, double x, double y);
inline double nearness_at(const RasterPrim& prim, double x, double y) {
  const double plain = prim.nearness.at[0] + prim.nearness.at[1] * x + prim.nearness.at[2] * y;
  return prim.is_plane ? plain : std::clamp(plain, prim.nearness_min, prim.nearness_max);
}
// The sample rule, by looking at every primitive: the place in the list of the one that is seen; kNone: none. REQUIRES:
// a list in the order of ids.
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

class RasterScene {
 public:
  // REQUIRES: a scene without spheres (tessellate). Runs on the calling thread and on idle threads of the pool.
  RasterScene(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool);

  const CompiledScene& scene() const { return scene_; }
  const ViewPlan& plan() const { return plan_; }
  int reach_px() const { return reach_px_; }  // how far a pixel's samples may lie outside it
  const RasterCounts& counts() const { return counts_; }
  int64_t memory_bytes() const;

  // The primitives that may meet a window, in the order of their ids. x, y: its pixels over kWindowPx.
  std::vector<const RasterPrim*> in_window(int x, int y) const;
  // All of them.
  std::vector<const RasterPrim*> all() const;

 private:
  struct Placement {
    uint32_t window, prim;
  };
  // Neighbours in order of id, set up by one thread.
  struct Chunk {
    uint32_t body = 0, first = 0, last = 0;  // of its triangles
    std::vector<RasterPrim> prims;
    std::vector<Placement> placements;  // by window, then id
    RasterCounts counts;
  };

  void set_up(Chunk& chunk) const;
  void place(Chunk& chunk) const;

  const CompiledScene& scene_;
  const ViewPlan& plan_;
  int reach_px_ = 0, windows_across_ = 0;
  std::vector<Chunk> chunks_;
  RasterCounts counts_;
};

}  // namespace tilelight
