// SPDX-License-Identifier: Apache-2.0
// Renders as users see them: the same bytes however they are scheduled, passes, replays, cancelling, the time rule.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <latch>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "renderer/render/pass_schedule.h"
#include "renderer/render/predict.h"
#include "renderer/render/render.h"
#include "renderer/render/spend.h"
#include "renderer/scene/parse.h"
#include "renderer/trace/isa.h"
#include "tests/unit/host_floats.h"

namespace tilelight {
namespace {

// Glass, mirrors, a checker, a mesh and both kinds of light in one small picture.
constexpr const char* kBusyScene = R"({
  "image": {"width": 97, "height": 61},
  "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 6},
             {"type": "directional", "direction": [-1, -2, -1], "intensity": 0.4}],
  "materials": {"glass": {"diffuse": 0.02, "specular": 0.5, "reflection": 0.1, "transmission": 0.85},
                "mirror": {"diffuse": 0.1, "specular": 0.6, "reflection": 0.8},
                "tiles": {"diffuse": {"checker": {"a": 0.9, "b": 0.1, "size": 0.5}}, "reflection": 0.1}},
  "objects": [{"type": "box", "min": [-4, -1, -4], "max": [4, 0, 4], "material": "tiles"},
              {"type": "sphere", "center": [0, 1, 0], "radius": 1, "material": "glass"},
              {"type": "sphere", "center": [2, 1, -1], "radius": 1, "material": "mirror"},
              {"type": "chess_piece", "piece": "knight", "position": [-1.5, 0, 0.5], "detail": 16}]})";

struct Prepared {
  std::shared_ptr<const CompiledScene> scene;
  View view;
};

Prepared prepare(TilePool& pool, const char* json = kBusyScene) {
  const auto parsed = parse_scene(json, Limits{});
  if (!parsed) throw std::runtime_error(parsed.error().errors.at(0).detail);
  return {compile_scene(parsed->scene, pool), parsed->view};
}

std::vector<float> render(int threads, int tile_px, const std::function<void(RenderSpec&)>& change) {
  TilePool pool(threads);
  Prepared p = prepare(pool);
  change(p.view.render);
  RenderOptions options;
  options.tile_px = tile_px;
  const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view), options);
  EXPECT_TRUE(render->wait_ms(1e12));
  EXPECT_EQ(render->progress().state, RenderState::done);
  EXPECT_EQ(render->report().points.back().nonfinite, 0);
  return render->image()->rgb;
}

TEST(Render, GivesTheSameBytesOnAnyThreadsAndTiles) {
  const auto four_samples = [](RenderSpec& spec) { spec.samples = 4; };
  const auto expected = render(1, 32, four_samples);
  for (const auto& [threads, tile] : {std::pair{2, 16}, {7, 8}, {3, 1}, {2, 64}, {16, 13}}) {
    EXPECT_EQ(render(threads, tile, four_samples), expected) << threads << " threads, tiles of " << tile;
  }
}

TEST(Render, GivesTheBytesOfTheKernelThatCanDoAllWhereALeanerOneIsChosen) {
  TilePool pool(2);
  const std::string head = R"({"image": {"width": 61, "height": 47}, "render": {"samples": 2},
    "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 6},
               {"type": "directional", "direction": [-1, -2, -1], "intensity": 0.4}],
    "camera": {"position": [2, 3, 6], "target": [0, 0.5, 0]},
    "materials": {"mirror": {"diffuse": 0.4, "specular": 0.6, "reflection": 0.5}}, "objects": [)";
  const std::string sphere = R"({"type": "sphere", "center": [0, 1, 0], "radius": 1)",
                    box = R"({"type": "box", "min": [-1, 0, -1], "max": [1, 1, 1])",
                    plane = R"({"type": "plane", "point": [0, 0, 0], "normal": [0, 1, 0])",
                    knight = R"({"type": "chess_piece", "piece": "knight", "position": [0, 0, 0], "detail": 16)",
                    mirror = R"(, "material": "mirror"})", dull = "}";
  for (const std::string& objects :
       {sphere + dull, sphere + mirror, box + dull, box + mirror, plane + mirror, knight + dull, knight + mirror,
        sphere + mirror + "," + plane + dull, knight + dull + "," + plane + mirror}) {
    const Prepared p = prepare(pool, (head + objects + "]}").c_str());
    ViewPlan plan = plan_view(*p.scene, p.view);
    EXPECT_NE(plan.variant, KernelVariant::glass_shadows);
    const auto image_of = [&] {
      const auto render = Render::start(pool, Priority::normal, p.scene, plan);
      EXPECT_TRUE(render->wait_ms(1e12));
      return render->image()->rgb;
    };
    const std::vector<float> lean = image_of();
    plan.variant = KernelVariant::glass_shadows;
    EXPECT_EQ(image_of(), lean) << objects;
  }
}

