// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/raster_scene.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <string>

#include "renderer/base/safe_length.h"
#include "renderer/compile/passes.h"
#include "renderer/raster/triangle_setup.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

// The two triangles of a box's face, corners by their signs along the face's axes.
constexpr int kFaceTriangles[2][3][2] = {{{-1, -1}, {1, -1}, {1, 1}}, {{-1, -1}, {1, 1}, {-1, 1}}};
constexpr uint32_t kBoxTriangles = 12;

Vec3 box_corner(const Vec3& half, uint32_t face, const int (&signs)[2]) {
  const int axis = static_cast<int>(face / 2);
  Vec3 corner;
  corner[axis] = face % 2 ? half[axis] : -half[axis];
  corner[(axis + 1) % 3] = signs[0] * half[(axis + 1) % 3];
  corner[(axis + 2) % 3] = signs[1] * half[(axis + 2) % 3];
  return corner;
}

uint32_t triangle_count(const CompiledBody& body) {
  if (body.kind == BodyKind::mesh) return static_cast<uint32_t>(body.mesh->triangles.size());
  return body.kind == BodyKind::box ? kBoxTriangles : 1;
}

bool holds_eye(const CompiledBody& body, const Eye& eye) {
  const Box box = body_bounds(body);
  const Vec3 margin(0x1p-20);
  const auto is_in = [&](const Vec3& p) {
    return p.x > box.lo.x - margin.x && p.y > box.lo.y - margin.y && p.z > box.lo.z - margin.z &&
           p.x < box.hi.x + margin.x && p.y < box.hi.y + margin.y && p.z < box.hi.z + margin.z;
  };
  if (eye.projection == Projection::perspective && eye.lead == 0.0) return is_in(eye.origin);
  // Rays that start on a plane: the body must lie wholly behind it in the way of the view.
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z);
    if (!(glm::dot(p - eye.start, eye.forward) > margin.x)) return true;
  }
  return false;
}

// Which sign of the projected triangle's volume turns it away from the eye, so that something of its own body hides it;
// 0 where both sides may be seen.
double hidden_sign(const CompiledBody& body, const Eye& eye) {
  const bool is_outward =
      body.kind == BodyKind::box ? body.has_inside : body.kind == BodyKind::mesh && body.mesh->is_known_outward;
  if (!is_outward || holds_eye(body, eye)) return 0.0;
  return glm::determinant(Mat3(body.world_from_local)) < 0.0 ? -1.0 : 1.0;
}

double volume(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c) {
  const Vec3 p(a.w, a.x, a.y), q(b.w, b.x, b.y), r(c.w, c.x, c.y);
  return glm::dot(p, glm::cross(q - p, r - p));
}

}  // namespace

bool covers(const RasterPrim& prim, double x, double y) {
  if (prim.is_plane) {
    const double near = value_at(prim.nearness, x, y);
    return near > prim.plane_above && near <= prim.plane_up_to;
  }
  for (const Edge& edge : prim.edges) {
    if (!(value_at(edge, x, y) >= 0.0)) return false;
  }
  return true;
}

uint32_t seen_at(std::span<const RasterPrim* const> prims, double x, double y) {
  double front = -std::numeric_limits<double>::infinity();
  for (const RasterPrim* prim : prims) {
    if (covers(*prim, x, y)) front = std::max(front, surely_as_near(*prim, value_at(prim->nearness, x, y)));
  }
  for (uint32_t i = 0; i < prims.size(); ++i) {
    const RasterPrim& prim = *prims[i];
    if (covers(prim, x, y) && maybe_as_near(prim, value_at(prim.nearness, x, y)) >= front) return i;
  }
  return kNone;
}

