// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/triangle_setup.h"

#include <algorithm>
#include <cmath>

#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

// Beyond this, pixels from the image's corner, triangles are clipped: with 8 bits below the pixel, coordinates keep to
// 25 bits and the terms of an edge to 52.
constexpr double kGuardPx = 65536.0;
// Nothing nearer to the eye than this is seen, normalised units. Depth needs no such plane for
// its precision, but what lies in the eye has no place in the image.
constexpr double kLeastDepth = 0x1p-40;

double distance(const TriangleSetup::Clip& clip, const ImagePoint& p) {
  return clip.w * p.w + clip.x * p.x + clip.y * p.y + clip.nearness * p.nearness + clip.constant;
}

struct Polygon {
  static constexpr int kMost = 9;  // each of five clips adds one corner to three at most
  std::array<ImagePoint, kMost> at;
  int count = 0;
  void push(const ImagePoint& p) { at[static_cast<size_t>(count++)] = p; }
};

// Sutherland and Hodgman 1974. A cut edge is always cut from its inner end on, so that both triangles at an edge get
// the same point.
Polygon cut(const Polygon& polygon, const TriangleSetup::Clip& clip) {
  Polygon out;
  for (int i = 0; i < polygon.count; ++i) {
    const ImagePoint &from = polygon.at[i], &to = polygon.at[(i + 1) % polygon.count];
    const double a = distance(clip, from), b = distance(clip, to);
    if (a >= 0.0) out.push(from);
    if ((a >= 0.0) == (b >= 0.0)) continue;
    const ImagePoint &inner = a >= 0.0 ? from : to, &outer = a >= 0.0 ? to : from;
    const double in = a >= 0.0 ? a : b, off = a >= 0.0 ? b : a;
    out.push(inner + in / (in - off) * (outer + -1.0 * inner));
  }
  return out;
}

struct GridPoint {
  double x, y;  // whole steps of 1/256 pixel
};
// What clipping has left beyond the guard, by the rounding of corners far away, is brought back to it.
double on_grid(double px) { return std::nearbyint(std::clamp(px, -kGuardPx, 2.0 * kGuardPx) * kSubpixels); }
GridPoint on_grid(const ImagePoint& p) { return {on_grid(p.x / p.w), on_grid(p.y / p.w)}; }

// Inside is on the right of the way from a to b as the image lies, y downwards.
Edge edge_between(const GridPoint& a, const GridPoint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const bool is_top_left = dy < 0.0 || (dy == 0.0 && dx > 0.0);
  return {{dy * a.x - dx * a.y - (is_top_left ? 0.0 : 1.0), -dy, dx}};
}

// Pixels from the grid.
int first_pixel(double lowest, int reach, int end) {
  return static_cast<int>(std::clamp(std::floor(lowest / kSubpixels) - reach, 0.0, static_cast<double>(end)));
}
int end_pixel(double highest, int reach, int end) {
  return static_cast<int>(std::clamp(std::floor(highest / kSubpixels) + 1.0 + reach, 0.0, static_cast<double>(end)));
}

}  // namespace

TriangleSetup::TriangleSetup(const ImageProjection& projection, int width, int height, int reach_px)
    : projection_(projection), width_(width), height_(height), reach_px_(reach_px) {
  // Where rays do not start in the eye, they start where nearness is 0.
  const Clip before_eye{.w = 1.0, .constant = -kLeastDepth}, before_start{.nearness = -1.0};
  clips_ = {projection.is_inverse() ? before_eye : before_start, Clip{.w = kGuardPx, .x = 1.0},
            Clip{.w = kGuardPx, .y = 1.0}, Clip{.w = 2.0 * kGuardPx, .x = -1.0}, Clip{.w = 2.0 * kGuardPx, .y = -1.0}};
}