// Inside two glued cubes of one mesh the face between them shows at no depth.
TEST(Render, AtDepthZeroShowsWhatDepthOneShowsOfOneMeshOfTwoShells) {
  TilePool pool(2);
  const std::string json =
      R"({"image": {"width": 48, "height": 48}, "render": {"samples": 1, "max_depth": %d, "weight_cutoff": 0},
    "lights": [], "ambient": 1, "background": {"bottom": 0, "top": 0},
    "camera": {"position": [0.5, 0.4, 0.5], "target": [0.7, 1.6, 0.6], "fov_y_deg": 60},
    "materials": {"g": {"diffuse": 0, "transmission": 1e-30, "ambient": {"checker": {"size": 0.05, "a": 1, "b": 0.1}}}},
    "meshes": {"two": {"positions": [0,0,0, 1,0,0, 0,1,0, 1,1,0, 0,0,1, 1,0,1, 0,1,1, 1,1,1, 0,2,0, 1,2,0, 0,2,1, 1,2,1],
      "indices": [0,4,6, 0,6,2, 1,3,7, 1,7,5, 0,1,5, 0,5,4, 2,6,7, 2,7,3, 0,2,3, 0,3,1, 4,5,7, 4,7,6,
                  2,6,10, 2,10,8, 3,9,11, 3,11,7, 2,3,7, 2,7,6, 8,10,11, 8,11,9, 2,8,9, 2,9,3, 6,7,11, 6,11,10]}},
    "objects": [{"type": "mesh", "mesh": "two", "material": "g"}]})";
  const auto image_at = [&](int depth) {
    std::string at_depth = json;
    at_depth.replace(at_depth.find("%d"), 2, std::to_string(depth));
    const Prepared p = prepare(pool, at_depth.c_str());
    const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
    EXPECT_TRUE(render->wait_ms(1e12));
    return render->image()->rgb;
  };
  EXPECT_EQ(image_at(0), image_at(1));
}

TEST(Render, GivesTheSameBytesOnEveryInstructionSet) {
  const auto two_samples = [](RenderSpec& spec) { spec.samples = 2; };
  const auto expected = render(2, 32, two_samples);
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    EXPECT_EQ(render(2, 32, two_samples), expected) << isa;
  }
  (void)select_isa("auto");
}

TEST(Render, GivesTheSameBytesWhateverFloatingPointTheHostHasSet) {
  const auto two_samples = [](RenderSpec& spec) { spec.samples = 2; };
  const auto expected = render(2, 32, two_samples);
  for (const test::Host host : {test::Host::flushing, test::Host::upwards})
    test::on_host(host, [&] { EXPECT_EQ(render(2, 32, two_samples), expected) << static_cast<int>(host); });
}

TEST(Render, AnySplitOfTheSameSamplesGivesTheSameBytes) {
  const auto whole = render(2, 32, [](RenderSpec& spec) { spec.samples = 8; });
  EXPECT_EQ(render(2, 32, [](RenderSpec& spec) { spec.passes = {3, 5}; }), whole);
  EXPECT_EQ(render(2, 32, [](RenderSpec& spec) { spec.passes = {8}; }), whole);
}

