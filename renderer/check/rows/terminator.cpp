// SPDX-License-Identifier: Apache-2.0
// H3, H8: where the light ends on a mesh whose normals make it look round, and the shadows of what is close to it.
#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/check/check.h"
#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/film/tone.h"

namespace tilelight::check {
namespace {

// Lambert's light alone, from 60 degrees beside the eye, and along no edge of the mesh.
ParsedScene lit_ball(int size_px, bool is_mesh, Terminator terminator, bool shadows) {
  ParsedScene parsed = scene_of(R"({"ambient": 0, "background": {"bottom": 0, "top": 0}, "camera":
    {"position": [0, 0, 6], "target": [0, 0, 0], "fov_y_deg": 20},
    "lights": [{"type": "directional", "direction": [-0.7848855672213958, -0.36599815077066677, -0.5]}],
    "objects": [{"type": "sphere", "material": {"diffuse": 1}}]})");
  parsed.view.image.width = parsed.view.image.height = size_px;
  parsed.view.render.terminator = terminator;
  parsed.view.render.shadows = shadows;
  if (is_mesh) {
    MeshData ball = icosphere(2);  // 320 triangles, with the sphere's own normals
    ball.normals = ball.positions;
    parsed.scene.meshes = {ball};
    parsed.scene.objects[0].shape = MeshShape{0};
  }
  return parsed;
}

// What the mesh's own shadow does where its shading normals face the light.
struct OwnShadow {
  double pixels_percent = 0.0;  // of those that face the light
  double levels = 0.0;          // of 255, as displayed: the largest difference that it makes
};
OwnShadow own_shadow(const Context& context, Terminator terminator) {
  const int size = context.is_quick ? 256 : 512;
  const Picture free = picture_of(lit_ball(size, true, Terminator::smooth, false), context.pool);
  const Picture shadowed = picture_of(lit_ball(size, true, terminator, true), context.pool);
  size_t facing = 0, dark = 0;
  OwnShadow out;
  for (size_t i = 0; i < free.linear.size(); i += 3) {
    facing += free.linear[i] > 0.0f;
    dark += free.linear[i] > 0.0f && shadowed.linear[i] == 0.0f;
    note(out.levels, 255.0 * std::abs(displayed(free.linear[i], 0.0) - displayed(shadowed.linear[i], 0.0)));
  }
  out.pixels_percent = 100.0 * static_cast<double>(dark) / static_cast<double>(facing);
  return out;
}

// The largest step between neighbours in the difference to the true sphere, in levels of 255 of linear light (the curve
// of a display would magnify the parallax between facet and sphere), away from the outline. At 1024 pixels that
// parallax changes by less than the bound from one to the next; a true step is as large at any size.
double facet_step(const Context& context, Terminator terminator) {
  constexpr int kSizePx = 1024;
  const Picture mesh = picture_of(lit_ball(kSizePx, true, terminator, true), context.pool);
  const Picture ball = picture_of(lit_ball(kSizePx, false, terminator, true), context.pool);
  const int size = mesh.width;
  const auto difference = [&](int x, int y) {
    const size_t i = 3 * (static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x));
    return 255.0 * (double{mesh.linear[i]} - double{ball.linear[i]});
  };
  const auto is_inside = [&](int x, int y) {  // within 0.9 of the outline's radius
    const double dx = (x - 0.5 * size) / (0.5 * size), dy = (y - 0.5 * size) / (0.5 * size);
    const double outline = 1.0 / std::sqrt(35.0) / 0.17632698070846498;  // tan of the outline over tan 10 degrees
    return std::sqrt(dx * dx + dy * dy) < 0.9 * outline;
  };
  double step = 0.0;
  for (int y = 0; y + 1 < size; ++y) {
    for (int x = 0; x + 1 < size; ++x) {
      if (!is_inside(x, y) || !is_inside(x + 1, y) || !is_inside(x, y + 1)) continue;
      note(step, std::abs(difference(x + 1, y) - difference(x, y)));
      note(step, std::abs(difference(x, y + 1) - difference(x, y)));
    }
  }
  return step;
}