RasterScene::RasterScene(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool,
                         const std::atomic<bool>* stop)
    : scene_(scene),
      plan_(plan),
      reach_px_(plan.view.render.filter == PixelFilter::box ? 0 : kFilterReachPx),
      windows_across_((plan.view.image.width + kWindowPx - 1) / kWindowPx),
      windows_down_((plan.view.image.height + kWindowPx - 1) / kWindowPx) {
  constexpr uint32_t kChunkTriangles = 4096;
  std::vector<uint32_t> by_rank(scene.bodies.size());
  std::iota(by_rank.begin(), by_rank.end(), 0u);
  std::sort(by_rank.begin(), by_rank.end(),
            [&](uint32_t a, uint32_t b) { return scene.bodies[a].rank < scene.bodies[b].rank; });
  for (const uint32_t body : by_rank) {
    const uint32_t count = triangle_count(scene.bodies[body]);
    counts_.triangles += scene.bodies[body].kind == BodyKind::plane ? 0 : count;
    for (uint32_t first = 0; first < count; first += kChunkTriangles)
      chunks_.push_back({body, first, std::min(count, first + kChunkTriangles), {}, {}});
  }
  if (counts_.triangles > kMostRasterTriangles)
    throw std::length_error("this method holds a scene of " + std::to_string(kMostRasterTriangles) +
                            " triangles, and this one has " + std::to_string(counts_.triangles) +
                            "; ray tracing shares them among instances");
  pool.parallel_for(
      static_cast<int64_t>(chunks_.size()), Priority::normal,
      [&](int64_t i) { set_up(chunks_[static_cast<size_t>(i)]); }, stop);
  uint32_t order = 0;
  for (Chunk& chunk : chunks_) {
    for (RasterPrim& prim : chunk.prims) prim.order = order++;
    counts_.turned_away += chunk.counts.turned_away;
    counts_.outside += chunk.counts.outside;
    counts_.clipped += chunk.counts.clipped;
    counts_.drawn += static_cast<int64_t>(chunk.prims.size());
  }
  place_in_windows();
}

void RasterScene::set_up(Chunk& chunk) const {
  const CompiledBody& body = scene_.bodies[chunk.body];
  const ImageProjection projection(plan_.eye);
  const TriangleSetup setup(projection, plan_.view.image.width, plan_.view.image.height, reach_px_);
  if (body.kind == BodyKind::plane) {
    const Vec3 normal = unit_of(body.world_from_normal * Vec3(0.0, 1.0, 0.0));
    setup.add_plane(Vec3(body.world_from_local[3]), normal, chunk.body, chunk.prims);
    return;
  }
  const double hidden = hidden_sign(body, plan_.eye);
  for (uint32_t t = chunk.first; t < chunk.last; ++t) {
    ImagePoint corners[3];
    for (int c = 0; c < 3; ++c) {
      const Vec3 local = body.kind == BodyKind::box ? box_corner(body.half, t / 2, kFaceTriangles[t % 2][c])
                                                    : body.mesh->positions[body.mesh->triangles[t][c]];
      corners[c] = projection.of(transform_point(body.world_from_local, local));
    }
    // A box's faces wind by their axes alone: outwards on its upper sides.
    const double winding = body.kind == BodyKind::box && t / 2 % 2 == 0 ? -hidden : hidden;
    if (winding * volume(corners[0], corners[1], corners[2]) > 0.0) {
      ++chunk.counts.turned_away;
      continue;
    }
    setup.add(corners, chunk.body, body.kind == BodyKind::box ? t / 2 : t, chunk.prims, chunk.counts);
  }
}

void RasterScene::place_in_windows() {
  const auto for_each_window = [&](const RasterPrim& prim, const auto& visit) {
    for (int y = prim.box.y0 / kWindowPx; y * kWindowPx < prim.box.y1; ++y) {
      for (int x = prim.box.x0 / kWindowPx; x * kWindowPx < prim.box.x1; ++x)
        visit(static_cast<size_t>(y) * windows_across_ + x);
    }
  };
  begins_.assign(static_cast<size_t>(windows_across_) * windows_down_ + 1, 0);
  for (const Chunk& chunk : chunks_)
    for (const RasterPrim& prim : chunk.prims) for_each_window(prim, [&](size_t window) { ++begins_[window + 1]; });
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  placed_.resize(begins_.back());
  std::vector<size_t> next(begins_.begin(), begins_.end() - 1);
  for (const Chunk& chunk : chunks_)
    for (const RasterPrim& prim : chunk.prims)
      for_each_window(prim, [&](size_t window) { placed_[next[window]++] = &prim; });
  counts_.placements = static_cast<int64_t>(placed_.size());
}

std::span<const RasterPrim* const> RasterScene::in_window(int x, int y) const {
  const size_t window = static_cast<size_t>(y) * windows_across_ + x;
  return std::span(placed_).subspan(begins_[window], begins_[window + 1] - begins_[window]);
}

std::vector<const RasterPrim*> RasterScene::all() const {
  std::vector<const RasterPrim*> out;
  for (const Chunk& chunk : chunks_)
    for (const RasterPrim& prim : chunk.prims) out.push_back(&prim);
  return out;
}

int64_t RasterScene::memory_bytes() const {
  return counts_.drawn * static_cast<int64_t>(sizeof(RasterPrim)) +
         static_cast<int64_t>(placed_.size() * sizeof(placed_[0]) + begins_.size() * sizeof(begins_[0]) +
                              chunks_.size() * sizeof(Chunk));
}

}  // namespace tilelight