// Where samples go is told by the samples before, so it must not depend on who took them either.
TEST(Render, SamplesThatFollowTheErrorGiveTheSameBytesHoweverScheduled) {
  const auto following = [](RenderSpec& spec) {
    spec.samples = 24;
    spec.adaptive = true;
  };
  const auto expected = render(1, 32, following);
  EXPECT_NE(expected, render(1, 32, [](RenderSpec& spec) { spec.samples = 24; }));
  for (const auto& [threads, tile_px] : {std::pair{2, 32}, {7, 8}, {2, 5}, {3, 1000}})
    EXPECT_EQ(render(threads, tile_px, following), expected) << threads << " threads, tiles of " << tile_px;
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    EXPECT_EQ(render(2, 32, following), expected) << isa;
  }
  (void)select_isa("auto");
}

TEST(Spend, GivesToTheCellsInWhichASampleDoesMost) {
  Film film(16, 4);  // four cells
  film.samples() = {4, 4, 4, 8};
  // By variance over samples: the third, the fourth, the first, the second.
  const std::vector<float> variances = {2.0f, 1.0f, 9.0f, 10.0f};
  constexpr double kOne = 16.0 / 64.0;  // a sample for each pixel of a cell, as a part of the image
  EXPECT_EQ(spend(film, variances, 4 * kOne), (std::vector<uint32_t>{4, 4, 8, 8}));
  EXPECT_EQ(spend(film, variances, 12 * kOne), (std::vector<uint32_t>{4, 4, 8, 16}));
  EXPECT_EQ(spend(film, variances, 16 * kOne), (std::vector<uint32_t>{8, 4, 8, 16}));
  EXPECT_EQ(spend(film, variances, 0.01), (std::vector<uint32_t>{4, 4, 8, 8})) << "one cell at least";
  EXPECT_EQ(spend(film, {0.0f, 0.0f, 0.0f, 0.0f}, 4 * kOne), (std::vector<uint32_t>{8, 4, 4, 8}))
      << "the first of equals";
}

TEST(Render, TheFullKernelGivesTheBytesOfTheLeanOne) {
  // A glass bead inside the floor, in the direction of view, switches every ability on and is never seen.
  constexpr const char* kLean = R"({"image": {"width": 64, "height": 48}, "render": {"samples": 1},
    "camera": {"position": [0, 2, 6], "target": [0, 0.5, 0]}, "materials": {"glass": {"diffuse": 0, "transmission": 0.9}},
    "objects": [{"type": "sphere", "center": [0, 1, 0]}, {"type": "box", "min": [-3, -1, -3], "max": [3, 0, 3]}%s]})";
  TilePool pool(2);
  const auto pixels = [&](const std::string& more) {
    std::string json = kLean;
    json.replace(json.find("%s"), 2, more);
    const Prepared p = prepare(pool, json.c_str());
    const ViewPlan plan = plan_view(*p.scene, p.view);
    const auto render = Render::start(pool, Priority::normal, p.scene, plan);
    render->wait_ms(1e12);
    return std::pair(plan.plan.kernel, render->image()->rgb);
  };
  const auto lean = pixels("");
  const auto full = pixels(R"(, {"type": "sphere", "center": [0, -0.5, 1], "radius": 0.1, "material": "glass"})");
  EXPECT_EQ(lean.first, "local+shadows");
  EXPECT_EQ(full.first, "glass+shadows");
  EXPECT_EQ(lean.second, full.second);
}

