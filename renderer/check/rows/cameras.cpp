// SPDX-License-Identifier: Apache-2.0
// C: fields, ups and image shapes at their ends. The scenes are rows of boxes whose edges the camera's geometry hits at
// known pixels, so that every first surface follows from a closed form.
#include <cmath>
#include <string>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/cameras.h"
#include "renderer/film/sampling.h"

namespace tilelight::check {
namespace {

ViewPlan plan_of(const ParsedScene& parsed, TilePool& pool) {
  return plan_view(*compile_scene(parsed.scene, pool), parsed.view);
}

void set_size(ParsedScene& parsed, int width, int height) {
  parsed.view.image.width = width, parsed.view.image.height = height;
}

// How many rays of the middle row differ in direction from the one before. In float for comparison, with the axes of
// the same camera.
struct Distinct {
  int in_double = 1, in_float = 1;
};
Distinct distinct_directions(const Eye& eye, int size) {
  Distinct count;
  const Vec3f forward(eye.forward), step(eye.step_x), corner = -0.5f * static_cast<float>(size) * step;
  Vec3 last(0.0);
  Vec3f last_float(0.0f);
  for (int x = 0; x < size; ++x) {
    const Vec3 direction = eye_ray(eye, x + 0.5, 0.5 * size).direction;
    const Vec3f in_float = glm::normalize(forward + corner + (static_cast<float>(x) + 0.5f) * step);
    if (x > 0) count.in_double += direction != last, count.in_float += in_float != last_float;
    last = direction, last_float = in_float;
  }
  return count;
}

// The eye sees 1.7e-8 of a wall at distance 1: first a single box, then strips side by side.
Outcome narrow(const Context& context) {
  constexpr double kFovDeg = 1e-6;
  const int size = context.is_quick ? 128 : 512;
  const double view_height = 2.0 * elementary::tan(elementary::rad_from_deg(0.5 * kFovDeg));
  Camera camera;
  camera.position = Vec3(0, 0, 1);
  camera.fov_y_deg = kFovDeg;
  const Strips strips{.count = 64, .width = view_height / 60.0, .half_height = view_height};
  Camera aside = camera;  // at the middle of the second of two strips
  aside.position.x = aside.target.x = 0.5;
  const ParsedScene wall = view_of_strips({.count = 2, .width = 1.0, .half_height = 1.0}, aside, size);
  const ParsedScene fine = view_of_strips(strips, camera, size);
  const Picture whole = picture_of(wall, context.pool), picture = picture_of(fine, context.pool);
  const std::vector<uint64_t> expected = expected_strips(strips, view_height, size);
  const int small = 128;  // the textbook asks every strip
  const ParsedScene few = view_of_strips(strips, camera, small);
  const auto textbook = TextbookTracer(few.scene).picture(few.view, *few.view.camera, context.pool);
  const Distinct distinct = distinct_directions(plan_of(fine, context.pool).eye, size);
  return {{at_least(1, "part of the pixels that shows the wall", coverage(whole.ids, 1)),
           at_most(0, "steps back within a row of ids", static_cast<double>(steps_back(picture.ids, size))),
           at_most(0.1, "first surfaces off the closed form, %", differing_bodies(expected, picture.ids)),
           at_least(size, "distinct directions in a row", distinct.in_double)},
          {at_most(0.1, "first surfaces off the closed form, %",
                   differing_bodies(expected_strips(strips, view_height, small), textbook.ids)),
           at_least(size, "distinct directions in a row", distinct.in_float)}};
}

// The eye in the middle of a box of half size 1: a pixel whose ray goes farther to the side than up sees a side wall.
Outcome wide(const Context& context) {
  constexpr const char* kRoom = R"({"objects": [{"type": "box", "min": [-1, -1, -1], "max": [1, 1, 1]}],
    "camera": {"position": [0, 0, 0], "target": [0, 0, -1], "fov_y_deg": )";
  const int size = context.is_quick ? 128 : 512;
  ParsedScene room = scene_of(std::string(kRoom) + "179.99}}");
  set_size(room, size, size);
  const Picture picture = picture_of(room, context.pool);
  const double half_height = 1.0 / elementary::tan(elementary::rad_from_deg(0.005));  // of 179.99 degrees
  int64_t wrong = 0;
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const SamplePoint s = sample_point(x, y, 0, 0);
      const double across = (2.0 * (x + s.x) / size - 1.0) * half_height,
                   up = (1.0 - 2.0 * (y + s.y) / size) * half_height;
      const uint32_t face = std::abs(across) > std::abs(up) ? (across > 0.0 ? 1 : 0) : (up > 0.0 ? 3 : 2);
      wrong += picture.ids[static_cast<size_t>(y * size + x)] != surface_id(0, face);
    }
  }
  // Half the field in float and its tangent: at 180 degrees the argument is already past the pole.
  const auto naive_half_height = [](float fov) { return elementary::tan(0.5f * fov * (3.14159265f / 180.0f)); };
  int accepted = 0, flipped = 0;
  for (const char* fov : {"180", "0", "-1"}) {
    accepted += parse_scene(std::string(kRoom) + fov + "}}", Limits{}).has_value();
    flipped += !(naive_half_height(std::stof(fov)) > 0.0);
  }
  const Eye eye = plan_of(room, context.pool).eye;
  const double found = 0.5 * size * glm::length(eye.step_y);
  return {{at_most(0, "refused fields that are accepted", accepted),
           at_most(0, "samples that are not finite", static_cast<double>(picture.nonfinite())),
           at_most(0, "first surfaces off the closed form", static_cast<double>(wrong)),
           at_most(1e-9, "half height of the picture, relative error", std::abs(found / half_height - 1.0))},
          {at_most(0, "fields whose picture plane is empty or flipped", flipped),
           at_most(1e-9, "half height of the picture, relative error",
                   std::abs(naive_half_height(179.99f) / half_height - 1.0))}};
}

