// SPDX-License-Identifier: Apache-2.0
// H: surfaces that nearly touch, or lie in one place: light that grazes, shadows that have to reach their body.
#include <algorithm>
#include <cmath>
#include <limits>

#include "renderer/base/elementary.h"
#include "renderer/check/check.h"
#include "renderer/check/kit/looks.h"
#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/neighbours.h"

namespace tilelight::check {
namespace {

// The plane as one of three kinds of body, lit at an elevation.
constexpr const char* kGroundKinds[] = {"plane", "box", "mesh of 3200 triangles"};
std::string grazed_ground(size_t kind, double elevation_deg, int side) {
  const double e = elementary::rad_from_deg(elevation_deg);
  const Vec3 to_light = elementary::cos(e) * glm::normalize(kAcross + 0.4 * kAlong) + elementary::sin(e) * kNormal;
  const std::string objects[] = {
      R"({"type":"plane","point":[0,0,0],"normal":)" + text(kNormal) + "}",
      R"({"type":"box","min":[-30,-1,-30],"max":[30,1,30],)" + turn_text() + R"(,"translate":)" + text(-kNormal) + "}",
      R"({"type":"mesh","mesh":"sheet"})"};
  return R"({"meshes":{"sheet":)" + mesh_text(sheet(5.0, 40)) + R"(},"objects":[)" + objects[kind] +
         R"(],"lights":[{"type":"directional","direction":)" + text(-to_light) + R"(}],"camera":{"position":)" +
         text(3.0 * kNormal + 0.5 * kAcross) + R"(,"target":[0,0,0]},)" + image_text(side, side) + "}";
}

// The light stands 0.1 or 0.001 degrees over a plane: no point of it is in shadow.
Outcome acne(const Context& context) {
  Outcome out;
  const int side = side_of(context);
  for (const double elevation : {0.1, 0.001}) {
    for (size_t kind = 0; kind < std::size(kGroundKinds); ++kind) {
      const std::vector<Seen> pixels = look(grazed_ground(kind, elevation, side), context.pool);
      const auto dark = std::count_if(pixels.begin(), pixels.end(), [](const Seen& s) { return !s.is_lit; });
      out.ours.push_back(at_most(0, std::string(kGroundKinds[kind]) + " at " + text(elevation) + " deg: shadowed",
                                 static_cast<double>(dark)));
    }
    for (const double epsilon : {0.0, 1e-5}) {
      const ParsedScene parsed = scene_of(grazed_ground(0, elevation, 128));
      const auto textbook = TextbookTracer(parsed.scene, static_cast<float>(epsilon))
                                .picture(parsed.view, *parsed.view.camera, context.pool);
      const auto dark = std::count(textbook.lit.begin(), textbook.lit.end(), 0);
      out.naive.push_back(at_most(0, "offset " + text(epsilon) + ", " + text(elevation) + " deg: shadowed, %",
                                  percent(dark, std::ssize(textbook.lit))));
    }
  }
  return out;
}

// A box on a floor, lit from behind at 45 degrees: seen along its foot, which lies in the middle row of 4096.
constexpr int kContactPx = 4096;
const Vec3 kContactEye(-3.0, 3.0, 0.0), kContactTarget(-0.5, 0.0, 0.0);
constexpr double kContactFovDeg = 12.0;
constexpr const char* kFloors[] = {R"({"type":"plane"})", R"({"type":"box","min":[-9,-1,-9],"max":[9,0,9]})"};
struct Stander {
  const char* name;
  Vec3 min, max;
};
const Stander kStanders[] = {{"box", {-0.5, 0.0, -0.5}, {0.5, 1.0, 0.5}},
                             {"wall of 1e-3", {-0.5, 0.0, -0.5}, {-0.499, 1.0, 0.5}}};
std::string standing(const Stander& stander, const char* floor) {
  return R"({"objects":[)" + std::string(floor) + R"(,{"type":"box","min":)" + text(stander.min) + R"(,"max":)" +
         text(stander.max) + R"(}],"lights":[{"type":"directional","direction":[-1,-1,0]}],"camera":{"position":)" +
         text(kContactEye) + R"(,"target":)" + text(kContactTarget) + R"(,"fov_y_deg":)" + text(kContactFovDeg) + "}," +
         image_text(kContactPx, kContactPx) + "}";
}

// In each column, the lit pixels of the floor between the box's side and the shadow.
double widest_gap(const std::vector<Seen>& strip, int width) {
  int widest = 0;
  for (int x = 0; x < width; ++x) {
    int gap = 0;
    for (size_t i = static_cast<size_t>(x); i < strip.size(); i += static_cast<size_t>(width)) {
      if (strip[i].body() != 0) continue;
      if (!strip[i].is_lit) break;
      ++gap;
    }
    widest = std::max(widest, gap);
  }
  return widest;
}

// The rows of pixels of the floor, from the foot on, whose point is_blocked(ray to the light) leaves lit.
template <class IsBlocked>
double textbook_gap(const IsBlocked& is_blocked) {
  // On the floor a row of pixels is this wide, seen at the slope of the view.
  const double distance = glm::length(kContactEye - kContactTarget);
  const double px = 2.0 * elementary::tan(elementary::rad_from_deg(0.5 * kContactFovDeg)) * distance / kContactPx;
  const double row = px * distance / kContactEye.y;
  const Vec3f to_light = glm::normalize(Vec3f(1.0f, 1.0f, 0.0f));
  int gap = 0;
  while (gap < kContactPx && !is_blocked(naive::RayF{Vec3f(-0.5 - (gap + 0.5) * row, 0.0, 0.1), to_light})) ++gap;
  return gap;
}

Outcome contact(const Context& context) {
  Outcome out;
  const int width = context.is_quick ? 256 : kContactPx;
  const TileRect strip{(kContactPx - width) / 2, kContactPx / 2 - 16, (kContactPx + width) / 2, kContactPx / 2 + 64};
  constexpr float kLift = 1e-2f;
  for (const Stander& stander : kStanders) {
    const std::string what = std::string(stander.name) + ": gap before the shadow, pixels of 4096";
    for (const char* floor : kFloors) {
      const std::vector<Seen> pixels = look(standing(stander, floor), context.pool, strip);
      const auto dark =
          std::count_if(pixels.begin(), pixels.end(), [](const Seen& s) { return s.body() == 0 && !s.is_lit; });
      out.ours.push_back(at_most(1, what, widest_gap(pixels, width)));
      out.ours.push_back(at_least(60, "rows of shadow", static_cast<double>(dark) / width));
    }
  }
  const auto is_entered = [](const naive::RayF& ray) {
    const auto hit = naive::slabs(ray, Vec3f(kStanders[0].min), Vec3f(kStanders[0].max), true);
    return hit && hit->near > kLift;
  };
  const TextbookTracer wall(scene_of(standing(kStanders[1], kFloors[0])).scene, kLift);
  const auto is_blocked = [&](const naive::RayF& ray) {
    return wall.is_blocked(ray, kLift, std::numeric_limits<float>::infinity());
  };
  out.naive.push_back(at_most(1, "box, entries alone: gap before the shadow", textbook_gap(is_entered)));
  out.naive.push_back(at_most(1, "wall: gap before the shadow", textbook_gap(is_blocked)));
  return out;
}

// A pawn on a board, lit from behind at 45 degrees. Its foot overhangs the circle it stands on, of radius 0.265, up to
// a height of 0.0756: behind it the board is dark from the circle on.
std::string pawn_on_board(double size, int side) {
  return R"({"objects":[{"type":"chess_piece","piece":"pawn","position":[0,0,0],"scale":)" + text(size) +
         R"(},{"type":"box","min":)" + text(size * Vec3(-1.0, -0.1, -1.0)) + R"(,"max":)" +
         text(size * Vec3(1.0, 0.0, 1.0)) + R"(}],"lights":[{"type":"directional","direction":[-1,-1,0]}],
            "camera":{"position":)" +
         text(size * Vec3(-3.0, 0.4, 0.0)) + R"(,"target":)" + text(size * Vec3(-0.27, 0.0, 0.0)) +
         R"(,"fov_y_deg":2},)" + image_text(side, side) + "}";
}
bool is_behind_foot(const Seen& seen, double size) {
  const Vec3 p = seen.at / size;
  const double from_axis = std::sqrt(p.x * p.x + p.z * p.z);
  return seen.body() == 1 && from_axis < 0.265 + 0.07 && p.x < -0.94 * from_axis;
}

Outcome pawn_contact(const Context& context) {
  const int side = context.is_quick ? 64 : 256, textbook_side = 48;
  Outcome out;
  for (const double size : {1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e9}) {
    const std::vector<Seen> pixels = look(pawn_on_board(size, side), context.pool);
    const auto is_judged = [&](const Seen& s) { return is_behind_foot(s, size); };
    const auto judged = std::count_if(pixels.begin(), pixels.end(), is_judged);
    const auto lit =
        std::count_if(pixels.begin(), pixels.end(), [&](const Seen& s) { return is_judged(s) && s.is_lit; });
    out.ours.push_back(at_most(0, "size " + text(size) + ": lit pixels behind the foot", static_cast<double>(lit)));
    out.ours.push_back(at_least(0.1 * side * side, "pixels judged", static_cast<double>(judged)));
  }
  for (const double size : {1e-9, 1e-3}) {
    const ParsedScene parsed = scene_of(pawn_on_board(size, textbook_side));
    const std::vector<Seen> pixels = look(pawn_on_board(size, textbook_side), context.pool);
    const auto textbook = TextbookTracer(parsed.scene).picture(parsed.view, *parsed.view.camera, context.pool);
    int64_t lit = 0;
    for (size_t i = 0; i < pixels.size(); ++i) lit += is_behind_foot(pixels[i], size) && textbook.lit[i];
    out.naive.push_back(at_most(0, "size " + text(size) + ": lit pixels behind the foot", static_cast<double>(lit)));
  }
  return out;
}

// A lamp in a closed shade: the floor far below is dark.
Outcome lampshade(const Context& context) {
  Outcome out;
  const int side = side_of(context);
  for (const double distance : {1.0, 1e3, 1e6}) {
    const double radius = 1e-9 * distance;
    const auto document = [&](double shade) {
      return R"({"objects":[{"type":"box","min":[-1,-1,-1],"max":[1,0,1]},{"type":"sphere","center":)" +
             text(Vec3(0.0, distance, 0.0)) + R"(,"radius":)" + text(shade) +
             R"(}],"lights":[{"type":"point","position":)" + text(Vec3(0.0, distance, 0.0)) +
             R"(}],"camera":{"position":[0.2,1.5,2],"target":[0,0,0]},)" + image_text(side, side) + "}";
    };
    const std::vector<Seen> pixels = look(document(radius), context.pool);
    const auto lit = std::count_if(pixels.begin(), pixels.end(), [](const Seen& s) { return s.is_lit; });
    out.ours.push_back(
        at_most(0, "shade of 1e-9 around a lamp " + text(distance) + " away: lit pixels", static_cast<double>(lit)));
    // pbrt's shadow rays end at 1 - 1e-4 of their way; the shade is made as wide as float can bear.
    const TextbookTracer textbook(scene_of(document(1e-5 * distance)).scene);
    const auto way = static_cast<float>(distance);
    out.naive.push_back(
        at_least(1, "a shade of 1e-5 holds light from " + text(distance) + " away",
                 textbook.is_blocked({Vec3f(0.0f), Vec3f(0.0f, 1.0f, 0.0f)}, 1e-3f, way * (1 - 1e-4f))));
  }
  return out;
}

constexpr Row kRows[] = {
    {"H1", "light that grazes a plane", "elevation 0.1 and 0.001 degrees", "shadow rays lifted by 0 or 1e-5", acne},
    {"H2", "contact", "a box on a floor, light at 45 degrees, 4096 pixels", "shadow rays lifted by 1e-2", contact},
    {"H4", "two surfaces in one plane", "planes apart by rounding alone", "the smaller t wins", coplanar},
    {"H5", "two surfaces almost in one plane", "a gap of 1e-6 at 100, between things at 0.01 and 1e4",
     "z / w in float, near 0.01 and far 1e4", nearly_coplanar},
    {"H6", "a pawn on its board", "sizes 1e-9 to 1e9", "shadow rays lifted by 1e-3", pawn_contact},
    {"H7", "a lamp in its shade", "radius 1e-9 of the distance", "shadow rays end 1e-4 before the light (pbrt)",
     lampshade},
};

}  // namespace

std::span<const Row> neighbour_rows() { return kRows; }

}  // namespace tilelight::check
