// SPDX-License-Identifier: Apache-2.0
// Request, Response and Problem as the handlers see them. Nothing here knows the HTTP library. Plain values.
#pragma once

#include <strings.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "renderer/renderer.h"
#include "server/http/origin.h"

namespace tilelight::server {

struct CaseLess {
  using is_transparent = void;
  bool operator()(std::string_view a, std::string_view b) const {
    const int order = strncasecmp(a.data(), b.data(), std::min(a.size(), b.size()));
    return order != 0 ? order < 0 : a.size() < b.size();
  }
};

using Headers = std::multimap<std::string, std::string, CaseLess>;  // of one name in the order in which they came

struct Request {
  std::string method;                 // "GET", also where the client said HEAD: the body is left out at the end
  std::string path;                   // as sent, without the query: for the log
  std::vector<std::string> segments;  // of the path, each decoded by itself: "/a/b%2Fc" has "a" and "b/c"
  std::multimap<std::string, std::string> query;  // decoded
  Headers headers;                                // as sent: a percent sign in them is one
  std::string_view body;                          // lives as long as the request
  std::string client;                             // the address of who asks: the peer's, or what a trusted proxy says
  std::string scheme;                             // under which the client asks; empty where no trusted proxy says it
  Authority host;                                 // that the client asks; without a name where it says none
  std::string prefix;                             // of our paths as the client sees them, "/render"; empty: none
  std::string id;                                 // names the request in the log and in problems
  std::stop_token gone;                           // requested when the client closes its connection
  std::vector<std::string> args;                  // what the route's {names} matched

  // The first value, or nothing.
  std::optional<std::string_view> header(std::string_view name) const {
    const auto found = headers.find(name);
    if (found == headers.end()) return std::nullopt;
    return found->second;
  }
  std::optional<std::string_view> param(const std::string& name) const {
    const auto found = query.find(name);
    if (found == query.end()) return std::nullopt;
    return found->second;
  }
};

// Bytes that others hold too, and that nobody changes.
using SharedBytes = std::shared_ptr<const std::string>;

// The body of a response that comes as it is made. One thread at a time asks; it must not block.
class BodyStream {
 public:
  virtual ~BodyStream() = default;
  // What there is to send now, of bounded size; empty: nothing yet. Nothing: the end.
  virtual std::optional<std::string> next() = 0;
};

struct Response {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string content_type;
  std::string body;
  SharedBytes shared = nullptr;  // in place of `body`: an image that many clients read slowly is in memory once
  std::shared_ptr<BodyStream> stream = nullptr;  // in place of both

  size_t body_bytes() const { return shared ? shared->size() : body.size(); }

  Response& with(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
};

inline Response json_response(int status, std::string body) {
  return {status, {}, "application/json", std::move(body)};
}
inline Response empty_response(int status) { return {status, {}, "", ""}; }

// What is wrong, as RFC 9457 says it.
struct Problem {
  int status = 500;
  std::string code;    // the last part of `type`: stable, lower_snake_case
  std::string detail;  // what was found, what is allowed, what to do
  std::vector<SceneError> errors;
  std::vector<std::pair<std::string, std::string>> headers;

  Problem& with(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
};

// The problem document as a response.
Response problem_response(const Problem& problem, std::string_view request_id);

// "Not Found" for 404.
std::string_view status_title(int status);

using Reply = ::tl::expected<Response, Problem>;

inline ::tl::unexpected<Problem> problem(int status, std::string code, std::string detail) {
  return ::tl::unexpected<Problem>(Problem{status, std::move(code), std::move(detail), {}, {}});
}
// The server cannot take this now.
inline ::tl::unexpected<Problem> busy(std::string code, std::string detail, int retry_after_s) {
  return ::tl::unexpected<Problem>(
      Problem{503, std::move(code), std::move(detail), {}, {{"Retry-After", std::to_string(retry_after_s)}}});
}
// What the parser found, under the status of its kind.
::tl::unexpected<Problem> scene_problem(const SceneErrors& errors);

}  // namespace tilelight::server
