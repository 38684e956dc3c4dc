// SPDX-License-Identifier: Apache-2.0
// L: the light equation against closed forms.
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/check/check.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/rows/lights.h"

namespace tilelight::check {
namespace {

using elementary::kPi;

// Grey by its diffuse part alone.
const std::string kDiffuse = R"("material": {"diffuse": 0.8, "ambient": 0})";

// A light on a surface, or nearer to it than float knows: no direction, a division by nothing.
Outcome at_the_light(const Context& context) {
  // All rays of this view start at x = z = 0.5: what their pixels add is under its last bit.
  const std::string view = R"("camera": {"type": "orthographic", "height": 1e-20, "up": [0, 0, -1],
    "position": [0.5, 5, 0.5], "target": [0.5, 0, 0.5]}, "image": {"width": 8, "height": 8}, )";
  const auto lit = [&](const std::string& place, const std::string& object, const std::string& meshes = {}) {
    return picture_of(scene_of("{" + view + meshes + dark_but("{\"type\": \"point\", \"position\": " + place + "}") +
                               R"("attenuation": {"k": 0}, "objects": [)" + object + ", " + kDiffuse + "}]}"),
                      context.pool);
  };
  const Picture above = lit("[0.5, 1e-30, 0.5]", R"({"type": "plane")");
  const Picture on = lit("[0.5, 0, 0.5]", R"({"type": "box", "min": [-1, -1, -1], "max": [1, 0, 1])");
  // On a vertex of a mesh, which all rays meet.
  const Picture vertex =
      lit("[0.5, 0.25, 0.5]", R"({"type": "mesh", "mesh": "tetra")",
          R"("meshes": {"tetra": {"positions": [0.5, 0.25, 0.5, 1.5, -1, 0.5, 0, -1, 1.5, 0, -1, -0.5],
          "indices": [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]}}, )");

  int64_t naive_bad = 0;
  for (const float height : {1e-30f, 0.0f}) {
    const Vec3f path(0.0f, height, 0.0f);
    const float distance = glm::length(path);
    naive_bad += !std::isfinite(0.8f * (path / distance).y / distance);
  }
  const auto unlit = [](const Picture& picture) {
    return static_cast<double>(picture.report.points.back().lights_on_hits);
  };
  return {{at_most(0, "samples not finite", above.nonfinite() + on.nonfinite() + vertex.nonfinite()),
           at_most(1e-6, "light 1e-30 above, kd I / d, relative error", relative(above.linear[0], 0.8e30)),
           at_most(0, "light on the surface or vertex, what it adds", on.linear[0] + vertex.linear[0]),
           within(0, "hits that are told to have a light on them, off 64 and 64 by", unlit(on) + unlit(vertex), 128)},
          {at_most(0, "samples not finite", naive_bad)}};
}

// A floor under a light at the height 1: kd I (h / rho) / (rho + K).
Outcome floor_under_a_light(const Context& context) {
  const int size = context.is_quick ? 64 : 256;
  constexpr double kHeight = 40.0, kEye = 5.0;
  double worst = 0.0, worst_to_viewer = 0.0, worst_unscaled = 0.0;
  for (const double k : {0.0, 1.0, 1e6}) {
    const ParsedScene scene =
        scene_of("{" + view_along_z(size, kHeight, 1) + dark_but(R"({"type": "point", "position": [0, 0, 1]})") +
                 R"("attenuation": {"k": )" + text(k) + R"(}, "objects": [
        {"type": "box", "min": [-100, -100, -1], "max": [100, 100, 0], )" +
                 kDiffuse + "}]}");
    const Picture picture = picture_of(scene, context.pool);
    for_each_pixel(size, kHeight, [&](size_t pixel, double x, double y) {
      const double rho = std::sqrt(1.0 + x * x + y * y);
      const double expected = 0.8 / rho / (rho + k);
      note(worst, relative(picture.linear[3 * pixel], expected));
      // d of the viewer; and K in a renderer's own unit, here 128.
      note(worst_to_viewer, relative(0.8 / rho / (kEye + k), expected));
      note(worst_unscaled, relative(0.8 / rho / (rho + 128.0 * k), expected));
    });
  }
  return {{at_most(5e-6, "kd I (h / rho) / (rho + K), relative error", worst)},
          {at_most(5e-6, "d to the viewer, relative error", worst_to_viewer),
           at_most(5e-6, "K in units of the normalised scene, relative error", worst_unscaled)}};
}

