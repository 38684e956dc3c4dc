// SPDX-License-Identifier: Apache-2.0
// Renders over real sockets: waited for, as jobs, shared, cancelled, refused.
#include <thread>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using Renders = ServiceTest;

const Fields kPng = {{"Accept", "image/png"}};

TEST_F(Renders, APostWithAcceptPngWaitsAndAnswersWithThePicture) {
  const auto answer = service_->post("/v1/renders", small_scene(), kPng);
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.header("content-type"), "image/png");
  EXPECT_EQ(png_size(answer.body), std::pair(48, 32));
  EXPECT_FALSE(answer.header("etag").empty());
  EXPECT_NE(answer.header("render-info").find("spp=2, stop=\"samples\""), std::string::npos)
      << answer.header("render-info");
  for (const char* step : {"parse", "queue", "compile", "render", "encode"}) {
    EXPECT_NE(answer.header("server-timing").find(std::string(step) + ";dur="), std::string::npos) << step;
  }
}

TEST_F(Renders, AJobGivesTheSameBytesAsTheWait) {
  const auto waited = service_->post("/v1/renders", small_scene(1), kPng);
  const auto accepted = service_->post("/v1/renders", small_scene(1));
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  EXPECT_FALSE(accepted.header("retry-after").empty());
  const std::string location = accepted.header("location");
  const Json status = service_->wait_for_end(location);
  ASSERT_EQ(status.at("state"), "done") << status;
  EXPECT_EQ(status.at("progress").at("spp"), 2);
  EXPECT_EQ(status.at("image_url"), location + "/image");
  EXPECT_TRUE(status.at("plan").contains("features"));
  EXPECT_TRUE(status.at("report").is_object());
  const auto image = service_->get(location + "/image");
  EXPECT_EQ(image.status, 200);
  EXPECT_EQ(image.body, waited.body);
  EXPECT_EQ(image.header("etag"), waited.header("etag"));
  EXPECT_NE(image.header("cache-control").find("immutable"), std::string::npos);
}

