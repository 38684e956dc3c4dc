// SPDX-License-Identifier: Apache-2.0
// Bytes as what a connection receives. Nothing crashes; a head is found at the same place however it arrives; what is
// read of one holds no line end or NUL where none may be, and is spelled so that it can be read again.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include "server/http/head.h"
#include "server/http/negotiate.h"
#include "server/http/origin.h"
#include "server/http/target.h"
#include "tests/fuzz/require.h"

namespace tilelight::fuzz {
namespace {

using namespace server;

std::string encoded(std::string_view text) {
  std::string out;
  for (const char c : text) {
    char byte[4];
    std::snprintf(byte, sizeof byte, "%%%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    out += byte;
  }
  return out;
}

// A target of which every byte is encoded but the separators means the same.
void check_target(const Request& request, const std::string& told) {
  if (request.path == "*") return;
  std::string path, query;
  for (const std::string& segment : request.segments) path += "/" + encoded(segment);
  for (const auto& [name, value] : request.query) query += "&" + encoded(name) + "=" + encoded(value);
  REQUIRE(path_segments(path) == request.segments, told);
  REQUIRE(query_parameters(query) == request.query, told);
  const auto slashes = std::count(request.path.begin(), request.path.end(), '/');
  REQUIRE(static_cast<size_t>(slashes) == request.segments.size(), told);
}

void check_fields(const Request& request, const std::string& told) {
  constexpr std::string_view kNever("\r\n\0", 3);
  for (const auto& [name, value] : request.headers) {
    REQUIRE(!name.empty() && value.find_first_of(kNever) == std::string::npos, told);
  }
  REQUIRE(request.headers.count("Host") <= 1 && request.headers.count("Content-Length") <= 1, told);
  if (const auto host = request.header("Host"); host && !host->empty()) {
    const auto authority = parse_authority(*host);
    REQUIRE(authority && parse_authority(authority_text(*authority)), told);
  }
  const Preferences preferences = read_preferences(request);
  REQUIRE(!preferences.wait_s || *preferences.wait_s >= 0.0, told);
  best_offer(request, {"image/png", "application/json"});
  // A condition and its opposite: of a strong tag, If-Match and If-None-Match of one list say different things.
  Request turned;
  for (const auto& [name, value] : request.headers) turned.headers.emplace("If-Match", value);
  if (is_match_met(turned, {true, "\"a\""}) && !turned.headers.empty()) {
    for (const auto& [name, value] : request.headers) turned.headers.emplace("If-None-Match", value);
    REQUIRE(has_current(turned, "\"a\""), told);
  }
}

void check_prefixes(std::string_view bytes, const HeadLimits& limits, size_t end) {
  for (size_t size = 0; size < end; ++size) {
    const auto part = scan_head(bytes.substr(0, size), limits);
    REQUIRE(part && !*part, std::string(bytes.substr(0, size)));
  }
}

void check_head(std::string_view bytes, const HeadLimits& limits) {
  const std::string told(bytes);
  const auto head = scan_head(bytes, limits);
  if (!head) {
    REQUIRE(head.error().status >= 400 && !head.error().detail.empty(), told);
    // What is refused stays refused, whatever follows.
    REQUIRE(!scan_head(told + "\r\n\r\n", limits), told);
    return;
  }
  if (!*head) return;
  REQUIRE((*head)->bytes <= std::min(bytes.size(), limits.head_bytes), told);
  REQUIRE((*head)->body_bytes >= 0 && (*head)->body_bytes <= limits.body_bytes, told);
  REQUIRE(bytes.substr((*head)->bytes - 4, 4) == "\r\n\r\n", told);
  check_prefixes(bytes, limits, (*head)->bytes);
  check_target((*head)->request, told);
  check_fields((*head)->request, told);
}

}  // namespace
}  // namespace tilelight::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tilelight;
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  fuzz::check_head(bytes, {});
  server::HeadLimits small;
  small.head_bytes = 256;
  small.target_bytes = 40;
  small.field_bytes = 60;
  small.fields = 5;
  small.body_bytes = 100;
  fuzz::check_head(bytes, small);
  return 0;
}
