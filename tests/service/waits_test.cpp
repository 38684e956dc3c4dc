// SPDX-License-Identifier: Apache-2.0
// How long requests wait at most, so that no proxy gives up on them.
#include <set>
#include <thread>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

server::Config waiting_at_most(int seconds) {
  server::Config config;
  config.max_wait_s = seconds;
  return config;
}

TEST(Waits, ARenderThatIsNotReadyIsAJobAfterTheLongestWait) {
  Service own(waiting_at_most(1));
  for (const char* prefer : {"wait=60", "wait=2", "wait=1", ""}) {
    const auto answer = own.post("/v1/renders", endless_scene(), {{"Accept", "image/png"}, {"Prefer", prefer}});
    EXPECT_EQ(answer.status, 202) << prefer;
    EXPECT_EQ(answer.header("preference-applied"), *prefer ? "wait=1" : "") << prefer;
    EXPECT_EQ(Json::parse(own.get(answer.header("location")).body).at("state"), "running") << prefer;
  }
  const auto shorter = own.post("/v1/renders", endless_scene(), {{"Accept", "image/png"}, {"Prefer", "wait=0"}});
  EXPECT_EQ(shorter.header("preference-applied"), "wait=0");
}

TEST(Waits, AllWhoseWaitEndsHaveAJobOfTheirOwnAndTheRenderGoesOn) {
  Service own(waiting_at_most(1));
  std::vector<HttpAnswer> answers(8);
  std::vector<std::thread> clients;
  for (HttpAnswer& answer : answers) {
    clients.emplace_back([&] { answer = own.post("/v1/renders", endless_scene(), {{"Accept", "image/png"}}); });
  }
  for (std::thread& client : clients) client.join();
  std::set<std::string> locations;
  for (const HttpAnswer& answer : answers) {
    EXPECT_EQ(answer.status, 202);
    locations.insert(answer.header("location"));
    EXPECT_EQ(Json::parse(own.get(answer.header("location")).body).at("state"), "running");
  }
  EXPECT_EQ(locations.size(), answers.size());
  EXPECT_EQ(own.metric("tilelight_renders_total{state=\"cancelled\"}"), 0);
}

TEST(Waits, ARefinementThatIsNotReadyIsAJobToo) {
  Service own(waiting_at_most(1));
  const std::string scene = R"({"image": {"width": 1024, "height": 1024}, "render": {"samples": 1},
                                "objects": [{"type": "chess_position"}]})";
  const std::string source = own.post("/v1/renders", scene).header("location");
  ASSERT_EQ(own.wait_for_end(source).at("state"), "done");
  const auto refined =
      own.post(source + "/refine", R"({"samples": 4096})", {{"Accept", "image/png"}, {"Prefer", "wait=60"}});
  EXPECT_EQ(refined.status, 202);
  EXPECT_EQ(refined.header("preference-applied"), "wait=1");
  ask(own.port(), "DELETE", refined.header("location"));
}

TEST(Waits, ASceneThatTakesLongToCompileIsAskedForAgainAndIsThereThen) {
  Service own(waiting_at_most(0));
  // Half a million triangles and more: their tree is not there at once.
  const auto large = [](const char* detail) {
    return R"({"objects": [{"type": "chess_position", "detail": )" + std::string(detail) + "}]}";
  };
  for (const auto& [path, scene] : {std::pair("/v1/plan", large("90")), std::pair("/v1/sessions", large("91"))}) {
    HttpAnswer answer;
    int refusals = 0;
    do {
      answer = own.post(path, scene);
      if (answer.status == 503) {
        ++refusals;
        EXPECT_EQ(Json::parse(answer.body).at("type"), "urn:tilelight:problem:compiling");
        EXPECT_NE(answer.header("retry-after"), "");
      }
    } while (answer.status == 503);
    EXPECT_LT(answer.status, 300) << answer.body;
    EXPECT_GT(refusals, 0) << path;
  }
  EXPECT_EQ(own.app().metrics().value("tilelight_scene_cache_total", "result=\"miss\""), 2) << "it went on meanwhile";
}

TEST(Waits, TheLongestIsSaidInTheLimits) {
  EXPECT_EQ(Json::parse(Service().get("/v1/limits").body).at("server").at("max_wait_s"), 40)
      << "HAProxy of Debian gives up after 50 seconds, nginx and Varnish after 60";
  EXPECT_EQ(Json::parse(Service(waiting_at_most(7)).get("/v1/limits").body).at("server").at("max_wait_s"), 7);
}

}  // namespace
}  // namespace tilelight::service
