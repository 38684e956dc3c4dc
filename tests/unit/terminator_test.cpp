// SPDX-License-Identifier: Apache-2.0
// Where the light of smooth meshes ends: their own shadows are smooth, and whatever else is between them and the light
// casts its shadow on them, however near. By closed forms, by the kernels and by the reference.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "renderer/film/tone.h"
#include "renderer/measure/judge.h"
#include "renderer/render/render.h"
#include "tests/unit/terminator_scenes.h"

namespace tilelight {
namespace {

using namespace terminator_test;  // NOLINT(google-build-using-namespace)
using check::Picture;
using check::picture_of;

class Terminators : public testing::Test {
 protected:
  // Both renderers, within the rounding of a float.
  void expect_seen(const Scene& scene, const Vec3& place, const Vec3& from, double expected, const std::string& what,
                   const RenderSpec& render = {}) {
    const Seen seen = look_at(scene, place, from, pool_, render);
    EXPECT_NEAR(seen.fast, expected, 1e-6) << what;
    EXPECT_NEAR(seen.reference, expected, 1e-6) << what;
  }

  TilePool pool_{2};
};

// The top facet of a drum under a plate, seen from between them.
struct Covered {
  int sides;
  double gap, elevation_deg;  // gap: in sagittas of the facet
  bool is_one_mesh;           // drum and plate

  double sagitta() const { return 1.0 - std::cos(kPi / sides); }
  double height() const { return std::cos(kPi / sides); }
  double half_width() const { return std::sin(kPi / sides); }
  double elevation() const { return elevation_deg * kPi / 180.0; }
  double plate_half() const { return 0.8 * half_width(); }
  double plate_thickness() const { return 0.01 * half_width(); }
  double space() const { return gap * sagitta(); }
  Vec3 to_light() const { return {std::cos(elevation()), std::sin(elevation()), 0.0}; }

