// SPDX-License-Identifier: Apache-2.0
#include <nlohmann/json.hpp>

#include "server/http/message.h"

namespace tilelight::server {
namespace {

using Json = nlohmann::ordered_json;

Json error_json(const SceneError& error) {
  Json out = {{"pointer", error.pointer}, {"code", error.code}, {"detail", error.detail}};
  if (!error.allowed.empty()) out["allowed"] = error.allowed;
  if (!error.hint.empty()) out["hint"] = error.hint;
  if (error.line > 0) out["line"] = error.line, out["column"] = error.column;
  return out;
}

}  // namespace

std::string_view status_title(int status) {
  switch (status) {
    case 400:
      return "Bad Request";
    case 403:
      return "Forbidden";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 406:
      return "Not Acceptable";
    case 408:
      return "Request Timeout";
    case 409:
      return "Conflict";
    case 410:
      return "Gone";
    case 411:
      return "Length Required";
    case 412:
      return "Precondition Failed";
    case 413:
      return "Content Too Large";
    case 414:
      return "URI Too Long";
    case 415:
      return "Unsupported Media Type";
    case 417:
      return "Expectation Failed";
    case 421:
      return "Misdirected Request";
    case 422:
      return "Unprocessable Content";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 500:
      return "Internal Server Error";
    case 501:
      return "Not Implemented";
    case 503:
      return "Service Unavailable";
    case 505:
      return "HTTP Version Not Supported";
    default:
      return "Error";
  }
}

Response problem_response(const Problem& problem, std::string_view request_id) {
  Json document = {{"type", "urn:tilelight:problem:" + problem.code},
                   {"title", status_title(problem.status)},
                   {"status", problem.status},
                   {"detail", problem.detail}};
  if (!request_id.empty()) document["request_id"] = request_id;
  if (!problem.errors.empty()) {
    Json errors = Json::array();
    for (const SceneError& error : problem.errors) errors.push_back(error_json(error));
    document["errors"] = std::move(errors);
  }
  Response response{problem.status, problem.headers, "application/problem+json", ""};
  // What a client sent may be quoted in the detail. It need not be UTF-8, and must not steer the terminal that shows
  // it.
  response.body = printable_json(document.dump(-1, ' ', false, Json::error_handler_t::replace));
  response.with("Cache-Control", "no-store");
  return response;
}

::tl::unexpected<Problem> scene_problem(const SceneErrors& errors) {
  Problem out;
  out.errors = errors.errors;
  const std::string first = errors.errors.empty() ? "" : errors.errors.front().detail;
  switch (errors.kind) {
    case SceneErrors::Kind::not_json:
      out.status = 400;
      out.code = "not_json";
      break;
    case SceneErrors::Kind::too_large:
      out.status = 413;
      out.code = "limit";
      break;
    case SceneErrors::Kind::invalid:
      out.status = 422;
      out.code = "invalid_scene";
      break;
  }
  out.detail =
      errors.errors.size() == 1 ? first : std::to_string(errors.errors.size()) + " errors; the first: " + first;
  return ::tl::unexpected<Problem>(std::move(out));
}

}  // namespace tilelight::server
