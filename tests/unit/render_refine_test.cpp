// SPDX-License-Identifier: Apache-2.0
// Renders that go on from done ones: the same bytes as one render of the same passes, whatever became of the film.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <stdexcept>

#include "renderer/render/pass_schedule.h"
#include "renderer/render/render.h"
#include "renderer/scene/parse.h"

namespace tilelight {
namespace {

// Glass over a checker, 49 by 31: edges, and cells that are cut at the image's end.
constexpr const char* kScene = R"({
  "image": {"width": 49, "height": 31},
  "materials": {"glass": {"diffuse": 0.02, "specular": 0.5, "reflection": 0.1, "transmission": 0.85}},
  "objects": [{"type": "sphere", "center": [0, 1, 0], "radius": 1, "material": "glass"},
              {"type": "plane", "material": {"diffuse": {"checker": {"a": 0.9, "b": 0.1, "size": 0.5}}}}]})";

class Refine : public ::testing::Test {
 protected:
  using Change = std::function<void(RenderSpec&)>;

  Refine() {
    const auto parsed = parse_scene(kScene, Limits{});
    if (!parsed) throw std::runtime_error(parsed.error().errors.at(0).detail);
    scene_ = compile_scene(parsed->scene, pool_);
    view_ = parsed->view;
  }