  Scene scene() const {
    const Vec3 low(-plate_half(), height() + space(), -0.9),
        high(plate_half(), height() + space() + plate_thickness(), 0.9);
    Scene out = matte_scene();
    MeshData mesh = drum(sides);
    if (is_one_mesh) add_box(mesh, low, high);
    add(out, mesh);
    if (!is_one_mesh) add(out, BoxShape{low, high});
    add_sun(out, to_light());
    return out;
  }
  // The light's way from the middle of the facet passes under the plate's edge, and under the plate itself.
  bool passes_under() const { return space() + plate_thickness() < plate_half() * std::tan(elevation()); }
  bool is_lit() const { return space() > plate_half() * std::tan(elevation()); }
  std::string text() const {
    return std::to_string(sides) + " sides, gap of " + std::to_string(gap) + " sagittas, light at " +
           std::to_string(elevation_deg) + (is_one_mesh ? ", one mesh" : "");
  }
};

TEST_F(Terminators, LieInTheShadowOfAPlateHoweverCloseItIs) {
  int dark = 0, lit = 0;
  for (const int sides : {5, 8, 24}) {
    for (const double gap : {1e-6, 1e-3, 0.1, 0.5, 0.999, 1.001, 1.5, 1.9, 2.0, 2.1}) {
      for (const double elevation_deg : {90.0, 60.0, 30.0, 10.0, 3.0, 1.0}) {
        for (const bool is_one_mesh : {false, true}) {
          const Covered c{sides, gap, elevation_deg, is_one_mesh};
          const Vec3 place(0.0, c.height(), 0.1);
          const Vec3 from = place + Vec3(0.0, 0.5 * c.space(), 0.0);
          if (c.passes_under()) expect_seen(c.scene(), place, from, 0.0, c.text()), ++dark;
          if (c.is_lit()) expect_seen(c.scene(), place, from, std::sin(c.elevation()), c.text()), ++lit;
        }
      }
    }
  }
  EXPECT_GT(dark, 200);
  EXPECT_GT(lit, 20);
}

// The place in a triangle with the same weight of all corners, and the axes of the triangle there: y across it.
Mat4 frame_of(const MeshData& mesh, size_t triangle) {
  const Vec3 &a = mesh.positions[mesh.indices[3 * triangle]], &b = mesh.positions[mesh.indices[3 * triangle + 1]],
             &c = mesh.positions[mesh.indices[3 * triangle + 2]];
  const Vec3 y = glm::normalize(glm::cross(b - a, c - a)), x = glm::normalize(b - a);
  Mat4 m(1.0);
  m[0] = Vec4(x, 0.0), m[1] = Vec4(y, 0.0), m[2] = Vec4(glm::cross(x, y), 0.0), m[3] = Vec4((a + b + c) / 3.0, 1.0);
  return m;
}

TEST_F(Terminators, LieInTheShadowOfWhatTouchesAFineGlobe) {
  const MeshData mesh = globe(48);
  for (const size_t triangle : {size_t{5}, size_t{700}, mesh.indices.size() / 6, mesh.indices.size() / 3 - 20}) {
    const Mat4 frame = frame_of(mesh, triangle);
    const Vec3 place(frame[3]), up(frame[1]);
    Scene bare = matte_scene();
    add(bare, mesh);
    add_sun(bare, up);
    expect_seen(bare, place, place + up, glm::dot(up, glm::normalize(place)), "nothing before the light");
    for (const double gap : {1e-6, 1e-4, 1e-3, 0.005, 0.01}) {
      for (const bool is_ball : {false, true}) {
        Scene scene = matte_scene();
        add(scene, mesh);
        Shape shape = BoxShape{Vec3(-0.02, gap, -0.02), Vec3(0.02, gap + 1e-3, 0.02)};
        if (is_ball) shape = SphereShape{Vec3(0.0, gap + 0.02, 0.0), 0.02};
        add(scene, shape).world_from_shape = frame;
        add_sun(scene, up);
        expect_seen(scene, place, place + 0.5 * gap * up, 0.0,
                    "triangle " + std::to_string(triangle) + ", gap of " + std::to_string(gap));
      }
    }
  }
}

// A curve of which only the facet's far half sees the light: there it comes from behind the facet.
struct LowLight {
  double sine = -0.1;     // of its elevation over the facet
  double across = -0.25;  // of the facet: where it is looked at, with a normal turned towards the light
  Vec3 place() const { return {across * 2.0 * std::sin(kPi / 8.0), std::cos(kPi / 8.0), 0.1}; }
  Vec3 to_light() const { return {-std::sqrt(1.0 - sine * sine), sine, 0.0}; }
  // Of the curve over the facet: the distances to the tangent planes at the corners, mixed, along their normals.
  double lift() const { return (1.0 - std::pow(place().x, 2) - std::pow(place().y, 2)) * std::cos(kPi / 8.0); }
  double cosine() const {  // to the normals of both corners, mixed as the place is
    const double a = kPi / 2.0 - kPi / 8.0, b = kPi / 2.0 + kPi / 8.0;
    const Vec3 n =
        (0.5 + across) * Vec3(std::cos(a), std::sin(a), 0) + (0.5 - across) * Vec3(std::cos(b), std::sin(b), 0);
    return glm::dot(glm::normalize(n), to_light());
  }
};

TEST_F(Terminators, LetWhatLiesUnderTheCurveCastItsShadowToo) {
  const LowLight low;
  const double lift = low.lift();
  for (const bool is_glass : {false, true}) {
    for (const double gap : {0.0, 1e-4, 0.3, 0.9, 1.2}) {  // in lifts of the curve; 0: no plate
      Scene scene = matte_scene();
      Material glass;
      glass.diffuse = glass.ambient = Color(0.0), glass.transmission = Color(0.5);
      scene.materials.push_back(glass);
      add(scene, drum(8));
      const double y = low.place().y + gap * lift;
      if (gap > 0.0) add(scene, BoxShape{Vec3(-0.24, y, -0.5), Vec3(0.3, y, 0.5)}, is_glass ? 1 : 0);
      add_sun(scene, low.to_light());
      const bool is_under = gap > 0.0 && gap < 1.0;
      const double expected = low.cosine() * (is_under ? is_glass ? 0.5 : 0.0 : 1.0);
      expect_seen(scene, low.place(), low.place() + Vec3(0.0, gap > 0.0 ? 0.5 * gap * lift : 0.5, 0.0), expected,
                  (is_glass ? "glass at " : "plate at ") + std::to_string(gap));
    }
  }
}

TEST_F(Terminators, TintLightOncePerSurfaceHoweverCloseTheGlassIs) {
  for (const double gap : {1e-5, 1e-3, 0.02, 0.1}) {
    Scene scene = matte_scene();
    Material glass;
    glass.diffuse = glass.ambient = Color(0.0), glass.transmission = Color(0.5);
    scene.materials.push_back(glass);
    add(scene, drum(8));
    const double y = std::cos(kPi / 8.0);
    add(scene, BoxShape{Vec3(-0.3, y + gap, -0.5), Vec3(0.3, y + 1.5 * gap, 0.5)}, 1);
    add_sun(scene, Vec3(0.0, 1.0, 0.0));
    expect_seen(scene, Vec3(0.0, y, 0.1), Vec3(0.0, y + 0.5 * gap, 0.1), 0.25, std::to_string(gap));
  }
}

TEST_F(Terminators, KnowOnWhichSideOfTheFacetALightLies) {
  const double y = std::cos(kPi / 8.0);
  for (const double height : {-0.3, -0.05, -1e-3, 1e-3, 0.05, 0.1, 0.3}) {
    for (const double aside : {0.0, -0.2}) {  // from the place, along the facet
      const Vec3 place(-0.1, y, 0.1);
      const Vec3 lamp = place + Vec3(aside, height, 0.0);
      Scene scene = matte_scene();
      add(scene, drum(8));
      Light& light = scene.lights.emplace_back();
      light.position = lamp, light.intensity = 1.0;
      const double tilt = std::atan(std::tan(kPi / 8.0) * 0.1 / std::sin(kPi / 8.0));  // of the mixed normal
      const double cosine = glm::dot(Vec3(-std::sin(tilt), std::cos(tilt), 0.0), glm::normalize(lamp - place));
      expect_seen(scene, place, place + Vec3(0.3, 0.9, 0.0), height > 0.0 ? cosine : 0.0,
                  "lamp at " + std::to_string(height) + ", " + std::to_string(aside));
    }
  }
}

// An orthographic view of everything within 1.6 of the origin.
ParsedScene view_of(const Scene& scene, int size_px, const Vec3& from) {
  ParsedScene out;
  out.scene = scene;
  Camera camera;
  camera.projection = Projection::orthographic;
  camera.position = 9.0 * glm::normalize(from), camera.height = 3.2;
  out.view.camera = camera;
  out.view.image = {size_px, size_px, 0.0};
  out.view.render.samples = 1;
  return out;
}
Picture picture_by(ParsedScene view, Terminator terminator, bool shadows, TilePool& pool) {
  view.view.render.terminator = terminator, view.view.render.shadows = shadows;
  return picture_of(view, pool);
}

// A drum in a place of its own: turned, longer one way than the other, under things that stand on it and over it.
Scene cluttered_drum(int sides, const Vec3& to_light) {
  Scene scene = matte_scene();
  MeshData mesh = drum(sides);
  const double y = std::cos(kPi / sides);
  add_box(mesh, {-0.1, y + 0.01, -0.9}, {0.3, y + 0.02, -0.5});
  add(scene, mesh);
  add(scene, BoxShape{{-0.3, y + 1e-3, -0.3}, {0.1, y + 0.02, 0.1}});
  add(scene, BoxShape{{0.0, y, 0.3}, {0.05, y + 0.3, 0.35}});
  add(scene, SphereShape{{-0.2, y + 0.08, 0.6}, 0.08});
  const Mat4 turned = glm::rotate(Mat4(1.0), 0.7, Vec3(1.0, 2.0, 0.5));
  for (Object& object : scene.objects) object.world_from_shape = turned * glm::scale(Mat4(1.0), Vec3(1.0, 0.6, 0.9));
  add_sun(scene, to_light);
  return scene;
}

// Two balls of one mesh, the smaller stuck a little into the larger: they have no corner in common.
Scene grown_together(const Vec3& to_light) {
  Scene scene = matte_scene();
  MeshData mesh = globe(12);
  const MeshData small = globe(12);
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const Vec3& p : small.positions) mesh.positions.push_back(0.3 * p + Vec3(0.0, 1.27, 0.0));
  for (const Vec3& n : small.normals) mesh.normals.push_back(n);
  for (const uint32_t i : small.indices) mesh.indices.push_back(first + i);
  add(scene, mesh);
  add_sun(scene, to_light);
  return scene;
}

TEST_F(Terminators, AreExactWhereverTheFacetFacesTheLight) {
  size_t facing = 0, shadowed = 0, differing = 0;
  for (const Vec3& light : {Vec3(1, 1, 1), Vec3(-0.3, 1, 0.8), Vec3(0.1, 0.2, 1), Vec3(1, 0.3, -0.1)}) {
    const Vec3 to_light = glm::normalize(light);
    for (const Scene& scene : {cluttered_drum(8, to_light), cluttered_drum(32, to_light), grown_together(to_light)}) {
      const ParsedScene view = view_of(scene, 160, Vec3(0.2, 1.0, 1.4));
      const Picture faced = picture_by(view, Terminator::exact, false, pool_);
      const Picture exact = picture_by(view, Terminator::exact, true, pool_);
      const Picture smooth = picture_by(view, Terminator::smooth, true, pool_);
      for (size_t i = 0; i < faced.linear.size(); i += 3) {
        if (faced.linear[i] == 0.0f) continue;
        ++facing, shadowed += exact.linear[i] == 0.0f, differing += exact.linear[i] != smooth.linear[i];
      }
    }
  }
  EXPECT_GT(facing, 24000u);
  EXPECT_GT(shadowed, 400u);
  EXPECT_EQ(differing, 0u);
}

// Of the pixels whose normals face the light, in percent: those in the mesh's own shadow though the same surface,
// finely cut, is lit there.
double own_shadow_percent(const MeshData& coarse, const MeshData& fine, const Vec3& to_light, TilePool& pool) {
  const auto picture = [&](const MeshData& mesh, bool shadows) {
    Scene scene = matte_scene();
    add(scene, mesh);
    add_sun(scene, to_light);
    return picture_by(view_of(scene, 256, Vec3(0.3, 0.8, 1.0)), Terminator::smooth, shadows, pool);
  };
  const Picture faced = picture(coarse, false), seen = picture(coarse, true), truth = picture(fine, true);
  size_t facing = 0, dark = 0;
  for (size_t i = 0; i < faced.linear.size(); i += 3) {
    if (!(faced.linear[i] > 0.0f)) continue;
    ++facing, dark += seen.linear[i] == 0.0f && truth.linear[i] > 0.0f;
  }
  return 100.0 * static_cast<double>(dark) / static_cast<double>(facing);
}

TEST_F(Terminators, ShadeNoFacetThatTheCurveShows) {
  for (const Vec3& light :
       {Vec3(1, 0.2, -0.4), Vec3(0.6, 0.5, -0.2), Vec3(-0.2, 1, 0.1), Vec3(1, 0, 0), Vec3(0, 1, 0)}) {
    const Vec3 to_light = glm::normalize(light);
    EXPECT_EQ(own_shadow_percent(drum(8), drum(512), to_light, pool_), 0.0);
    EXPECT_EQ(own_shadow_percent(globe(12), globe(256), to_light, pool_), 0.0);
    EXPECT_LE(own_shadow_percent(ring(24, 12), ring(512, 256), to_light, pool_), 1.0);
  }
}

// Whether a picture is dark at a pixel and wherever else no more than `reach` pixels aside and up or down.
bool is_dark_around(const Picture& picture, int x, int y, int reach) {
  for (int v = std::max(0, y - reach); v <= std::min(picture.height - 1, y + reach); ++v) {
    for (int u = std::max(0, x - reach); u <= std::min(picture.width - 1, x + reach); ++u)
      if (picture.linear[3 * (static_cast<size_t>(v) * picture.width + u)] > 0.0f) return false;
  }
  return true;
}

constexpr std::array kLowLights = {Vec3(1, 0.08, -0.1), Vec3(1, 0.15, 0.3), Vec3(-0.3, 0.1, 1), Vec3(-1, 0.12, 0.5)};

ParsedScene hills_in_light(int cuts, bool is_closed, const Vec3& light, double transmission = 0.0) {
  Scene scene = matte_scene();
  scene.materials[0].transmission = Color(transmission);
  add(scene, hills(cuts, is_closed));
  add_sun(scene, glm::normalize(light));
  return view_of(scene, 192, Vec3(0.3, 1.0, 0.4));
}

TEST_F(Terminators, LieInTheShadowOfTheHillsOfTheirMeshOpenOrClosed) {
  constexpr int kFacetPx = 9;  // a side of the coarser ones
  for (const Vec3& light : kLowLights) {
    for (const bool is_closed : {false, true}) {
      const Picture truth = picture_by(hills_in_light(160, is_closed, light), Terminator::exact, true, pool_);
      for (const int cuts : {20, 40}) {
        const Picture seen = picture_by(hills_in_light(cuts, is_closed, light), Terminator::smooth, true, pool_);
        int dark = 0, lit = 0;
        for (int y = 0; y < seen.height; ++y) {
          for (int x = 0; x < seen.width; ++x) {
            const size_t i = static_cast<size_t>(y) * seen.width + x;
            if (seen.ids[i] >> 32 != 0 || !is_dark_around(truth, x, y, kFacetPx)) continue;
            ++dark, lit += seen.linear[3 * i] > 0.0f;
          }
        }
        EXPECT_GT(dark, 500) << light.x << " " << cuts << is_closed;
        EXPECT_EQ(lit, 0) << light.x << " " << cuts << is_closed;
      }
    }
  }
}

TEST_F(Terminators, OfHillsAreThoseOfTheReference) {
  for (const Vec3& light : kLowLights) {
    for (const bool is_closed : {false, true}) {
      for (const double transmission : {0.0, 0.6}) {
        ParsedScene view = hills_in_light(20, is_closed, light, transmission);
        view.view.render.max_depth = 0;
        const ImageDifference d = judge_view(view.scene, view.view, pool_).difference;
        EXPECT_LE(d.id_mismatches, 4);
        EXPECT_LE(d.q8_differing, 8) << light.x << " " << is_closed << " " << transmission;
      }
    }
  }
}

double rms_apart(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (size_t i = 0; i < a.linear.size(); ++i) sum += std::pow(double{a.linear[i]} - double{b.linear[i]}, 2);
  return std::sqrt(sum / static_cast<double>(a.linear.size()));
}

TEST_F(Terminators, SmoothAndExactMeetAsTheMeshGetsFiner) {
  // The strip in which they differ is as wide as a facet turns, and the light there as strong: the power 1.5.
  std::vector<double> apart;
  for (const int around : {12, 24, 48, 96}) {
    Scene scene = matte_scene();
    add(scene, globe(around));
    add(scene, SphereShape{{0.3, 1.05, 0.2}, 0.2});
    add_sun(scene, glm::normalize(Vec3(1.0, 0.6, -0.5)));
    const ParsedScene view = view_of(scene, 256, Vec3(0.3, 0.8, 1.0));
    apart.push_back(
        rms_apart(picture_by(view, Terminator::smooth, true, pool_), picture_by(view, Terminator::exact, true, pool_)));
  }
  for (size_t i = 1; i < apart.size(); ++i) EXPECT_LT(apart[i], 0.5 * apart[i - 1]) << i;
}

// Everything whose shadow is not plain, by both renderers: saddles, glass, instances, touching smooth bodies.
TEST_F(Terminators, AreThoseOfTheReference) {
  for (const Vec3& light : {Vec3(1, 0.2, -0.4), Vec3(-0.2, 1, 0.3)}) {
    for (const bool is_lamp : {false, true}) {
      for (const double transmission : {0.0, 0.6}) {
        Scene scene = cluttered_drum(8, glm::normalize(light));
        scene.materials[0].transmission = Color(transmission);
        add(scene, ring(24, 12, 0.3)).world_from_shape = glm::translate(Mat4(1.0), Vec3(0.0, -1.0, 0.0));
        ChessPieceShape knight;
        knight.piece = Piece::knight, knight.detail = 12, knight.position = {1.0, -0.69, 0.4};
        add(scene, knight);
        if (is_lamp) scene.lights[0] = Light{}, scene.lights[0].position = 1.7 * glm::normalize(light);
        ParsedScene view = view_of(scene, 192, Vec3(0.2, 1.0, 1.4));
        view.view.render.max_depth = 0;
        const ImageDifference d = judge_view(view.scene, view.view, pool_).difference;
        EXPECT_LE(d.id_mismatches, 4);
        EXPECT_LE(d.q8_differing, 8) << is_lamp << " " << transmission;
      }
    }
  }
}

std::vector<uint8_t> drawn(const ParsedScene& view, TilePool& pool) {
  const auto compiled = compile_scene(view.scene, pool);
  const auto render = Render::start(pool, Priority::normal, compiled, plan_view(*compiled, view.view));
  while (!render->wait_ms(1e9)) continue;
  return to_srgb8(*render->image(), 0.0);
}

TEST_F(Terminators, AreTheSameByEveryMethod) {
  const Scene scene = cluttered_drum(8, glm::normalize(Vec3(1.0, 0.2, -0.4)));
  for (const Shading shading : {Shading::phong, Shading::gouraud, Shading::flat}) {
    ParsedScene view = view_of(scene, 192, Vec3(0.2, 1.0, 1.4));
    view.view.render.shading = shading, view.view.render.tessellate = true;
    const std::vector<uint8_t> rays = drawn(view, pool_);
    for (const Algorithm algorithm : {Algorithm::zbuffer, Algorithm::warnock}) {
      view.view.render.algorithm = algorithm;
      EXPECT_LE(check::differing_pixels(rays, drawn(view, pool_)), 0.05);
    }
  }
}

}  // namespace
}  // namespace tilelight
