// SPDX-License-Identifier: Apache-2.0
// The scanner of heads by itself: what it takes, what it refuses, and that it hands fields on as they were sent.
#include <gtest/gtest.h>

#include "server/http/head.h"
#include "server/http/target.h"

namespace tilelight::server {
namespace {

// The request of a complete head; its path is "refused: STATUS" where the head is refused.
Request scanned(const std::string& text) {
  auto head = scan_head(text, {});
  if (head && *head) return std::move((*head)->request);
  Request none;
  none.path = head ? "incomplete" : "refused: " + std::to_string(head.error().status);
  return none;
}
Request with_line(const std::string& line) { return scanned(line + "\r\nHost: localhost\r\n\r\n"); }
Request with_target(const std::string& target) { return with_line("GET " + target + " HTTP/1.1"); }
Request with_field(const std::string& line) {
  return scanned("GET / HTTP/1.1\r\nHost: localhost\r\n" + line + "\r\n\r\n");
}

using Segments = std::vector<std::string>;

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
    EXPECT_EQ((*head)->request.path, "/v1/renders");
    EXPECT_EQ((*head)->request.query.find("x")->second, "1");
    EXPECT_EQ((*head)->request.headers.size(), 3u);
  }
}

TEST(Head, OfHttp10NeedsNoHost) { EXPECT_EQ(scanned("GET / HTTP/1.0\r\n\r\n").path, "/"); }

TEST(Head, ValuesAreHandedOnAsTheyWereSent) {
  for (const char* value :
       {"a%62c", "%0d%0aX: y", "%00", "100%", "a+b", "%zz", "\xc3\xa9", "a\tb", "", "a,b;c=\"%41\""}) {
    const Request request = with_field("Idempotency-Key:" + std::string(value));
    EXPECT_EQ(request.header("idempotency-key"), value);
    EXPECT_EQ(request.headers.size(), 2u) << value;
  }
  EXPECT_EQ(with_field("Host%: a").header("host%"), "a") << "% is lawful in a name too, and means nothing";
  EXPECT_EQ(scanned("GET / HTTP/1.1\r\nHost: localhos%74\r\n\r\n").header("host"), "localhos%74");
  EXPECT_EQ(with_field("X: a\r\nx:  b \r\nX:c").headers.count("X"), 3u);
}

TEST(Head, FieldsThatReadersCouldTakeDifferentlyAreRefused) {
  for (const char* lines : {"X : y",
                            " X: y",
                            "X: y\r\n folded",
                            "X: y\r\n\tfolded",
                            ": y",
                            "X",
                            "X: a\rb",
                            "X: a\nb",
                            "X: a\x01",
                            "X: a\x7f",
                            "Content-Length: 1\r\nContent-Length: 1",
                            "Content-Length: 5, 5",
                            "Content-Length: 0x5",
                            "Content-Length: -5",
                            "Content-Length: 5 5",
                            "Content-Length:",
                            "Host: localhost",
                            "Origin: a\r\norigin: b",
                            "Content-Type: a\r\nContent-Type: a",
                            "Idempotency-Key: a\r\nIDEMPOTENCY-KEY: b",
                            "Transfer-Encoding: chunked\r\nContent-Length: 5"}) {
    EXPECT_EQ(with_field(lines).path, "refused: 400") << lines;
  }
  EXPECT_EQ(with_field(std::string("X: a\0b", 6)).path, "refused: 400");
  EXPECT_EQ(with_field("Transfer-Encoding: chunked").path, "refused: 411");
  EXPECT_EQ(with_field("Transfer-Encoding: Chunked, chunked").path, "refused: 501");
  EXPECT_EQ(with_field("Transfer-Encoding: identity").path, "refused: 501");
  EXPECT_EQ(with_field("Content-Encoding: identity, br").path, "refused: 415");
  EXPECT_EQ(with_field("Content-Encoding: Identity").path, "/");
  EXPECT_EQ(with_field("Content-Length: 99999999999999999999").path, "refused: 413");
  EXPECT_EQ(with_field("Content-Length: 007").path, "/");
}

TEST(Head, LinesEndWithCrAndLf) {
  for (const char* text : {"GET / HTTP/1.1\n", "\n", "GET / HTTP/1.1\r\nHost: a\n", "\r\n\r\n", "\r\nGET /"}) {
    EXPECT_EQ(scanned(text).path, "refused: 400") << text;
  }
  EXPECT_EQ(empty_line_bytes("\r\nGET"), 2u) << "what the connection skips before the head";
  EXPECT_EQ(empty_line_bytes("\r"), 0u);
  EXPECT_EQ(empty_line_bytes("\nG"), 0u);
}