TEST(Render, CancelStopsItAndKeepsWhatWholePassesMade) {
  TilePool pool(2);
  Prepared p = prepare(pool);
  p.view.render.samples = 1'000'000;
  std::latch first_pass(1);
  std::atomic<bool> is_first{true};
  RenderOptions options;
  options.on_pass = [&] {
    if (is_first.exchange(false)) first_pass.count_down();
  };
  const auto render = Render::start(pool, Priority::batch, p.scene, plan_view(*p.scene, p.view), options);
  first_pass.wait();
  render->cancel();
  EXPECT_TRUE(render->wait_ms(10'000));
  EXPECT_EQ(render->progress().state, RenderState::cancelled);
  EXPECT_EQ(render->report().stop, "cancelled");
  EXPECT_NE(render->image(), nullptr);
}

TEST(Render, IsLetGoByThePoolWhenItEnds) {
  TilePool pool(3);
  const Prepared p = prepare(pool);
  View small = p.view;
  small.image.width = 40, small.image.height = 30;
  small.render.samples = 2;
  for (int i = 0; i < 50; ++i) {
    auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, small));
    if (i % 2 == 1) render->cancel();
    render->wait_ms(1e12);
    const std::weak_ptr<Render> left = render;
    render.reset();
    const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (!left.expired() && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
    ASSERT_TRUE(left.expired()) << "render " << i << " is held";
  }
}

TEST(Render, HoldsTheTruncationBoundOfGlassThatBendsNothing) {
  // A thin sheet has no Fresnel term: it mirrors kr and lets kt through, and each of the two goes on.
  constexpr const char* kSheets = R"({"image": {"width": 8, "height": 8}, "lights": [], "ambient": 1,
    "camera": {"type": "orthographic", "height": 0.1, "position": [0, 0, 0], "target": [0, 0, -1]},
    "render": {"samples": 1, "max_depth": %d, "weight_cutoff": 0},
    "materials": {"m": {"ambient": 0.2, "diffuse": 0, "reflection": 0.4, "transmission": 0.5, "fresnel": true}},
    "objects": [{"type": "plane", "point": [0, 0, -1], "normal": [0, 0, 1], "material": "m"},
                {"type": "plane", "point": [0, 0, 1], "normal": [0, 0, 1], "material": "m"}]})";
  TilePool pool(2);
  const auto render = [&](int depth) {
    std::string json(kSheets);
    json.replace(json.find("%d"), 2, std::to_string(depth));
    const Prepared p = prepare(pool, json.c_str());
    const auto done = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
    done->wait_ms(1e12);
    return std::pair(done->image()->rgb[0], done->report().points.back().truncation_bound);
  };
  const auto [deep, deep_bound] = render(40);
  const auto [shallow, shallow_bound] = render(1);
  EXPECT_GT(deep - shallow, 0.1f);
  EXPECT_GE(shallow_bound, deep - shallow);
}

