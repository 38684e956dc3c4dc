// SPDX-License-Identifier: Apache-2.0
// Renders that go on from done ones: the same bytes as one render, as long as the film is kept.
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

std::string ball(const std::string& rules, int width = 64, int height = 48) {
  return R"({"objects": [{"type": "sphere"}, {"type": "plane", "point": [0, -1, 0]}], "image": {"width": )" +
         std::to_string(width) + R"(, "height": )" + std::to_string(height) + R"(}, "render": {)" + rules + "}}";
}

std::string problem_of(const HttpAnswer& answer) {
  const std::string type = Json::parse(answer.body).value("type", "");
  return std::to_string(answer.status) + " " + type.substr(type.rfind(':') + 1);
}

Json first_error(const HttpAnswer& answer) { return Json::parse(answer.body).at("errors").at(0); }

std::string location_of(const Json& job) { return "/v1/renders/" + job.at("id").get<std::string>(); }

class Refine : public ::testing::Test {
 protected:
  // The done job that answers the request.
  Json done(const HttpAnswer& accepted) {
    EXPECT_EQ(accepted.status, 202) << accepted.body;
    const Json job = service_.wait_for_end(accepted.header("location"));
    EXPECT_EQ(job.at("state"), "done") << job;
    return job;
  }
  Json render(const std::string& body) { return done(service_.post("/v1/renders", body)); }
  HttpAnswer ask_refine(const Json& job, const std::string& body, Fields fields = {}) {
    return service_.post(location_of(job) + "/refine", body, std::move(fields));
  }
  Json refine(const Json& job, const std::string& body) { return done(ask_refine(job, body)); }
  HttpAnswer image(const Json& job) { return service_.get(location_of(job) + "/image"); }
  // The passes of the job's report, once more.
  Json replay(const Json& job) {
    const Json report = job.at("report");
    return render(
        ball(R"("adaptive": )" + report.at("adaptive").dump() + R"(, "passes": )" + report.at("passes").dump()));
  }

  Service service_;
};

TEST_F(Refine, SixtyFourThenTo128AreThePictureOf128) {
  const Json whole = render(ball(R"("samples": 128)")), source = render(ball(R"("samples": 64)"));
  const HttpAnswer accepted = ask_refine(source, R"({"samples": 128})");
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  EXPECT_FALSE(accepted.header("retry-after").empty());
  EXPECT_NE(accepted.header("location"), location_of(source)) << "a new render";
  const Json refined = done(accepted);
  EXPECT_EQ(refined.at("refines"), source.at("id"));
  EXPECT_EQ(source.at("refines"), nullptr);
  EXPECT_EQ(image(refined).body, image(whole).body);
  EXPECT_EQ(image(refined).header("etag"), image(whole).header("etag"));
  EXPECT_NE(image(source).body, image(whole).body);
  EXPECT_EQ(refined.at("progress").at("spp"), 128);
  const Json report = refined.at("report"), before = source.at("report");
  EXPECT_EQ(report.at("passes"), whole.at("report").at("passes"));
  const Json points = report.at("points");
  ASSERT_EQ(points.size(), before.at("points").size() + 1);
  for (size_t i = 0; i < before.at("points").size(); ++i) EXPECT_EQ(points.at(i), before.at("points").at(i));
  EXPECT_EQ(points.back().at("rays"), whole.at("report").at("points").back().at("rays"));
  EXPECT_EQ(points.back().at("rmse"), whole.at("report").at("points").back().at("rmse"));
}

TEST_F(Refine, ARefinedRenderIsRefinedAndEachReplaysFromItsReport) {
  const Json source = render(ball(R"("rmse": 0.02)"));
  const Json better = refine(source, R"({"rmse": 0.003})"), best = refine(better, R"({"rmse": 0.002, "samples": 500})");
  EXPECT_EQ(best.at("report").at("stop"), "rmse");
  EXPECT_LE(best.at("report").at("points").back().at("rmse_ci95").at(1), 0.002);
  for (const Json& job : {better, best}) EXPECT_EQ(image(replay(job)).body, image(job).body);
}

TEST_F(Refine, TimeIsThatOfWhatIsAddedWhereverTheClockStoppedTheSource) {
  for (const int ms : {11, 17, 25, 40}) {
    const Json source = render(ball(R"("time_ms": )" + std::to_string(ms)));
    const Json refined = refine(source, R"({"time_ms": 60})");
    EXPECT_EQ(refined.at("report").at("stop"), "time");
    EXPECT_GE(refined.at("progress").at("spp"), source.at("progress").at("spp"));
    EXPECT_EQ(image(replay(refined)).body, image(refined).body) << ms;
  }
}

