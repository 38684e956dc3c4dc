// SPDX-License-Identifier: Apache-2.0
// The methods that work on triangles, as renders show them: beside each other, beside rays, and beside what light on a
// face comes to by hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

#include "renderer/compile/tessellate.h"
#include "renderer/geometry/sphere_mesh.h"
#include "renderer/raster/raster_scene.h"
#include "renderer/render/render.h"
#include "renderer/scene/parse.h"
#include "renderer/trace/isa.h"

namespace tilelight {
namespace {

// Spheres, boxes that go through each other, a plane to the horizon, a mesh, a checker, both kinds of light.
constexpr const char* kScene = R"({
  "image": {"width": 141, "height": 93},
  "camera": {"position": [4, 3, 6], "target": [0, 0.5, 0]},
  "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 6},
             {"type": "directional", "direction": [-1, -2, -1], "intensity": 0.4}],
  "materials": {"tiles": {"diffuse": {"checker": {"a": 0.9, "b": 0.1, "size": 0.5}}},
                "shiny": {"diffuse": [0.8, 0.3, 0.2], "specular": 0.5, "shininess": 20}},
  "objects": [{"type": "plane", "point": [0, -0.01, 0], "material": "tiles"},
              {"type": "cube", "center": [0, 0.5, 0], "material": "shiny"},
              {"type": "cube", "center": [0.3, 0.7, 0.2], "rotate_deg": {"axis": [1, 2, 3], "angle": 37}},
              {"type": "sphere", "center": [-1.5, 0.8, 0], "radius": 0.8, "material": "shiny"},
              {"type": "chess_piece", "piece": "knight", "position": [1.5, 0, 0.5], "detail": 16}]})";

struct Picture {
  std::shared_ptr<const Image> image;
  ViewPlan plan;
};

Picture draw(const std::string& json, const std::function<void(View&)>& change, RenderOptions options = {},
             int threads = 2) {
  const auto parsed = parse_scene(json, Limits{});
  if (!parsed) throw std::runtime_error(parsed.error().errors.at(0).detail);
  TilePool pool(threads);
  View view = parsed->view;
  change(view);
  const auto scene = compile_scene(parsed->scene, pool);
  const ViewPlan plan = plan_view(*scene, view);
  const auto render = Render::start(pool, Priority::normal, scene, plan, std::move(options));
  EXPECT_TRUE(render->wait_ms(1e12));
  EXPECT_EQ(render->progress().state, RenderState::done) << render->progress().error;
  EXPECT_EQ(render->report().points.back().nonfinite, 0);
  return {render->image(), plan};
}

std::function<void(View&)> by(Algorithm algorithm, Shading shading = Shading::phong, int samples = 1) {
  return [=](View& view) {
    view.render.algorithm = algorithm;
    view.render.shading = shading;
    view.render.samples = samples;
    view.render.max_depth = 0;
    view.render.tessellate = true;
  };
}

// Part of the pixels that differ by more than a 512th of the range of light.
double part_that_differs(const Image& a, const Image& b) {
  int64_t differing = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) {
    float most = 0.0f;
    for (size_t c = i; c < i + 3; ++c) most = std::max(most, std::fabs(a.rgb[c] - b.rgb[c]));
    differing += most > 1.0f / 512;
  }
  return static_cast<double>(differing) / (static_cast<double>(a.width) * a.height);
}

TEST(Raster, WarnockAndZbufferGiveTheSameBytes) {
  for (const auto filter : {PixelFilter::box, PixelFilter::tent, PixelFilter::gaussian}) {
    for (const auto shading : {Shading::flat, Shading::gouraud, Shading::phong}) {
      const auto with = [&](Algorithm algorithm) {
        return draw(kScene, [&](View& view) {
          by(algorithm, shading, 5)(view);
          view.render.filter = filter;
        });
      };
      EXPECT_EQ(with(Algorithm::zbuffer).image->rgb, with(Algorithm::warnock).image->rgb);
    }
  }
}

TEST(Raster, ShowsWhatRaysShow) {
  for (const auto projection : {Projection::perspective, Projection::orthographic}) {
    for (const auto shading : {Shading::flat, Shading::gouraud, Shading::phong}) {
      const auto with = [&](Algorithm algorithm) {
        return draw(kScene, [&](View& view) {
          by(algorithm, shading)(view);
          view.camera->projection = projection;
          view.camera->height = 4.0;
        });
      };
      const Image rays = *with(Algorithm::raytrace).image, raster = *with(Algorithm::zbuffer).image;
      EXPECT_LE(part_that_differs(rays, raster), 5e-3) << "in a small picture with much to see";
    }
  }
}

