// SPDX-License-Identifier: Apache-2.0
// Overrides merged key by key over a view.
#include <gtest/gtest.h>

#include "scene_support.h"

namespace tilelight {
namespace {

View base_view() {
  return test::parsed(test::scene_of(R"({"type": "sphere"})", R"(
    "camera": {"position": [4, 5, 9.1], "target": [0, 0.1, 0], "fov_y_deg": 35},
    "image": {"width": 640, "exposure": 0.3}, "render": {"seed": 4294967295, "weight_cutoff": 0.1},)"))
      .view;
}

View merged(std::string_view text, const View& base = base_view()) {
  auto view = parse_view(text, base, Limits{});
  if (view) return *view;
  ADD_FAILURE() << test::listed(view.error().errors);
  return {};
}

SceneErrors refused(std::string_view text, const View& base = base_view()) {
  auto view = parse_view(text, base, Limits{});
  EXPECT_FALSE(view);
  return view ? SceneErrors{} : view.error();
}

TEST(ParseView, KeepsTheBaseWhereNothingIsSaid) {
  const View view = merged("{}");
  EXPECT_EQ(view.camera->position, Vec3(4, 5, 9.1));
  EXPECT_EQ(view.camera->fov_y_deg, 35.0);
  EXPECT_EQ(view.image.width, 640);
  EXPECT_EQ(view.image.height, 720);
  EXPECT_EQ(view.image.exposure, 0.3);
  EXPECT_EQ(view.render.seed, 4294967295u);
  EXPECT_EQ(view.render.weight_cutoff, 0.1);
  EXPECT_EQ(view.render.samples, 16);
}

TEST(ParseView, ChangesOneKeyAndNoOther) {
  const View view = merged(R"({"camera": {"target": [1, 1, 1]}, "image": {"height": 480}})");
  EXPECT_EQ(view.camera->target, Vec3(1, 1, 1));
  EXPECT_EQ(view.camera->position, Vec3(4, 5, 9.1));
  EXPECT_EQ(view.camera->fov_y_deg, 35.0);
  EXPECT_EQ(view.image.width, 640);
  EXPECT_EQ(view.image.height, 480);
}

TEST(ParseView, TakesNullAsTheDefault) {
  const View view = merged(R"({"camera": null, "image": {"width": null}, "render": {"seed": null}})");
  EXPECT_FALSE(view.camera);
  EXPECT_EQ(view.image.width, 1280);
  EXPECT_EQ(view.image.exposure, 0.3);
  EXPECT_EQ(view.render.seed, 0u);
}

TEST(ParseView, ChangesTheLensWithTheType) {
  const View flat = merged(R"({"camera": {"type": "orthographic", "height": 3}})");
  EXPECT_EQ(flat.camera->projection, Projection::orthographic);
  EXPECT_EQ(flat.camera->height, 3.0);
  EXPECT_EQ(flat.camera->position, Vec3(4, 5, 9.1));
  const View deep = merged(R"({"camera": {"type": "perspective"}})", flat);
  EXPECT_EQ(deep.camera->projection, Projection::perspective);
  EXPECT_EQ(deep.camera->fov_y_deg, 40.0);
}

TEST(ParseView, ResolvesStopRulesOfTheMergedView) {
  EXPECT_EQ(merged(R"({"render": {"time_ms": 500}})").render.samples, Limits{}.samples);
  const View timed = merged(R"({"render": {"time_ms": 500}})");
  EXPECT_EQ(merged(R"({"render": {"samples": 8}})", timed).render.samples, 8);
  EXPECT_EQ(merged(R"({"render": {"samples": 8}})", timed).render.time_ms, 500.0);
  EXPECT_EQ(merged(R"({"render": {"time_ms": null}})", timed).render.samples, 16);
  View by_hand;
  by_hand.render.samples = 64;
  EXPECT_EQ(merged(R"({"render": {"time_ms": 500}})", by_hand).render.samples, 64);
}

TEST(ParseView, FramesWithoutACameraUntilOneIsGiven) {
  View framed = base_view();
  framed.camera.reset();
  EXPECT_FALSE(merged(R"({"image": {"width": 10}})", framed).camera);
  EXPECT_EQ(merged(R"({"camera": {"position": [1, 2, 3]}})", framed).camera->position, Vec3(1, 2, 3));
  EXPECT_EQ(refused(R"({"camera": {"fov_y_deg": 30}})", framed).errors[0].code, "missing_key");
}

TEST(ParseView, RefusesWithPointersIntoTheOverrides) {
  const SceneErrors errors = refused("{\n\"camera\": {\"fov_y_deg\": 200},\n\"imag\": {}, \"objects\": []}");
  ASSERT_EQ(errors.errors.size(), 3u) << test::listed(errors.errors);
  EXPECT_EQ(errors.errors[0].pointer, "/camera/fov_y_deg");
  EXPECT_EQ(errors.errors[0].line, 2);
  EXPECT_EQ(errors.errors[0].column, 25);
  EXPECT_EQ(errors.errors[1].pointer, "/imag");
  EXPECT_EQ(errors.errors[2].code, "unknown_key");
  EXPECT_EQ(refused(R"({"camera": {"position": [0, 0.1, 0]}})").errors[0].code, "out_of_range");  // the base's target
  EXPECT_EQ(refused(R"({"camera": {"target": [4, 5, 9.1]}})").errors[0].line, 0);                 // the base's position
  EXPECT_EQ(refused(R"({"image": 3})").errors[0].code, "wrong_type");
  EXPECT_EQ(refused(R"([1])").errors[0].code, "wrong_type");
  EXPECT_EQ(refused(R"({"image": {"width": 1, "width": 2}})").errors[0].code, "duplicate_key");
  EXPECT_EQ(refused(R"({"image": {"width": 1e400}})").errors[0].pointer, "/image/width");
  EXPECT_EQ(refused("{").kind, SceneErrors::Kind::not_json);
}

}  // namespace
}  // namespace tilelight
