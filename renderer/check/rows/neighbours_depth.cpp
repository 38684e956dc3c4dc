// SPDX-License-Identifier: Apache-2.0
// H4, H5: two surfaces in one plane, and in almost one: who is seen, by every method that knows it.
#include <algorithm>

#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/kit/textbook_raster.h"
#include "renderer/check/rows/neighbours.h"

namespace tilelight::check {
namespace {

struct Method {
  Algorithm algorithm;
  const char* name;
};
constexpr Method kMethods[] = {
    {Algorithm::raytrace, "rays"}, {Algorithm::zbuffer, "z-buffer"}, {Algorithm::warnock, "Warnock"}};

// Two squares of one plane: meshes cut along different diagonals, one shifted, a flat box, a face of a slab. Body 0 is
// red, body 1 green.
std::string two_quads(const std::string& first, const std::string& second, int side) {
  const std::string red = R"(,"material":{"diffuse":[1,0,0]}})", green = R"(,"material":{"diffuse":[0,1,0]}})";
  return R"({"meshes":{"a":)" + mesh_text(sheet(1.0, 1)) + R"(,"b":)" + mesh_text(sheet(1.0, 3, true)) +
         R"(},"objects":[)" + first + red + (second.empty() ? "" : "," + second + green) +
         R"(],"camera":{"position":)" + text(2.0 * kNormal + 1.5 * kAcross + 0.3 * kAlong) + R"(,"target":[0,0,0]},)" +
         image_text(side, side) + "}";
}

// The pixels of the first surface alone that show it just so when the second lies in its place.
double first_shown(const ParsedScene& both, const ParsedScene& alone, Algorithm algorithm, TilePool& pool) {
  struct Shown {
    std::vector<uint64_t> ids;
    std::vector<uint8_t> rgb;
  };
  const auto shown = [&](ParsedScene parsed) -> Shown {
    parsed.view.render.algorithm = algorithm;
    Picture picture = picture_of(parsed, pool);
    if (algorithm == Algorithm::raytrace) return {std::move(picture.ids), std::move(picture.rgb)};
    return {DrawnScene(parsed, pool).ids(algorithm), std::move(picture.rgb)};
  };
  const Shown with = shown(both), without = shown(alone);
  int64_t in_common = 0, same = 0;
  for (size_t i = 0; i < with.ids.size(); ++i) {
    if (without.ids[i] == kNothingHit) continue;
    ++in_common;
    same += with.ids[i] == without.ids[i] && with.rgb[3 * i + 1] == without.rgb[3 * i + 1];
  }
  return percent(same, in_common);
}

// Two sheets that lean away from the eye in the origin, the second farther by `gap` of its distance on every ray, and
// boxes at both ends of the depths. is_far_first: the farther one has the lower id.
constexpr double kNearest = 0.01, kFarthest = 1e4, kGap = 1e-6;
ParsedScene two_sheets(bool is_far_first, int side) {
  MeshData sheets[2];
  for (int i = 0; i < 2; ++i) {
    for (const Vec2& at : {Vec2(-40, -40), Vec2(40, -40), Vec2(40, 40), Vec2(-40, 40)}) {
      const Vec3 p(at.x, at.y, -(100.0 + 0.3 * at.x - 0.2 * at.y));
      sheets[i].positions.push_back((i == 0 ? 1.0 : 1.0 + kGap) * p);
    }
    sheets[i].indices = {0, 1, 2, 0, 2, 3};
  }
  const std::string near = R"({"type":"mesh","mesh":"near","material":{"diffuse":[1,0,0]}})",
                    far = R"({"type":"mesh","mesh":"far","material":{"diffuse":[0,1,0]}})";
  return scene_of(R"({"lights":[],"meshes":{"near":)" + mesh_text(sheets[0]) + R"(,"far":)" + mesh_text(sheets[1]) +
                  R"(},"objects":[)" + (is_far_first ? far + "," + near : near + "," + far) +
                  R"(,{"type":"box","min":[0.002,0.002,-0.011],"max":[0.003,0.003,-0.01]},
                  {"type":"box","min":[-8000,-8000,-10000],"max":[8000,8000,-9990]}],
                  "camera":{"position":[0,0,0],"target":[0,0,-1],"fov_y_deg":60},"render":{"max_depth":0},)" +
                  image_text(side, side) + "}");
}

