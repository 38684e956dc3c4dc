// SPDX-License-Identifier: Apache-2.0
// The statistics of a study by closed forms, and a small study whose numbers must hang together.
#include <gtest/gtest.h>

#include <regex>

#include <cmath>
#include <string>

#include "renderer/study/compare.h"
#include "renderer/study/pov_scene.h"
#include "renderer/study/statistics.h"
#include "renderer/study/study.h"

namespace tilelight {
namespace {

TEST(PowerLaws, AreFoundExactlyAndWithTheirDoubt) {
  std::vector<Sample> samples;
  for (const double x : {1.0, 2.0, 4.0, 8.0, 16.0}) samples.push_back({x, 3.0 * std::pow(x, -0.75)});
  const auto exact = fit_power_law(samples);
  ASSERT_TRUE(exact);
  EXPECT_NEAR(exact->slope, -0.75, 1e-12);
  EXPECT_NEAR(exact->high - exact->low, 0.0, 1e-7);
  // Student's interval for a line through ln x = 0, 1, 2 and ln y = 0, 1, 0: slope 0, residual variance 2/3,
  // sum of squares 2, t(0.975; 1) = 12.706.
  const double e = std::exp(1.0);
  const auto loose = fit_power_law({{1.0, 1.0}, {e, e}, {e * e, 1.0}});
  ASSERT_TRUE(loose);
  EXPECT_NEAR(loose->slope, 0.0, 1e-12);
  EXPECT_NEAR(loose->high, 12.706 * std::sqrt((2.0 / 3.0) / 2.0), 1e-9);
  EXPECT_FALSE(fit_power_law({{1.0, 1.0}, {2.0, 1.0}}));
  EXPECT_FALSE(fit_power_law({{1.0, 1.0}, {2.0, 0.0}, {3.0, 1.0}}));
}

// POV-Ray has a rule of its own for a sky along the view.
TEST(PovScenes, SayWhatIsUpWhereTheCameraDoesNot) {
  Scene scene;
  scene.materials.emplace_back();
  scene.objects.emplace_back();
  View view;
  for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
    view.camera = Camera{};
    view.camera->projection = projection;
    view.camera->position = {0, 5, 0};
    EXPECT_TRUE(std::regex_search(pov_scene(scene, view).text, std::regex(R"( up <-?0,-?0,-[0-9.e-]+>)")));
    view.camera->up = {1, 0, 0};
    EXPECT_TRUE(std::regex_search(pov_scene(scene, view).text, std::regex(R"( up <[0-9.e-]+,-?0,-?0>)")));
  }
}

TEST(Curves, AreStraightOnLogarithmicAxes) {
  const std::vector<Sample> curve{{1.0, 1.0}, {100.0, 0.01}};
  EXPECT_NEAR(*on_curve(curve, 10.0), 0.1, 1e-12);
  EXPECT_FALSE(on_curve(curve, 0.5));
  EXPECT_FALSE(on_curve(curve, 101.0));
}

TEST(ParetoFronts, HaveWhatNothingBeats) {
  EXPECT_EQ(pareto_front({{1, 5}, {2, 3}, {3, 4}, {4, 1}, {4, 1}}), (std::vector<bool>{true, true, false, true, true}));
}

TEST(StepsOfAFront, AreTheCheapestForErrorsThatFallByAFactor) {
  // On the front: (1, 8), (2, 5), (3, 4), (5, 2), (9, 1.9); of these 5 is not half of 8, and 1.9 is not half of 2 but
  // last.
  EXPECT_EQ(steps_of_front({{9, 1.9}, {2, 5}, {1, 8}, {5, 2}, {4, 7}, {3, 4}}, 2.0), (std::vector<size_t>{2, 5, 3, 0}));
  EXPECT_EQ(steps_of_front({{1, 0}}, 2.0), std::vector<size_t>{0});
}

TEST(Medians, AreInTheMiddle) {
  EXPECT_EQ(median({3, 1, 2}), 2.0);
  EXPECT_EQ(median({4, 1, 2, 3}), 2.5);
}

constexpr const char* kScene = R"({
  "image": {"width": 32, "height": 24},
  "materials": {"mirror": {"diffuse": 0.2, "reflection": 0.7}},
  "objects": [{"type": "plane", "material": {"diffuse": {"checker": {"size": 0.7}}}},
              {"type": "sphere", "center": [0, 1, 0], "material": "mirror"},
              {"type": "sphere", "center": [2, 1, 0.5], "material": "mirror"}]})";

