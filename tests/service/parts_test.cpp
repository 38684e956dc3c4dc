// SPDX-License-Identifier: Apache-2.0
// The pure parts of the server by themselves: heads, spans of JSON, negotiation, configuration, log lines, times.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "server/clock.h"
#include "server/config.h"
#include "server/http/head.h"
#include "server/http/json_members.h"
#include "server/http/negotiate.h"
#include "server/jobs/job.h"
#include "server/log.h"

namespace tilelight::server {
namespace {

TEST(Head, IsFoundAtTheSamePlaceHoweverItArrives) {
  const std::string request =
      "POST /v1/renders?x=1 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\nRange: bytes=0-1\r\n\r\n{}";
  const size_t end = request.size() - 2;
  for (size_t size = 0; size <= request.size(); ++size) {
    const auto head = scan_head(request.substr(0, size), {});
    ASSERT_TRUE(head) << size;
    ASSERT_EQ(head->has_value(), size >= end) << size;
    if (!*head) continue;
    EXPECT_EQ((*head)->bytes, end);
    EXPECT_EQ((*head)->body_bytes, 2);
    EXPECT_EQ((*head)->text, "POST /v1/renders?x=1 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 2\r\n\r\n");
  }
}

TEST(Head, OfHttp10NeedsNoHost) { EXPECT_TRUE(scan_head("GET / HTTP/1.0\r\n\r\n", {})->has_value()); }

TEST(JsonMembers, AreTheTopLevelOnes) {
  const std::string text = R"( {"a": {"b": "}\"", "c": [1, {"d": 2}]}, "e" : "x,y", "f":1.5e3 , "g": null} )";
  const auto members = scan_members(text);
  ASSERT_TRUE(members);
  ASSERT_EQ(members->size(), 4u);
  EXPECT_EQ((*members)[0].value, R"({"b": "}\"", "c": [1, {"d": 2}]})");
  EXPECT_EQ((*members)[1].value, R"("x,y")");
  EXPECT_EQ(find_member(*members, "f")->value, "1.5e3");
  EXPECT_EQ(find_member(*members, "h"), nullptr);
}

TEST(JsonMembers, OfABrokenOutlineAreNone) {
  for (const char* text :
       {"", "[]", "{", "{\"a\"}", "{\"a\":}", "{\"a\":1,}", "{\"a\":1}x", "{\"a\":\"", "{\"a\":{]", "{a:1}"}) {
    EXPECT_FALSE(scan_members(text)) << text;
  }
  EXPECT_TRUE(scan_members("{}")->empty());
}

