// SPDX-License-Identifier: Apache-2.0
// R7: what is interpolated over a face is interpolated over the face and not over its picture.
#include <algorithm>
#include <cmath>
#include <optional>

#include "renderer/check/kit/methods.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"
#include "renderer/check/rows/raster.h"
#include "renderer/trace/pixel_filter.h"

namespace tilelight::check {
namespace {

// A floor one unit under the eye, between depths of 1 and 100, two triangles with a diagonal from its first corner to
// its third. The eye stands in the origin and looks along -z over a field of 60 degrees.
constexpr double kTanHalfFov = 0.5773502691896258;
const Vec3 kFloor[4] = {{-2, -1, -1}, {2, -1, -1}, {2, -1, -100}, {-2, -1, -100}};
const Vec3 kNormals[4] = {{0.6, 0.8, 0.0}, {-0.6, 0.8, 0.0}, {0.0, 0.8, 0.6}, {0.0, 0.8, -0.6}};
const Vec3 kLamp(0.5, 6.0, -4.0);
constexpr double kAmbient = 0.1, kDiffuse = 0.7, kSpecular = 0.25, kIntensity = 9.0, kConstant = 2.0;

ParsedScene receding_floor(int side_px, Shading shading) {
  ParsedScene parsed;
  parsed.scene = scene_of_shapes({MeshShape{0}});
  MeshData& floor = parsed.scene.meshes.emplace_back();
  floor.positions.assign(std::begin(kFloor), std::end(kFloor));
  floor.normals.assign(std::begin(kNormals), std::end(kNormals));
  floor.indices = {0, 1, 2, 0, 2, 3};
  Material& material = parsed.scene.materials[0];
  material.ambient = Color(1.0), material.diffuse = Color(kDiffuse), material.specular = Color(kSpecular);
  material.shininess = 4.0;
  parsed.scene.ambient = Color(kAmbient);
  parsed.scene.background = {Color(0.0), Color(0.0)};
  parsed.scene.attenuation = {AttenuationMode::linear, kConstant};
  Light& light = parsed.scene.lights.emplace_back();
  light.position = kLamp, light.intensity = kIntensity;
  parsed.view.image = {side_px, side_px};
  parsed.view.render.samples = 1;
  parsed.view.render.shadows = false;
  parsed.view.render.shading = shading;
  Camera& camera = parsed.view.camera.emplace();
  camera.target = Vec3(0.0, 0.0, -1.0);
  camera.fov_y_deg = 60.0;
  return parsed;
}

// The model's equation, written out.
double light_at(const Vec3& at, const Vec3& normal) {
  const Vec3 n = glm::normalize(normal), viewer = -glm::normalize(at), to_lamp = kLamp - at;
  const double distance = glm::length(to_lamp), facing = glm::dot(n, to_lamp / distance);
  if (!(facing > 0.0)) return kAmbient;
  const double mirrored = std::max(0.0, glm::dot(2.0 * facing * n - to_lamp / distance, viewer));
  const double lobe = mirrored * mirrored * mirrored * mirrored;
  return kAmbient + kIntensity * (kDiffuse * facing + kSpecular * lobe) / (distance + kConstant);
}

struct Weights {
  int corners[3];
  double at[3];
};
// Of the corners, from the places of all four and of the point, in the floor or in the picture. Which triangle it lies
// in, the floor decides.
Weights weights_of(const Vec2 (&corners)[4], const Vec2& p, bool is_first) {
  Weights out{{0, is_first ? 1 : 2, is_first ? 2 : 3}, {}};
  const auto area = [](const Vec2& a, const Vec2& b, const Vec2& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  };
  const Vec2 &a = corners[out.corners[0]], &b = corners[out.corners[1]], &c = corners[out.corners[2]];
  out.at[0] = area(p, b, c) / area(a, b, c), out.at[1] = area(a, p, c) / area(a, b, c);
  out.at[2] = area(a, b, p) / area(a, b, c);
  return out;
}

Vec2 in_picture(const Vec3& p, int side_px) { return 0.5 * side_px * (Vec2(p.x, -p.y) / (-p.z * kTanHalfFov) + 1.0); }

// What the sample at a point of the picture shows, pixels; none where it misses the floor. over_picture: interpolated
// over the picture, as is wrong.
std::optional<double> expected(const Vec2& px, int side_px, Shading shading, bool over_picture) {
  const Vec3 direction((2.0 * px.x / side_px - 1.0) * kTanHalfFov, (1.0 - 2.0 * px.y / side_px) * kTanHalfFov, -1.0);
  if (!(direction.y < 0.0)) return std::nullopt;
  const Vec3 at = direction / -direction.y;
  if (!(std::abs(at.x) < 2.0 && at.z < -1.0 && at.z > -100.0)) return std::nullopt;
  Vec2 corners[4];
  for (int i = 0; i < 4; ++i)
    corners[i] = over_picture ? in_picture(kFloor[i], side_px) : Vec2(kFloor[i].x, kFloor[i].z);
  const bool is_first = (at.x + 2.0) * 99.0 > -(at.z + 1.0) * 4.0;  // right of the diagonal
  const Weights w = weights_of(corners, over_picture ? px : Vec2(at.x, at.z), is_first);
  double value = 0.0;
  Vec3 normal(0.0);
  for (int i = 0; i < 3; ++i) {
    value += w.at[i] * light_at(kFloor[w.corners[i]], kNormals[w.corners[i]]);
    normal += w.at[i] * kNormals[w.corners[i]];
  }
  return shading == Shading::gouraud ? value : light_at(at, normal);
}

// The largest difference to what is expected, in levels of 255, where no edge is near.
double farthest(const Context& context, const ParsedScene& parsed, bool over_picture) {
  const Picture picture = picture_of(parsed, context.pool);
  const std::vector<Beside> beside = DrawnScene(parsed, context.pool).beside();
  const int side = picture.width;
  double worst = 0.0;
  for (size_t i = 0; i < beside.size(); ++i) {
    const int x = static_cast<int>(i) % side, y = static_cast<int>(i) / side;
    const SamplePoint p = place_sample(parsed.view.render, x, y, 0);
    const auto value = expected(Vec2(x + p.x, y + p.y), side, parsed.view.render.shading, over_picture);
    if (value && beside[i] == Beside::same) note(worst, 255.0 * std::abs(*value - double{picture.linear[3 * i]}));
  }
  return worst;
}

}  // namespace

Outcome receding_face(const Context& context) {
  Outcome out;
  for (const Shading shading : {Shading::gouraud, Shading::phong}) {
    const std::string name = shading == Shading::gouraud ? "Gouraud" : "Phong";
    ParsedScene parsed = receding_floor(side_of(context), shading);
    parsed.view.render.tessellate = true;  // samples on the grid by rays too
    for (const auto& [algorithm, method] :
         {std::pair{Algorithm::raytrace, "rays"}, std::pair{Algorithm::zbuffer, "z-buffer"},
          std::pair{Algorithm::warnock, "Warnock"}}) {
      parsed.view.render.algorithm = algorithm;
      out.ours.push_back(at_most(1.0, name + ", " + method + ": farthest from the closed form, levels of 255",
                                 farthest(context, parsed, false)));
    }
    out.naive.push_back(
        at_most(1.0, name + " over the picture: how far off, levels of 255", farthest(context, parsed, true)));
  }
  return out;
}

}  // namespace tilelight::check
