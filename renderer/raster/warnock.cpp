// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/warnock.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

// Places of samples, in steps of the grid; ends included.
struct Places {
  double x0, y0, x1, y1;
  Places(const TileRect& window, int reach_px)
      : x0((window.x0 - reach_px) * kSubpixels),
        y0((window.y0 - reach_px) * kSubpixels),
        x1((window.x1 + reach_px) * kSubpixels - 1.0),
        y1((window.y1 + reach_px) * kSubpixels - 1.0) {}
};

struct Span {
  double least, most;
};
Span over(const Affine& f, const Places& p) {
  const double x0 = f.at[1] * p.x0, x1 = f.at[1] * p.x1, y0 = f.at[2] * p.y0, y1 = f.at[2] * p.y1;
  return {f.at[0] + std::min(x0, x1) + std::min(y0, y1), f.at[0] + std::max(x0, x1) + std::max(y0, y1)};
}

// How near a primitive surely and maybe is, wherever it is met in a window. Rounding keeps order, so what holds at the
// corners, rounded, holds for the samples, rounded.
double surely_everywhere(const RasterPrim& prim, const Places& places) {
  return surely_as_near(prim, over(prim.nearness, places).least);
}
double maybe_anywhere(const RasterPrim& prim, const Places& places) {
  return maybe_as_near(prim, over(prim.nearness, places).most);
}

bool meets(const TileRect& a, const TileRect& b) { return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1; }

// Cuts the window in four at half the power of two that its edge had before the image cut it.
std::vector<TileRect> quarters(const TileRect& window) {
  const int half =
      static_cast<int>(std::bit_ceil(static_cast<uint32_t>(std::max(window.width(), window.height())))) / 2;
  std::vector<TileRect> out;
  for (int y = window.y0; y < window.y1; y += half) {
    for (int x = window.x0; x < window.x1; x += half)
      out.push_back({x, y, std::min(x + half, window.x1), std::min(y + half, window.y1)});
  }
  return out;
}

struct Look {
  PrimList seen;            // what may be seen in the window, in order
  bool is_covered = false;  // by the only one
};

// Whether `back` is behind `front`, which surrounds the window, wherever both are met: their nearness differs by an
// affine function, so its corners tell. Surfaces that recede side by side are told apart long before their ranges are.
bool is_behind(const RasterPrim& back, const RasterPrim& front, const Places& places) {
  const double apart = 2.0 * (back.slack + front.slack);  // and more than rounding at any place
  for (const double x : {places.x0, places.x1}) {
    for (const double y : {places.y0, places.y1}) {
      if (!(value_at(back.nearness, x, y) + apart < std::min(value_at(front.nearness, x, y), front.most))) return false;
    }
  }
  return back.least < surely_everywhere(front, places);  // it may have been brought up to that
}

// What of the primitives may be seen in a window: none that does not meet it, none behind one that surrounds it.
Look look_into(const TileRect& window, const PrimList& prims, int reach_px) {
  const Places places(window, reach_px);
  Look out;
  double front = -std::numeric_limits<double>::infinity();  // the sample rule's is no less, for any sample
  const RasterPrim* nearest = nullptr;                      // of those that surround
  std::vector<bool> surrounds;
  for (const RasterPrim* prim : prims) {
    const Lie lie = lie_of(*prim, window, reach_px);
    if (lie == Lie::disjoint) continue;
    out.seen.push_back(prim);
    surrounds.push_back(lie == Lie::surrounding);
    if (lie != Lie::surrounding) continue;
    const double least = surely_everywhere(*prim, places);
    if (least > front) front = least, nearest = prim;
  }
  if (!nearest) return out;
  size_t kept = 0;
  for (size_t i = 0; i < out.seen.size(); ++i) {
    const RasterPrim& prim = *out.seen[i];
    if (maybe_anywhere(prim, places) < front) continue;
    if (&prim != nearest && is_behind(prim, *nearest, places)) continue;
    out.seen[kept] = out.seen[i];
    surrounds[kept++] = surrounds[i];
  }
  out.seen.resize(kept);
  out.is_covered = kept == 1 && surrounds[0];
  return out;
}

}  // namespace

Lie lie_of(const RasterPrim& prim, const TileRect& window, int reach_px) {
  if (!meets(prim.box, window)) return Lie::disjoint;
  const Places places(window, reach_px);
  if (prim.is_plane) {
    const Span near = over(prim.nearness, places);
    if (near.most <= prim.plane_above || near.least > prim.plane_up_to) return Lie::disjoint;
    const bool is_around = near.least > prim.plane_above && near.most <= prim.plane_up_to;
    return is_around ? Lie::surrounding : Lie::intersecting;
  }
  bool is_around = true;
  for (const Edge& edge : prim.edges) {
    const Span at = over(edge, places);
    if (at.most < 0.0) return Lie::disjoint;
    is_around &= at.least >= 0.0;
  }
  if (is_around) return Lie::surrounding;
  const TileRect& box = prim.box;
  const bool is_inside = box.x0 >= window.x0 && box.y0 >= window.y0 && box.x1 <= window.x1 && box.y1 <= window.y1;
  return is_inside ? Lie::contained : Lie::intersecting;
}

