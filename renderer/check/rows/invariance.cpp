// SPDX-License-Identifier: Apache-2.0
// I: the same scene scaled, moved, turned, mirrored and stretched. A similarity of everything that is a place or a
// length changes nothing in a picture, so each picture is compared with that of the scene as it was.
#include <cmath>
#include <string>

#include "renderer/base/elementary.h"
#include "renderer/check/check.h"
#include "renderer/check/rows/invariance_scene.h"
#include "renderer/film/sampling.h"
#include "renderer/scene/transform.h"

namespace tilelight::check {
namespace {

int study_px(const Context& context) { return context.is_quick ? 160 : 512; }
constexpr int kTextbookPx = 128;  // percentages need no more, and the textbook tries every triangle

Outcome powers_of_two(const Context& context) {
  Outcome out;
  const auto compare = [&](AttenuationMode mode, int exponent) {
    const ParsedScene base = study(study_px(context), mode), small = study(kTextbookPx, mode);
    const Picture unscaled = picture_of(base, context.pool);
    const auto textbook = textbook_picture(small, context.pool);
    for (const int k : {exponent, -exponent}) {
      const std::string at = " at 2^" + std::to_string(k) + ", %";
      const Picture picture = picture_of(scaled(base, std::ldexp(1.0, k)), context.pool);
      out.ours.push_back(
          at_most(0, "pixels that differ in a bit" + at, differing_bits(unscaled.linear, picture.linear)));
      out.ours.push_back(at_most(0, "first surfaces that differ" + at, differing_ids(unscaled.ids, picture.ids)));
      const auto broken = textbook_picture(scaled(small, std::ldexp(1.0, k)), context.pool);
      out.naive.push_back(at_most(0, "pixels that differ" + at, differing_pixels(textbook.rgb, broken.rgb)));
    }
  };
  compare(AttenuationMode::linear, 20);
  compare(AttenuationMode::inverse_square, 60);
  return out;
}

// Squares of lengths leave the range of a double here: near the greatest length of the language, and far under it.
Outcome ends_of_double(const Context& context) {
  const ParsedScene base = study(study_px(context)), small = study(kTextbookPx);
  const Picture unscaled = picture_of(base, context.pool);
  Outcome out;
  for (const int k : {96, -660}) {
    const std::string at = " at 2^" + std::to_string(k) + ", %";
    const Picture picture = picture_of(scaled(base, std::ldexp(1.0, k)), context.pool);
    out.ours.push_back(at_most(0, "pixels that differ in a bit" + at, differing_bits(unscaled.linear, picture.linear)));
    out.ours.push_back(at_most(0, "first surfaces that differ" + at, differing_ids(unscaled.ids, picture.ids)));
  }
  out.naive.push_back(at_most(0, "first surfaces that differ in float at 2^96, %",
                              differing_ids(textbook_picture(small, context.pool).ids,
                                            textbook_picture(scaled(small, 0x1p96), context.pool).ids)));
  out.naive.push_back(
      at_most(0, "first surfaces that differ in double at 2^-660, %",
              differing_ids(reference_ids(small, context.pool), reference_ids(scaled(small, 0x1p-660), context.pool))));
  return out;
}

Outcome powers_of_ten(const Context& context) {
  Outcome out;
  const ParsedScene base = study(study_px(context)), small = study(kTextbookPx);
  const Picture unscaled = picture_of(base, context.pool);
  const auto textbook = textbook_picture(small, context.pool);
  for (const int k : {-6, -3, 3, 6, -15, 15}) {
    const double s = k > 0 ? elementary::pow(10.0, k) : 1.0 / elementary::pow(10.0, -k);
    const std::string at = " at 1e" + std::to_string(k) + ", %";
    const Picture picture = picture_of(scaled(base, s), context.pool);
    out.ours.push_back(at_most(0.02, "pixels that differ" + at, differing_pixels(unscaled.rgb, picture.rgb)));
    if (std::abs(k) <= 6)
      out.ours.push_back(at_most(0, "first surfaces that differ" + at, differing_ids(unscaled.ids, picture.ids)));
    const auto broken = textbook_picture(scaled(small, s), context.pool);
    out.naive.push_back(at_most(0.02, "pixels that differ" + at, differing_pixels(textbook.rgb, broken.rgb)));
  }
  return out;
}

Outcome translated(const Context& context) {
  const Vec3 by(1e7, -7e6, 3e6);
  const ParsedScene base = study(study_px(context)), small = study(kTextbookPx);
  const Picture here = picture_of(base, context.pool), there = picture_of(shifted(base, by), context.pool);
  const auto textbook = textbook_picture(small, context.pool);
  const auto far_away = textbook_picture(shifted(small, by), context.pool);
  const auto tenth = textbook_picture(shifted(small, 0.1 * by), context.pool);
  return {{at_most(0.02, "pixels that differ, %", differing_pixels(here.rgb, there.rgb))},
          {at_most(0.02, "pixels that differ, %", differing_pixels(textbook.rgb, far_away.rgb)),
           at_most(0.02, "pixels that differ at a tenth of the way, %", differing_pixels(textbook.rgb, tenth.rgb))}};
}

// At 1e15 doubles lie 1/8 apart: moving rounds every coordinate to eighths, and to nothing else. So the picture is that
// of the scene whose coordinates were rounded to eighths where it stands.
Outcome translated_far(const Context& context) {
  const Vec3 by(1e15, -0.7e15, 0.9e15);
  const ParsedScene moved = shifted(study(study_px(context)), by);
  const ParsedScene rounded = shifted(moved, -by);
  const Picture there = picture_of(moved, context.pool), here = picture_of(rounded, context.pool);
  // The reference computes in double, but in the user's own coordinates.
  const auto shown = [&](const ParsedScene& parsed) {
    View small = parsed.view;
    small.image.width = small.image.height = kTextbookPx;
    const auto pixels = reference_image(ReferenceScene(parsed.scene), small, *small.camera, context.pool);
    return shown_image(pixels, kTextbookPx, kTextbookPx, small.image.exposure);
  };
  const ShownImage plain_there = shown(moved), plain_here = shown(rounded);
  return {{at_most(0, "first surfaces that differ, %", differing_ids(here.ids, there.ids)),
           at_most(0.02, "pixels that differ, %", differing_pixels(here.rgb, there.rgb))},
          {at_most(0, "first surfaces that differ, %", differing_ids(plain_here.primary_ids, plain_there.primary_ids)),
           at_most(0.02, "pixels that differ, %", differing_pixels(plain_here.rgb, plain_there.rgb))}};
}

Outcome rotated(const Context& context) {
  Outcome out;
  const ParsedScene base = study(study_px(context)), small = study(kTextbookPx);
  const Picture upright = picture_of(base, context.pool);
  // Two steps of floats at the scene's size: enough while the floor is level and its height exact.
  constexpr float kEpsilon = 0x1p-19f;
  const auto textbook = textbook_picture(small, context.pool, kEpsilon);
  const auto compare = [&](const std::string& turn, const Mat3& m) {
    const Picture picture = picture_of(turned(base, m), context.pool);
    out.ours.push_back(
        at_most(0.01, "first surfaces that differ " + turn + ", %", differing_ids(upright.ids, picture.ids)));
    out.ours.push_back(at_most(0.05, "pixels that differ " + turn + ", %", differing_pixels(upright.rgb, picture.rgb)));
  };
  const Mat3 tilt = rotation_about(Vec3(1, 2, 3), 37.0);
  compare("at 37 degrees", tilt);
  compare("at 90 degrees", rotation_about(Vec3(0, 0, 1), 90.0));
  // The epsilon fits axes, and 90 degrees only exchange them.
  const auto tilted = textbook_picture(turned(small, tilt), context.pool, kEpsilon);
  out.naive.push_back(at_most(0.05, "pixels that differ at 37 degrees, %", differing_pixels(textbook.rgb, tilted.rgb)));
  return out;
}

// What the mirrored camera sees at a point of its picture lies, in the scene as it was, at the flipped point. The
// samples of a pixel are no mirror images of those of its opposite, so the reference takes them where they are.
ShownImage flipped_reference(const ParsedScene& parsed, TilePool& pool) {
  const int width = parsed.view.image.width, height = parsed.view.image.height;
  const ReferenceScene scene(parsed.scene);
  const ReferenceEye eye = make_reference_eye(scene, parsed.view, *parsed.view.camera);
  std::vector<ReferencePixel> pixels(static_cast<size_t>(width) * static_cast<size_t>(height));
  pool.parallel_for(height, Priority::batch, [&](int64_t row) {
    const auto y = static_cast<int>(row);
    for (int x = 0; x < width; ++x) {
      const SamplePoint s = sample_point(x, y, parsed.view.render.seed, 0);
      pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)] =
          reference_sample(scene, eye, Vec2(width - (x + s.x), y + s.y));
    }
  });
  return shown_image(pixels, width, height, parsed.view.image.exposure);
}