TEST(Raster, GivesTheSameBytesOnAnyThreadsTilesAndCpu) {
  for (const auto algorithm : {Algorithm::zbuffer, Algorithm::warnock}) {
    const auto change = by(algorithm, Shading::gouraud, 3);
    const auto expected = draw(kScene, change).image->rgb;
    for (const auto& [threads, tile] : {std::pair{1, 16}, {7, 8}, {3, 4}, {2, 64}}) {
      RenderOptions options;
      options.tile_px = tile;
      EXPECT_EQ(draw(kScene, change, options, threads).image->rgb, expected) << threads << ", " << tile;
    }
    for (const std::string& isa : available_isas()) {
      ASSERT_TRUE(select_isa(isa));
      EXPECT_EQ(draw(kScene, change).image->rgb, expected) << isa;
    }
    ASSERT_TRUE(select_isa("auto"));
  }
}

// Open squares that the eye sees nearly edge on, from a ten millionth to a thousandth of a radian over their planes,
// lit on one side: rays pass beside them as often as through them.
std::string fan_scene() {
  std::string meshes, objects;
  for (int i = 0; i < 24; ++i) {
    const double turn = 0.26 * i, over = 1e-7 * std::pow(1.5, i);
    const Vec3 along(std::cos(turn), std::sin(turn), 0.0), across(-along.y, along.x, 0.0);
    std::string corners;
    for (const auto& [u, z] : {std::pair{0.3, -3.0}, {1.2, -3.0}, {1.2, -5.0}, {0.3, -5.0}}) {
      const Vec3 p = u * along + Vec3(0, 0, z) + over * across;
      for (int k = 0; k < 3; ++k) {
        char text[32];
        std::snprintf(text, sizeof text, "%.17g", p[k]);
        corners += (corners.empty() ? "" : ",") + std::string(text);
      }
    }
    const std::string name = "\"m" + std::to_string(i) + "\"", comma = i > 0 ? "," : "";
    meshes += comma + name + R"(: {"positions": [)" + corners + R"(], "indices": [0, 1, 2, 0, 2, 3]})";
    objects += comma + R"({"type": "mesh", "mesh": )" + name + "}";
  }
  return R"({"image": {"width": 128, "height": 96}, "camera": {"position": [0, 0, 0], "target": [0, 0, -1], "fov_y_deg": 50},
    "lights": [{"type": "directional", "direction": [-1, -0.3, -0.2], "intensity": 1.2}], "meshes": {)" +
         meshes + R"(}, "objects": [)" + objects + "]}";
}

TEST(Raster, LightsFacesSeenEdgeOnTheSameWhoeverComesFirst) {
  const std::string scene = fan_scene();
  for (const auto shading : {Shading::flat, Shading::gouraud, Shading::phong}) {
    const auto expected = draw(scene, by(Algorithm::zbuffer, shading, 16)).image->rgb;
    EXPECT_EQ(draw(scene, by(Algorithm::warnock, shading, 16)).image->rgb, expected);
    for (const auto& [threads, tile] : {std::pair{1, 4}, {3, 64}, {2, 8}, {1, 128}}) {
      RenderOptions options;
      options.tile_px = tile;
      EXPECT_EQ(draw(scene, by(Algorithm::zbuffer, shading, 16), options, threads).image->rgb, expected) << tile;
    }
  }
}

