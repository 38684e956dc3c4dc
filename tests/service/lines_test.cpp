// SPDX-License-Identifier: Apache-2.0
// Line drawings as SVG: wherever an image is served, of pictures by roberts, and of no others.
#include <map>
#include <regex>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using Lines = ServiceTest;

const Fields kSvg = {{"Accept", "image/svg+xml"}};

// How often each element comes, if the text is XML without entities, comments and the like; else nothing.
std::optional<std::map<std::string, int>> xml_elements(const std::string& text) {
  static const std::regex kTag(
      R"re(<(/?)([A-Za-z][\w-]*)((?:\s+[A-Za-z][\w:-]*="[^"<&]*")*)\s*(/?)>|[^<&>\s]+|[<&>])re");
  std::map<std::string, int> counts;
  std::vector<std::string> open;
  int roots = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), kTag), end; it != end; ++it) {
    const std::smatch& tag = *it;
    if (!tag[2].matched) return std::nullopt;  // text between the elements: ours have none
    if (tag[1].length() != 0) {
      if (open.empty() || open.back() != tag[2] || tag[3].length() != 0 || tag[4].length() != 0) return std::nullopt;
      open.pop_back();
      continue;
    }
    roots += open.empty() ? 1 : 0;
    ++counts[tag[2]];
    if (tag[4].length() == 0) open.push_back(tag[2]);
  }
  return open.empty() && roots == 1 ? std::optional(counts) : std::nullopt;
}

std::string wrapped(const std::string& scene, const std::string& more) {
  return R"({"scene": )" + scene + ", " + more + "}";
}

void expect_code(const HttpAnswer& answer, int status, const std::string& code) {
  EXPECT_EQ(answer.status, status) << answer.body;
  EXPECT_EQ(Json::parse(answer.body, nullptr, false).value("type", ""), "urn:tilelight:problem:" + code);
}

// Of the one error of a body that is not valid.
void expect_pointer(const HttpAnswer& answer, const std::string& pointer) {
  ASSERT_EQ(answer.status, 422) << answer.body;
  const Json errors = Json::parse(answer.body).at("errors");
  ASSERT_EQ(errors.size(), 1u) << answer.body;
  EXPECT_EQ(errors[0].at("pointer"), pointer);
  EXPECT_EQ(errors[0].at("allowed"), Json({"png", "jpeg", "exr"}));
}

TEST_F(Lines, APostWithAcceptSvgIsAnsweredWithTheLines) {
  const auto answer = service_->post("/v1/renders", line_scene(), kSvg);
  ASSERT_EQ(answer.status, 200) << answer.body;
  EXPECT_EQ(answer.header("content-type"), "image/svg+xml");
  EXPECT_EQ(answer.header("vary"), "Accept");
  EXPECT_FALSE(answer.header("etag").empty());
  EXPECT_NE(answer.header("render-info").find("spp=2"), std::string::npos);
  EXPECT_NE(answer.body.find("viewBox=\"0 0 48 32\""), std::string::npos) << answer.body;
  auto elements = xml_elements(answer.body);
  ASSERT_TRUE(elements) << answer.body;
  EXPECT_EQ((*elements)["path"], 2) << "six edges of the box are its outline and three are before it";
  const auto all = service_->post("/v1/renders", line_scene(R"(, "samples": 2, "hidden_lines": true)"), kSvg);
  elements = xml_elements(all.body);
  ASSERT_TRUE(elements) << all.body;
  EXPECT_EQ((*elements)["path"], 3) << "and three are behind it";
}

TEST_F(Lines, AnSvgMayRunAndFetchNothing) {
  const auto answer = service_->post("/v1/renders", line_scene(), kSvg);
  EXPECT_EQ(answer.header("content-security-policy"), "default-src 'none'; sandbox");
  EXPECT_EQ(answer.header("x-content-type-options"), "nosniff");
  EXPECT_EQ(answer.body.find("script"), std::string::npos);
  EXPECT_EQ(answer.body.find("style="), std::string::npos) << "which the policy would not let through";
}

TEST_F(Lines, AJobHasItsPictureInPixelsAndInLines) {
  const auto waited = service_->post("/v1/renders", line_scene(), kSvg);
  const std::string image = service_->post("/v1/renders", line_scene()).header("location") + "/image";
  service_->wait_for_end(image.substr(0, image.rfind('/')));
  const auto svg = service_->get(image, kSvg);
  EXPECT_EQ(svg.body, waited.body);
  EXPECT_EQ(svg.header("etag"), waited.header("etag"));
  EXPECT_NE(svg.header("cache-control").find("immutable"), std::string::npos);
  const auto again = service_->get(image, {{"Accept", "image/svg+xml"}, {"If-None-Match", svg.header("etag")}});
  EXPECT_EQ(again.status, 304);
  EXPECT_EQ(again.header("etag"), svg.header("etag"));
  const auto png = service_->get(image);
  EXPECT_EQ(png_size(png.body), std::pair(48, 32));
  EXPECT_NE(png.header("etag"), svg.header("etag"));
}

