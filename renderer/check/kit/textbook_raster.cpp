// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/textbook_raster.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "renderer/measure/reference.h"
#include "renderer/raster/projection.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight::check {
namespace {

// A box's faces as RasterScene orders them, two triangles each.
void add_box(const Vec3& half, const std::function<void(uint32_t, const Vec3 (&)[3])>& add) {
  for (uint32_t face = 0; face < 6; ++face) {
    const int axis = static_cast<int>(face / 2);
    const auto corner = [&](double u, double v) {
      Vec3 p;
      p[axis] = face % 2 ? half[axis] : -half[axis];
      p[(axis + 1) % 3] = u * half[(axis + 1) % 3];
      p[(axis + 2) % 3] = v * half[(axis + 2) % 3];
      return p;
    };
    add(face, {corner(-1, -1), corner(1, -1), corner(1, 1)});
    add(face, {corner(-1, -1), corner(1, 1), corner(-1, 1)});
  }
}

struct Corners {
  Vec2 at[3];  // pixels
  double nearness[3];
};

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// The pixels that it may meet.
TileRect box_of(const Corners& corners, const ImageSpec& image) {
  const Vec2 low = glm::min(glm::min(corners.at[0], corners.at[1]), corners.at[2]);
  const Vec2 high = glm::max(glm::max(corners.at[0], corners.at[1]), corners.at[2]);
  const auto pixel = [](double v, int end) {
    return static_cast<int>(std::clamp(std::floor(v), 0.0, static_cast<double>(end)));
  };
  return {pixel(low.x, image.width), pixel(low.y, image.height), pixel(high.x + 1.0, image.width),
          pixel(high.y + 1.0, image.height)};
}

}  // namespace

std::vector<WorldTriangle> triangles_of(const CompiledScene& scene) {
  std::vector<WorldTriangle> out;
  for (const CompiledBody& body : scene.bodies) {
    const auto add = [&](uint32_t prim, const Vec3(&local)[3]) {
      WorldTriangle& triangle = out.emplace_back();
      triangle.id = surface_id(body.body, prim);
      for (int c = 0; c < 3; ++c) triangle.corners[c] = transform_point(body.world_from_local, local[c]);
    };
    if (body.kind == BodyKind::box) {
      add_box(body.half, add);
      continue;
    }
    for (uint32_t t = 0; t < body.mesh->triangles.size(); ++t) {
      const auto& tri = body.mesh->triangles[t];
      add(t, {body.mesh->positions[tri[0]], body.mesh->positions[tri[1]], body.mesh->positions[tri[2]]});
    }
  }
  return out;
}

std::vector<uint64_t> textbook_ids(const DrawnScene& drawn, const TextbookRaster& raster) {
  const ImageSpec& image = drawn.plan().view.image;
  const ImageProjection projection(drawn.plan().eye);
  const auto width = static_cast<size_t>(image.width);
  std::vector<uint64_t> ids(width * static_cast<size_t>(image.height), kNothingHit);
  std::vector<double> depths(ids.size(), std::numeric_limits<double>::infinity());
  const double near = raster.near / drawn.scene().units, far = raster.far / drawn.scene().units;
  const auto depth_of = [&](double nearness) {
    if (!(raster.far > 0.0)) return -nearness;
    const double z = 1.0 / nearness;
    return double{static_cast<float>(far * (z - near) / (z * (far - near)))};
  };
  for (const WorldTriangle& triangle : triangles_of(drawn.scene())) {
    Corners corners;
    for (int c = 0; c < 3; ++c) {
      const ImagePoint place = projection.of(triangle.corners[c]);
      corners.at[c] = Vec2(place.x, place.y) / place.w;
      if (raster.steps_per_px > 0.0)
        corners.at[c] = glm::round(corners.at[c] * raster.steps_per_px) / raster.steps_per_px;
      corners.nearness[c] = place.nearness / place.w;
    }
    const double area = twice_area(corners.at[0], corners.at[1], corners.at[2]);
    if (area == 0.0) continue;
    for_each_pixel(box_of(corners, image), [&](int x, int y) {
      const SamplePoint s = place_sample(drawn.plan().view.render, x, y, 0);
      const Vec2 at(x + s.x, y + s.y);
      double nearness = 0.0;
      for (int c = 0; c < 3; ++c) {
        const double part = twice_area(corners.at[(c + 1) % 3], corners.at[(c + 2) % 3], at) / area;
        if (!(part >= 0.0)) return;
        nearness += part * corners.nearness[c];
      }
      const size_t i = static_cast<size_t>(y) * width + static_cast<size_t>(x);
      if (depth_of(nearness) < depths[i]) depths[i] = depth_of(nearness), ids[i] = triangle.id;
    });
  }
  return ids;
}

}  // namespace tilelight::check