TEST(Head, VersionsOfHttp1AreTaken) {
  EXPECT_EQ(with_line("GET / HTTP/1.1").path, "/");
  EXPECT_EQ(with_line("GET / HTTP/1.9").path, "/") << "a higher minor version is read as the highest known";
  for (const char* version : {"HTTP/2.0", "HTTP/0.9", "HTTP/3.0"}) {
    EXPECT_EQ(with_line("GET / " + std::string(version)).path, "refused: 505") << version;
  }
  for (const char* line : {"GET / http/1.1", "GET / HTTP/1.10", "GET / HTTP/11", "GET /", "GET  / HTTP/1.1",
                           "GET / HTTP/1.1 ", " GET / HTTP/1.1", "GET\t/\tHTTP/1.1", "G@T / HTTP/1.1"}) {
    EXPECT_EQ(with_line(line).path, "refused: 400") << line;
  }
  EXPECT_EQ(with_line("get / HTTP/1.1").path, "refused: 501") << "methods have a case";
  EXPECT_EQ(scanned("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n").path, "refused: 505");
}

TEST(Head, OfATargetWithItsHostTheHostHeaderDoesNotCount) {
  const auto host_of = [](const std::string& target, const std::string& host = "Host: other.example\r\n") {
    const Request request = scanned("GET " + target + " HTTP/1.1\r\n" + host + "\r\n");
    return request.path + " " + std::string(request.header("host").value_or("none"));
  };
  EXPECT_EQ(host_of("http://localhost:8080/v1/limits"), "/v1/limits localhost:8080");
  EXPECT_EQ(host_of("HTTPS://[::1]/a?b"), "/a [::1]");
  EXPECT_EQ(host_of("http://localhost"), "/ localhost");
  EXPECT_EQ(host_of("http://localhost?a=b"), "/ localhost");
  EXPECT_EQ(with_target("http://localhost?a=b").query.count("a"), 1u);
  EXPECT_EQ(host_of("/v1/limits"), "/v1/limits other.example");
  EXPECT_EQ(host_of("http://localhost/", ""), "refused: 400 none") << "HTTP/1.1 has a Host header all the same";
  EXPECT_EQ(host_of("http://localhost/", "Host: a\r\nHost: b\r\n"), "refused: 400 none");
  EXPECT_EQ(scanned("GET http://localhost/ HTTP/1.0\r\n\r\n").header("host"), "localhost");
  for (const char* target :
       {"http:///v1/limits", "http://user@localhost/", "http://a:b@localhost/", "ftp://localhost/", "http:/localhost",
        "http://local host/", "http://localhost:x/", "http://localhost:99999/", "http://[::1/", "http://a\\b/",
        "localhost/", "localhost:80", "*", "", "/a#b", "http://a/#b"}) {
    EXPECT_EQ(with_target(target).path, "refused: 400") << target;
  }
}

TEST(Head, HostIsAHostAndPerhapsAPort) {
  for (const char* host : {"localhost", "localhost:80", "localhost:", "127.0.0.1:8080", "[::1]", "[2001:db8::1]:443",
                           "a_b.example", "%6cocalhost", ""}) {
    EXPECT_EQ(scanned("GET / HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n").path, "/") << host;
  }
  for (const char* host :
       {":80", "localhost:80:80", "localhost:8x", "localhost:65536", "[::1", "[localhost]", "[::1]80", "::1",
        "user@localhost", "a/b", "a b", "localhos%7", "http://localhost", "a\"b"}) {
    EXPECT_EQ(scanned("GET / HTTP/1.1\r\nHost: " + std::string(host) + "\r\n\r\n").path, "refused: 400") << host;
  }
}

TEST(Head, OptionsKnowsTheServerAsAWhole) {
  EXPECT_EQ(with_line("OPTIONS * HTTP/1.1").path, "*");
  EXPECT_EQ(with_line("OPTIONS http://localhost HTTP/1.1").path, "*") << "RFC 9112, 3.2.4";
  EXPECT_EQ(with_line("OPTIONS http://localhost/ HTTP/1.1").path, "/");
  EXPECT_EQ(with_line("OPTIONS *x HTTP/1.1").path, "refused: 400");
}