class SmallStudy : public testing::Test {
 protected:
  static const Study& study() {
    static const Study made = [] {
      TilePool pool(2);
      StudyOptions options;
      options.most_samples = 16, options.rounds = 3;
      return *make_study(*parse_scene(kScene, Limits{}), "small", pool, options);
    }();
    return made;
  }
};

TEST_F(SmallStudy, HasAReferenceThatIsTenTimesAsGood) {
  EXPECT_GT(study().reference_rmse, 0.0);
  EXPECT_LE(study().reference_rmse, 0.1 * study().least_rmse);
}

TEST_F(SmallStudy, SeesTheErrorFallAsTheFieldKnowsIt) {
  const StudySeries& uniform = study().series.front();
  ASSERT_EQ(uniform.runs.size(), 5u);  // 1, 2, 4, 8, 16
  for (size_t i = 1; i < uniform.runs.size(); ++i)
    EXPECT_LT(uniform.runs[i].error.rmse, uniform.runs[i - 1].error.rmse);
  ASSERT_TRUE(uniform.by_samples);
  EXPECT_LT(uniform.by_samples->slope, -0.5);  // better than random
  EXPECT_GT(uniform.by_samples->slope, -1.5);
}

TEST_F(SmallStudy, FindsNoDifferenceBetweenOursAndTheTwinInDouble) {
  const StudySeries &uniform = study().series.front(), &twin = study().series.back();
  ASSERT_EQ(twin.name, "reference renderer");
  EXPECT_NEAR(twin.runs[1].rmse_by_round[0], uniform.runs[2].rmse_by_round[0], 1e-5);  // the same four samples
  EXPECT_LT(study().components.rounding, 1e-4);
}

TEST_F(SmallStudy, KnowsTheQuantisationOfEightBits) {
  EXPECT_NEAR(study().components.quantisation, 1.0 / (255.0 * std::sqrt(12.0)), 2e-4);
}

// The light that a smaller depth leaves untraced is really less than the bound.
TEST_F(SmallStudy, FindsTheTruncationWithinItsBound) {
  int bounded = 0;
  for (const KnobRow& row : study().knobs) {
    if (row.truncation_bound < 0.0 || row.is_exact) continue;
    EXPECT_LE(row.truncation, row.truncation_bound + 1e-9) << row.knob << " " << row.value;
    ++bounded;
  }
  EXPECT_GE(bounded, 8);
  EXPECT_GT(study().knobs.front().truncation, 0.001);  // depth 0: no mirror shows anything
}

TEST_F(SmallStudy, MarksAFront) {
  int marked = 0;
  for (const StudySeries& series : study().series) {
    for (const StudyRun& run : series.runs) marked += run.is_on_front;
  }
  EXPECT_GE(marked, 1);
}

TEST_F(SmallStudy, WritesARowForEveryRun) {
  const std::string csv = study_csv(study());
  size_t runs = 0;
  for (const StudySeries& series : study().series) runs += series.runs.size();
  EXPECT_EQ(static_cast<size_t>(std::count(csv.begin(), csv.end(), '\n')), runs + 1);
}

TEST(AStudy, ShowsTheSweepOfItsPeer) {
  Study study;
  study.series.emplace_back().runs.emplace_back();
  EXPECT_EQ(study_html(study).find("How POV-Ray's settings were chosen"), std::string::npos);
  study.peer_trials = {{"+AM2 +A0.030 +R3 -J +BM2", 2.5, 100.0, 180.0, 0.0125, true}};
  const std::string page = study_html(study), json = study_json(study);
  EXPECT_NE(page.find("How POV-Ray's settings were chosen"), std::string::npos);
  EXPECT_NE(page.find("+AM2 +A0.030 +R3 -J +BM2"), std::string::npos);
  EXPECT_NE(json.find("\"cpu_ms\": 180.0"), std::string::npos);
}