// The same picture with a light so many times stronger.
Outcome strong_and_weak(const Context& context) {
  const int size = context.is_quick ? 96 : 512;
  const auto with = [&](double intensity, double exposure) {
    return picture_of(
        scene_of(
            R"({"camera": {"position": [2, 3, 5]}, )" +
            image_text(size, size).substr(0, image_text(size, size).size() - 1) + R"(, "exposure": )" + text(exposure) +
            "}, " + dark_but(R"({"type": "point", "position": [3, 4, 1], "intensity": )" + text(intensity) + "}") +
            R"("objects": [{"type": "sphere", "material": {"specular": 0.5}}, {"type": "plane", "point": [0, -1, 0],
        "material": {"reflection": 0.3}}]})"),
        context.pool);
  };
  const Picture one = with(1.0, 0.0);
  double bits = 0.0, worst = 0.0, half_worst = 0.0;
  for (const double stops : {90.0, -90.0}) {
    const double power = elementary::exp2(stops);
    const Picture same = with(power, -stops);
    bits += differing_pixels(one.rgb, same.rgb);
    for (size_t i = 0; i < one.linear.size(); ++i) bits += static_cast<double>(same.linear[i]) != one.linear[i] * power;
  }
  for (const double power : {1e30, 1e-30}) {
    const Picture same = with(power, -elementary::log2(power));
    for (size_t i = 0; i < one.linear.size(); ++i) {
      if (!(one.linear[i] > 0.0f)) continue;
      note(worst, relative(same.linear[i] / power, one.linear[i]));
      // A frame buffer of half floats ends at 65504 and at 2^-24.
      const double half = same.linear[i] > 65504.0f ? INFINITY : same.linear[i] < 0x1p-25f ? 0.0 : same.linear[i];
      note(half_worst, relative(half / power, one.linear[i]));
    }
  }
  return {{at_most(0, "2^90, 2^-90: what differs from intensity 1", bits),
           at_most(1e-6, "1e30, 1e-30: relative to intensity 1", worst)},
          {at_most(1e-6, "1e30, 1e-30: relative to intensity 1", half_worst)}};
}

// Light adds up: a strong light and 999 that are nothing beside it one by one.
Outcome superposition(const Context& context) {
  const int size = context.is_quick ? 32 : 256;
  const auto with = [&](const std::string& lights) {
    return picture_of(scene_of(R"({"camera": {"position": [2, 3, 5]}, "background": {"bottom": 0, "top": 0},
        "image": {"width": )" + text(size) +
                               R"(, "height": )" + text(size) + R"(}, "lights": [)" + lights + R"(],
        "objects": [{"type": "sphere", "material": {"specular": 0.5}}, {"type": "plane", "point": [0, -1, 0]}]})"),
                      context.pool);
  };
  const std::string strong = R"({"type": "point", "position": [3, 4, 1], "intensity": 9, "shadow": false})";
  const std::string other = R"({"type": "directional", "direction": [1, -2, -1], "intensity": 0.5})";
  std::string weak, all = strong;
  for (int i = 1; i < 1000; ++i) {
    const std::string light =
        R"({"type": "point", "intensity": 3e-7, "shadow": false, "position": [)" + text(3.0 + 1e-3 * i) + ", 4, 1]}";
    weak += (weak.empty() ? "" : ", ") + light;
    all += ", " + light;
  }
  const Picture none = with(""), first = with(strong);
  const auto apart = [&](const Picture& second, const Picture& both) {
    double worst = 0.0;
    for (size_t i = 0; i < both.linear.size(); ++i) {
      if (!(both.linear[i] > 0.0f)) continue;
      const double sum = double{first.linear[i]} + second.linear[i] - none.linear[i];
      note(worst, relative(sum, both.linear[i]));
    }
    return worst;
  };
  const double two = apart(with(other), with(strong + ", " + other));
  const double thousand = apart(with(weak), with(all));
  // One after the other in float, the strong one first: the others are under half its last place.
  float naive = 9.0f;
  for (int i = 1; i < 1000; ++i) naive += 3e-7f;
  return {{at_most(1e-5, "I(L1 + L2) - I(L1) - I(L2) + amb, relative", two),
           at_most(1e-5, "1 light and 999 against all, relative", thousand)},
          {at_most(1e-5, "1 light and 999 in float, relative", relative(naive, 9.0 + 999 * 3e-7))}};
}

