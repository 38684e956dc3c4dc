// SPDX-License-Identifier: Apache-2.0
// The error of a render as clients see it: stop rules, headers, reports and the layer of errors.
#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/renderer.h"
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

std::string ball(const std::string& rules, int width = 64, int height = 48) {
  return R"({"objects": [{"type": "sphere"}, {"type": "plane", "point": [0, -1, 0]}], "image": {"width": )" +
         std::to_string(width) + R"(, "height": )" + std::to_string(height) + R"(}, "render": {)" + rules + "}}";
}

class Accuracy : public ::testing::Test {
 protected:
  // The finished job's own document.
  Json render(const std::string& body) {
    const HttpAnswer accepted = service_.post("/v1/renders", body, {{"Prefer", "respond-async"}});
    EXPECT_EQ(accepted.status, 202) << accepted.body;
    const std::string path = accepted.header("location");
    for (int i = 0; i < 100; ++i) {
      const Json job = Json::parse(service_.get(path, {{"Prefer", "wait=30"}}).body);
      if (job.at("state") == "done") return job;
    }
    ADD_FAILURE() << "no end";
    return {};
  }

  Service service_;
};

TEST_F(Accuracy, ARenderStopsOnceItsErrorIsAsAsked) {
  const Json job = render(ball(R"("rmse": 0.004)"));
  const Json report = job.at("report");
  EXPECT_EQ(report.at("stop"), "rmse");
  EXPECT_EQ(report.at("adaptive"), true);
  const Json last = report.at("points").back();
  EXPECT_LE(last.at("rmse_ci95").at(1), 0.004);
  EXPECT_GT(last.at("rmse"), 0.0);
  EXPECT_LT(last.at("rmse_ci95").at(0), last.at("rmse"));
  EXPECT_EQ(report.at("points").at(0).at("rmse"), nullptr) << "of one sample nothing is known";
}

// The same scene by the library, without a server, has the image whose hash the server tells.
TEST_F(Accuracy, TheFinalReportSaysWhatWasRenderedAndByWhat) {
  const std::string body = ball(R"("samples": 4, "seed": 7)");
  const Json job = render(body);
  const Json report = Json::parse(service_.get("/v1/renders/" + job.at("id").get<std::string>() + "/report").body);
  const auto parsed = parse_scene(body, Limits{});
  ASSERT_TRUE(parsed);
  TilePool pool(2);
  const auto compiled = compile_scene(parsed->scene, pool);
  const auto render = Render::start(pool, Priority::normal, compiled, plan_view(*compiled, parsed->view));
  ASSERT_TRUE(render->wait_ms(1e12));
  EXPECT_EQ(report.at("image_hash"), image_hash(*render->image()));
  EXPECT_EQ(report.at("scene_sha256"), parsed->scene_id);
  EXPECT_EQ(report.at("seed"), 7);
  EXPECT_EQ(report.at("version").get<std::string>().substr(0, 2), "0.");
  const Json& last = report.at("points").back();
  const double rmse = last.at("rmse"), seconds = 1e-3 * last.at("elapsed_ms").get<double>();
  EXPECT_NEAR(report.at("efficiency").get<double>() * rmse * rmse * seconds, 1.0, 1e-9);
  EXPECT_EQ(report.at("components").at("sampling"), rmse);
  const double rounding = report.at("components").at("rounding");
  EXPECT_GT(rounding, 0.0) << "the film keeps floats";
  EXPECT_LT(rounding, 1e-6);
}

TEST_F(Accuracy, TheReportReplaysItExactly) {
  const Json job = render(ball(R"("rmse": 0.004)"));
  const Json report = job.at("report");
  const Json replayed = render(ball(R"("adaptive": true, "passes": )" + report.at("passes").dump()));
  EXPECT_EQ(replayed.at("report").at("stop"), "passes");
  const auto image_of = [&](const Json& of) {
    return service_.get("/v1/renders/" + of.at("id").get<std::string>() + "/image").body;
  };
  EXPECT_EQ(image_of(job), image_of(replayed));
}

TEST_F(Accuracy, AnImageCarriesItsErrorInItsHeader) {
  const auto info_of = [&](const std::string& rule) {
    const HttpAnswer answer = service_.post("/v1/renders", ball(rule), {{"Accept", "image/png"}});
    EXPECT_EQ(answer.status, 200) << answer.body;
    return answer.header("render-info");
  };
  const std::string by_error = info_of(R"("rmse": 0.004)");
  EXPECT_NE(by_error.find("stop=\"rmse\""), std::string::npos) << by_error;
  EXPECT_NE(by_error.find(", rmse=0.00"), std::string::npos) << by_error;
  // How far it gets in that time, and with it whether an error is known, is the machine's.
  const std::string by_time = info_of(R"("time_ms": 20)");
  EXPECT_NE(by_time.find("stop=\"time\""), std::string::npos) << by_time;
}

TEST_F(Accuracy, TheLayerOfErrorsComesInColoursAndAsNumbers) {
  const Json job = render(ball(R"("samples": 16)"));
  const std::string path = "/v1/renders/" + job.at("id").get<std::string>() + "/image?layer=";
  const HttpAnswer picture = service_.get(path + "color"), map = service_.get(path + "error");
  ASSERT_EQ(map.status, 200) << map.body;
  EXPECT_NE(map.body, picture.body);
  EXPECT_NE(map.header("etag"), picture.header("etag"));
  const HttpAnswer numbers = service_.get(path + "error", {{"Accept", "image/x-exr"}});
  ASSERT_EQ(numbers.status, 200);
  const auto image = decode_linear(numbers.body, ImageFormat::exr, 1 << 20);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 64);
  const float most = *std::max_element(image->rgb.begin(), image->rgb.end());
  EXPECT_NEAR(most, job.at("report").at("points").back().at("est_max").get<double>(), 1e-3 * most);
  EXPECT_EQ(service_.get(path + "depth").status, 400);
}

TEST_F(Accuracy, TheReportComesAsACurve) {
  const Json job = render(ball(R"("samples": 16)"));
  const std::string path = "/v1/renders/" + job.at("id").get<std::string>() + "/report";
  const HttpAnswer curve = service_.get(path, {{"Accept", "image/svg+xml"}});
  EXPECT_EQ(curve.status, 200);
  EXPECT_EQ(curve.header("content-type"), "image/svg+xml");
  EXPECT_EQ(curve.body.substr(0, 5), "<svg ");
  size_t marks = 0;
  for (size_t at = curve.body.find("<circle"); at != std::string::npos; at = curve.body.find("<circle", at + 1))
    ++marks;
  EXPECT_EQ(marks, 4u) << "passes of 1, 1, 2, 4 and 8 samples, of which the first knows nothing";
  const std::string csv = service_.get(path, {{"Accept", "text/csv"}}).body;
  EXPECT_NE(csv.find(",rmse,rmse_low,rmse_high,"), std::string::npos);
}

}  // namespace
}  // namespace tilelight::service