// A study's reference is the whole light model, whatever the scene asks for: by rays at a sample a pixel no mirror
// may be missing.
TEST(AStudy, SetsEveryMethodBesideTheWholeLight) {
  TilePool pool(2);
  StudyOptions options;
  options.most_samples = 8, options.rounds = 3;
  auto parsed = *parse_scene(kScene, Limits{});
  parsed.view.image.width = 16, parsed.view.image.height = 12;
  parsed.view.render.algorithm = Algorithm::zbuffer;
  const auto study = make_study(parsed, "by a depth buffer", pool, options);
  ASSERT_TRUE(study);
  const auto finest = [&](const std::string& method) {
    for (const StudySeries& series : study->series)
      if (series.method == method && series.shading == "phong") return series.runs.back().error.rmse;
    return -1.0;
  };
  EXPECT_LT(finest("raytrace"), 0.5 * finest("zbuffer"));
}

TEST(AStudy, CanBeCancelled) {
  TilePool pool(2);
  StudyOptions options;
  int asked = 0;
  options.is_cancelled = [&asked] { return ++asked > 3; };
  EXPECT_FALSE(make_study(*parse_scene(kScene, Limits{}), "small", pool, options));
}

TEST(Comparisons, FindWarnockAndZbufferEqualAndBothLikeRays) {
  const auto parsed = parse_scene(kScene, Limits{});
  ASSERT_TRUE(parsed);
  TilePool pool(2);
  CompareOptions options;
  options.samples = 2, options.rounds = 1, options.reference_samples = 8;
  options.methods = {Algorithm::raytrace, Algorithm::zbuffer, Algorithm::warnock};
  const auto made = compare_methods(*parsed, "scene", pool, options);
  ASSERT_TRUE(made);
  ASSERT_EQ(made->rows.size(), 9u);
  for (int shading = 0; shading < 3; ++shading) {
    const CompareRow &rays = made->rows[shading], &zbuffer = made->rows[3 + shading],
                     &warnock = made->rows[6 + shading];
    EXPECT_EQ(zbuffer.image->rgb, warnock.image->rgb);
    EXPECT_EQ(zbuffer.shading, rays.shading);
    ASSERT_TRUE(zbuffer.to_rays);
    EXPECT_LE(zbuffer.to_rays->part, 0.03) << "a small picture, much of it edges";
    EXPECT_FALSE(rays.to_rays);
    EXPECT_EQ(zbuffer.rays.reflected, 0);
    EXPECT_GT(rays.rays.reflected, 0);
  }
  EXPECT_LT(made->rows[2].error.rmse, made->rows[5].error.rmse) << "rays alone see mirrors";

  ASSERT_EQ(made->works.size(), 2u);
  const auto count = [&](size_t work, const std::string& name) {
    for (const auto& c : made->works[work].work.counts)
      if (c.name == name) return c.value;
    ADD_FAILURE() << name;
    return 0.0;
  };
  const double pixels = 32.0 * 24.0;
  EXPECT_GE(count(0, "coverings of samples"), 0.4 * pixels) << "the floor is half the picture";
  // Every cut makes two to four windows of one; what is not divided is settled or decided.
  const double windows = count(1, "windows looked at"), divided = count(1, "windows divided");
  EXPECT_EQ(windows, divided + count(1, "windows empty") + count(1, "windows of one primitive") +
                         count(1, "windows surrounded") + count(1, "pixels decided one by one"));
  EXPECT_LE(windows - 1.0, 4.0 * divided);
  EXPECT_LE(count(1, "deepest subdivision"), 5.0) << "log2 32";

  const std::string page = comparison_html(*made), numbers = comparison_json(*made);
  for (const char* file :
       {"reference.png", "zbuffer-flat.png", "warnock-phong-off.png", "zbuffer-gouraud-rays.png", "warnock-work.png"})
    EXPECT_NE(page.find(file), std::string::npos) << file;
  EXPECT_NE(numbers.find("\"differing_part\""), std::string::npos);
}

}  // namespace
}  // namespace tilelight