TEST(Raster, HidesWhatLiesBehindAWallHoweverFlatlyItIsSeen) {
  for (const char* over : {"1e-7", "1e-9", "1e-12"}) {
    const std::string eye = std::string("[0, ") + over + ", 1]", target = std::string("[0, ") + over + ", 0]";
    const std::string scene = R"({"image": {"width": 128, "height": 128}, "ambient": 1, "lights": [],
      "background": {"bottom": 0, "top": 0},
      "camera": {"position": )" +
                              eye + R"(, "target": )" + target + R"(, "up": [0.3, 1, 0], "fov_y_deg": 60},
      "materials": {"red": {"ambient": [1, 0, 0], "diffuse": 0}, "green": {"ambient": [0, 1, 0], "diffuse": 0}},
      "objects": [{"type": "box", "min": [-2, -0.5, -3], "max": [2, 0, -1], "material": "red"},
                  {"type": "box", "min": [-2, -2, -0.6], "max": [2, 2, -0.5], "material": "green"}]})";
    for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer, Algorithm::warnock}) {
      const auto image = draw(scene, by(algorithm, Shading::phong, 8)).image;
      for (size_t i = 0; i < image->rgb.size(); i += 3) ASSERT_EQ(image->rgb[i], 0.0f) << over << ", " << i / 3;
    }
  }
}

TEST(Raster, StopsPreparingWhenItIsCancelledAndSaysWhatItCannotHold) {
  std::string men;
  for (int i = 0; i < 60; ++i)
    men += (i > 0 ? "," : "") +
           std::string(R"({"type": "chess_piece", "piece": "queen", "detail": 96, "position": [)") +
           std::to_string(i % 8) + ", 0, " + std::to_string(i / 8) + "]}";
  const auto parsed = parse_scene(R"({"image": {"width": 320, "height": 200}, "objects": [)" + men + "]}", Limits{});
  ASSERT_TRUE(parsed);
  TilePool pool(2);
  const auto scene = compile_scene(parsed->scene, pool);
  for (const auto algorithm : {Algorithm::zbuffer, Algorithm::warnock, Algorithm::roberts}) {
    View view = parsed->view;
    view.render.algorithm = algorithm;
    const auto render = Render::start(pool, Priority::normal, scene, plan_view(*scene, view));
    render->cancel();
    ASSERT_TRUE(render->wait_ms(1e12));
    EXPECT_EQ(render->progress().state, RenderState::cancelled) << render->progress().error;
    EXPECT_TRUE(render->progress().error.empty());
  }
  const std::string many = R"({"type": "chess_position", "detail": 512})";
  const auto large = parse_scene(R"({"objects": [)" + many + "," + many + "]}", Limits{});
  ASSERT_TRUE(large);
  View view = large->view;
  view.render.algorithm = Algorithm::zbuffer;
  const auto compiled = compile_scene(large->scene, pool);
  ASSERT_GT(compiled->plan.triangles_instanced, kMostRasterTriangles);
  const auto render = Render::start(pool, Priority::normal, compiled, plan_view(*compiled, view));
  ASSERT_TRUE(render->wait_ms(1e12));
  EXPECT_EQ(render->progress().state, RenderState::failed);
  EXPECT_NE(render->progress().error.find("8000000 triangles"), std::string::npos) << render->progress().error;
}

TEST(Tessellation, CutsManySpheresCoarserAndSaysSo) {
  std::string balls;
  for (int i = 0; i < 400; ++i)
    balls += (i > 0 ? "," : "") + std::string(R"({"type": "sphere", "radius": 1, "center": [)") + std::to_string(i) +
             ", 0, 0]}";
  const auto parsed = parse_scene(R"({"camera": {"type": "orthographic", "position": [0, 0, 9], "height": 2},
    "render": {"tessellate": true, "chord_error_px": 0.01}, "objects": [)" +
                                      balls + "]}",
                                  Limits{});
  ASSERT_TRUE(parsed);
  TilePool pool(2);
  const auto scene = compile_scene(parsed->scene, pool);
  const ViewPlan plan = plan_view(*scene, parsed->view);
  EXPECT_LE(plan.plan.triangles_instanced, kMostSphereTriangles);
  EXPECT_GT(plan.plan.triangles_instanced, kMostSphereTriangles / 4) << "no coarser than need be";
  EXPECT_EQ(drawn_scene(scene, plan, pool)->plan.triangles_instanced, plan.plan.triangles_instanced);
  ASSERT_EQ(plan.plan.warnings.size(), 1u);
  EXPECT_EQ(plan.plan.warnings[0].code, "coarser_spheres");
}

TEST(Raster, GoesWhereTheErrorIsAndByRulesOnErrorAndTime) {
  const auto adaptive = [](Algorithm algorithm) {
    return draw(kScene, [&](View& view) {
      by(algorithm, Shading::phong, 32)(view);
      view.render.rmse = 0.012;
      view.render.adaptive = true;
    });
  };
  EXPECT_EQ(adaptive(Algorithm::zbuffer).image->rgb, adaptive(Algorithm::warnock).image->rgb);
  draw(kScene, [&](View& view) {
    by(Algorithm::zbuffer, Shading::phong, 4096)(view);
    view.render.time_ms = 20.0;
  });
}