void subdivide(const TileRect& window, int depth, const PrimList& prims, int reach_px, WarnockCounts& counts,
               const OnWindow& on_window) {
  ++counts.windows;
  counts.looks += static_cast<int64_t>(prims.size());
  counts.depth = std::max(counts.depth, depth);
  const Look look = look_into(window, prims, reach_px);
  const auto settle = [&](int64_t& count, Outcome outcome) {
    ++count;
    counts.settled_pixels += outcome == Outcome::pixel ? 0 : window.pixel_count();
    on_window(window, outcome, depth, look.seen);
  };
  if (look.seen.empty()) return settle(counts.empty, Outcome::empty);
  if (look.is_covered) return settle(counts.surrounded, Outcome::surrounded);
  if (look.seen.size() == 1) return settle(counts.single, Outcome::single);
  if (window.pixel_count() == 1) return settle(counts.pixels, Outcome::pixel);
  ++counts.divided;
  for (const TileRect& quarter : quarters(window))
    subdivide(quarter, depth + 1, look.seen, reach_px, counts, on_window);
}

TileRect WarnockScene::root() const {
  const ImageSpec& image = raster_.plan().view.image;
  return {0, 0, image.width, image.height};
}

WarnockScene::WarnockScene(const RasterScene& raster, TilePool& pool, const std::atomic<bool>* stop) : raster_(raster) {
  const TileRect image = root();
  windows_across_ = (image.x1 + kWindowPx - 1) / kWindowPx;
  lists_.resize(static_cast<size_t>(windows_across_) * ((image.y1 + kWindowPx - 1) / kWindowPx));
  struct Node {
    TileRect window;
    PrimList prims;
  };
  std::vector<Node> level;
  level.push_back({image, raster.all()});
  while (!level.empty()) {
    std::vector<std::vector<Node>> parts(level.size());
    pool.parallel_for(
        static_cast<int64_t>(level.size()), Priority::normal,
        [&](int64_t i) {
          const Node& node = level[static_cast<size_t>(i)];
          PrimList seen = look_into(node.window, node.prims, raster_.reach_px()).seen;
          const TileRect& w = node.window;
          if (std::max(w.width(), w.height()) <= kWindowPx) {
            lists_[static_cast<size_t>(w.y0 / kWindowPx * windows_across_ + w.x0 / kWindowPx)] = std::move(seen);
            return;
          }
          for (const TileRect& quarter : quarters(w)) parts[static_cast<size_t>(i)].push_back({quarter, seen});
        },
        stop);
    level.clear();
    for (auto& part : parts) std::move(part.begin(), part.end(), std::back_inserter(level));
  }
}

std::span<const RasterPrim* const> WarnockScene::draw(int x, int y, std::span<VisibleWindow> layers) const {
  const PrimList& list = lists_[static_cast<size_t>(y * windows_across_ + x)];
  const TileRect image = root();
  const int x0 = x * kWindowPx, y0 = y * kWindowPx;
  const TileRect window{x0, y0, std::min(x0 + kWindowPx, image.x1), std::min(y0 + kWindowPx, image.y1)};
  // The place of a primitive in the list, which is in the order of ranks like the part of it that a small window sees.
  const auto place_of = [&](const RasterPrim* prim) {
    return static_cast<uint32_t>(
        std::lower_bound(list.begin(), list.end(), prim,
                         [](const RasterPrim* a, const RasterPrim* b) { return a->order < b->order; }) -
        list.begin());
  };
  WarnockCounts unread;  // visit() counts the whole, from the image down
  subdivide(window, 0, list, raster_.reach_px(), unread,
            [&](const TileRect& part, Outcome outcome, int, const PrimList& seen) {
              if (outcome == Outcome::empty) return;
              const uint32_t first = place_of(seen[0]);
              for (VisibleWindow& layer : layers) {
                for_each_pixel(part, [&](int px, int py) {
                  const size_t at = VisibleWindow::at(px - x0, py - y0);
                  if (!(layer.x[at] == layer.x[at])) return;  // no sample is asked for
                  if (outcome == Outcome::surrounded) {
                    layer.owner[at] = first;
                  } else if (const uint32_t i = seen_at(seen, layer.x[at], layer.y[at]); i != kNone) {
                    layer.owner[at] = i == 0 ? first : place_of(seen[i]);
                  }
                });
              }
            });
  return list;
}

int64_t WarnockScene::memory_bytes() const {
  int64_t bytes = static_cast<int64_t>(lists_.size() * sizeof(PrimList));
  for (const PrimList& list : lists_) bytes += static_cast<int64_t>(list.size() * sizeof(list[0]));
  return bytes;
}

WarnockCounts WarnockScene::visit(const OnWindow& on_window) const {
  WarnockCounts counts;
  subdivide(root(), 0, raster_.all(), raster_.reach_px(), counts, on_window);
  return counts;
}

}  // namespace tilelight