TEST_F(Renders, AKnownEntityTagIsAnswered304WithoutABody) {
  const std::string location = service_->post("/v1/renders", small_scene(2)).header("location");
  service_->wait_for_end(location);
  const auto image = service_->get(location + "/image");
  const auto again = service_->get(location + "/image", {{"If-None-Match", image.header("etag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.header("etag"), image.header("etag"));
  EXPECT_EQ(again.header("content-length"), "");
  const auto status = service_->get(location);
  EXPECT_EQ(service_->get(location, {{"If-None-Match", status.header("etag")}}).status, 304);
}

TEST_F(Renders, AcceptChoosesTheFormat) {
  const std::string location = service_->post("/v1/renders", small_scene(3)).header("location");
  service_->wait_for_end(location);
  EXPECT_EQ(service_->get(location + "/image").header("content-type"), "image/png");
  EXPECT_EQ(service_->get(location + "/image", {{"Accept", "image/jpeg"}}).header("content-type"), "image/jpeg");
  EXPECT_EQ(service_->get(location + "/image", {{"Accept", "image/png;q=0.1, image/x-exr"}}).body.substr(0, 4),
            "\x76\x2f\x31\x01");  // OpenEXR's magic number
  EXPECT_EQ(service_->get(location + "/image", {{"Accept", "image/webp"}}).status, 406);
  EXPECT_EQ(service_->post("/v1/renders", small_scene(3), {{"Accept", "text/html"}}).status, 406);
}

TEST_F(Renders, DeletingARunningJobStopsItsWork) {
  const auto accepted = service_->post("/v1/renders", endless_scene(1));
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::string location = accepted.header("location");
  ASSERT_TRUE(service_->metric_reaches("tilelight_renders_running", 1));
  const double before = service_->app().metrics().value("tilelight_renders_total", "state=\"cancelled\"");
  EXPECT_EQ(ask(service_->port(), "DELETE", location).status, 204);
  EXPECT_EQ(service_->get(location).status, 404);
  EXPECT_EQ(ask(service_->port(), "DELETE", location).status, 404);
  EXPECT_TRUE(service_->metric_reaches("tilelight_renders_total{state=\"cancelled\"}", before + 1));
  // The pool is idle again: a small render gets through.
  EXPECT_EQ(service_->post("/v1/renders", small_scene(4), kPng).status, 200);
}

TEST_F(Renders, AClientThatLeavesWhileItWaitsCancelsItsRender) {
  const double before = service_->app().metrics().value("tilelight_renders_total", "state=\"cancelled\"");
  {
    HttpClient client(service_->port());
    const std::string scene = endless_scene(2);
    client.write(
        "POST /v1/renders HTTP/1.1\r\nHost: localhost\r\nAccept: image/png\r\nContent-Type: application/json\r\n"
        "Content-Length: " +
        std::to_string(scene.size()) + "\r\n\r\n" + scene);
    ASSERT_TRUE(service_->metric_reaches("tilelight_renders_running", 1));
  }
  EXPECT_TRUE(service_->metric_reaches("tilelight_renders_total{state=\"cancelled\"}", before + 1));
}

TEST_F(Renders, IdenticalRendersInFlightAreOneUntilTheLastHolderLeaves) {
  const server::Metrics& metrics = service_->app().metrics();
  const double shared = metrics.value("tilelight_renders_shared_total", "");
  const double cancelled = metrics.value("tilelight_renders_total", "state=\"cancelled\"");
  const std::string first = service_->post("/v1/renders", endless_scene(3)).header("location");
  const std::string second = service_->post("/v1/renders", endless_scene(3)).header("location");
  EXPECT_NE(first, second);
  EXPECT_EQ(metrics.value("tilelight_renders_shared_total", ""), shared + 1);
  ask(service_->port(), "DELETE", first);
  EXPECT_EQ(Json::parse(service_->get(second).body).at("state"), "running");
  EXPECT_EQ(metrics.value("tilelight_renders_total", "state=\"cancelled\""), cancelled);
  ask(service_->port(), "DELETE", second);
  EXPECT_TRUE(service_->metric_reaches("tilelight_renders_total{state=\"cancelled\"}", cancelled + 1));
}

TEST_F(Renders, AWaitThatRunsOutBecomesAJob) {
  const auto answer =
      service_->post("/v1/renders", endless_scene(4), {{"Accept", "image/png"}, {"Prefer", "wait=0.05"}});
  ASSERT_EQ(answer.status, 202);
  EXPECT_FALSE(answer.header("preference-applied").empty());
  const std::string location = answer.header("location");
  const auto image = service_->get(location + "/image");
  EXPECT_EQ(image.status, 409);
  EXPECT_EQ(Json::parse(image.body).at("type"), "urn:tilelight:problem:not_ready");
  ask(service_->port(), "DELETE", location);
}

TEST_F(Renders, TheBestSoFarCanBeSeenWhileARenderRuns) {
  const std::string scene =
      R"({"scene": )" + small_scene() + R"(, "image": {"width": 320, "height": 200}, "render": {"samples": 4096}})";
  const auto accepted = service_->post("/v1/renders", scene);
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::string location = accepted.header("location");
  Json status;
  do {
    status = Json::parse(service_->get(location, {{"Prefer", "wait=30"}}).body);
  } while (status.at("progress").at("spp") < 1);
  const auto partial = service_->get(location + "/image?partial=1");
  EXPECT_EQ(partial.status, 200);
  EXPECT_EQ(png_size(partial.body), std::pair(320, 200));
  ask(service_->port(), "DELETE", location);
}

TEST_F(Renders, AnIdempotencyKeyFindsTheJobOfTheFirstTry) {
  const Fields key = {{"Idempotency-Key", "k1"}};
  const auto first = service_->post("/v1/renders", small_scene(5), key);
  const auto retry = service_->post("/v1/renders", small_scene(5), key);
  ASSERT_EQ(retry.status, 202);
  EXPECT_EQ(retry.header("location"), first.header("location"));
  EXPECT_EQ(service_->post("/v1/renders", small_scene(6), key).status, 422);
  service_->clock().advance_ms(25 * 3600 * 1000.0);  // a key lives for a day
  EXPECT_EQ(service_->post("/v1/renders", small_scene(6), key).status, 202);
}

TEST_F(Renders, AnIdempotencyKeyWhoseJobWasDeletedMakesANewOne) {
  const Fields key = {{"Idempotency-Key", "k2"}};
  const std::string first = service_->post("/v1/renders", small_scene(10), key).header("location");
  ASSERT_EQ(ask(service_->port(), "DELETE", first).status, 204);
  const std::string second = service_->post("/v1/renders", small_scene(10), key).header("location");
  EXPECT_NE(second, first);
  EXPECT_EQ(service_->wait_for_end(second).value("state", ""), "done");
  EXPECT_EQ(service_->post("/v1/renders", small_scene(10), key).header("location"), second);
}

TEST_F(Renders, AnIdempotencyKeyIsNotSpentOnARequestThatWasRefused) {
  const Fields key = {{"Idempotency-Key", "k3"}};
  ASSERT_EQ(service_->post("/v1/renders", R"({"objects": [{"type": "spher"}]})", key).status, 422);
  const auto corrected = service_->post("/v1/renders", small_scene(11), key);
  ASSERT_EQ(corrected.status, 202) << corrected.body;
  EXPECT_EQ(service_->post("/v1/renders", small_scene(11), key).header("location"), corrected.header("location"));
}

TEST_F(Renders, TheListIsNewestFirstAndPagesByLink) {
  Service own;
  std::vector<std::string> made;
  for (int seed = 0; seed < 5; ++seed) {
    made.insert(made.begin(), Json::parse(own.post("/v1/renders", small_scene(seed)).body).at("id"));
  }
  std::vector<std::string> listed;
  std::string path = "/v1/renders?limit=2";
  for (int page = 0; page < 3; ++page) {
    const auto answer = own.get(path);
    const Json renders = Json::parse(answer.body).at("renders");
    for (const Json& render : renders) listed.push_back(render.at("id"));
    const std::string link = answer.header("link");
    EXPECT_EQ(link.empty(), page == 2);
    if (link.empty()) break;
    EXPECT_NE(link.find("rel=\"next\""), std::string::npos);
    path = link.substr(1, link.find('>') - 1);
  }
  EXPECT_EQ(listed, made);
  EXPECT_EQ(own.get("/v1/renders?state=odd").status, 400);
}

TEST_F(Renders, AFullQueueAnswers503WithRetryAfter) {
  server::Config config;
  config.max_queue = 1;
  Service own(config);
  std::vector<int> statuses;
  HttpAnswer last;
  // Two batch renders run at once and one may wait.
  for (int seed = 0; seed < 4; ++seed) {
    last = own.post("/v1/renders", endless_scene(seed));
    statuses.push_back(last.status);
  }
  EXPECT_EQ(statuses, (std::vector<int>{202, 202, 202, 503}));
  EXPECT_FALSE(last.header("retry-after").empty());
  EXPECT_EQ(last.header("content-type"), "application/problem+json");
  // Other priorities have lanes of their own, and other requests are answered.
  EXPECT_EQ(own.get("/v1/limits").status, 200);
}

TEST_F(Renders, OldResultsMakeRoomAndTheirImagesAreGone) {
  server::Config config;
  config.max_results = 1;
  Service own(config);
  const std::string first = own.post("/v1/renders", small_scene(0)).header("location");
  own.wait_for_end(first);
  const std::string second = own.post("/v1/renders", small_scene(1)).header("location");
  own.wait_for_end(second);
  EXPECT_EQ(own.get(second + "/image").status, 200);
  EXPECT_EQ(own.get(first + "/image").status, 410);
  EXPECT_EQ(Json::parse(own.get(first).body).at("state"), "done");
}

TEST_F(Renders, TheReportComesAsJsonAndAsCsv) {
  const std::string location = service_->post("/v1/renders", small_scene(7)).header("location");
  service_->wait_for_end(location);
  EXPECT_TRUE(Json::parse(service_->get(location + "/report").body).is_object());
  const auto csv = service_->get(location + "/report", {{"Accept", "text/csv"}});
  EXPECT_EQ(csv.header("content-type"), "text/csv");
  EXPECT_EQ(csv.body.substr(0, 9), "pass,spp,");
  EXPECT_EQ(std::count(csv.body.begin(), csv.body.end(), '\n'), 3);  // the names and passes of 1 and 1 samples
}

TEST_F(Renders, APixelIsExplained) {
  const std::string location = service_->post("/v1/renders", small_scene(8)).header("location");
  service_->wait_for_end(location);
  const auto pixel = service_->get(location + "/pixel?x=24&y=16");
  ASSERT_EQ(pixel.status, 200) << pixel.body;
  EXPECT_TRUE(Json::parse(pixel.body).contains("rays"));
  EXPECT_EQ(service_->get(location + "/pixel?x=48&y=0").status, 422);
  EXPECT_EQ(service_->get(location + "/pixel").status, 422);
}

TEST_F(Renders, ARenderNobodyHasIs404) {
  for (const char* path :
       {"/v1/renders/none", "/v1/renders/none/image", "/v1/renders/none/report", "/v1/renders/none/pixel"}) {
    EXPECT_EQ(service_->get(path).status, 404) << path;
  }
}

}  // namespace
}  // namespace tilelight::service