// The phase of a matt ball: the mean over its disc of max(0, N.L), the light at the phase angle phi.
Outcome phases(const Context& context) {
  constexpr int kSize = 1024;
  const std::vector<double> phis = context.is_quick ? std::vector{0.5, 2.5} : std::vector{0.0, 0.5, 0.5 * kPi, 2.5};
  double worst = 0.0, worst_unclamped = 0.0;
  for (const double phi : phis) {
    const Vec3 to_light(elementary::sin(phi), 0.0, elementary::cos(phi));
    const ParsedScene scene = scene_of("{" + view_along_z(kSize, 2.0, context.is_quick ? 1 : 4) +
                                       dark_but(R"({"type": "directional", "shadow": false, "direction": [)" +
                                                text(-to_light.x) + ", 0, " + text(-to_light.z) + "]}") +
                                       R"("objects": [{"type": "sphere", "material": {"diffuse": 1, "ambient": 0}}]})");
    const Picture picture = picture_of(scene, context.pool);
    double sum = 0.0;
    for (size_t i = 0; i < picture.linear.size(); i += 3) sum += picture.linear[i];
    constexpr double kDiscPx = 0.25 * kPi * kSize * kSize;
    const double expected = 2.0 / (3.0 * kPi) * (elementary::sin(phi) + (kPi - phi) * elementary::cos(phi));
    note(worst, std::abs(sum / kDiscPx - expected));
    // The mean of N.L itself: what faces away takes light away.
    note(worst_unclamped, std::abs(2.0 / 3.0 * elementary::cos(phi) - expected));
  }
  return {{at_most(2e-5, "mean of max(0, N.L) over the disc, off by", worst)},
          {at_most(2e-5, "mean of N.L, off by", worst_unclamped)}};
}

// A light at infinity is what a point light is at a million times the scene's extent.
Outcome from_infinity(const Context& context) {
  const int size = context.is_quick ? 64 : 512;
  const Vec3 to_light = glm::normalize(Vec3(1.0, 2.0, 1.5));
  constexpr double kFar = 4e6;
  const auto with = [&](const std::string& light) {
    return picture_of(scene_of(R"({"camera": {"position": [2, 3, 5]}, "attenuation": {"k": 0}, "image": {"width": )" +
                               text(size) + R"(, "height": )" + text(size) + "}, " + dark_but(light) + R"("objects": [
          {"type": "sphere", "material": {"diffuse": 0.8, "ambient": 0, "specular": 0.2, "shininess": 20}},
          {"type": "box", "min": [-2, -1.5, -2], "max": [2, -1, 2], )" +
                               kDiffuse + "}]}"),
                      context.pool);
  };
  const Picture far =
      with(R"({"type": "point", "position": )" + text(kFar * to_light) + R"(, "intensity": )" + text(kFar) + "}");
  const Picture infinite = with(R"({"type": "directional", "direction": )" + text(-to_light) + "}");
  double worst = 0.0, naive_worst = 0.0;
  for (size_t i = 0; i < far.linear.size(); ++i) note(worst, std::abs(double{far.linear[i]} - infinite.linear[i]));
  // The box from above, by the formula of a point light whose place is at infinity.
  const Vec3f light = std::numeric_limits<float>::infinity() * Vec3f(to_light);
  for (double x = -2.0; x <= 2.0; x += 0.1) {
    const Vec3f path = light - Vec3f(x, -1.0, 0.3);
    const float d = glm::length(path), lambert = 0.8f * glm::normalize(path).y / d;
    note(naive_worst, std::abs(lambert - 0.8 * to_light.y));
  }
  return {{at_most(1e-5, "against a point light of I D at D, off by", worst)},
          {at_most(1e-5, "a point light at infinity, off by", naive_worst)}};
}

constexpr Row kRows[] = {
    {"L1", "light on the surface", "d = 1e-30, 0 and on a vertex; K = 0", "L = path / |path| in float", at_the_light},
    {"L2", "floor under a light", "K = 0, 1, 1e6", "d to the viewer; K of another scale", floor_under_a_light},
    {"L3", "intensity", "2^90, 2^-90, 1e30, 1e-30, exposure inverse", "a frame buffer of half floats", strong_and_weak},
    {"L4", "superposition", "1000 lights, 999 of them 3e-8 of the first", "a sum in float, strong first",
     superposition},
    {"L5", "shininess under a headlight", "n = 0, 1, 1e2, 1e4, 1e6", "pow(dot, n) in float", lobe_range},
    {"L6", "lobes at their guards", "R.V < 0; 0 with n = 0; 1 + 1e-7 with n = 1e9", "pow(dot, n) in float",
     lobe_guards},
    {"L7", "phases of a ball", "phi = 0, 0.5, pi / 2, 2.5", "N.L not clamped at 0", phases},
    {"L8", "light at infinity", "K = 0", "a point light at an infinite place", from_infinity},
    {"L9", "lights over 30 decades", "1000 lights of 1e-15 to 1e15, in two orders", "a sum in float", many_decades},
    {"L10", "shininess of a needle", "n = 1e9, 1e12", "pow(dot, n), even in double", needle_lobe},
    {"L11", "inverse square", "d = 1e-12 to 1e12, K = 0", "1 / max(d^2, 0.01^2), as game engines clamp it",
     inverse_square},
};

}  // namespace

std::span<const Row> light_rows() { return kRows; }

}  // namespace tilelight::check