TEST(Raster, SeesAFloorBetweenTheEyeAndTheHorizonAlone) {
  // The horizon of a plane under a level eye is the middle of the picture.
  const char* scene = R"({"image": {"width": 32, "height": 64}, "background": {"bottom": 0, "top": 0},
    "camera": {"position": [0, 1, 0], "target": [0, 1, -1]}, "ambient": 1, "lights": [],
    "objects": [{"type": "plane", "material": {"ambient": 1}}]})";
  for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer, Algorithm::warnock}) {
    const auto image = draw(scene, by(algorithm)).image;
    for (int y = 0; y < 64; ++y) EXPECT_EQ(image->rgb[static_cast<size_t>(y) * 32 * 3], y < 32 ? 0.0f : 1.0f) << y;
  }
}

TEST(Raster, KnowsLocalLightAloneAndSaysSo) {
  const Picture picture = draw(R"({"objects": [{"type": "sphere", "material": {"reflection": 0.5}}],
                                   "image": {"width": 64, "height": 48}})",
                               [](View& view) {
                                 view.render.algorithm = Algorithm::zbuffer;
                                 view.render.samples = 1;
                               });
  EXPECT_EQ(picture.plan.plan.kernel, "zbuffer, local");
  const auto& left_out = picture.plan.plan.left_out;
  const auto says = [&](const std::string& what, const std::string& why) {
    return std::any_of(left_out.begin(), left_out.end(),
                       [&](const LeftOut& l) { return l.what == what && l.why.find(why) != std::string::npos; });
  };
  EXPECT_TRUE(says("feature reflection", "zbuffer knows local light only"));
  EXPECT_TRUE(says("feature spheres", "triangles"));
}

// Two squares side by side, seen in parallel: seven lines of known lengths.
constexpr const char* kSquares = R"({
  "image": {"width": 200, "height": 100},
  "camera": {"type": "orthographic", "position": [0, 0, 5], "target": [0, 0, 0], "height": 2},
  "objects": [{"type": "box", "min": [-1.5, -0.5, -1], "max": [-0.5, 0.5, 0]},
              {"type": "box", "min": [0.5, -0.5, -1], "max": [1.5, 0.5, 0]}]})";

TEST(Roberts, InksTheAreaOfItsLines) {
  const Image image = *draw(kSquares, by(Algorithm::roberts, Shading::phong, 64)).image;
  double ink = 0.0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) ink += (1.0 - image.rgb[i]) / 0.99;
  // Strokes of 1.5 pixels about squares of 50: less half a corner's square at each, with round ends.
  EXPECT_NEAR(ink, 2 * 4 * 50 * 1.5, 0.02 * 2 * 4 * 50 * 1.5);
}

TEST(Roberts, GivesLinesAsSvgAndDashesHiddenOnesOnRequest) {
  const auto parsed = parse_scene(kScene, Limits{});
  ASSERT_TRUE(parsed);
  TilePool pool(2);
  const auto scene = compile_scene(parsed->scene, pool);
  size_t plain = 0;
  for (const bool hidden : {false, true}) {
    View view = parsed->view;
    view.render.algorithm = Algorithm::roberts, view.render.samples = 2, view.render.hidden_lines = hidden;
    const auto render = Render::start(pool, Priority::normal, scene, plan_view(*scene, view));
    ASSERT_TRUE(render->wait_ms(1e12));
    const std::string svg = render->lines_svg();
    EXPECT_EQ(svg.compare(0, 4, "<svg"), 0) << svg.substr(0, 80);
    EXPECT_EQ(svg.find("stroke-dasharray") != std::string::npos, hidden);
    EXPECT_GT(svg.size(), plain);
    plain = svg.size();
    EXPECT_EQ(render->report().points.back().truncation_bound, 0.0) << "lines leave no light out";
  }
  View view = parsed->view;
  view.render.samples = 1;
  const auto rays = Render::start(pool, Priority::normal, scene, plan_view(*scene, view));
  ASSERT_TRUE(rays->wait_ms(1e12));
  EXPECT_TRUE(rays->lines_svg().empty());
}