TEST_F(Refine, AnImageThatIsWaitedForComesAtOnceAndIsNoJob) {
  const Json source = render(ball(R"("samples": 4)"));
  const HttpAnswer waited = ask_refine(source, R"({"samples": 8})", {{"Accept", "image/png"}});
  ASSERT_EQ(waited.status, 200) << waited.body;
  EXPECT_NE(waited.header("render-info").find("spp=8, stop=\"samples\""), std::string::npos);
  EXPECT_EQ(waited.body, image(render(ball(R"("samples": 8)"))).body);
}

TEST_F(Refine, WhatLeavesNothingToDoIsRefusedAndSaysWhatWouldNot) {
  const Json source = render(ball(R"("samples": 16)"));
  const HttpAnswer same = ask_refine(source, R"({"samples": 16})");
  EXPECT_EQ(same.status, 422);
  const Json error = first_error(same);
  EXPECT_EQ(error.at("pointer"), "/samples");
  EXPECT_EQ(error.at("code"), "already_reached");
  EXPECT_NE(error.at("hint").get<std::string>().find("ask for 32"), std::string::npos) << error;
  EXPECT_FALSE(error.at("allowed").empty());
  EXPECT_EQ(first_error(ask_refine(source, R"({"samples": 99, "rmse": 0.5})")).at("pointer"), "/rmse");
  EXPECT_EQ(first_error(ask_refine(source, R"({"time_ms": 1})")).at("pointer"), "/time_ms");
}

TEST_F(Refine, WhatIsNotUnderstoodIsRefusedWithItsPlace) {
  const Json source = render(ball(R"("samples": 2)"));
  const auto refused = [&](const std::string& body) {
    const HttpAnswer answer = ask_refine(source, body);
    return std::to_string(answer.status) + " " + first_error(answer).at("pointer").get<std::string>() + " " +
           first_error(answer).at("code").get<std::string>();
  };
  EXPECT_EQ(refused("{}"), "422  missing_key");
  EXPECT_EQ(refused(R"({"samples": 0})").substr(0, 12), "422 /samples");
  EXPECT_EQ(refused(R"({"samples": "8"})").substr(0, 12), "422 /samples");
  EXPECT_EQ(refused(R"({"samples": 1000000})").substr(0, 12), "422 /samples");
  EXPECT_EQ(refused(R"({"rmse": 0})").substr(0, 9), "422 /rmse");
  EXPECT_EQ(refused(R"({"time_ms": -1})").substr(0, 12), "422 /time_ms");
  EXPECT_EQ(refused(R"({"samples": 8, "seed": 1})"), "422 /seed unknown_key");
  EXPECT_EQ(refused(R"({"samples": 8, "priority": "interactive"})"), "422 /priority unknown_name");
  EXPECT_EQ(ask_refine(source, "[8]").status, 422);
  EXPECT_EQ(problem_of(ask_refine(source, R"({"samples": 8)")), "400 not_json");
  const HttpAnswer broken = ask_refine(source, R"({"samples": 8x})");
  EXPECT_EQ(problem_of(broken), "400 not_json");
  EXPECT_GE(first_error(broken).at("column"), 13) << "where the client wrote it";
  EXPECT_LE(first_error(broken).at("column"), 15);
}

TEST_F(Refine, OnlyADoneRenderIsRefined) {
  EXPECT_EQ(problem_of(service_.post("/v1/renders/none/refine", R"({"samples": 8})")), "404 no_such_render");
  const std::string running = service_.post("/v1/renders", endless_scene()).header("location");
  EXPECT_EQ(problem_of(service_.post(running + "/refine", R"({"samples": 8})")), "409 not_ready");
  EXPECT_EQ(ask(service_.port(), "DELETE", running).status, 204);
  EXPECT_EQ(problem_of(service_.post(running + "/refine", R"({"samples": 8})")), "404 no_such_render");
  const HttpAnswer read = service_.get(running + "/refine");
  EXPECT_EQ(read.status, 405);
  EXPECT_EQ(read.header("allow"), "POST, OPTIONS");
}

TEST_F(Refine, AFilmIsKeptForSomeMinutes) {
  const Json source = render(ball(R"("samples": 2)")), other = render(ball(R"("samples": 3)"));
  const double keep_ms =
      1000.0 * Json::parse(service_.get("/v1/limits").body).at("server").at("film_keep_s").get<int>();
  // Bytes a pixel: its samples, and 27 of image and error.
  EXPECT_TRUE(service_.metric_reaches("tilelight_films_bytes", 64 * 48 * (2 * 12 + 3 * 12 + 2 * 27)));
  service_.clock().advance_ms(keep_ms - 1.0);
  const Json refined = refine(source, R"({"samples": 4})");
  service_.clock().advance_ms(1.0);
  for (const Json& job : {source, other}) EXPECT_EQ(problem_of(ask_refine(job, R"({"samples": 8})")), "410 expired");
  EXPECT_EQ(image(source).status, 200) << "the image is kept longer";
  EXPECT_EQ(refine(refined, R"({"samples": 8})").at("progress").at("spp"), 8) << "its own film is younger";
}

