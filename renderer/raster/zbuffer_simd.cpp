// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/raster/zbuffer_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>

#include "renderer/raster/zbuffer.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

// A function of the image in lanes. Multiplied and added one after the other: fused operations would give other bits on
// CPUs that have none.
struct AffineLanes {
  V constant, by_x, by_y;
  HWY_INLINE explicit AffineLanes(const Affine& f)
      : constant(hn::Set(D(), f.at[0])), by_x(hn::Set(D(), f.at[1])), by_y(hn::Set(D(), f.at[2])) {}
  HWY_INLINE V at(V x, V y) const { return hn::Add(hn::Add(constant, hn::Mul(by_x, x)), hn::Mul(by_y, y)); }
};

// While a window is drawn: more than one primitive may be what this sample sees; they are looked at again at the end.
constexpr uint32_t kTied = kNone - 1;

HWY_INLINE int64_t draw_triangle(const RasterPrim& prim, uint32_t owner, const TileRect& part, VisibleWindow& window) {
  const D d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const AffineLanes e0(prim.edges[0]), e1(prim.edges[1]), e2(prim.edges[2]), nearness(prim.nearness);
  const V zero = hn::Zero(d), slack = hn::Set(d, prim.slack);
  const V least = hn::Set(d, prim.least), greatest = hn::Set(d, prim.most);
  int64_t covered = 0;
  for (int y = part.y0; y < part.y1; ++y) {
    for (int x = part.x0 / lanes * lanes; x < part.x1; x += lanes) {
      const size_t at = VisibleWindow::at(x, y);
      const V sx = hn::Load(d, window.x + at), sy = hn::Load(d, window.y + at);
      // What is nowhere, being not a number, is in no triangle.
      const M inside =
          hn::And(hn::And(hn::Ge(e0.at(sx, sy), zero), hn::Ge(e1.at(sx, sy), zero)), hn::Ge(e2.at(sx, sy), zero));
      if (hn::AllFalse(d, inside)) continue;
      covered += static_cast<int64_t>(hn::CountTrue(d, inside));
      const V near = nearness.at(sx, sy);
      const V surely = hn::Min(hn::Max(hn::Sub(near, slack), least), greatest);
      const V maybe = hn::Min(hn::Max(hn::Add(near, slack), least), greatest);
      const V front = hn::Load(d, window.front + at), most = hn::Load(d, window.most + at);
      const M advances = hn::And(inside, hn::Gt(surely, front)), wins = hn::And(inside, hn::Gt(surely, most));
      hn::Store(hn::IfThenElse(advances, surely, front), d, window.front + at);
      hn::Store(hn::IfThenElse(inside, hn::Max(maybe, most), most), d, window.most + at);
      uint8_t advancing[8] = {}, winning[8] = {};
      hn::StoreMaskBits(d, advances, advancing);
      hn::StoreMaskBits(d, wins, winning);
      for (uint32_t left = advancing[0]; left != 0; left &= left - 1) {
        const auto lane = static_cast<size_t>(__builtin_ctz(left));
        window.owner[at + lane] = winning[0] >> lane & 1 ? owner : kTied;
      }
    }
  }
  return covered;
}

int64_t draw_plane(const RasterPrim& prim, uint32_t owner, VisibleWindow& window) {
  int64_t covered = 0;
  for (size_t at = 0; at < VisibleWindow::kPixels; ++at) {
    if (!covers(prim, window.x[at], window.y[at])) continue;
    ++covered;
    const double near = value_at(prim.nearness, window.x[at], window.y[at]);
    if (const double surely = surely_as_near(prim, near); surely > window.front[at]) {
      window.owner[at] = surely > window.most[at] ? owner : kTied;
      window.front[at] = surely;
    }
    window.most[at] = std::max(window.most[at], maybe_as_near(prim, near));
  }
  return covered;
}

int64_t draw_all(std::span<const RasterPrim* const> prims, int x0, int y0, VisibleWindow& window) {
  int64_t covered = 0;
  for (uint32_t i = 0; i < prims.size(); ++i) {
    const RasterPrim& prim = *prims[i];
    if (prim.is_plane) {
      covered += draw_plane(prim, i, window);
      continue;
    }
    const TileRect part{std::max(prim.box.x0 - x0, 0), std::max(prim.box.y0 - y0, 0),
                        std::min(prim.box.x1 - x0, kWindowPx), std::min(prim.box.y1 - y0, kWindowPx)};
    covered += draw_triangle(prim, i, part, window);
  }
  for (size_t at = 0; at < VisibleWindow::kPixels; ++at) {
    if (window.owner[at] == kTied) window.owner[at] = seen_at(prims, window.x[at], window.y[at]);
  }
  return covered;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(draw_all);

int64_t draw_depths(std::span<const RasterPrim* const> prims, int x0, int y0, VisibleWindow& window) {
  return HWY_DYNAMIC_DISPATCH(draw_all)(prims, x0, y0, window);
}

}  // namespace tilelight
#endif
