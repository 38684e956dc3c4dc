// SPDX-License-Identifier: Apache-2.0
// R1, R4: how often samples are covered: by a net without a gap exactly once, by triangles far below a pixel as often
// as their area says.
#include <algorithm>
#include <cmath>
#include <memory>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/methods.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"
#include "renderer/check/rows/raster.h"
#include "renderer/raster/zbuffer.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight::check {
namespace {

// A flat mesh before a camera to which one unit is one pixel of a square picture; at tilt_deg it leans away from a
// perspective one.
ParsedScene sheet_before_camera(MeshData mesh, int side_px, double tilt_deg = 0.0) {
  ParsedScene parsed;
  parsed.scene = scene_of_shapes({MeshShape{0}});
  parsed.scene.meshes.push_back(std::move(mesh));
  parsed.scene.materials[0].ambient = Color(1.0);
  parsed.scene.ambient = Color(1.0);
  parsed.scene.background = {Color(0.0), Color(0.0)};
  parsed.view.image = {side_px, side_px};
  parsed.view.render.algorithm = Algorithm::zbuffer;
  Camera& camera = parsed.view.camera.emplace();
  const double tilt = elementary::rad_from_deg(tilt_deg);
  camera.projection = tilt_deg == 0.0 ? Projection::orthographic : Projection::perspective;
  camera.position = 1.5 * side_px * Vec3(0.0, elementary::sin(tilt), elementary::cos(tilt));
  camera.height = side_px;
  camera.fov_y_deg = 24.0;
  return parsed;
}
Vec3 world_of(const Vec2& px, int side_px) { return {px.x - 0.5 * side_px, 0.5 * side_px - px.y, 0.0}; }

// How finely the corners of a net are placed, steps a pixel; 0: anywhere.
struct Net {
  double steps_per_px = 0.0;
  double offset_px = 0.0;  // of the places from whole steps
};
// The corners, pixels: in rows, each moved at random, yet not so far that a triangle turned over; beyond the picture.
std::vector<Vec2> corners_of(const Net& net, int cells, int side_px, Random& random) {
  std::vector<Vec2> corners;
  for (int i = 0; i <= cells; ++i) {
    for (int j = 0; j <= cells; ++j) {
      const double cell = (side_px + 4.0) / cells;
      Vec2 p(-2.0 + cell * j, -2.0 + cell * i);
      p += Vec2(random.between(-0.2, 0.2), random.between(-0.2, 0.2)) * cell;
      if (net.steps_per_px > 0.0) p = glm::floor(p * net.steps_per_px) / net.steps_per_px + net.offset_px;
      corners.push_back(p);
    }
  }
  return corners;
}
std::vector<uint32_t> indices_of(int cells, Random& random) {
  std::vector<uint32_t> out;
  const auto row = static_cast<uint32_t>(cells + 1);
  for (uint32_t i = 0; i + 1 < row; ++i) {
    for (uint32_t j = 0; j + 1 < row; ++j) {
      const uint32_t a = i * row + j, b = a + 1, c = b + row, d = a + row;
      if (random.unit() < 0.5)
        out.insert(out.end(), {a, d, c, a, c, b});
      else
        out.insert(out.end(), {a, d, b, b, d, c});
    }
  }
  return out;
}

struct Cover {
  int64_t samples = 0, times = 0, never = 0;  // how often they are covered, in sum; and how many of them not at all
};
// Of one sample in every pixel, at place(x, y), steps of the grid; `layers` times.
template <class Place>
Cover cover_of(const DrawnScene& drawn, int layers, const Place& place) {
  const ImageSpec& image = drawn.plan().view.image;
  const RasterScene raster(drawn.scene(), drawn.plan(), drawn.pool());
  const int across = (image.width + kWindowPx - 1) / kWindowPx;
  std::vector<Cover> parts(static_cast<size_t>(across) * static_cast<size_t>(across));
  drawn.pool().parallel_for(std::ssize(parts), Priority::batch, [&](int64_t i) {
    const int x = static_cast<int>(i) % across, y = static_cast<int>(i) / across;
    const auto window = std::make_unique<VisibleWindow>();
    const auto prims = raster.in_window(x, y);
    Random random(static_cast<uint64_t>(i) + 1000);
    Cover& part = parts[static_cast<size_t>(i)];
    for (int layer = 0; layer < layers; ++layer) {
      place_samples(
          image, x * kWindowPx, y * kWindowPx, [&](int px, int py) { return place(layer, px, py, random); }, *window);
      part.times += draw_depths(prims, x * kWindowPx, y * kWindowPx, *window);
      for (size_t at = 0; at < VisibleWindow::kPixels; ++at) {
        const bool is_asked_for = window->x[at] == window->x[at];
        part.samples += is_asked_for;
        part.never += is_asked_for && window->owner[at] == kNone;
      }
    }
  });
  Cover sum;
  for (const Cover& part : parts) sum.samples += part.samples, sum.times += part.times, sum.never += part.never;
  return sum;
}

// How far the middles of pixels are from being covered once each, if samples on an edge are all in, or all out.
int64_t textbook_errors(const std::vector<Vec2>& corners, const std::vector<uint32_t>& indices, int side_px,
                        bool is_closed) {
  std::vector<int> times(static_cast<size_t>(side_px) * static_cast<size_t>(side_px));
  for (size_t t = 0; t < indices.size(); t += 3) {
    Vec2 p[3];
    for (size_t c = 0; c < 3; ++c) p[c] = corners[indices[t + c]];
    const Vec2 low = glm::min(p[0], glm::min(p[1], p[2])), high = glm::max(p[0], glm::max(p[1], p[2]));
    const auto pixel = [&](double v) { return static_cast<int>(std::clamp(v, 0.0, static_cast<double>(side_px))); };
    for_each_pixel({pixel(low.x), pixel(low.y), pixel(high.x + 1.0), pixel(high.y + 1.0)}, [&](int x, int y) {
      const Vec2 at(x + 0.5, y + 0.5);
      for (int c = 0; c < 3; ++c) {
        const Vec2 edge = p[(c + 1) % 3] - p[c], to = at - p[c];
        const double inside = edge.y * to.x - edge.x * to.y;
        if (is_closed ? inside < 0.0 : inside <= 0.0) return;
      }
      ++times[static_cast<size_t>(y) * static_cast<size_t>(side_px) + static_cast<size_t>(x)];
    });
  }
  return std::count_if(times.begin(), times.end(), [](int n) { return n != 1; });
}

}  // namespace

