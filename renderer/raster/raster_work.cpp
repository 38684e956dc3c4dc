// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/raster_work.h"

#include <algorithm>

#include "renderer/trace/pixel_filter.h"

namespace tilelight {
namespace {

Image black(const ImageSpec& size) {
  return {size.width, size.height, std::vector<float>(static_cast<size_t>(size.width) * size.height * 3, 0.0f)};
}

void paint(Image& image, int x, int y, const Color& color) {
  float* at = image.rgb.data() + (static_cast<size_t>(y) * image.width + x) * 3;
  for (int c = 0; c < 3; ++c) at[c] = static_cast<float>(color[c]);
}

// Takes whole numbers and others.
auto adder(MethodWork& out) {
  return [&out](const char* name, auto value) { out.counts.push_back({name, static_cast<double>(value)}); };
}

void add_set_up(const RasterScene& raster, MethodWork& out) {
  const RasterCounts& counts = raster.counts();
  const auto add = adder(out);
  add("triangles of the scene", counts.triangles);
  add("turned away from the eye", counts.turned_away);
  add("outside of the picture, or on no sample's grid", counts.outside);
  add("clipped", counts.clipped);
  add("primitives drawn", counts.drawn);
  add("placements in windows of 32 pixels", counts.placements);
}

}  // namespace

MethodWork zbuffer_work(const RasterScene& raster) {
  const View& view = raster.plan().view;
  MethodWork out;
  add_set_up(raster, out);
  out.picture = black(view.image);
  out.caption = "Coverings of each pixel's first sample: none is black, then brighter with every one, white from 8 on";
  int64_t coverings = 0, covered = 0, most = 0;
  for (int top = 0; top < view.image.height; top += kWindowPx) {
    for (int left = 0; left < view.image.width; left += kWindowPx) {
      const auto prims = raster.in_window(left / kWindowPx, top / kWindowPx);
      const TileRect window{left, top, std::min(left + kWindowPx, view.image.width),
                            std::min(top + kWindowPx, view.image.height)};
      for_each_pixel(window, [&](int x, int y) {
        const SamplePoint p = place_sample(view.render, x, y, 0);
        int64_t here = 0;
        for (const RasterPrim* prim : prims) here += covers(*prim, (x + p.x) * kSubpixels, (y + p.y) * kSubpixels);
        coverings += here, covered += here > 0, most = std::max(most, here);
        const double part = std::min(1.0, static_cast<double>(here) / 8.0);
        paint(*out.picture, x, y, Color(part * part));  // evenly spread to the eye
      });
    }
  }
  const auto add = adder(out);
  add("coverings of samples", coverings);
  add("coverings of a covered sample, mean",
      static_cast<double>(coverings) / static_cast<double>(std::max<int64_t>(1, covered)));
  add("coverings of a sample, most", most);
  return out;
}

MethodWork roberts_work(const LineDrawing& drawing) {
  MethodWork out;
  const LineWork& work = drawing.work;
  const auto add = adder(out);
  add("bodies that hide as one convex body", work.convex_bodies);
  add("faces", work.faces);
  add("edges looked at", work.edges);
  add("junctions found between faces", work.junction_segments);
  add("occlusion tests of a line", work.occlusion_tests);
  add("lines drawn", work.drawn_lines);
  return out;
}

MethodWork warnock_work(const RasterScene& raster, const WarnockScene& subdivision) {
  MethodWork out;
  add_set_up(raster, out);
  Image picture = black(raster.plan().view.image);
  // One hue for each of empty, single, surrounded, pixel; a rim that is darker shows the windows.
  constexpr double kRim = 0.35;
  const Color hues[] = {{0.02, 0.02, 0.03}, {0.1, 0.45, 0.2}, {0.1, 0.25, 0.7}, {0.9, 0.25, 0.1}};
  const WarnockCounts counts = subdivision.visit([&](const TileRect& window, Outcome outcome, int, const PrimList&) {
    for_each_pixel(window, [&](int x, int y) {
      const bool is_rim = window.width() > 1 && (x == window.x0 || y == window.y0);
      paint(picture, x, y, hues[static_cast<size_t>(outcome)] * (is_rim ? kRim : 1.0));
    });
  });
  out.picture = std::move(picture);
  out.caption =
      "Warnock's windows: black where nothing is, green where one primitive is alone, blue where one surrounds the "
      "window in front of all others, red where pixels had to be decided one by one";
  const double pixels = static_cast<double>(raster.plan().view.image.width) * raster.plan().view.image.height;
  const auto add = adder(out);
  add("windows looked at", counts.windows);
  add("windows divided", counts.divided);
  add("windows empty", counts.empty);
  add("windows of one primitive", counts.single);
  add("windows surrounded", counts.surrounded);
  add("pixels decided one by one", counts.pixels);
  add("deepest subdivision", counts.depth);
  add("looks at a primitive in a window", counts.looks);
  add("work saved: part of the pixels that lie in easy windows, %",
      100.0 * static_cast<double>(counts.settled_pixels) / pixels);
  return out;
}

}  // namespace tilelight
