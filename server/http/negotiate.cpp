// SPDX-License-Identifier: Apache-2.0
#include "server/http/negotiate.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "server/http/text.h"

namespace tilelight::server {
namespace {

// The parts between the separators, trimmed and without empty ones; quoted strings stay whole.
std::vector<std::string> split_unquoted(std::string_view value, char separator) {
  std::vector<std::string> out;
  std::string item;
  bool is_quoted = false;
  const auto flush = [&] {
    if (const auto text = trim(item); !text.empty()) out.emplace_back(text);
    item.clear();
  };
  for (size_t i = 0; i < value.size(); ++i) {
    if (value[i] == '"') is_quoted = !is_quoted;
    if (is_quoted && value[i] == '\\' && i + 1 < value.size()) item += value[i++];
    if (value[i] == separator && !is_quoted) {
      flush();
    } else {
      item += value[i];
    }
  }
  flush();
  return out;
}

struct MediaRange {
  std::string type;  // "image/*"
  double quality = 1.0;
};

std::vector<MediaRange> accepted(const Request& request) {
  std::vector<MediaRange> ranges;
  for (const std::string& item : header_list(request, "accept")) {
    MediaRange range;
    const std::vector<std::string> parts = split_unquoted(lower(item), ';');  // the type, and its parameters
    if (parts.empty()) continue;
    range.type = parts.front();
    for (const std::string& parameter : parts) {
      if (!parameter.starts_with("q=")) continue;
      double quality = 0.0;
      std::from_chars(parameter.data() + 2, parameter.data() + parameter.size(), quality);
      range.quality = std::clamp(quality, 0.0, 1.0);
    }
    ranges.push_back(std::move(range));
  }
  return ranges;
}

// 3: the very type, 2: type/*, 1: */*, 0: no match.
int specificity(const std::string& range, std::string_view type) {
  if (range == type) return 3;
  if (range == "*/*" || range == "*") return 1;
  const bool is_wild = range.size() > 2 && range.compare(range.size() - 2, 2, "/*") == 0;
  return is_wild && type.substr(0, range.size() - 1) == std::string_view(range).substr(0, range.size() - 1) ? 2 : 0;
}

// The quality of a type by the most specific range that matches with at least this specificity.
double quality_of(const std::vector<MediaRange>& ranges, std::string_view type, int at_least) {
  int best = 0;
  double quality = 0.0;
  for (const MediaRange& range : ranges) {
    const int match = specificity(range.type, type);
    if (match >= at_least && match > best) best = match, quality = range.quality;
  }
  return quality;
}

// "text" without its quotes and escapes (RFC 9110, 5.6.4); a token as it is.
std::string unquoted(std::string_view text) {
  if (text.size() < 2 || text.front() != '"' || text.back() != '"') return std::string(text);
  std::string out;
  for (size_t i = 1; i + 1 < text.size(); ++i) {
    if (text[i] == '\\' && i + 2 < text.size()) ++i;
    out += text[i];
  }
  return out;
}

// delta-seconds, and decimals; nothing for anything else.
std::optional<double> read_seconds(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789.") != std::string_view::npos) return std::nullopt;
  double seconds = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error == std::errc::result_out_of_range) return HUGE_VAL;
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return seconds;
}

std::string_view without_weakness(std::string_view tag) { return tag.substr(0, 2) == "W/" ? tag.substr(2) : tag; }

}  // namespace

std::vector<std::string> split_list(std::string_view value) { return split_unquoted(value, ','); }

std::vector<std::string> header_list(const Request& request, std::string_view name) {
  std::vector<std::string> out;
  const auto [first, last] = request.headers.equal_range(name);
  for (auto it = first; it != last; ++it) {
    for (auto& item : split_list(it->second)) out.push_back(std::move(item));
  }
  return out;
}

std::optional<std::string_view> best_offer(const Request& request, const std::vector<std::string_view>& offers) {
  const auto ranges = accepted(request);
  if (ranges.empty()) return offers.front();
  std::optional<std::string_view> best;
  double best_quality = 0.0;
  for (const std::string_view offer : offers) {
    const double quality = quality_of(ranges, offer, 1);
    if (quality > best_quality) best_quality = quality, best = offer;
  }
  return best;
}

std::optional<ImageFormat> asked_image_format(const Request& request, const std::vector<ImageFormat>& formats) {
  const auto ranges = accepted(request);
  std::optional<ImageFormat> best;
  double best_quality = 0.0;
  for (const ImageFormat format : formats) {
    const double quality = quality_of(ranges, media_type(format), 2);
    if (quality > best_quality) best_quality = quality, best = format;
  }
  if (quality_of(ranges, "application/json", 3) > best_quality) return std::nullopt;
  return best;
}

Preferences read_preferences(const Request& request) {
  Preferences out;
  bool has_wait = false;
  for (const std::string& item : header_list(request, "prefer")) {
    if (item.front() == ';') continue;
    const auto parts = split_unquoted(item, ';');  // a preference and its parameters, of which none means anything here
    const size_t equals = parts[0].find('=');
    const std::string_view name = trim(std::string_view(parts[0]).substr(0, equals));
    const std::string value =
        equals == std::string::npos ? "" : unquoted(trim(std::string_view(parts[0]).substr(equals + 1)));
    if (is_same_name(name, "respond-async") && value.empty()) out.respond_async = true;
    // Of equal ones the first counts (RFC 7240, 2), also where it says nothing that is understood.
    if (is_same_name(name, "wait") && !std::exchange(has_wait, true)) out.wait_s = read_seconds(value);
  }
  return out;
}

bool has_current(const Request& request, std::string_view etag) {
  const auto tags = header_list(request, "if-none-match");
  if (tags == std::vector<std::string>{"*"}) return true;
  return std::any_of(tags.begin(), tags.end(),
                     [&](const std::string& tag) { return without_weakness(tag) == without_weakness(etag); });
}

bool is_match_met(const Request& request, const Current& current) {
  if (!request.header("if-match")) return true;
  const auto tags = header_list(request, "if-match");
  if (tags == std::vector<std::string>{"*"}) return current.exists;
  const bool is_strong = current.exists && current.etag.substr(0, 1) == "\"";
  return is_strong && std::find(tags.begin(), tags.end(), current.etag) != tags.end();
}

Problem precondition_failed(const Current& current) {
  Problem failed{412, "precondition_failed", "", {}, {}};
  failed.detail = "what is here now is not what the request's If-Match or If-None-Match allows; ";
  if (!current.exists) {
    failed.detail += "it has no representation";
  } else if (current.etag.empty()) {
    failed.detail += "it has no entity tag";
  } else {
    failed.detail += "its entity tag is " + current.etag;
    if (has_prefix(current.etag, "W/")) failed.detail += ", a weak one, which If-Match never matches";
    failed.with("ETag", current.etag);
  }
  return failed;
}

::tl::expected<void, Problem> check_conditions(const Request& request, const Current& current) {
  const bool is_named = current.exists && has_current(request, current.etag);
  if (is_match_met(request, current) && !is_named) return {};
  return ::tl::unexpected<Problem>(precondition_failed(current));
}

}  // namespace tilelight::server