// Mirrored corners turn the other way round: a winding taken from them calls the outside of a mesh its back, and where
// backs are culled another surface is seen.
double culled(const ParsedScene& parsed, TilePool& pool) {
  const auto picture = textbook_picture(parsed, pool);
  const std::vector<Body> bodies = make_bodies(parsed.scene);
  int64_t backs = 0;
  for (const uint64_t id : picture.ids) {
    if (id == kNothingHit || bodies[id >> 32].kind != BodyKind::mesh) continue;
    const Body& body = bodies[id >> 32];
    const auto& corners = body.mesh->triangles[id & 0xffffffffu];
    const auto corner = [&](int i) {
      return transform_point(body.world_from_local, body.mesh->positions[corners[static_cast<size_t>(i)]]);
    };
    const Vec3 normal = glm::cross(corner(1) - corner(0), corner(2) - corner(0));
    backs += glm::dot(normal, corner(0) - parsed.view.camera->position) > 0.0;
  }
  return percent(backs, static_cast<int64_t>(picture.ids.size()));
}

Outcome mirrored(const Context& context) {
  const Mat3 flip(-1, 0, 0, 0, 1, 0, 0, 0, 1);
  const ParsedScene base = study(study_px(context));
  const Picture picture = picture_of(turned(base, flip), context.pool);
  const ShownImage expected = flipped_reference(base, context.pool);
  return {{at_most(0.01, "first surfaces that differ, %", differing_ids(expected.primary_ids, picture.ids)),
           at_most(0.05, "pixels that differ, %", differing_pixels(expected.rgb, picture.rgb))},
          {at_most(0.01, "first surfaces that differ, %", culled(turned(study(kTextbookPx), flip), context.pool))}};
}