Outcome closed_tiling(const Context& context) {
  const int side = context.is_quick ? 256 : 1024, cells = context.is_quick ? 56 : 224, layers = 8;
  struct Kind {
    const char* name;
    Net net;
    double tilt_deg;
  };
  Outcome out;
  for (const Kind& kind : {Kind{"corners on middles of pixels", {1.0, 0.5}, 0.0},
                           Kind{"corners on the samples' grid", {kSubpixels, 0.0}, 0.0},
                           Kind{"corners anywhere", {}, 0.0}, Kind{"corners anywhere, in perspective", {}, 35.0}}) {
    Random random(1);
    const std::vector<Vec2> corners = corners_of(kind.net, cells, side, random);
    MeshData mesh;
    for (const Vec2& p : corners) mesh.positions.push_back(world_of(p, side));
    mesh.indices = indices_of(cells, random);
    // Each pixel's first sample lies on a corner, where one is in the pixel, else in the middle; all others anywhere.
    std::vector<Vec2> first(static_cast<size_t>(side) * static_cast<size_t>(side));
    for (size_t i = 0; i < first.size(); ++i)
      first[i] = Vec2(i % static_cast<size_t>(side), i / static_cast<size_t>(side)) + 0.5;
    for (const Vec2& p : corners) {
      if (p.x >= 0.0 && p.y >= 0.0 && p.x < side && p.y < side)
        first[static_cast<size_t>(p.y) * static_cast<size_t>(side) + static_cast<size_t>(p.x)] = p;
    }
    const DrawnScene drawn(sheet_before_camera(mesh, side, kind.tilt_deg), context.pool);
    const Cover cover = cover_of(drawn, layers, [&](int layer, int x, int y, Random& r) {
      if (layer == 0)
        return glm::floor(kSubpixels *
                          first[static_cast<size_t>(y) * static_cast<size_t>(side) + static_cast<size_t>(x)]);
      return kSubpixels * Vec2(x, y) + Vec2(r.next() % 256, r.next() % 256);
    });
    out.ours.push_back(
        at_most(0, std::string(kind.name) + ": samples never covered", static_cast<double>(cover.never)));
    out.ours.push_back(within(0, "coverings, off one a sample by", static_cast<double>(cover.times),
                              static_cast<double>(cover.samples)));
    if (kind.net.steps_per_px != 1.0) continue;
    for (const bool is_closed : {true, false}) {
      out.naive.push_back(
          at_most(0, is_closed ? "edges of both: middles covered twice or more" : "edges of neither: middles in cracks",
                  static_cast<double>(textbook_errors(corners, mesh.indices, side, is_closed))));
    }
  }
  return out;
}

