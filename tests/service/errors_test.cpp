// SPDX-License-Identifier: Apache-2.0
// Every error is a problem document that says what was found, where, and what is allowed.
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using Errors = ServiceTest;

Json problem_of(const HttpAnswer& answer) {
  EXPECT_EQ(answer.header("content-type"), "application/problem+json") << answer.status;
  const Json problem = Json::parse(answer.body, nullptr, false);
  EXPECT_EQ(problem.at("status"), answer.status);
  for (const char* member : {"type", "title", "detail", "request_id"}) EXPECT_TRUE(problem.contains(member)) << problem;
  return problem;
}

// Whether the server still answers after what was just done to it.
bool is_well(const Service& service) { return service.get("/v1/limits").status == 200; }

TEST_F(Errors, ABadSceneIs422WithEveryErrorAndItsPointer) {
  const auto answer =
      service_->post("/v1/renders", R"({"objects": [{"type": "sphere", "radius": -1}, {"type": "spher"}]})");
  EXPECT_EQ(answer.status, 422);
  const Json problem = problem_of(answer);
  std::set<std::string> pointers;
  for (const Json& error : problem.at("errors")) pointers.insert(error.at("pointer"));
  EXPECT_TRUE(pointers.count("/objects/0/radius")) << problem;
  EXPECT_TRUE(pointers.count("/objects/1/type")) << problem;
}

TEST_F(Errors, TextThatIsNotJsonIs400WithLineAndColumn) {
  const auto answer = service_->post("/v1/renders", "{\"objects\": [\n  {\"type\" \"sphere\"}]}");
  EXPECT_EQ(answer.status, 400);
  const Json error = problem_of(answer).at("errors").at(0);
  EXPECT_EQ(error.at("line"), 2);
  EXPECT_GE(error.at("column"), 10);
}

TEST_F(Errors, PlacesInsideAWrappedSceneAreThoseOfTheBody) {
  const auto answer = service_->post(
      "/v1/renders", "{\"format\": \"png\",\n\"scene\": {\"objects\":\n [{\"type\": \"sphere\", \"radius\": -1}]}}");
  EXPECT_EQ(answer.status, 422);
  const Json error = problem_of(answer).at("errors").at(0);
  EXPECT_EQ(error.at("pointer"), "/scene/objects/0/radius");
  if (error.contains("line")) {
    EXPECT_EQ(error.at("line"), 3);
  }
}

TEST_F(Errors, WhatIsWrongAroundASceneIsSaidAllAtOnce) {
  const auto answer = service_->post("/v1/renders", R"({"scene": "x", "fromat": "png", "priority": "high"})");
  EXPECT_EQ(answer.status, 422);
  const Json problem = problem_of(answer);
  EXPECT_EQ(problem.at("errors").size(), 2) << problem;
  EXPECT_EQ(Json::parse(service_->post("/v1/renders", R"({"scene": "x"})").body).at("errors").at(0).at("code"),
            "unknown_scene");
}