// A triangle in the plane z = 0, seen head on in parallel, lit by a light at (0, 0, 1) without attenuation: at a place
// r from the origin the cosine is 1 / sqrt(1 + r^2).
constexpr const char* kTriangle = R"({
  "image": {"width": 200, "height": 200}, "ambient": 0, "attenuation": {"mode": "none"},
  "camera": {"type": "orthographic", "position": [0, 0, 5], "target": [0, 0, 0], "height": 4},
  "lights": [{"type": "point", "position": [0, 0, 1], "intensity": 1}],
  "meshes": {"t": {"positions": [-1, -1, 0, 1, -1, 0, -1, 1, 0], "indices": [0, 1, 2]}},
  "background": {"bottom": 0, "top": 0},
  "objects": [{"type": "mesh", "mesh": "t", "material": {"diffuse": 1}}]})";

float at(const Image& image, int x, int y) { return image.rgb[(static_cast<size_t>(y) * image.width + x) * 3]; }

TEST(Shading, FlatLightsAFaceOnceAtItsMiddle) {
  for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer}) {
    const auto image = draw(kTriangle, by(algorithm, Shading::flat)).image;
    const double middle = 1.0 / std::sqrt(1.0 + 2.0 / 9.0);  // at (-1/3, -1/3)
    for (const auto& [x, y] : {std::pair{55, 145}, {100, 145}, {55, 100}, {70, 120}})
      EXPECT_NEAR(at(*image, x, y), middle, 1e-6) << x << ", " << y;
  }
}

TEST(Shading, GouraudIsLinearBetweenTheCorners) {
  for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer}) {
    std::string scene = kTriangle;
    const std::string over_middle = R"("position": [0, 0, 1])";
    scene.replace(scene.find(over_middle), over_middle.size(), R"("position": [-1, -1, 1])");
    const auto image = draw(scene, by(algorithm, Shading::gouraud)).image;
    // The corners see the light at cosines of 1, and twice of 1 / sqrt 5: lit the more the nearer to the first.
    const double near = 1.0, far = 1.0 / std::sqrt(5.0);
    for (const auto& [x, y] : {std::pair{55, 145}, {95, 145}, {55, 105}, {70, 120}}) {
      const double b = (x + 0.5 - 50.0) / 100.0, c = (150.0 - y - 0.5) / 100.0;
      EXPECT_NEAR(at(*image, x, y), (1.0 - b - c) * near + (b + c) * far, 8e-3) << x << ", " << y;
    }
  }
}

TEST(Shading, PhongIsLitByThePoint) {
  for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer}) {
    const auto image = draw(kTriangle, by(algorithm, Shading::phong)).image;
    for (const auto& [x, y] : {std::pair{55, 145}, {98, 101}, {55, 101}, {70, 120}}) {
      const double px = (x + 0.5 - 100.0) / 50.0, py = (100.0 - y - 0.5) / 50.0;
      EXPECT_NEAR(at(*image, x, y), 1.0 / std::sqrt(1.0 + px * px + py * py), 8e-3) << "up to half a pixel";
    }
  }
}

TEST(Shading, GouraudOnABoxsFaceIsBilinear) {
  const char* scene = R"({
    "image": {"width": 100, "height": 100}, "ambient": 0, "attenuation": {"mode": "none"},
    "camera": {"type": "orthographic", "position": [0, 0, 5], "target": [0, 0, 0], "height": 2},
    "lights": [{"type": "point", "position": [-1, -0.5, 1], "intensity": 1}],
    "objects": [{"type": "box", "min": [-1, -1, -1], "max": [1, 1, 0], "material": {"diffuse": 1}}]})";
  const auto cosine = [](double x, double y) {
    return 1.0 / std::sqrt(1.0 + (x + 1) * (x + 1) + (y + 0.5) * (y + 0.5));
  };
  for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer}) {
    const auto image = draw(scene, by(algorithm, Shading::gouraud)).image;
    for (const auto& [px, py] : {std::pair{50, 50}, {25, 75}, {75, 75}, {25, 25}, {75, 25}}) {
      const double u = (px + 0.5) / 100.0, v = (99.5 - py) / 100.0;
      const double low = (1.0 - u) * cosine(-1, -1) + u * cosine(1, -1),
                   high = (1.0 - u) * cosine(-1, 1) + u * cosine(1, 1);
      EXPECT_NEAR(at(*image, px, py), (1.0 - v) * low + v * high, 6e-3) << px << ", " << py;
    }
  }
}