// How far the eye's axes are from being unit and at right angles.
double frame_error(const Eye& eye) {
  const Mat3 m(glm::normalize(eye.step_x), -glm::normalize(eye.step_y), -eye.forward);
  const Mat3 product = glm::transpose(m) * m - Mat3(1.0);
  double worst = std::abs(glm::determinant(m) - 1.0);
  for (int i = 0; i < 9; ++i) note(worst, std::abs(product[i / 3][i % 3]));
  return worst;
}

constexpr const char* kThings = R"({"image": {"width": 96, "height": 64}, "objects": [{"type": "cube", "size": 1.2},
  {"type": "sphere", "center": [0.7, 0.4, 0.5], "radius": 0.4}], "camera": {"position": [3, 2, 5], "target": [0, 0.5, 0]}})";

Outcome up_along_view(const Context& context) {
  const ParsedScene plain = scene_of(kThings);
  const Camera& camera = *plain.view.camera;
  const Vec3 view = camera.target - camera.position;  // (-3, -1.5, -5): least along y
  const auto with_up = [&](const Vec3& up) {
    ParsedScene parsed = plain;
    parsed.view.camera->up = up;
    return parsed;
  };
  const Picture parallel = picture_of(with_up(1.7 * view), context.pool);
  const Picture again = picture_of(with_up(1.7 * view), context.pool);
  const Picture fallback = picture_of(with_up(Vec3(0, 1, 0)), context.pool);
  int warnings = 0;
  for (const SceneWarning& w : parallel.warnings) warnings += w.code == "up_parallel_to_view";

  // 1e-8 off the view: that little is enough to know the right hand.
  const Vec3 side = glm::normalize(glm::cross(view, Vec3(1, 0, 0)));
  const Vec3 nearly = view + 1e-8 * glm::length(view) * side;
  const ParsedScene off = with_up(nearly);
  const Eye eye = plan_of(off, context.pool).eye, fallen = plan_of(with_up(1.7 * view), context.pool).eye;
  const Vec3 right = glm::normalize(glm::cross(view, side));
  ParsedScene straight_down = plain;
  straight_down.view.camera->position = Vec3(0, 5, 0), straight_down.view.camera->target = Vec3(0.0);
  const Picture below = picture_of(straight_down, context.pool);
  const auto textbook =
      TextbookTracer(straight_down.scene).picture(straight_down.view, *straight_down.view.camera, context.pool);
  return {{at_least(1, "warnings that up is along the view", warnings),
           at_most(1e-6, "fallback axes off an orthonormal frame", frame_error(fallen)),
           at_most(0, "pixels that differ from up = (0, 1, 0), %", differing_pixels(fallback.rgb, parallel.rgb)),
           at_most(0, "pixels that differ the second time, %", differing_pixels(again.rgb, parallel.rgb)),
           at_most(1e-6, "axes at 1e-8 off an orthonormal frame", frame_error(eye)),
           at_most(1e-6, "right hand at 1e-8, off", glm::length(glm::normalize(eye.step_x) - right)),
           at_most(0, "samples that are not finite", static_cast<double>(parallel.nonfinite() + below.nonfinite())),
           at_least(0.05, "part of the picture straight down that shows the cube", coverage(below.ids, 0))},
          {at_most(0, "samples that are not finite, straight down", static_cast<double>(textbook.nonfinite)),
           at_least(0.05, "part of the picture straight down that shows the cube", coverage(textbook.ids, 0))}};
}

