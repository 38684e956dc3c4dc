// SPDX-License-Identifier: Apache-2.0
// The pure parts of the server by themselves (heads: head_test.cpp): spans of JSON, negotiation, times.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "server/clock.h"
#include "server/http/json_members.h"
#include "server/http/negotiate.h"
#include "server/jobs/job.h"

namespace tilelight::server {
namespace {

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
  EXPECT_EQ(best(R"(image/png;x=";q=0")"), "image/png");
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

// {wait, respond-async} as a client has spelled them.
std::pair<std::optional<double>, bool> preferred(std::string prefer) {
  const Preferences preferences = read_preferences(with_header("Prefer", std::move(prefer)));
  return {preferences.wait_s, preferences.respond_async};
}
constexpr auto kNothing = std::pair<std::optional<double>, bool>(std::nullopt, false);

TEST(Prefer, IsReadAsRfc7240SpellsIt) {
  const std::pair<std::optional<double>, bool> ten{10.0, false}, both{10.0, true}, job{std::nullopt, true};
  EXPECT_EQ(preferred("wait=10"), ten);
  EXPECT_EQ(preferred("WAIT = \"10\""), ten) << "names without case, blanks around =, a quoted value";
  EXPECT_EQ(preferred("wait=10; foo=bar"), ten) << "a parameter";
  EXPECT_EQ(preferred("wait=10;foo=\"a;b,wait=5\" ; x"), ten);
  EXPECT_EQ(preferred("foo; wait=5, wait=10"), ten) << "a parameter is no preference";
  EXPECT_EQ(preferred("foo=\"wait=5, respond-async\", wait=\"1\\0\""), ten) << "nor is what stands in quotes";
  EXPECT_EQ(preferred("respond-async, wait=10"), both) << "the example of section 4.3";
  EXPECT_EQ(preferred("Respond-Async; x=1"), job);
  EXPECT_EQ(preferred("respond-async=\"\""), job) << "an empty value is none";
  EXPECT_EQ(preferred("wait=99999999999999999999").first, 1e20);
}

TEST(Prefer, OfTwoWaitsTheFirstCounts) {
  EXPECT_EQ(preferred("wait=10, wait=20").first, 10.0);
  EXPECT_EQ(preferred("wait=soon, wait=20").first, std::nullopt) << "also where it is not understood";
  Request request = with_header("Prefer", "wait=10");
  request.headers.emplace("prefer", "wait=20");
  EXPECT_EQ(read_preferences(request).wait_s, 10.0);
}

TEST(Prefer, ThatMeansNothingIsIgnored) {
  for (const char* text : {"", "wait", "wait=", "wait=\"\"", "wait=-1", "wait=+1", "wait=x", "wait=1e1", "wait=inf",
                           "wait=nan", "wait=0x10", "wait=10%30", "respond-async=yes", "respond-asyncs", ";wait=10",
                           "handling=lenient", "=", ";;,,"}) {
    EXPECT_EQ(preferred(text), kNothing) << text;
  }
}

TEST(IfMatch, IsMetByAStrongTagAlone) {
  const auto met = [](std::string value, const Current& current) {
    return is_match_met(with_header("If-Match", std::move(value)), current);
  };
  const Current strong{true, "\"a,b\""}, weak{true, "W/\"a\""}, untagged{true, ""}, nothing{false, ""};
  EXPECT_TRUE(is_match_met({}, strong));
  EXPECT_TRUE(met("\"x\", \"a,b\"", strong));
  EXPECT_FALSE(met("W/\"a,b\"", strong));
  EXPECT_FALSE(met("\"a\"", strong));
  EXPECT_FALSE(met("a,b", strong));
  EXPECT_FALSE(met("", strong));
  EXPECT_FALSE(met("W/\"a\"", weak)) << "the strong comparison knows no weak tags";
  EXPECT_FALSE(met("\"a\"", weak));
  EXPECT_TRUE(met("*", weak));
  EXPECT_TRUE(met("*", untagged));
  EXPECT_FALSE(met("*", nothing));
  EXPECT_FALSE(met("\"a\"", untagged));
}

TEST(IfNoneMatch, ComparesWeaklyAndKnowsLists) {
  EXPECT_TRUE(has_current(with_header("If-None-Match", "\"a\", W/\"b,c\""), "\"b,c\""));
  EXPECT_TRUE(has_current(with_header("If-None-Match", "*"), "\"a\""));
  EXPECT_FALSE(has_current(with_header("If-None-Match", "\"ab\""), "\"a\""));
  EXPECT_FALSE(has_current({}, "\"a\""));
}

TEST(Time, OfHttpIsWrittenByRfc9110) {
  EXPECT_EQ(http_date(784'111'777'999), "Sun, 06 Nov 1994 08:49:37 GMT") << "its own example";
  EXPECT_EQ(http_date(951'782'400'123), "Tue, 29 Feb 2000 00:00:00 GMT");
}

TEST(Time, IsWrittenByRfc3339) {
  EXPECT_EQ(rfc3339(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(rfc3339(951'782'400'123), "2000-02-29T00:00:00.123Z");
}

}  // namespace
}  // namespace tilelight::server