TEST_F(Refine, TheOldestFilmsMakeRoomForTheNext) {
  server::Config config;
  config.films_mb = 1;
  Service own(config);
  const auto end = [&](const HttpAnswer& answer) { return own.wait_for_end(answer.header("location")); };
  // 96 bytes of samples a pixel and as much as a third of that beside them: 0.7 MB, and one that never fits.
  const Json first = end(own.post("/v1/renders", ball(R"("samples": 8)", 80, 64))),
             second = end(own.post("/v1/renders", ball(R"("samples": 9)", 80, 64))),
             large = end(own.post("/v1/renders", ball(R"("samples": 8)", 160, 128)));
  const auto status = [&](const Json& job) {
    return own.post(location_of(job) + "/refine", R"({"samples": 64, "priority": "normal"})").status;
  };
  EXPECT_EQ(status(first), 410);
  EXPECT_EQ(status(large), 410);
  EXPECT_EQ(status(second), 202);
  EXPECT_LT(own.metric("tilelight_films_bytes"), 1 << 20);
}

TEST_F(Refine, WithoutABudgetForFilmsNothingIsRefined) {
  server::Config config;
  config.films_mb = 0;
  Service own(config);
  const Json job = own.wait_for_end(own.post("/v1/renders", small_scene()).header("location"));
  EXPECT_EQ(problem_of(own.post(location_of(job) + "/refine", R"({"samples": 8})")), "410 expired");
}

TEST_F(Refine, ManyAtOnceLeaveTheSourceAsItWas) {
  const Json source = render(ball(R"("samples": 2)", 128, 96));
  const server::Metrics& metrics = service_.app().metrics();
  const HttpAnswer endless = ask_refine(source, R"({"samples": 4096})"),
                   joined = ask_refine(source, R"({"samples": 4096})");
  EXPECT_NE(endless.header("location"), joined.header("location"));
  EXPECT_EQ(metrics.value("tilelight_renders_shared_total", ""), 1) << "the same of the same is one work";
  const HttpAnswer a = ask_refine(source, R"({"samples": 4, "priority": "normal"})"),
                   b = ask_refine(source, R"({"samples": 8, "priority": "normal"})");
  EXPECT_EQ(image(done(a)).body, image(render(ball(R"("samples": 4)", 128, 96))).body);
  EXPECT_EQ(image(done(b)).body, image(render(ball(R"("samples": 8)", 128, 96))).body);
  for (const HttpAnswer& each : {endless, joined})
    EXPECT_EQ(ask(service_.port(), "DELETE", each.header("location")).status, 204);
  EXPECT_TRUE(service_.metric_reaches("tilelight_renders_total{state=\"cancelled\"}", 1));
  EXPECT_EQ(image(refine(source, R"({"samples": 6})")).body, image(render(ball(R"("samples": 6)", 128, 96))).body);
}

TEST_F(Refine, TheSourceMayGoWhileItIsRefined) {
  const Json source = render(ball(R"("samples": 2)"));
  // It waits behind two that do not end, and by then the film is gone.
  std::vector<std::string> ahead;
  for (int seed = 0; seed < 2; ++seed)
    ahead.push_back(service_.post("/v1/renders", endless_scene(seed)).header("location"));
  const HttpAnswer accepted = ask_refine(source, R"({"samples": 8})");
  EXPECT_EQ(ask(service_.port(), "DELETE", location_of(source)).status, 204);
  for (const std::string& location : ahead) ask(service_.port(), "DELETE", location);
  EXPECT_EQ(image(done(accepted)).body, image(render(ball(R"("samples": 8)"))).body);
}

TEST_F(Refine, AnIdempotencyKeyFindsTheJobOfTheFirstTry) {
  const Json source = render(ball(R"("samples": 2)")), other = render(ball(R"("samples": 3)"));
  const Fields key = {{"Idempotency-Key", "k"}};
  const std::string first = ask_refine(source, R"({"samples": 8})", key).header("location");
  EXPECT_EQ(ask_refine(source, R"({"samples": 8})", key).header("location"), first);
  EXPECT_EQ(problem_of(ask_refine(source, R"({"samples": 9})", key)), "422 idempotency_key_reused");
  EXPECT_EQ(problem_of(ask_refine(other, R"({"samples": 8})", key)), "422 idempotency_key_reused");
  service_.wait_for_end(first);
  service_.clock().advance_ms(600'000.0);
  EXPECT_EQ(ask_refine(source, R"({"samples": 8})", key).header("location"), first) << "also once the film is gone";
}

}  // namespace
}  // namespace tilelight::service