Outcome terminator(const Context& context) {
  const char* shadow = "largest step by its own shadow, levels of 255";
  const char* step = "largest step beside the true sphere, levels of 255";
  const OwnShadow smooth = own_shadow(context, Terminator::smooth);
  return {{at_most(1.0, "pixels facing the light that their own mesh shades, %", smooth.pixels_percent),
           at_most(2.0, shadow, smooth.levels), at_most(2.0, step, facet_step(context, Terminator::smooth))},
          {at_most(2.0, shadow, own_shadow(context, Terminator::exact).levels),
           at_most(2.0, step, facet_step(context, Terminator::exact))}};
}

// The middle of a triangle of a mesh around the origin, and the way out of it.
struct Facet {
  std::array<Vec3, 3> corner;
  Vec3 middle, out;
  Facet(const MeshData& mesh, size_t triangle) {
    for (size_t v = 0; v < 3; ++v) corner[v] = mesh.positions[mesh.indices[3 * triangle + v]];
    middle = (corner[0] + corner[1] + corner[2]) / 3.0;
    out = glm::normalize(glm::cross(corner[1] - corner[0], corner[2] - corner[0]));
  }
  // How high above its middle the tangent planes at the corners put the curve (Hanika 2021), of the unit sphere.
  double lift() const {
    double height = 0.0;
    for (const Vec3& n : corner) height += glm::dot(n, n - middle) * glm::dot(n, out) / 3.0;
    return height;
  }
};

constexpr double kPlateHeight = 1e-3;

// A facet of the ball straight under the light, and under a plate `gap` over it or none; seen from beneath the plate.
bool is_lit(const Context& context, const MeshData& ball, const Facet& facet, double gap, bool has_plate) {
  ParsedScene parsed = lit_ball(1, true, Terminator::smooth, true);
  parsed.scene.meshes = {ball};
  parsed.scene.lights[0].direction = -facet.out;
  const Vec3 x = glm::normalize(facet.corner[1] - facet.corner[0]);
  Object plate = parsed.scene.objects[0];
  plate.shape = BoxShape{{-0.02, gap, -0.02}, {0.02, gap + kPlateHeight, 0.02}};
  plate.world_from_shape[0] = Vec4(x, 0.0), plate.world_from_shape[1] = Vec4(facet.out, 0.0);
  plate.world_from_shape[2] = Vec4(glm::cross(x, facet.out), 0.0), plate.world_from_shape[3] = Vec4(facet.middle, 1.0);
  if (has_plate) parsed.scene.objects.push_back(plate);
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.position = facet.middle + 0.5 * gap * facet.out, camera.target = facet.middle;
  camera.up = x, camera.height = 1e-9;
  parsed.view.camera = camera;
  return picture_of(parsed, context.pool).linear[0] > 0.0f;
}

Outcome contact_on_curve(const Context& context) {
  MeshData ball = icosphere(2);
  ball.normals = ball.positions;
  const size_t step = context.is_quick ? 64 : 16;
  int lit = 0, lit_by_offset = 0, free = 0, facets = 0;
  for (size_t triangle = 0; triangle < ball.indices.size() / 3; triangle += step) {
    const Facet facet(ball, triangle);
    ++facets, free += is_lit(context, ball, facet, facet.lift(), false);
    for (const double part : {1e-6, 1e-3, 0.1, 0.5, 0.9, 1.1}) {  // of the offset
      const double gap = part * facet.lift();
      lit += is_lit(context, ball, facet, gap, true);
      lit_by_offset += facet.lift() > gap + kPlateHeight;  // a shadow ray that starts so high starts over the plate
    }
  }
  const char* what = "facets lit under a plate";
  return {{at_most(0, what, lit), at_least(100, "facets lit without one, %", percent(free, facets))},
          {at_most(0, what, lit_by_offset)}};
}

constexpr Row kRows[] = {
    {"H3", "the light's end on a smooth mesh", "320 triangles in place of a sphere, light from 60 degrees",
     "shadow rays from the facet (terminator: exact)", terminator},
    {"H8", "contact on a smooth mesh", "a plate 1e-6 to 1.1 of the offset over a facet, straight under the light",
     "every shadow ray from the curve (Hanika)", contact_on_curve},
};

}  // namespace

std::span<const Row> terminator_rows() { return kRows; }

}  // namespace tilelight::check