TEST_F(Errors, HostileDocumentsAreRefusedAndDoNoHarm) {
  const std::string deep = std::string(100'000, '[') + std::string(100'000, ']');
  const std::string deep_object = [] {
    std::string text = "{\"objects\": ";
    for (int i = 0; i < 100'000; ++i) text += "{\"a\":";
    return text;
  }();
  const std::pair<const char*, std::string> documents[] = {
      {"deep arrays", deep},
      {"deep arrays in a scene", R"({"objects": )" + deep + "}"},
      {"deep and cut off", deep_object},
      {"nothing", ""},
      {"a number", "7"},
      {"a wrong type", R"({"objects": 7})"},
      {"an empty scene", R"({"objects": []})"},
      {"a duplicate key", R"({"objects": [{"type": "sphere", "radius": 1, "radius": 2}]})"},
      {"a number beyond double", R"({"objects": [{"type": "sphere", "radius": 1e400}]})"},
      {"a huge image", R"({"image": {"width": 1000000, "height": 1000000}, "objects": [{"type": "sphere"}]})"},
      {"an image of nothing", R"({"image": {"width": 0, "height": 0}, "objects": [{"type": "sphere"}]})"},
      {"bytes that are no UTF-8", "{\"objects\": [{\"type\": \"sph\xff\xfe\"}]}"},
      {"a NUL", std::string("{\"objects\": \0}", 14)},
  };
  for (const auto& [name, document] : documents) {
    for (const char* path : {"/v1/renders", "/v1/scenes", "/v1/plan", "/v1/sessions"}) {
      const auto answer = service_->post(path, document, {{"Accept", "*/*"}});
      EXPECT_TRUE(answer.status == 400 || answer.status == 413 || answer.status == 422)
          << name << " " << path << " " << answer.status;
      problem_of(answer);
    }
  }
  EXPECT_TRUE(is_well(*service_));
}

TEST_F(Errors, AWrongMethodIs405AndAllowNamesTheRightOnes) {
  const auto answer = ask(service_->port(), "DELETE", "/v1/renders");
  EXPECT_EQ(answer.status, 405);
  problem_of(answer);
  EXPECT_EQ(answer.header("allow"), "POST, GET, HEAD, OPTIONS");
  EXPECT_EQ(ask(service_->port(), "PATCH", "/v1/sessions/x/view").header("allow"), "PUT, OPTIONS");
  EXPECT_EQ(ask(service_->port(), "PUT", "/").header("allow"), "GET, HEAD, OPTIONS");
}

TEST_F(Errors, UnknownPathsAndLaterReleasesAre404) {
  for (const char* path : {"/nowhere", "/v1/", "/v1/renders/", "/v1/assets", "/v1/renders/x/events", "/../etc/passwd",
                           "/%2e%2e/%2e%2e/etc/passwd", "/js/../../x", "/metrics", "//"}) {
    EXPECT_EQ(service_->get(path).status, 404) << path;
  }
}

TEST_F(Errors, AHostThatIsNotOursIs421) {
  EXPECT_EQ(service_->get("/v1/limits", {{"Host", "evil.example"}}).status, 421);
  EXPECT_EQ(service_->get("/v1/limits", {{"Host", "localhost:" + std::to_string(service_->port())}}).status, 200);
  EXPECT_EQ(service_->get("/v1/limits", {{"Host", "192.168.1.9:8080"}}).status, 200);
  EXPECT_EQ(service_->get("/v1/limits", {{"Host", "[::1]:8080"}}).status, 200);
  server::Config config;
  config.allowed_hosts = {"render.example"};
  Service own(config);
  EXPECT_EQ(own.get("/v1/limits", {{"Host", "render.example:443"}}).status, 200);
}

TEST_F(Errors, PagesOfOtherSitesCannotChangeAnything) {
  const std::string own = "http://127.0.0.1:" + std::to_string(service_->port());
  EXPECT_EQ(service_->post("/v1/renders", small_scene(), {{"Origin", "http://evil.example"}}).status, 403);
  EXPECT_EQ(service_->post("/v1/renders", small_scene(), {{"Origin", "null"}}).status, 403);
  EXPECT_EQ(service_->post("/v1/renders", small_scene(), {{"Origin", own}}).status, 202);
  EXPECT_EQ(ask(service_->port(), "DELETE", "/v1/renders/x", {{"Origin", "http://evil.example"}}).status, 403);
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"}) {
    EXPECT_EQ(ask(service_->port(), "POST", "/v1/renders", {{"Content-Type", type}}, small_scene()).status, 415)
        << type;
  }
  EXPECT_EQ(ask(service_->port(), "POST", "/v1/renders", {}, small_scene()).status, 415);
  EXPECT_EQ(service_->get("/v1/limits").header("access-control-allow-origin"), "");
}

}  // namespace
}  // namespace tilelight::service
