// SPDX-License-Identifier: Apache-2.0
// Scenes stored once, planned and pictured often.
#include "server/jobs/kept_pictures.h"
#include "server/jobs/render_work.h"
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using Scenes = ServiceTest;

std::string store(const Service& service, const std::string& scene) {
  return Json::parse(service.post("/v1/scenes", scene).body).at("id");
}

TEST_F(Scenes, ASceneIsStoredUnderTheHashOfWhatItMeans) {
  const auto first = service_->post("/v1/scenes", R"({"objects": [{"type": "sphere", "radius": 2}]})");
  EXPECT_EQ(first.status, 201);
  const std::string id = Json::parse(first.body).at("id");
  EXPECT_EQ(first.header("location"), "/v1/scenes/" + id);
  const auto again = service_->post("/v1/scenes", R"({"objects":[{"radius":2.0,"type":"sphere"}]})");
  EXPECT_EQ(again.status, 200);
  EXPECT_EQ(Json::parse(again.body).at("id"), id);
  const auto scene = service_->get("/v1/scenes/" + id);
  EXPECT_EQ(Json::parse(scene.body).at("objects").at(0).at("radius"), 2);
  EXPECT_EQ(service_->get("/v1/scenes/" + id, {{"If-None-Match", scene.header("etag")}}).status, 304);
  EXPECT_EQ(service_->get("/v1/scenes/0123").status, 404);
}

TEST_F(Scenes, AStoredSceneIsRenderedByItsIdWithAnotherView) {
  const std::string id = store(*service_, small_scene());
  const auto picture = service_->post(
      "/v1/renders", R"({"scene": ")" + id + R"(", "image": {"width": 24, "height": 18}})", {{"Accept", "image/png"}});
  ASSERT_EQ(picture.status, 200) << picture.body;
  EXPECT_EQ(png_size(picture.body), std::pair(24, 18));
}

TEST_F(Scenes, AnOverrideOfTheViewIsTheSameAsWritingItIntoTheScene) {
  const std::string id = store(*service_, small_scene());
  const std::string camera = R"("camera": {"position": [4,5,9], "target": [0,0.5,0], "fov_y_deg": 30})";
  const auto wrapped =
      service_->post("/v1/renders", R"({"scene": ")" + id + "\", " + camera + "}", {{"Accept", "image/png"}});
  const auto written =
      service_->post("/v1/renders", "{" + camera + ", " + small_scene().substr(1), {{"Accept", "image/png"}});
  const auto queried = service_->get("/v1/scenes/" + id + "/image?position=4,5,9&target=0,0.5,0&fov_y_deg=30");
  ASSERT_EQ(wrapped.status, 200) << wrapped.body;
  ASSERT_EQ(queried.status, 200) << queried.body;
  EXPECT_EQ(wrapped.body, written.body);
  EXPECT_EQ(queried.body, written.body);
}

TEST_F(Scenes, APicturesTagIsKnownBeforeItIsRendered) {
  const std::string id = store(*service_, small_scene());
  const std::string path = "/v1/scenes/" + id + "/image?width=40&height=30&samples=1";
  const auto picture = service_->get(path, {{"Accept", "image/avif,image/webp,image/png,*/*;q=0.8"}});
  ASSERT_EQ(picture.status, 200) << picture.body;
  EXPECT_EQ(png_size(picture.body), std::pair(40, 30));
  EXPECT_EQ(picture.header("cache-control"), "public, max-age=31536000, immutable");
  EXPECT_EQ(picture.header("vary"), "Accept");
  const double before = service_->app().metrics().value("tilelight_renders_total", "state=\"done\"");
  for (const std::string& tags : {picture.header("etag"), "W/" + picture.header("etag"),
                                  "\"a,b\", W/\"c\"," + picture.header("etag"), std::string("*")}) {
    const auto same = service_->get(path, {{"If-None-Match", tags}});
    EXPECT_EQ(same.status, 304) << tags;
    EXPECT_EQ(same.header("etag"), picture.header("etag"));
    EXPECT_EQ(same.header("cache-control"), picture.header("cache-control"));
  }
  EXPECT_EQ(service_->app().metrics().value("tilelight_renders_total", "state=\"done\""), before)
      << "nothing was rendered";
  EXPECT_NE(service_->get(path + "&exposure=1").header("etag"), picture.header("etag"));
}

TEST_F(Scenes, AnAddressMayNameTheFormatAndThenAcceptIsNotLookedAt) {
  const std::string id = store(*service_, small_scene(77));
  const std::string path = "/v1/scenes/" + id + "/image?width=16&height=12&samples=1";
  const auto jpeg = service_->get(path + "&format=jpeg", {{"Accept", "image/png"}});
  ASSERT_EQ(jpeg.status, 200) << jpeg.body;
  EXPECT_EQ(jpeg.header("content-type"), "image/jpeg");
  EXPECT_EQ(jpeg.header("vary"), "") << "one copy for everybody";
  const auto accepted = service_->get(path, {{"Accept", "image/jpeg"}});
  EXPECT_EQ(accepted.body, jpeg.body);
  EXPECT_EQ(accepted.header("etag"), jpeg.header("etag"));
  EXPECT_NE(service_->get(path).header("etag"), jpeg.header("etag"));
  for (const char* format : {"svg", "gif", "", "png&format=jpeg"}) {
    const auto refused = service_->get(path + "&format=" + format);
    EXPECT_EQ(refused.status, 422) << format;
    EXPECT_EQ(Json::parse(refused.body).at("errors").at(0).at("pointer"), "/format") << format;
    EXPECT_EQ(refused.header("cache-control"), "no-store");
  }
}