TEST(Head, APathIsCutFirstAndDecodedOnceAfterwards) {
  EXPECT_EQ(with_target("/").segments, Segments({""}));
  EXPECT_EQ(with_target("/v1/limits").segments, Segments({"v1", "limits"}));
  EXPECT_EQ(with_target("/%761/l%69mits").segments, Segments({"v1", "limits"}));
  EXPECT_EQ(with_target("/v1%2Flimits").segments, Segments({"v1/limits"}));
  EXPECT_EQ(with_target("/v1%2flimits").segments, Segments({"v1/limits"}));
  EXPECT_EQ(with_target("/v1%252Flimits").segments, Segments({"v1%2Flimits"}));
  EXPECT_EQ(with_target("/a%00b").segments, Segments({std::string("a\0b", 3)}));
  EXPECT_EQ(with_target("//a/./../b/").segments, Segments({"", "a", ".", "..", "b", ""}));
  EXPECT_EQ(with_target("/a;b=c/d+e").segments, Segments({"a;b=c", "d+e"}));
  EXPECT_EQ(with_target("/a%3Fb").segments, Segments({"a?b"}));
  for (const char* path : {"/%", "/%2", "/%zz", "/%2g", "/a%", "/%-1", "/%+1", "/% 1", "/%0x", "/%%41"}) {
    EXPECT_EQ(with_target(path).path, "refused: 400") << path;
    EXPECT_EQ(with_target("/?a=" + std::string(path + 1)).path, "refused: 400") << path;
    EXPECT_EQ(with_target("/?" + std::string(path + 1)).path, "refused: 400") << path;
  }
}

TEST(Head, AQueryIsCutFirstAndDecodedOnceAfterwards) {
  using Pairs = std::multimap<std::string, std::string>;
  EXPECT_EQ(with_target("/?a=b?c/d").query, Pairs({{"a", "b?c/d"}})) << "lawful: RFC 3986, 3.4";
  EXPECT_EQ(with_target("/?a=1&b=2&a=3").query, Pairs({{"a", "1"}, {"a", "3"}, {"b", "2"}}));
  EXPECT_EQ(with_target("/?a%3D=b%26c&%61=x=y").query, Pairs({{"a=", "b&c"}, {"a", "x=y"}}));
  EXPECT_EQ(with_target("/?a=%252B+%2B").query, Pairs({{"a", "%2B +"}}));
  EXPECT_EQ(with_target("/?a=%00").query, Pairs({{"a", std::string(1, '\0')}}));
  EXPECT_EQ(with_target("/?a&&b=&=c").query, Pairs({{"a", ""}, {"b", ""}, {"", "c"}}));
  EXPECT_EQ(with_target("/?").query, Pairs());
}

struct Ending {
  const char* fields;
  bool closes_1_1, closes_1_0;
};

TEST(Head, ConnectionIsAListWithoutCase) {
  for (const Ending& ending : std::initializer_list<Ending>{{"", false, true},
                                                            {"Connection: close", true, true},
                                                            {"Connection: CLOSE", true, true},
                                                            {"Connection: TE, Close", true, true},
                                                            {"Connection: ,close,", true, true},
                                                            {"Connection: keep-alive\r\nConnection: close", true, true},
                                                            {"Connection: keep-alive", false, false},
                                                            {"Connection: Keep-ALIVE", false, false},
                                                            {"Connection: TE,keep-alive", false, false},
                                                            {"Connection: closed", false, true},
                                                            {"Connection: clos%65", false, true},
                                                            {"Connection: Upgrade, HTTP2-Settings", false, true},
                                                            {"Proxy-Connection: keep-alive", false, true}}) {
    for (const bool is_1_0 : {false, true}) {
      const std::string fields = *ending.fields ? std::string(ending.fields) + "\r\n" : "";
      const auto head =
          scan_head(std::string("GET / HTTP/1.") + (is_1_0 ? "0" : "1") + "\r\nHost: a\r\n" + fields + "\r\n", {});
      EXPECT_EQ((*head)->closes, is_1_0 ? ending.closes_1_0 : ending.closes_1_1) << ending.fields << is_1_0;
    }
  }
}

TEST(Head, ExpectIsAListThatHttp10DoesNotKnow) {
  const auto expects = [](const std::string& version, const std::string& fields) {
    const auto head =
        scan_head("POST / HTTP/" + version + "\r\nHost: a\r\nContent-Length: 1\r\n" + fields + "\r\n\r\n", {});
    return head ? ((*head)->expects_continue ? 100 : 0) : head.error().status;
  };
  EXPECT_EQ(expects("1.1", "Expect: 100-continue"), 100);
  EXPECT_EQ(expects("1.1", "expect: 100-Continue, 100-CONTINUE"), 100);
  EXPECT_EQ(expects("1.1", "Expect: 100-continue\r\nExpect: 100-continue"), 100);
  EXPECT_EQ(expects("1.1", "Expect:"), 0);
  EXPECT_EQ(expects("1.1", "Expect: 100-continue, more"), 417);
  EXPECT_EQ(expects("1.1", "Expect: 100-continu%65"), 417);
  EXPECT_EQ(expects("1.0", "Expect: 100-continue"), 0);
  EXPECT_EQ(expects("1.0", "Expect: more"), 0);
}

}  // namespace
}  // namespace tilelight::server