namespace {

constexpr double kTinyPx = 0.1;

// Triangles with two sides of kTinyPx at a right angle, turned at random, all inside the picture.
MeshData confetti(int count, int side_px) {
  MeshData mesh;
  Random random(7);
  for (int i = 0; i < count; ++i) {
    const Vec2 a(random.between(1.0, side_px - 1.0), random.between(1.0, side_px - 1.0));
    const Vec3 direction = random.direction();
    const Vec2 u = kTinyPx * glm::normalize(Vec2(direction.x, direction.y)), v(-u.y, u.x);
    for (const Vec2& p : {a, a + u, a + v}) {
      mesh.indices.push_back(static_cast<uint32_t>(mesh.positions.size()));
      mesh.positions.push_back(world_of(p, side_px));
    }
  }
  return mesh;
}

// A turned square of triangles with two sides of kTinyPx at a right angle.
MeshData fine_square(int cells, double turn_deg) {
  MeshData mesh;
  const double turn = elementary::rad_from_deg(turn_deg);
  const Vec3 u = kTinyPx * Vec3(elementary::cos(turn), elementary::sin(turn), 0.0), v(-u.y, u.x, 0.0);
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) mesh.positions.push_back((j - 0.5 * cells) * u + (i - 0.5 * cells) * v);
  Random random(9);
  mesh.indices = indices_of(cells, random);
  return mesh;
}

double mean_of(const Picture& picture) {
  double sum = 0.0;
  for (const float v : picture.linear) sum += double{v};
  return sum / static_cast<double>(picture.linear.size());
}

// How many pixels are drawn, one triangle after the other, by spans that hold the pixels of both ends.
double pixels_by_spans(const MeshData& mesh) {
  double sum = 0.0;
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const Vec3 &a = mesh.positions[i], &b = mesh.positions[i + 1], &c = mesh.positions[i + 2];
    const Vec3 low = glm::floor(glm::min(a, glm::min(b, c))), high = glm::floor(glm::max(a, glm::max(b, c)));
    sum += high.y - low.y + high.x - low.x + 1.0;  // in each row one at least
  }
  return sum;
}

}  // namespace

Outcome tiny_triangles(const Context& context) {
  const int count = context.is_quick ? 100'000 : 1'000'000, side = 256, grid = context.is_quick ? 16 : 8;
  const double area = 0.5 * kTinyPx * kTinyPx * count;
  const MeshData scattered = confetti(count, side);
  const DrawnScene drawn(sheet_before_camera(scattered, side), context.pool);
  // Samples in strata, one in every cell of a grid within the pixel.
  const Cover cover = cover_of(drawn, grid * grid, [&](int layer, int x, int y, Random& random) {
    const Vec2 cell(layer % grid, layer / grid);
    return kSubpixels * Vec2(x, y) +
           glm::floor(kSubpixels * (cell + Vec2(random.unit(), random.unit())) / double(grid));
  });
  const double covered = static_cast<double>(cover.times) / (grid * grid);

  const int cells = context.is_quick ? 224 : 707;
  const MeshData square = fine_square(cells, 23.0);
  ParsedScene parsed = sheet_before_camera(square, 128);
  parsed.view.render.samples = 64;
  const double square_area = kTinyPx * kTinyPx * cells * cells;
  const double shown = mean_of(picture_of(parsed, context.pool)) * 128 * 128;
  return {
      {within(0.005, "scattered: mean coverings over their area, off 1 by", covered / area, 1.0),
       within(0.005, "side by side: mean of the picture over their area, off 1 by", shown / square_area, 1.0)},
      {within(0.005, "spans with both ends: pixels over the area, off 1 by", pixels_by_spans(scattered) / area, 1.0)}};
}

}  // namespace tilelight::check