TEST(JsonMembers, ThatAreTooManyWrapNoScene) {
  std::string text = "{\"a\":0";
  for (int i = 0; i < 100'000; ++i) text += ",\"a\":0";
  EXPECT_FALSE(scan_members(text + "}"));
}

TEST(JsonMembers, KeptOnesStayWhereTheyWereAndParse) {
  const std::string text = "{\"scene\": \"x\",\n \"camera\": {\"a\": [1,\n2]}, \"format\":\"png\", \"image\":{}}";
  const auto members = scan_members(text);
  const std::string kept = keep_members(text, *members, {"camera", "image"});
  EXPECT_EQ(kept.size(), text.size());
  EXPECT_EQ(kept.find("\"camera\""), text.find("\"camera\""));
  EXPECT_EQ(nlohmann::json::parse(kept), nlohmann::json::parse(R"({"camera": {"a": [1, 2]}, "image": {}})"));
  EXPECT_EQ(nlohmann::json::parse(keep_members(text, *members, {})), nlohmann::json::object());
  EXPECT_EQ(nlohmann::json::parse(keep_value(text, *find_member(*members, "camera"))),
            nlohmann::json::parse(R"({"a": [1, 2]})"));
}

TEST(JsonMembers, WithoutAValueTheRestStaysWhereItWasAndParses) {
  const std::string text = "\xEF\xBB\xBF{\"scene\": {\"a\": [1,\n2]}, \"format\": \"png\"}";
  const auto members = scan_members(text);
  ASSERT_TRUE(members) << "a byte order mark counts for nothing";
  const std::string rest = without_value(text, *find_member(*members, "scene"));
  EXPECT_EQ(rest.size(), text.size());
  EXPECT_EQ(rest.find("\"format\""), text.find("\"format\""));
  EXPECT_EQ(nlohmann::json::parse(rest), nlohmann::json::parse(R"({"scene": 0, "format": "png"})"));
}

TEST(JsonMembers, WholeNumbersAreThoseOfJson) {
  const std::pair<const char*, int64_t> numbers[] = {
      {"7", 7}, {"-7", -7}, {"7.0", 7}, {"0.7e1", 7}, {"9223372036854775807", INT64_MAX}};
  for (const auto& [text, number] : numbers) EXPECT_EQ(json_whole_number(text), number) << text;
  for (const char* text : {"", "7.5", "1e300", "9223372036854775808", "\"7\"", "[7]", "null", "7 7"})
    EXPECT_EQ(json_whole_number(text), std::nullopt) << text;
}

Request with_header(std::string name, std::string value) {
  Request request;
  request.headers.emplace(std::move(name), std::move(value));
  return request;
}

TEST(Accept, PicksTheBestOfferByQualityAndSpecificity) {
  const std::vector<std::string_view> offers = {"image/png", "image/jpeg"};
  const auto best = [&](std::string accept) {
    return best_offer(with_header("Accept", std::move(accept)), offers).value_or("none");
  };
  EXPECT_EQ(best("*/*"), "image/png");
  EXPECT_EQ(best("image/jpeg"), "image/jpeg");
  EXPECT_EQ(best("IMAGE/JPEG ; q=0.5, text/html"), "image/jpeg");
  EXPECT_EQ(best("image/*;q=0.5, image/jpeg"), "image/jpeg");
  EXPECT_EQ(best("image/png;q=0, */*"), "image/jpeg");
  EXPECT_EQ(best("text/html"), "none");
  EXPECT_EQ(best_offer({}, offers), "image/png");
}

TEST(Accept, AnImageIsWaitedForOnlyWhereItIsNamed) {
  const auto asked = [](std::string accept) {
    return asked_image_format(with_header("accept", std::move(accept)), image_formats(false));
  };
  EXPECT_EQ(asked("image/png"), ImageFormat::png);
  EXPECT_EQ(asked("image/x-exr, image/png;q=0.9"), ImageFormat::exr);
  EXPECT_EQ(asked("image/*"), ImageFormat::png);
  EXPECT_EQ(asked("*/*"), std::nullopt);
  EXPECT_EQ(asked("application/json, image/png;q=0.5"), std::nullopt);
  EXPECT_EQ(asked_image_format({}, image_formats(false)), std::nullopt);
}

TEST(Accept, AnSvgIsOfferedOfLinesAloneAndOnlyToWhoPrefersIt) {
  const auto asked = [](std::string accept, bool with_lines) {
    return asked_image_format(with_header("accept", std::move(accept)), image_formats(with_lines));
  };
  EXPECT_EQ(asked("image/svg+xml", true), ImageFormat::svg);
  EXPECT_EQ(asked("image/svg+xml", false), std::nullopt);
  EXPECT_EQ(asked("image/svg+xml, image/png;q=0.5", true), ImageFormat::svg);
  EXPECT_EQ(asked("image/svg+xml, image/png;q=0.5", false), ImageFormat::png);
  EXPECT_EQ(asked("image/svg+xml, application/json;q=0.5", false), std::nullopt);
  // What Chrome sends for <img>: it takes anything.
  EXPECT_EQ(asked("image/avif,image/webp,image/apng,image/svg+xml,image/*,*/*;q=0.8", true), ImageFormat::png);
}

TEST(Prefer, IsReadFromLists) {
  EXPECT_EQ(read_preferences(with_header("Prefer", "respond-async, wait=10")).wait_s, 10.0);
  EXPECT_TRUE(read_preferences(with_header("Prefer", "respond-async, wait=10")).respond_async);
  EXPECT_EQ(read_preferences(with_header("Prefer", "wait=-1")).wait_s, std::nullopt);
  EXPECT_EQ(read_preferences(with_header("Prefer", "wait=x")).wait_s, std::nullopt);
}

TEST(IfNoneMatch, ComparesWeaklyAndKnowsLists) {
  EXPECT_TRUE(has_current(with_header("If-None-Match", "\"a\", W/\"b,c\""), "\"b,c\""));
  EXPECT_TRUE(has_current(with_header("If-None-Match", "*"), "\"a\""));
  EXPECT_FALSE(has_current(with_header("If-None-Match", "\"ab\""), "\"a\""));
  EXPECT_FALSE(has_current({}, "\"a\""));
}

Result<ConfigRequest> load(std::vector<const char*> flags, std::map<std::string, std::string> environment = {}) {
  flags.insert(flags.begin(), "tilelightd");
  return load_config(static_cast<int>(flags.size()), flags.data(), environment);
}

TEST(Config, FlagsWinOverTheEnvironmentOverTheFileOverTheDefaults) {
  const std::string path = ::testing::TempDir() + "tilelight_config_test.json";
  std::ofstream(path) << R"({"port": 1, "threads": 1, "max_queue": 1})";
  const std::string flag = "--config=" + path;
  const auto loaded = load({flag.c_str(), "--port", "3"}, {{"TILELIGHT_PORT", "2"}, {"TILELIGHT_THREADS", "2"}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->config.port, 3);
  EXPECT_EQ(loaded->config.threads, 2);
  EXPECT_EQ(loaded->config.max_queue, 1);
  EXPECT_EQ(loaded->config.admin_port, 8081);
  std::ofstream(path) << R"({"prot": 1})";
  EXPECT_NE(load({flag.c_str()}).error().detail.find("prot"), std::string::npos);
}

TEST(Config, UnknownNamesAndBadValuesRefuseToStartAndAreNamed) {
  EXPECT_NE(load({"--prot", "1"}).error().detail.find("--prot"), std::string::npos);
  EXPECT_NE(load({}, {{"TILELIGHT_PROT", "1"}}).error().detail.find("TILELIGHT_PROT"), std::string::npos);
  EXPECT_NE(load({"--port", "70000"}).error().detail.find("70000"), std::string::npos);
  EXPECT_FALSE(load({"--max-results", "10001"})) << "more than there are records to find them by";
  EXPECT_NE(load({"--data-dir", "/tmp/x"}).error().detail.find(":memory:"), std::string::npos);
  EXPECT_NE(load({"--config", "/nowhere.json"}).error().detail.find("/nowhere.json"), std::string::npos);
}

TEST(Config, APublicAddressNeedsAWordOfAssent) {
  EXPECT_NE(load({"--host", "0.0.0.0"}).error().detail.find("--allow-open"), std::string::npos);
  EXPECT_FALSE(load({"--admin-host", "0.0.0.0"}));
  EXPECT_TRUE(load({"--host", "0.0.0.0", "--allow-open"}));
  EXPECT_TRUE(load({"--host", "::1"}));
  EXPECT_TRUE(load({"--data-dir", ":memory:", "--quiet"}));
}

TEST(Config, EverySettingIsInTheHelp) {
  const auto help = load({"--help"});
  ASSERT_TRUE(help);
  for (const Setting& setting : settings()) {
    EXPECT_NE(help->text.find("--" + std::string(setting.name)), std::string::npos) << setting.name;
  }
}

TEST(LogLine, StaysALineWhateverAClientSends) {
  const Log::Fields fields = {{"path", "/a\nb \"c\""}, {"status", int64_t{200}}, {"ms", 1.5}};
  EXPECT_EQ(log_line_text("request", fields), "request path=\"/a\\x0ab \\\"c\\\"\" status=200 ms=1.50");
  const auto json = nlohmann::json::parse(log_line_json("now", "info", "request", fields));
  EXPECT_EQ(json.at("path"), "/a\nb \"c\"");
  EXPECT_EQ(log_line_json("now", "info", "x", {{"y", "\xff\n"}}).find('\n'), std::string::npos);
}

TEST(Time, IsWrittenByRfc3339) {
  EXPECT_EQ(rfc3339(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(rfc3339(951'782'400'123), "2000-02-29T00:00:00.123Z");
}

}  // namespace
}  // namespace tilelight::server