TEST(Render, TheTimeRuleEndsWithTheBestImageSoFar) {
  TilePool pool(2);
  Prepared p = prepare(pool);
  p.view.render.samples = 1'000'000;
  p.view.render.time_ms = 150.0;
  const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
  ASSERT_TRUE(render->wait_ms(60'000));
  const RenderReport report = render->report();
  EXPECT_EQ(render->progress().state, RenderState::done);
  EXPECT_EQ(report.stop, "time");
  ASSERT_NE(render->image(), nullptr);
  // The recorded passes replay it exactly.
  p.view.render.time_ms.reset();
  p.view.render.passes = report.passes;
  const auto replay = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
  replay->wait_ms(1e12);
  EXPECT_EQ(replay->image()->rgb, render->image()->rgb);
}

TEST(Render, TellsAnErrorAtEveryExposureThatIsAllowed) {
  TilePool pool(2);
  for (const double exposure : {-1000.0, -130.0, 127.0, 128.0, 1000.0}) {
    Prepared p = prepare(pool);
    p.view.image.width = 16, p.view.image.height = 9;
    p.view.image.exposure = exposure;
    p.view.render.samples = 8;
    const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
    ASSERT_TRUE(render->wait_ms(1e12));
    const ErrorSummary error = render->report().points.back().error;
    EXPECT_TRUE(error.is_known);
    EXPECT_GE(error.rmse, 0.0) << exposure;
    EXPECT_LE(error.rmse, 1.0) << exposure;
    EXPECT_LE(error.most, 2.0) << exposure;
    for (const float bound : *render->error_bounds()) EXPECT_TRUE(bound >= 0.0f && bound < 2.0f) << exposure;
    predict_cost(p.scene, plan_view(*p.scene, p.view), pool);
  }
}

// One pixel of every cell has what one sample a pixel gives it, to the bit, and the passes after a sketch know nothing
// of it.
TEST(Render, ASketchIsThePictureInASixteenthOfItsPixels) {
  TilePool pool(2);
  Prepared p = prepare(pool);
  p.view.image.width = 75, p.view.image.height = 42;  // no whole number of cells
  const auto draw = [&](const std::vector<double>& passes) {
    p.view.render.passes = passes;
    p.view.render.samples = 4;
    const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
    EXPECT_TRUE(render->wait_ms(1e12));
    return render;
  };
  const auto sketch = draw({kSketchSamples}), whole = draw({1.0});
  const Image &rough = *sketch->image(), &fine = *whole->image();
  int same = 0;
  for (int y = 1; y < 42; y += 4) {
    for (int x = 1; x < 75; x += 4) {
      const size_t at = static_cast<size_t>(3 * (75 * y + x));
      same += std::equal(&rough.rgb[at], &rough.rgb[at] + 3, &fine.rgb[at]);
    }
  }
  EXPECT_EQ(same, 11 * 19);
  const ReportPoint point = sketch->report().points.back();
  EXPECT_EQ(point.rays.primary, 11 * 19);
  EXPECT_EQ(point.spp, kSketchSamples);
  EXPECT_FALSE(point.error.is_known);
  EXPECT_EQ(draw({kSketchSamples, 1.0, 1.0})->image()->rgb, draw({1.0, 1.0})->image()->rgb);
}

TEST(Render, CountsItsRaysAndBoundsWhatItLeftUntraced) {
  // Two facing mirrors of reflection 1/2 and depth 3: 1/16 of the light is never followed.
  constexpr const char* kMirrors = R"({"image": {"width": 8, "height": 8}, "lights": [], "ambient": 1,
    "camera": {"type": "orthographic", "height": 0.1, "position": [0, 0, 0], "target": [0, 0, -1]},
    "render": {"samples": 1, "max_depth": 3, "weight_cutoff": 0},
    "materials": {"m": {"ambient": 0.5, "diffuse": 0, "reflection": 0.5}}, "background": {"bottom": 0, "top": 0},
    "objects": [{"type": "box", "min": [-9, -9, -2], "max": [9, 9, -1], "material": "m"},
                {"type": "box", "min": [-9, -9, 1], "max": [9, 9, 2], "material": "m"}]})";
  TilePool pool(2);
  const Prepared p = prepare(pool, kMirrors);
  const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
  render->wait_ms(1e12);
  const ReportPoint point = render->report().points.back();
  EXPECT_EQ(point.rays.primary, 64);
  EXPECT_EQ(point.rays.reflected, 3 * 64);
  const double value = 0.5 * (1 + 0.5 + 0.25 + 0.125);  // the geometric series, cut after depth 3
  for (const float channel : render->image()->rgb) EXPECT_NEAR(channel, value, 1e-6);
  EXPECT_GE(point.truncation_bound, 1.0 - value - 1e-12);  // the whole series sums to 1
  EXPECT_LE(point.truncation_bound, 0.0625 + 1e-12);
}

