// SPDX-License-Identifier: Apache-2.0
// What POV-Ray is shown of a scene, by POV-Ray itself: what the table calls exact it draws as we do; what it draws
// otherwise is named.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <set>
#include <sstream>
#include <thread>

#include <nlohmann/json.hpp>

#include "renderer/measure/image_error.h"
#include "renderer/scene/grammar.h"
#include "renderer/scene/parse.h"
#include "renderer/study/pov_features.h"
#include "renderer/study/pov_scene.h"
#include "renderer/study/povray_run.h"
#include "tests/unit/pov_cases.h"

namespace tilelight {
namespace {

using Json = nlohmann::json;

ParsedScene parsed(const PovCase& test) {
  Json document = Json::parse(kPlainPovScene);
  document.merge_patch(Json::parse(test.document));
  auto scene = parse_scene(document.dump(), Limits{});
  if (!scene) throw std::runtime_error(test.what + ": " + scene.error().errors[0].detail + document.dump());
  return *scene;
}

// Throws std::exception where it cannot be parsed.
struct Framed {
  explicit Framed(const PovCase& test) : scene(parsed(test)), pool(1), compiled(compile_scene(scene.scene, pool)) {
    view = plan_view(*compiled, scene.view).view;
    pov = pov_scene(scene.scene, view);
  }
  ParsedScene scene;
  TilePool pool;
  std::shared_ptr<const CompiledScene> compiled;
  View view;
  PovScene pov;
};

const PovFeature* find_feature(const std::string& name) {
  for (const PovFeature& feature : pov_features())
    if (feature.name == name) return &feature;
  return nullptr;
}

void collect_keys(const Rule& rule, std::set<std::string>& keys);
void collect_keys(const Record& record, std::set<std::string>& keys) {
  for (const Field& field : record.fields) {
    if (!keys.insert(std::string(record.name) + "." + std::string(field.key)).second) continue;
    collect_keys(field.rule, keys);
  }
}
void collect_keys(const Rule& rule, std::set<std::string>& keys) {
  for (const Rule& option : rule.options) collect_keys(option, keys);
  for (const auto& record : rule.records) collect_keys(*record, keys);
}

TEST(TheTableOfPovRay, NamesEveryPropertyOfTheSceneLanguage) {
  std::set<std::string> of_language, of_table;
  collect_keys(scene_grammar(Limits{}), of_language);
  for (const PovFeature& feature : pov_features()) {
    std::istringstream keys{std::string(feature.keys)};
    for (std::string key; keys >> key;) of_table.insert(key);
  }
  for (const std::string& key : of_language) EXPECT_TRUE(of_table.contains(key)) << key << " has no row";
  for (const std::string& key : of_table) EXPECT_TRUE(of_language.contains(key)) << key << " is no property";
}

TEST(TheTableOfPovRay, HasASceneForEveryRow) {
  std::set<std::string> covered;
  for (const PovCase& test : pov_cases()) {
    covered.insert(test.feature);
    EXPECT_TRUE(find_feature(test.feature)) << test.feature;
  }
  for (const PovFeature& feature : pov_features()) {
    EXPECT_TRUE(covered.contains(std::string(feature.name))) << feature.name;
    EXPECT_EQ(feature.support == PovSupport::exact, feature.difference.empty()) << feature.name;
  }
}

TEST(NotesOnPovRay, NameWhatItDrawsOtherwiseAndNothingElse) {
  for (const PovCase& test : pov_cases()) {
    const auto notes = Framed(test).pov.differences;
    const PovFeature& feature = *find_feature(test.feature);
    if (feature.support == PovSupport::exact) {
      EXPECT_TRUE(notes.empty()) << test.feature << ", " << test.what << ": " << notes.front();
      continue;
    }
    const bool is_named = std::any_of(notes.begin(), notes.end(),
                                      [&](const std::string& note) { return note.starts_with(test.feature + ": "); });
    EXPECT_TRUE(is_named) << test.feature << ", " << test.what << ": " << notes.size() << " notes";
  }
}

class PovRayItself : public testing::Test {
 protected:
  void SetUp() override {
    if (!study::is_povray_installed()) GTEST_SKIP() << "POV-Ray is not installed (Debian: apt install povray)";
  }
};

// Of displayed values: rms between POV-Ray's picture and ours, both of very many samples.
double rms_to_povray(const PovCase& test) {
  Framed framed(test);
  const study::PovRay povray(framed.pov, framed.view.image, 1);
  const auto theirs = povray.draw({.method = 1, .threshold = 0.0, .depth = study::kPovMostDepth}).image;
  const StudyOptions options;
  const study::Studio studio(framed.pool, options);
  const auto ours = studio.draw(framed.compiled, study::with_samples(framed.view, 256, false)).image;
  const double exposure = framed.view.image.exposure;
  return rms_difference(displayed_image(*theirs, exposure), displayed_image(*ours, exposure));
}

TEST_F(PovRayItself, DrawsAsWeDoWhatTheTableCallsExact) {
  const std::vector<PovCase> cases = pov_cases();
  struct Result {
    double rms = -1.0;
    std::string failure;
  };
  std::vector<Result> results(cases.size());
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t i = next++; i < cases.size(); i = next++) {
      try {
        results[i].rms = rms_to_povray(cases[i]);
      } catch (const std::exception& error) {
        results[i].failure = error.what();
      }
    }
  };
  {
    std::vector<std::jthread> threads;  // POV-Ray sleeps for most of a small picture
    for (int i = 0; i < 4; ++i) threads.emplace_back(work);
  }
  constexpr double kAlike = 0.003;
  for (size_t i = 0; i < cases.size(); ++i) {
    const PovFeature& feature = *find_feature(cases[i].feature);
    const bool is_exact = feature.support == PovSupport::exact;
    std::printf("%s %.4f  %s: %s\n", is_exact ? "exact" : "noted", results[i].rms, cases[i].feature.c_str(),
                cases[i].what.c_str());
    EXPECT_EQ(results[i].failure, "") << cases[i].what;
    if (is_exact) {
      EXPECT_LE(results[i].rms, kAlike) << cases[i].feature << ": " << cases[i].what;
    }
  }
}

TEST_F(PovRayItself, CountsEveryRayFromTheEye) {
  const PovCase plain{"", "", "{}"};
  Framed framed(plain);
  const study::PovRay povray(framed.pov, framed.view.image, 1);
  EXPECT_EQ(povray.draw({}).spp, 1.0);
  // 48 x 36 pixels in blocks of 32 x 32: one ray a pixel and one more for each pixel above and to the left of the four
  // blocks; nine more in every pixel.
  const double border = 2 * 48 + 2 * 36;
  EXPECT_NEAR(povray.draw({.method = 1, .threshold = 0.0, .depth = 3}).spp, 10.0 + border / (48.0 * 36.0), 0.03);
}

}  // namespace
}  // namespace tilelight