Outcome eye_at_target(const Context& context) {
  const auto document = [](const char* position, const char* target) {
    return std::string(R"({"image": {"width": 96, "height": 64}, "objects": [{"type": "cube", "center": [-2, -1, -4]},
      {"type": "sphere", "center": [-1, -1, -3], "radius": 0.5}], "camera": {"position": )") +
           position + ", \"target\": " + target + "}}";
  };
  Outcome out;
  out.ours.push_back(at_most(0, "documents with eye = target that are accepted",
                             parse_scene(document("[1, 2, 3]", "[1, 2, 3]"), Limits{}).has_value()));
  const Picture expected = picture_of(scene_of(document("[0, 0, 0]", "[-2, -1, -3]")), context.pool);
  for (const char* position : {"[2e-30, 1e-30, 3e-30]", "[2e-300, 1e-300, 3e-300]"}) {
    const ParsedScene parsed = scene_of(document(position, "[0, 0, 0]"));
    const Picture picture = picture_of(parsed, context.pool);
    const std::string at = std::string(" from ") + position;
    out.ours.push_back(at_most(0, "samples that are not finite" + at, static_cast<double>(picture.nonfinite())));
    out.ours.push_back(at_most(0, "first surfaces off those of a target far away" + at + ", %",
                               differing_ids(expected.ids, picture.ids)));
    const auto textbook = TextbookTracer(parsed.scene).picture(parsed.view, *parsed.view.camera, context.pool);
    out.naive.push_back(at_most(0, "samples that are not finite" + at, static_cast<double>(textbook.nonfinite)));
  }
  return out;
}

// Strips of 48 pixels at a wall, seen by pictures of extreme shape.
Outcome shapes(const Context& context) {
  Outcome out;
  struct Shape {
    int width, height;
  };
  constexpr int kTall = 65536, kWide = 65537, kStrips = 1400, kStripPx = 48;
  for (const Shape shape : {Shape{1, 1}, Shape{1, kTall}, Shape{kWide, 2}}) {
    const bool is_tall = shape.height > shape.width;
    Camera camera;
    camera.projection = Projection::orthographic;
    camera.position = Vec3(0, 0, 1);
    camera.height = shape.height;             // a pixel is a unit
    if (is_tall) camera.up = Vec3(-1, 0, 0);  // the strips follow each other along x: here downwards
    ParsedScene parsed = view_of_strips({.count = kStrips, .width = kStripPx, .half_height = 4.0}, camera, 1);
    set_size(parsed, shape.width, shape.height);
    const Picture picture = picture_of(parsed, context.pool);
    int64_t wrong = 0, wrapped = 0;
    for (int y = 0; y < shape.height; ++y) {
      for (int x = 0; x < shape.width; ++x) {
        const SamplePoint s = sample_point(x, y, 0, 0);
        const auto strip_at = [&](double px) { return static_cast<uint64_t>(std::floor(px / kStripPx) + kStrips / 2); };
        const double at = is_tall ? y + s.y - 0.5 * shape.height : x + s.x - 0.5 * shape.width;
        const double at16 = is_tall ? static_cast<int16_t>(y) + s.y - 0.5 * shape.height
                                    : static_cast<int16_t>(x) + s.x - 0.5 * shape.width;
        const uint64_t seen =
            picture.ids[static_cast<size_t>(y) * static_cast<size_t>(shape.width) + static_cast<size_t>(x)] >> 32;
        wrong += seen != strip_at(at);
        wrapped += strip_at(at16) != strip_at(at);
      }
    }
    const std::string of = " at " + std::to_string(shape.width) + " x " + std::to_string(shape.height);
    out.ours.push_back(at_most(0, "first surfaces off the closed form" + of, static_cast<double>(wrong)));
    if (shape.width + shape.height > 2)
      out.naive.push_back(at_most(0, "first surfaces off the closed form" + of, static_cast<double>(wrapped)));
  }
  return out;
}

constexpr Row kRows[] = {
    {"C1", "narrow field", "1e-6 degrees = 1.7e-8 rad", "directions in float", narrow},
    {"C2", "wide field", "179.99 degrees; 180, 0, -1 are refused", "tan in float past the pole", wide},
    {"C3", "up along the view", "exactly; and 1e-8 off", "cross(view, up) normalised", up_along_view},
    {"C4", "eye at its target", "equal; 1e-30 and 1e-300 apart", "target - eye normalised in float", eye_at_target},
    {"C5", "shape of the picture", "1 x 1, 1 x 65536, 65537 x 2 pixels", "pixels counted in 16 bits", shapes},
};

}  // namespace

std::span<const Row> camera_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(kRows), std::end(kRows));
    all.insert(all.end(), far_camera_rows().begin(), far_camera_rows().end());
    return all;
  }();
  return rows;
}

}  // namespace tilelight::check