constexpr Row kRows[] = {
    {"I1", "unit of length by powers of two", "scene x 2^+-20 (K, I by s), 2^+-60 (inverse square: K, I by s^2)",
     "fixed epsilons, float in the user's units", powers_of_two},
    {"I2", "unit of length by powers of ten", "scene x 1e-6 ... 1e6, 1e+-15",
     "fixed epsilons, float in the user's units", powers_of_ten},
    {"I3", "moved far from the origin", "by (1e7, -7e6, 3e6)", "float in the user's coordinates", translated},
    {"I4", "turned as a whole", "37 degrees about (1, 2, 3); 90 degrees about z",
     "an epsilon of two steps of floats, enough for a level floor", rotated},
    {"I5", "mirrored as a whole", "scale (-1, 1, 1) on the scene and the camera",
     "backs culled by the winding of the transformed corners", mirrored},
    {"I8", "moved to where doubles are eighths", "by (1e15, -7e14, 9e14): the scene rounded to eighths",
     "double in the user's coordinates", translated_far},
    {"I10", "unit of length at the ends of the doubles", "scene x 2^96 and 2^-660 (K, I by s)",
     "squares of lengths in float; in double", ends_of_double},
};

}  // namespace

std::span<const Row> invariance_rows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all(std::begin(kRows), std::end(kRows));
    all.insert(all.end(), instance_rows().begin(), instance_rows().end());
    return all;
  }();
  return rows;
}

}  // namespace tilelight::check