TEST(Render, TheTruncationBoundIsNotShortByARounding) {
  constexpr const char* kMirrors = R"({"image": {"width": 1, "height": 1}, "lights": [], "ambient": 0.1,
    "camera": {"type": "orthographic", "height": 0.1, "position": [0, 0, 0], "target": [0, 0, -1]},
    "render": {"samples": 1, "max_depth": %d, "weight_cutoff": 0},
    "materials": {"m": {"ambient": 1, "diffuse": 0, "reflection": 0.99}}, "background": {"bottom": 0, "top": 0},
    "objects": [{"type": "plane", "point": [0, 0, -1], "normal": [0, 0, 1], "material": "m"},
                {"type": "plane", "point": [0, 0, 1], "normal": [0, 0, 1], "material": "m"}]})";
  TilePool pool(2);
  for (const int depth : {1, 5, 50, 100, 1000}) {
    std::string json(kMirrors);
    json.replace(json.find("%d"), 2, std::to_string(depth));
    const Prepared p = prepare(pool, json.c_str());
    const auto render = Render::start(pool, Priority::normal, p.scene, plan_view(*p.scene, p.view));
    render->wait_ms(1e12);
    const long double missing = 0.1L * std::pow(static_cast<long double>(0.99), depth + 1) / (1.0L - 0.99);
    EXPECT_GE(render->report().points.back().truncation_bound, missing) << depth;
  }
}

// A slow machine cuts a probe short, which then foretells less well; here only what it foretells is looked at.
constexpr double kNeverCutMs = 1e9;

TEST(PredictCost, ForetellsTheRaysOfTheRender) {
  TilePool pool(2);
  Prepared p = prepare(pool);
  p.view.image.width = 200, p.view.image.height = 120;
  p.view.render.samples = 4;
  const ViewPlan plan = plan_view(*p.scene, p.view);
  const CostPrediction cost = predict_cost(p.scene, plan, pool, kNeverCutMs);
  const auto render = Render::start(pool, Priority::normal, p.scene, plan);
  ASSERT_TRUE(render->wait_ms(1e12));
  const double mrays = 1e-6 * static_cast<double>(render->report().points.back().rays.total());
  EXPECT_NEAR(cost.mrays / mrays, 1.0, 0.1);
  EXPECT_GT(cost.cpu_ms, 0.0);
  EXPECT_DOUBLE_EQ(cost.elapsed_ms, cost.cpu_ms / 2);

  p.view.render.time_ms = 1e-3;
  const CostPrediction cut = predict_cost(p.scene, plan_view(*p.scene, p.view), pool, kNeverCutMs);
  EXPECT_NEAR(cut.mrays / cost.mrays, 1.0 / 64.0, 1e-3) << "of four samples a pixel, one in a pixel of sixteen";
}

TEST(PredictCost, HoldsForOnePixelAndForAnImageOfOneRow) {
  TilePool pool(1);
  Prepared p = prepare(pool, R"({"objects": [{"type": "sphere"}], "lights": []})");
  p.view.render.samples = 3;
  for (const auto& [width, height] : {std::pair{1, 1}, {5000, 1}, {1, 5000}, {3, 2}}) {
    p.view.image.width = width, p.view.image.height = height;
    // Nothing to light and nothing to mirror: the primary rays are all there are.
    EXPECT_NEAR(predict_cost(p.scene, plan_view(*p.scene, p.view), pool).mrays, 3e-6 * width * height, 1e-12);
  }
}

TEST(PassSchedule, DoublesUpToTheSamplesAskedFor) {
  RenderSpec spec;
  spec.samples = 11;
  const PassSchedule schedule(spec);
  std::vector<double> passes;
  for (Standing standing;; ++standing.passes) {
    const auto next = schedule.next(standing);
    if (next.samples == 0.0) {
      EXPECT_EQ(next.stop, "samples");
      break;
    }
    EXPECT_TRUE(next.for_all);
    passes.push_back(next.samples);
    standing.spp += next.samples;
  }
  EXPECT_EQ(passes, (std::vector<double>{1, 1, 2, 4, 3}));
}