  std::shared_ptr<Render> start(const Change& change, RenderOptions options = {}) {
    View view = view_;
    change(view.render);
    return Render::start(pool_, Priority::normal, scene_, plan_view(*scene_, view), std::move(options));
  }
  std::shared_ptr<Render> render(const Change& change, RenderOptions options = {}) {
    auto done = start(change, std::move(options));
    EXPECT_TRUE(done->wait_ms(60'000));
    EXPECT_EQ(done->progress().state, RenderState::done) << done->progress().error;
    return done;
  }
  static RenderOptions from(const Render& source, bool with_film = true) {
    RenderOptions options;
    options.continues = Continued{source.report(), with_film ? source.exposed_film() : nullptr};
    return options;
  }
  // The passes of the report, once more in one render.
  std::shared_ptr<Render> replay(const RenderReport& report) {
    return render([&](RenderSpec& spec) {
      spec.samples.reset();
      spec.passes = report.passes;
      spec.adaptive = report.adaptive;
    });
  }
  static Change samples(int count, bool adaptive = false) {
    return [=](RenderSpec& spec) {
      spec.samples = count;
      spec.adaptive = adaptive;
    };
  }

  TilePool pool_{3};
  std::shared_ptr<const CompiledScene> scene_;
  View view_;
};

TEST_F(Refine, SamplesThatAreAddedGiveTheBytesOfTheWhole) {
  const auto whole = render(samples(16));
  for (const int first : {1, 3, 8, 12}) {
    const auto source = render(samples(first));
    const auto refined = render(samples(16), from(*source));
    EXPECT_EQ(refined->image()->rgb, whole->image()->rgb) << first;
    EXPECT_EQ(refined->progress().spp, 16);
    const RenderReport report = refined->report(), before = source->report();
    ASSERT_GT(report.points.size(), before.points.size());
    for (size_t i = 0; i < before.points.size(); ++i)
      EXPECT_EQ(report.points[i].elapsed_ms, before.points[i].elapsed_ms);
    // Rays are counted on, and time goes on.
    const ReportPoint last = report.points.back(), all = whole->report().points.back();
    EXPECT_EQ(last.rays.total(), all.rays.total()) << first;
    EXPECT_EQ(last.truncation_bound, all.truncation_bound);
    EXPECT_GT(last.elapsed_ms, before.points.back().elapsed_ms);
    EXPECT_EQ(replay(report)->image()->rgb, whole->image()->rgb);
  }
}

TEST_F(Refine, TheErrorToldIsThatOfTheWhole) {
  const auto whole = render(samples(16)), refined = render(samples(16), from(*render(samples(8))));
  const ErrorSummary a = whole->report().points.back().error, b = refined->report().points.back().error;
  EXPECT_EQ(a.rmse, b.rmse);
  EXPECT_EQ(a.high, b.high);
  EXPECT_EQ(a.most, b.most);
  EXPECT_EQ(*whole->error_bounds(), *refined->error_bounds());
}

// What the error map remembers of earlier passes decides where samples go, so it has to come along.
TEST_F(Refine, SamplesThatFollowTheErrorReplayFromTheReport) {
  const auto source = render(samples(12, true));
  const auto once = render(samples(30, true), from(*source));
  const auto twice = render(
      [](RenderSpec& spec) {
        spec.rmse = 0.03;
        spec.samples = 4096;
        spec.adaptive = true;
      },
      from(*once));
  EXPECT_EQ(replay(once->report())->image()->rgb, once->image()->rgb);
  const auto again = replay(twice->report());
  EXPECT_EQ(again->image()->rgb, twice->image()->rgb);
  EXPECT_EQ(again->report().points.back().rays.total(), twice->report().points.back().rays.total());
  EXPECT_EQ(twice->report().stop, "rmse");
  EXPECT_LE(twice->report().points.back().error.high, 0.03);
}

TEST_F(Refine, ManyGoOnFromOneFilmAtOnceAndLeaveItAsItWas) {
  const auto source = render(samples(8));
  const auto cancelled = start(samples(1'000'000), from(*source));
  const auto a = start(samples(12), from(*source)), b = start(samples(16), from(*source));
  cancelled->cancel();
  for (const auto& each : {a, b, cancelled}) EXPECT_TRUE(each->wait_ms(60'000));
  EXPECT_EQ(cancelled->exposed_film(), nullptr);
  EXPECT_EQ(a->image()->rgb, render(samples(12))->image()->rgb);
  EXPECT_EQ(b->image()->rgb, render(samples(16))->image()->rgb);
  EXPECT_EQ(render(samples(10), from(*source))->image()->rgb, render(samples(10))->image()->rgb);
}

TEST_F(Refine, WithoutTheFilmThePassesAreRenderedOnceMore) {
  const auto source = render(samples(12, true));
  const auto with = render(samples(30, true), from(*source));
  const auto without = render(samples(30, true), from(*source, false));
  EXPECT_EQ(without->image()->rgb, with->image()->rgb);
  EXPECT_EQ(without->report().passes, with->report().passes);
  const auto a = with->report().points, b = without->report().points;
  ASSERT_EQ(a.size(), b.size());
  EXPECT_EQ(a.back().rays.total(), b.back().rays.total());
  EXPECT_EQ(b[0].elapsed_ms, source->report().points[0].elapsed_ms) << "its times are those of the first";
}

// The clock ends the source wherever it happens to be, also in the middle of a pass.
TEST_F(Refine, AfterTheTimeRuleItReplaysExactly) {
  const auto for_time = [](double ms) {
    return [=](RenderSpec& spec) {
      spec.samples = 1'000'000;
      spec.adaptive = true;
      spec.time_ms = ms;
    };
  };
  for (int i = 0; i < 8; ++i) {
    const auto source = render(for_time(15.0 + i));
    const auto refined = render(for_time(40.0), from(*source, i % 2 == 0));
    EXPECT_EQ(refined->report().stop, "time");
    EXPECT_GE(refined->report().points.size(), source->report().points.size());
    EXPECT_EQ(replay(refined->report())->image()->rgb, refined->image()->rgb) << i;
  }
}

TEST_F(Refine, ARuleThatIsMetEndsItAtOnceWithTheSamePicture) {
  const auto source = render(samples(16));
  const RenderReport report = source->report();
  RenderSpec spec = view_.render;
  spec.samples = 16;
  EXPECT_EQ(rule_met(spec, report), "samples");
  EXPECT_EQ(render(samples(16), from(*source))->image(), source->image());
  EXPECT_EQ(render(samples(16), from(*source))->report().passes, report.passes);
  spec.samples = 17;
  EXPECT_EQ(rule_met(spec, report), "");
  spec.rmse = report.points.back().error.high * 1.01;
  EXPECT_EQ(rule_met(spec, report), "rmse");
  spec.rmse = report.points.back().error.high * 0.99;
  EXPECT_EQ(rule_met(spec, report), "");
}

TEST(PassSchedule, TakesThePassesBeforeFirstWhateverTheRules) {
  RenderSpec spec;
  spec.samples = 8;
  spec.time_ms = 10.0;
  const PassSchedule schedule(spec, {1.0, 3.0});
  EXPECT_EQ(schedule.next({.elapsed_ms = 99.0}).samples, 1.0);
  EXPECT_EQ(schedule.next({.passes = 1, .spp = 1.0, .elapsed_ms = 99.0}).samples, 3.0);
  EXPECT_EQ(schedule.next({.passes = 2, .spp = 4.0, .elapsed_ms = 99.0}).stop, "time");
  EXPECT_EQ(schedule.next({.passes = 2, .spp = 4.0, .elapsed_ms = 0.0, .ms_per_sample = 0.1}).samples, 4.0);
}

}  // namespace
}  // namespace tilelight