void TriangleSetup::add(const ImagePoint (&corners)[3], uint32_t body, uint32_t prim, std::vector<RasterPrim>& out,
                        RasterCounts& counts) const {
  RasterPrim model;
  model.body = body, model.prim = prim;
  if (!nearness_through(corners[0], corners[1], corners[2], width_, height_, model.nearness, model.slack)) {
    ++counts.outside;
    return;
  }
  const auto all = [&](const auto& is) { return is(corners[0]) && is(corners[1]) && is(corners[2]); };
  const double reach = reach_px_ + 1.0;
  const bool is_outside = all([&](const ImagePoint& p) { return p.w < kLeastDepth; }) ||
                          all([&](const ImagePoint& p) { return p.x < -reach * p.w && p.w > 0.0; }) ||
                          all([&](const ImagePoint& p) { return p.y < -reach * p.w && p.w > 0.0; }) ||
                          all([&](const ImagePoint& p) { return p.x > (width_ + reach) * p.w && p.w > 0.0; }) ||
                          all([&](const ImagePoint& p) { return p.y > (height_ + reach) * p.w && p.w > 0.0; });
  if (is_outside) {
    ++counts.outside;
    return;
  }
  Polygon polygon;
  for (const ImagePoint& p : corners) polygon.push(p);
  bool is_cut = false;
  const auto clip_by = [&](const Clip& clip) {
    if (all([&](const ImagePoint& p) { return distance(clip, p) >= 0.0; })) return;
    is_cut = true;
    polygon = cut(polygon, clip);
  };
  for (const Clip& clip : clips_) clip_by(clip);
  counts.clipped += is_cut;
  const size_t before = out.size();
  for (int i = 1; i + 1 < polygon.count; ++i) add_part(polygon.at[0], polygon.at[i], polygon.at[i + 1], model, out);
  counts.outside += out.size() == before;
}

bool TriangleSetup::add_part(const ImagePoint& a, const ImagePoint& b, const ImagePoint& c, RasterPrim prim,
                             std::vector<RasterPrim>& out) const {
  GridPoint p = on_grid(a), q = on_grid(b), r = on_grid(c);
  const double area = (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
  if (area == 0.0) return false;  // covers no sample: its neighbours meet
  if (area < 0.0) std::swap(q, r);
  const auto [left, right] = std::minmax({p.x, q.x, r.x});
  const auto [top, bottom] = std::minmax({p.y, q.y, r.y});
  const int width = static_cast<int>(width_), height = static_cast<int>(height_);
  prim.box = {first_pixel(left, reach_px_, width), first_pixel(top, reach_px_, height),
              end_pixel(right, reach_px_, width), end_pixel(bottom, reach_px_, height)};
  if (prim.box.width() <= 0 || prim.box.height() <= 0) return false;
  prim.edges = {edge_between(p, q), edge_between(q, r), edge_between(r, p)};
  const double near[3] = {a.nearness / a.w, b.nearness / b.w, c.nearness / c.w};
  const auto [least, most] = std::minmax({near[0], near[1], near[2]});
  const double rounding = 0x1p-48 * std::max(std::abs(least), std::abs(most));
  prim.least = least - rounding, prim.most = most + rounding;
  for (int i = 1; i < 3; ++i) prim.nearness.at[i] /= kSubpixels;
  out.push_back(prim);
  return true;
}

void TriangleSetup::add_plane(const Vec3& place, const Vec3& normal, uint32_t body,
                              std::vector<RasterPrim>& out) const {
  RasterPrim prim;
  prim.body = body;
  prim.is_plane = true;
  prim.nearness = projection_.nearness_of_plane(place, normal);
  prim.slack = 0x1p-44 * (std::abs(prim.nearness.at[0]) + std::abs(prim.nearness.at[1]) * width_ +
                          std::abs(prim.nearness.at[2]) * height_);
  if (!std::isfinite(prim.slack)) return;  // it passes through the eye
  for (int i = 1; i < 3; ++i) prim.nearness.at[i] /= kSubpixels;
  prim.plane_above = projection_.least_nearness();
  prim.plane_up_to = projection_.most_nearness();
  prim.box = {0, 0, static_cast<int>(width_), static_cast<int>(height_)};
  out.push_back(prim);
}

}  // namespace tilelight