TEST(PassSchedule, EndsAReplayByTheFirstRuleThatHolds) {
  RenderSpec spec;
  spec.samples.reset();
  spec.passes = {1, 1, 2};
  EXPECT_EQ(PassSchedule(spec).expected_samples({}), 4);
  EXPECT_EQ(PassSchedule(spec).next({.passes = 3, .spp = 4}).stop, "passes");
  spec.samples = 3;
  const PassSchedule cut(spec);
  EXPECT_EQ(cut.expected_samples({}), 3);
  EXPECT_EQ(cut.next({.passes = 2, .spp = 2}).samples, 1);
  EXPECT_EQ(cut.next({.passes = 3, .spp = 3}).stop, "passes");
  spec.samples = 2;
  EXPECT_EQ(PassSchedule(spec).next({.passes = 2, .spp = 2}).stop, "samples");
  spec.time_ms = 5.0;
  EXPECT_EQ(PassSchedule(spec).next({.passes = 1, .spp = 1, .elapsed_ms = 6.0}).stop, "time");
  EXPECT_EQ(PassSchedule(spec).next({.elapsed_ms = 6.0}).samples, 1);
}

TEST(PassSchedule, CutsAPassToTheTimeThatIsLeft) {
  RenderSpec spec;
  spec.samples = 1000;
  spec.time_ms = 100.0;
  const PassSchedule schedule(spec);
  EXPECT_TRUE(schedule.next({}).is_sketch);
  const Standing sketched{.passes = 1, .spp = kSketchSamples, .elapsed_ms = 20.0, .ms_per_sample = 320.0};
  EXPECT_EQ(schedule.next(sketched).samples, 1) << "it may yet come in time";
  EXPECT_EQ(schedule.next({.passes = 1, .spp = kSketchSamples, .elapsed_ms = 101.0}).stop, "time");
  const auto cut = schedule.next({.passes = 5, .spp = 16, .elapsed_ms = 60.0, .ms_per_sample = 4.0});
  EXPECT_NEAR(cut.samples, 3.5, 0.1) << "where the error is, a sample may be dearer than those before";
  EXPECT_FALSE(cut.for_all);
  // The same passes in a replay without the rule: what is cut goes where the error is there too.
  RenderSpec replay;
  replay.samples.reset();
  replay.passes = {16.0, cut.samples};
  EXPECT_TRUE(PassSchedule(replay).next({}).for_all);
  EXPECT_FALSE(PassSchedule(replay).next({.passes = 1, .spp = 16}).for_all);
  const auto end = schedule.next({.passes = 6, .spp = 24, .elapsed_ms = 98.0, .ms_per_sample = 4.0});
  EXPECT_EQ(end.samples, 0);
  EXPECT_EQ(end.stop, "time");
}

// An error of 0 is what the samples so far tell: one that is smaller than they are apart may have been missed.
TEST(PassSchedule, TakesTheSamplesThatWereAskedForWhereNoErrorWas) {
  RenderSpec spec;
  spec.samples = 1000;
  for (const bool adaptive : {false, true}) {
    spec.adaptive = adaptive;
    EXPECT_EQ(PassSchedule(spec).next({.passes = 5, .spp = 16, .rmse = 0.0}).samples, 16);
  }
}

TEST(PassSchedule, EndsOnceTheUpperEndOfTheErrorIsAsAsked) {
  RenderSpec spec;
  spec.samples = 1000;
  spec.rmse = 0.01;
  spec.adaptive = true;
  const PassSchedule schedule(spec);
  EXPECT_EQ(schedule.next({.passes = 5, .spp = 16, .rmse = 0.0099}).stop, "rmse");
  EXPECT_EQ(schedule.next({.passes = 2, .spp = 2, .rmse = 0.0}).samples, 2) << "two samples tell too little";
  const auto near = schedule.next({.passes = 5, .spp = 16, .rmse = 0.0101});
  EXPECT_FALSE(near.for_all);
  EXPECT_EQ(near.samples, 2) << "an eighth more";
  EXPECT_EQ(schedule.next({.passes = 5, .spp = 16, .rmse = 0.1}).samples, 8) << "half as many again, and then look";
}

}  // namespace
}  // namespace tilelight