TEST(Shading, ShadowsFallByThePointWhateverTheShading) {
  // A small box above the middle of a floor, lit from straight above: its shadow has a sharp rim.
  const char* scene = R"({
    "image": {"width": 100, "height": 100}, "ambient": 0, "attenuation": {"mode": "none"},
    "camera": {"type": "orthographic", "position": [0, 1, 0], "target": [0, 0, 0], "up": [0, 0, -1], "height": 4},
    "lights": [{"type": "directional", "direction": [0, -1, 0], "intensity": 1}],
    "objects": [{"type": "box", "min": [-2, -1, -2], "max": [2, 0, 2], "material": {"diffuse": 1}},
                {"type": "box", "min": [-1, 2, -1], "max": [1, 3, 1]}]})";
  for (const auto algorithm : {Algorithm::raytrace, Algorithm::zbuffer, Algorithm::warnock}) {
    for (const auto shading : {Shading::flat, Shading::gouraud, Shading::phong}) {
      const auto image = draw(scene, by(algorithm, shading)).image;
      for (int x = 0; x < 100; ++x) {
        if (x == 24 || x == 25 || x == 74 || x == 75) continue;  // the rim
        EXPECT_FLOAT_EQ(at(*image, x, 50), x < 25 || x > 74 ? 1.0f : 0.0f) << x;
      }
    }
  }
}

TEST(SphereMesh, LiesAsNearTheSphereAsItSays) {
  for (const int detail : {2, 3, 4, 8, 24, 96, kMaxSphereDetail}) {
    const TriMesh mesh = make_sphere_mesh(detail);
    EXPECT_EQ(mesh.triangles.size(), static_cast<size_t>(8 * detail * detail));
    EXPECT_EQ(mesh.positions.size(), static_cast<size_t>(4 * detail * detail + 2));  // Euler: V = F/2 + 2
    EXPECT_TRUE(mesh.closed);
    double nearest = 1.0;
    for (const auto& t : mesh.triangles) {
      const Vec3 &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vec3 n = glm::normalize(glm::cross(b - a, c - a));
      EXPECT_GT(glm::dot(n, a), 0.0) << "outward";
      nearest = std::min(nearest, glm::dot(n, a));
    }
    for (const Vec3& p : mesh.positions) EXPECT_NEAR(glm::length(p), 1.0, 1e-15);
    EXPECT_LE(1.0 - nearest, sphere_mesh_error(detail)) << detail;
    EXPECT_GE(1.0 - nearest, 0.75 * sphere_mesh_error(detail)) << detail << ": or the bound is a waste";
  }
}

TEST(Tessellation, KeepsToTheChordErrorInPixels) {
  // A sphere of radius 1 in the middle of an orthographic picture of 100 pixels a unit.
  const auto parsed = parse_scene(R"({"image": {"width": 300, "height": 300},
    "camera": {"type": "orthographic", "position": [0, 0, 5], "target": [0, 0, 0], "height": 3},
    "objects": [{"type": "sphere"}], "render": {"tessellate": true}})",
                                  Limits{});
  ASSERT_TRUE(parsed);
  TilePool pool(1);
  const auto scene = compile_scene(parsed->scene, pool);
  int64_t last = 0;
  for (const double chord : {4.0, 1.0, 0.25, 0.05}) {
    View view = parsed->view;
    view.render.chord_error_px = chord;
    const auto drawn = drawn_scene(scene, plan_view(*scene, view), pool);
    ASSERT_EQ(drawn->bodies[0].kind, BodyKind::mesh);
    double error = 0.0;
    for (const auto& t : drawn->bodies[0].mesh->triangles) {
      const auto& p = drawn->bodies[0].mesh->positions;
      error = std::max(error, 1.0 - glm::length((p[t[0]] + p[t[1]] + p[t[2]]) / 3.0));
    }
    EXPECT_LE(100.0 * error, chord);
    EXPECT_GT(drawn->plan.triangles_instanced, last);
    last = drawn->plan.triangles_instanced;
  }
}

}  // namespace
}  // namespace tilelight