TEST_F(Scenes, APictureIsRenderedOnceHoweverOftenItIsAskedForWhileThereIsRoom) {
  Service own;
  const auto renders = [&] { return own.app().metrics().value("tilelight_renders_total", "state=\"done\""); };
  const std::string path = "/v1/scenes/" + store(own, small_scene()) + "/image";
  const auto first = own.get(path, {{"Prefer", "wait=20"}});
  EXPECT_EQ(first.header("preference-applied"), "") << "a cache would tell it to everybody";
  for (const char* accept : {"*/*", "image/*", "image/avif,image/webp,image/*;q=0.8"}) {
    const auto again = own.get(path, {{"Accept", accept}});
    EXPECT_EQ(again.body, first.body);
    EXPECT_EQ(again.header("render-info"), first.header("render-info"));
  }
  EXPECT_EQ(renders(), 1);
  server::KeptPictures pictures(2000);
  const auto picture = [](size_t bytes) { return server::KeptPicture{server::tagged(std::string(bytes, 'x')), ""}; };
  for (const char* etag : {"a", "b"}) pictures.put(etag, picture(400));
  EXPECT_TRUE(pictures.find("a")) << "used again";
  pictures.put("c", picture(400));
  EXPECT_FALSE(pictures.find("b")) << "the one that was not used for longest";
  EXPECT_TRUE(pictures.find("a") && pictures.find("c"));
  pictures.put("d", picture(4000));
  EXPECT_FALSE(pictures.find("d")) << "larger than all the room";
  EXPECT_TRUE(pictures.find("a") && pictures.find("c")) << "nor does it drive out the others";
}

TEST_F(Scenes, ABadQueryIs422WithAPointerIntoTheView) {
  const std::string id = store(*service_, small_scene());
  const auto pointer_of = [&](const std::string& query) {
    const auto answer = service_->get("/v1/scenes/" + id + "/image?" + query);
    EXPECT_EQ(answer.status, 422) << query << answer.body;
    return Json::parse(answer.body).at("errors").at(0).at("pointer").get<std::string>();
  };
  EXPECT_EQ(pointer_of("width=0"), "/image/width");
  EXPECT_EQ(pointer_of("position=1,2"), "/camera/position");
  EXPECT_EQ(pointer_of("position=1,2,x"), "/camera/position");
  EXPECT_EQ(pointer_of("widht=10"), "/widht");
  EXPECT_EQ(pointer_of("width=1%2C%22height%22%3A3"), "/image/width") << "no JSON through a query";
}

TEST_F(Scenes, AScenesThatStopsByTimeHasNoCacheablePicture) {
  const std::string id = store(*service_, R"({"render": {"time_ms": 10}, "objects": [{"type": "sphere"}]})");
  EXPECT_EQ(service_->get("/v1/scenes/" + id + "/image").status, 422);
}

TEST_F(Scenes, APlanSaysWhatAViewNeedsWithoutRendering) {
  const double before = service_->app().metrics().value("tilelight_renders_total", "state=\"done\"");
  const auto answer = service_->post("/v1/plan", small_scene());
  ASSERT_EQ(answer.status, 200) << answer.body;
  const Json document = Json::parse(answer.body);
  EXPECT_EQ(document.at("plan").at("bodies"), 2);
  EXPECT_GT(document.at("predicted").at("mrays"), 0.0);
  const Json& predicted = document.at("predicted");
  EXPECT_GT(predicted.at("elapsed_ms"), 0.0);
  EXPECT_LE(predicted.at("elapsed_ci95_ms").at(0), predicted.at("elapsed_ms"));
  EXPECT_GE(predicted.at("elapsed_ci95_ms").at(1), predicted.at("elapsed_ms"));
  EXPECT_GT(predicted.at("rmse"), 0.0);
  EXPECT_LT(predicted.at("rmse_ci95").at(0), predicted.at("rmse_ci95").at(1));
  EXPECT_EQ(document.at("camera").at("type"), "perspective");
  EXPECT_EQ(document.at("camera").at("position").size(), 3);
  EXPECT_EQ(document.at("scene").get<std::string>().size(), 64);
  EXPECT_EQ(service_->app().metrics().value("tilelight_renders_total", "state=\"done\""), before);
  const std::string id = store(*service_, small_scene());
  EXPECT_EQ(Json::parse(service_->get("/v1/scenes/" + id + "/plan").body).at("plan").at("bodies"), 2);
}

TEST_F(Scenes, ASceneIsCompiledOnceForAllItsViews) {
  Service own;
  const std::string id = store(own, small_scene());
  for (int width = 10; width < 15; ++width) {
    ASSERT_EQ(own.get("/v1/scenes/" + id + "/image?height=8&width=" + std::to_string(width)).status, 200);
  }
  EXPECT_EQ(own.app().metrics().value("tilelight_scene_cache_total", "result=\"miss\""), 1);
  EXPECT_EQ(own.app().metrics().value("tilelight_scene_cache_total", "result=\"hit\""), 4);
}

}  // namespace
}  // namespace tilelight::service
