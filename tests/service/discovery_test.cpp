// SPDX-License-Identifier: Apache-2.0
// What the server says about itself, the page, and the admin port.
#include <set>

#include "server/http/routes.h"
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using Discovery = ServiceTest;

TEST_F(Discovery, TheDescriptionOfTheApiHasExactlyTheRoutesOfTheTable) {
  std::set<std::string> routes, described, ids;
  for (const server::Route& route : server::api_routes())
    routes.insert(std::string(route.method) + " " + std::string(route.pattern));
  const Json document = Json::parse(service_->get("/openapi.json").body);
  for (const auto& [path, item] : document.at("paths").items()) {
    for (const auto& [method, operation] : item.items()) {
      if (method == "parameters") continue;
      std::string upper = method;
      for (char& c : upper) c = static_cast<char>(std::toupper(c));
      described.insert(upper + " " + path);
      EXPECT_TRUE(operation.contains("summary")) << method << " " << path;
      EXPECT_TRUE(ids.insert(operation.at("operationId")).second) << method << " " << path;
    }
  }
  EXPECT_EQ(described, routes);
}

std::set<std::string> query_names(const Json& document, const Json& parameters) {
  std::set<std::string> names;
  for (const Json& parameter : parameters) {
    const std::string reference = parameter.value("$ref", "");
    const Json& resolved = reference.empty() ? parameter : document.at(Json::json_pointer(reference.substr(1)));
    if (resolved.at("in") == "query") names.insert(resolved.at("name"));
  }
  return names;
}

TEST_F(Discovery, TheDescriptionHasExactlyTheQueryParametersOfTheTable) {
  const Json document = Json::parse(service_->get("/openapi.json").body);
  for (const server::Route& route : server::api_routes()) {
    std::string method(route.method);
    for (char& c : method) c = static_cast<char>(std::tolower(c));
    const Json& operation = document.at("paths").at(std::string(route.pattern)).at(method);
    EXPECT_EQ(query_names(document, operation.value("parameters", Json::array())),
              std::set<std::string>(route.query.begin(), route.query.end()))
        << route.pattern;
  }
}

void collect_references(const Json& json, std::set<std::string>& out) {
  if (json.is_object() && json.contains("$ref")) out.insert(json.at("$ref"));
  if (json.is_structured()) {
    for (const Json& child : json) collect_references(child, out);
  }
}

TEST_F(Discovery, EveryReferenceOfTheDescriptionLeadsIntoIt) {
  const Json document = Json::parse(service_->get("/openapi.json").body);
  std::set<std::string> references;
  collect_references(document, references);
  for (const std::string& reference : references) {
    ASSERT_EQ(reference[0], '#') << reference << " is not in the document itself";
    EXPECT_TRUE(document.contains(Json::json_pointer(reference.substr(1)))) << reference;
  }
}

TEST_F(Discovery, LimitsAndSchemaAreJsonAndCacheable) {
  for (const char* path : {"/v1/limits", "/v1/schema/scene.json", "/openapi.json"}) {
    const auto answer = service_->get(path);
    EXPECT_EQ(answer.status, 200) << path;
    EXPECT_TRUE(Json::parse(answer.body, nullptr, false).is_object()) << path;
    EXPECT_EQ(service_->get(path, {{"If-None-Match", "\"x\", " + answer.header("etag")}}).status, 304) << path;
  }
  EXPECT_EQ(Json::parse(service_->get("/v1/limits").body).at("pixels"), Limits{}.pixels);
}

TEST_F(Discovery, TheDescriptionTellsWhereTheServerIsAsTheClientSeesIt) {
  server::Config config;
  config.trusted_proxies = {server::parse_network("127.0.0.1").value()};
  Service own(std::move(config));
  const auto plain = own.get("/openapi.json"), below = own.get("/openapi.json", {{"X-Forwarded-Prefix", "/render"}});
  Json document = Json::parse(below.body);
  EXPECT_EQ(document.at("servers").at(0).at("url"), "/render");
  document["servers"][0]["url"] = "/";
  EXPECT_EQ(document, Json::parse(plain.body)) << "and nothing else differs";
  EXPECT_NE(below.header("etag"), plain.header("etag"));
  EXPECT_EQ(own.get("/openapi.json", {{"If-None-Match", plain.header("etag")}}).status, 304);
}

TEST_F(Discovery, ThePageIsServedFromTheProgramUnderAStrictPolicy) {
  const auto page = service_->get("/");
  ASSERT_EQ(page.status, 200);
  EXPECT_EQ(page.header("content-type"), "text/html; charset=utf-8");
  EXPECT_NE(page.header("content-security-policy").find("default-src 'none'"), std::string::npos);
  EXPECT_EQ(page.header("content-security-policy").find("unsafe"), std::string::npos);
  EXPECT_EQ(page.header("x-content-type-options"), "nosniff");
  EXPECT_EQ(service_->get("/index.html").body, page.body);
  EXPECT_EQ(service_->get("/", {{"If-None-Match", page.header("etag")}}).status, 304);
  EXPECT_EQ(service_->get("/js/main.js").header("content-type"), "text/javascript; charset=utf-8");
}

TEST_F(Discovery, EveryExampleOfThePageIsASceneThatTheServerPlans) {
  const Json index = Json::parse(service_->get("/scenes/index.json").body);
  ASSERT_FALSE(index.empty());
  for (const Json& entry : index) {
    const auto scene = service_->get("/scenes/" + entry.at("file").get<std::string>());
    ASSERT_EQ(scene.status, 200) << entry;
    EXPECT_EQ(service_->post("/v1/plan", scene.body).status, 200) << entry;
  }
}

TEST_F(Discovery, TheAdminPortTellsHealthVersionAndMetrics) {
  EXPECT_EQ(ask(service_->admin_port(), "GET", "/livez").status, 200);
  EXPECT_EQ(ask(service_->admin_port(), "GET", "/readyz").status, 200);
  EXPECT_EQ(Json::parse(ask(service_->admin_port(), "GET", "/version").body).at("name"), "tilelightd");
  EXPECT_EQ(ask(service_->admin_port(), "GET", "/").status, 404) << "the page is not here";
  EXPECT_EQ(service_->get("/metrics").status, 404) << "and metrics not there";
}

TEST_F(Discovery, MetricsCountTheRequestsByRouteAndStatus) {
  Service own;
  own.get("/v1/limits");
  own.get("/v1/limits");
  own.get("/nowhere");
  const std::string text = ask(own.admin_port(), "GET", "/metrics").body;
  EXPECT_NE(text.find("tilelight_http_requests_total{route=\"/v1/limits\",status=\"200\"} 2\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("tilelight_http_requests_total{route=\"none\",status=\"404\"} 1\n"), std::string::npos);
  EXPECT_NE(text.find("tilelight_http_request_duration_seconds_bucket{le=\"+Inf\"} 3\n"), std::string::npos);
  EXPECT_NE(text.find("# TYPE tilelight_renders_queued gauge\n"), std::string::npos);
}

TEST_F(Discovery, TwoServersLiveInOneProcess) {
  Service one, two;
  const std::string location = one.post("/v1/renders", small_scene()).header("location");
  EXPECT_EQ(one.get(location).status, 200);
  EXPECT_EQ(two.get(location).status, 404);
}

}  // namespace
}  // namespace tilelight::service