TEST_F(Lines, TheFormatSvgOfAJobIsThatOfItsImageAndOfItsRefining) {
  const std::string job = service_->post("/v1/renders", wrapped(line_scene(), R"("format": "svg")")).header("location");
  EXPECT_EQ(service_->wait_for_end(job).value("format", ""), "svg");
  const auto svg = service_->get(job + "/image");
  EXPECT_EQ(svg.header("content-type"), "image/svg+xml");
  const std::string refined = service_->post(job + "/refine", R"({"samples": 8})").header("location");
  EXPECT_EQ(service_->wait_for_end(refined).value("state", ""), "done");
  EXPECT_EQ(service_->get(refined + "/image").body, svg.body) << "samples change no line";
  EXPECT_EQ(service_->get(job + "/image", {{"Accept", "image/jpeg"}}).header("content-type"), "image/jpeg");
}

TEST_F(Lines, OfAStoredSceneAreCachedByATagOfTheirOwn) {
  const std::string scene = service_->post("/v1/scenes", line_scene()).header("location");
  const auto svg = service_->get(scene + "/image?samples=1", kSvg), png = service_->get(scene + "/image?samples=1");
  ASSERT_EQ(svg.status, 200) << svg.body;
  EXPECT_EQ(svg.body, service_->post("/v1/renders", line_scene(), kSvg).body);
  EXPECT_EQ(png.header("content-type"), "image/png");
  EXPECT_NE(svg.header("etag"), png.header("etag"));
  EXPECT_EQ(
      service_->get(scene + "/image?samples=1", {{"Accept", "image/svg+xml"}, {"If-None-Match", svg.header("etag")}})
          .status,
      304);
  const std::string other = service_->post("/v1/scenes", small_scene()).header("location");
  expect_code(service_->get(other + "/image", kSvg), 406, "not_acceptable");
}

TEST_F(Lines, AreCompleteFromTheFirstPassOn) {
  const auto scene = [](const std::string& samples) {
    return wrapped(line_scene(), R"("image": {"width": 640, "height": 400}, "render": {"samples": )" + samples + "}");
  };
  const std::string job = service_->post("/v1/renders", scene("4096")).header("location");
  while (Json::parse(service_->get(job, {{"Prefer", "wait=30"}}).body).at("progress").at("spp") < 1) {
  }
  const auto partial = service_->get(job + "/image?partial=1", kSvg);
  EXPECT_EQ(partial.status, 200);
  EXPECT_EQ(partial.header("cache-control"), "no-store");
  EXPECT_EQ(partial.body, service_->post("/v1/renders", scene("1"), kSvg).body);
  ask(service_->port(), "DELETE", job);
}

TEST_F(Lines, OtherAlgorithmsHaveNoneToServe) {
  expect_code(service_->post("/v1/renders", small_scene(), kSvg), 406, "not_acceptable");
  const auto png = service_->post("/v1/renders", small_scene(), {{"Accept", "image/svg+xml, image/png;q=0.5"}});
  EXPECT_EQ(png.header("content-type"), "image/png");
  const auto accepted =
      service_->post("/v1/renders", small_scene(), {{"Accept", "image/svg+xml, application/json;q=0.5"}});
  ASSERT_EQ(accepted.status, 202) << accepted.body;
  const std::string job = accepted.header("location");
  service_->wait_for_end(job);
  expect_code(service_->get(job + "/image", kSvg), 406, "not_acceptable");
  expect_pointer(service_->post("/v1/renders", wrapped(small_scene(), R"("format": "svg")")), "/format");
  expect_pointer(service_->post(job + "/refine", R"({"samples": 8, "format": "svg"})"), "/format");
}

TEST_F(Lines, AnIdempotencyKeyIsNotSpentOnLinesThatThereAreNot) {
  const auto with_key = [](const char* accept) { return Fields{{"Accept", accept}, {"Idempotency-Key", "lines"}}; };
  expect_code(service_->post("/v1/renders", small_scene(), with_key("image/svg+xml")), 406, "not_acceptable");
  const auto first = service_->post("/v1/renders", line_scene(), with_key("application/json"));
  ASSERT_EQ(first.status, 202) << first.body;
  const auto retry = service_->post("/v1/renders", line_scene(), with_key("image/svg+xml"));
  EXPECT_EQ(retry.header("content-type"), "image/svg+xml");
}

TEST_F(Lines, TheErrorByPixelAndFramesHaveNone) {
  const std::string job = service_->post("/v1/renders", wrapped(line_scene(), R"("format": "svg")")).header("location");
  service_->wait_for_end(job);
  expect_code(service_->get(job + "/image?layer=error", kSvg), 406, "not_acceptable");
  EXPECT_EQ(png_size(service_->get(job + "/image?layer=error").body), std::pair(48, 32));
  const std::string session = service_->post("/v1/sessions", line_scene()).header("location");
  expect_code(service_->get(session + "/frame", kSvg), 406, "not_acceptable");
  EXPECT_EQ(png_size(service_->get(session + "/frame").body), std::pair(48, 32));
}

}  // namespace
}  // namespace tilelight::service
