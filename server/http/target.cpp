// SPDX-License-Identifier: Apache-2.0
#include "server/http/target.h"

#include <algorithm>

#include "server/http/origin.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

// Splits at each separator; the parts may be empty.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const size_t at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

enum class Plus { is_plus, is_blank };

std::optional<std::string> percent_decoded(std::string_view text, Plus plus) {
  std::string out;
  out.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i] == '+' && plus == Plus::is_blank ? ' ' : text[i];
      continue;
    }
    const auto byte = whole_number<uint8_t>(text.substr(i + 1, 2), 16);
    if (!byte || i + 2 >= text.size()) return std::nullopt;
    out += static_cast<char>(*byte);
    i += 2;
  }
  return out;
}

}  // namespace

::tl::expected<Target, Problem> split_target(std::string_view method, std::string_view text) {
  const auto bad = [](const char* detail) { return problem(400, "bad_request", detail); };
  const bool printable = std::all_of(text.begin(), text.end(), [](unsigned char c) { return c > 0x20 && c != 0x7f; });
  if (!printable) return bad("the target holds blanks or control characters; write them as %20 and the like");
  if (text.find('#') != std::string_view::npos) return bad("the target holds a #; fragments stay with the client");
  Target target;
  if (text == "*" && method == "OPTIONS") {
    target.path = text;
    return target;
  }
  const bool is_absolute = has_prefix(text, "http://") || has_prefix(text, "https://");
  if (is_absolute) {
    text.remove_prefix(text.find("://") + 3);
    target.authority = text.substr(0, text.find_first_of("/?"));
    text.remove_prefix(target.authority.size());
    if (!parse_authority(target.authority)) return bad("the target names no host, or one that is none, or a user");
  }
  const size_t query = text.find('?');
  target.path = text.substr(0, query);
  if (query != std::string_view::npos) target.query = text.substr(query + 1);
  // RFC 9112, 3.2.4: OPTIONS of a server as a whole, as proxies say it; for all others an empty path is /.
  if (is_absolute && text.empty()) target.path = method == "OPTIONS" ? "*" : "/";
  if (is_absolute && target.path.empty()) target.path = "/";
  if (target.path.empty() || (target.path.front() != '/' && !is_absolute)) {
    return bad("the target must be a path that begins with /, or an http address as a whole");
  }
  return target;
}

std::optional<std::vector<std::string>> path_segments(std::string_view path) {
  std::vector<std::string> segments;
  for (const std::string_view part : split(path.substr(1), '/')) {
    auto segment = percent_decoded(part, Plus::is_plus);
    if (!segment) return std::nullopt;
    segments.push_back(std::move(*segment));
  }
  return segments;
}

std::optional<std::multimap<std::string, std::string>> query_parameters(std::string_view query) {
  std::multimap<std::string, std::string> parameters;
  for (const std::string_view part : split(query, '&')) {
    if (part.empty()) continue;
    const size_t equals = part.find('=');
    auto name = percent_decoded(part.substr(0, equals), Plus::is_blank);
    auto value = percent_decoded(equals == std::string_view::npos ? "" : part.substr(equals + 1), Plus::is_blank);
    if (!name || !value) return std::nullopt;
    parameters.emplace(std::move(*name), std::move(*value));
  }
  return parameters;
}

}  // namespace tilelight::server