// Of the pixels that show one of the two, away from edges, those that show the nearer one, %.
double nearer_shown(const std::vector<uint64_t>& ids, const std::vector<Beside>& beside, uint32_t nearer) {
  int64_t either = 0, right = 0;
  for (size_t i = 0; i < ids.size(); ++i) {
    if (ids[i] >> 32 > 1 || beside[i] != Beside::same) continue;
    ++either;
    right += ids[i] >> 32 == nearer;
  }
  return percent(right, either);
}

}  // namespace

Outcome coplanar(const Context& context) {
  const std::string a = R"({"type":"mesh","mesh":"a")", b = R"({"type":"mesh","mesh":"b")",
                    shifted = b + R"(,"translate":)" + text(0.3 * kAcross - 0.2 * kAlong),
                    flat = R"({"type":"box","min":[-1.2,0,-1.2],"max":[1.2,0,1.2],)" + turn_text(),
                    slab = R"({"type":"box","min":[-1.2,-0.1,-1.2],"max":[1.2,0.1,1.2],)" + turn_text() +
                           R"(,"translate":)" + text(-0.1 * kNormal);
  struct Pair {
    const char* what;
    const std::string &first, &second;
  };
  Outcome out;
  const int side = side_of(context);
  for (const Pair& pair : {Pair{"mesh, mesh", a, b}, Pair{"mesh, mesh in another order", b, a},
                           Pair{"mesh, shifted mesh", a, shifted}, Pair{"mesh, flat box", a, flat},
                           Pair{"flat box, mesh", flat, b}, Pair{"mesh, slab", a, slab}, Pair{"slab, mesh", slab, b}}) {
    const ParsedScene both = scene_of(two_quads(pair.first, pair.second, side));
    const ParsedScene alone = scene_of(two_quads(pair.first, "", side));
    for (const Method& method : kMethods) {
      out.ours.push_back(at_least(100, std::string(pair.what) + ", " + method.name + ": pixels that show the first, %",
                                  first_shown(both, alone, method.algorithm, context.pool)));
    }
    if (pair.first != flat && pair.second != flat) {
      const auto textbook = TextbookTracer(both.scene).picture(both.view, *both.view.camera, context.pool);
      const std::vector<uint64_t> first = picture_of(alone, context.pool).ids;
      int64_t in_common = 0, shown = 0;
      for (size_t i = 0; i < first.size(); ++i) {
        in_common += first[i] != kNothingHit;
        shown += first[i] != kNothingHit && textbook.ids[i] >> 32 == 0;
      }
      out.naive.push_back(
          at_least(100, std::string(pair.what) + ": pixels that show the first, %", percent(shown, in_common)));
    }
  }
  return out;
}

Outcome nearly_coplanar(const Context& context) {
  Outcome out;
  for (const bool is_far_first : {true, false}) {
    const DrawnScene drawn(two_sheets(is_far_first, side_of(context)), context.pool);
    const std::vector<Beside> beside = drawn.beside();
    const uint32_t nearer = is_far_first ? 1 : 0;
    const std::string order = is_far_first ? "the farther first, " : "the nearer first, ";
    for (const Method& method : kMethods) {
      out.ours.push_back(at_least(100, order + method.name + ": pixels that show the nearer, %",
                                  nearer_shown(drawn.ids(method.algorithm), beside, nearer)));
    }
    if (!is_far_first) continue;  // where depths are equal, what is drawn first stays
    const std::vector<uint64_t> naive = textbook_ids(drawn, {.near = kNearest, .far = kFarthest});
    out.naive.push_back(
        at_least(100, order + "z / w in float: pixels that show the nearer, %", nearer_shown(naive, beside, nearer)));
  }
  return out;
}

}  // namespace tilelight::check
