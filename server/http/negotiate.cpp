// SPDX-License-Identifier: Apache-2.0
#include "server/http/negotiate.h"

#include <algorithm>
#include <charconv>

#include "server/http/text.h"

namespace tilelight::server {
namespace {

std::string lower(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

// All values of a header as one list.
std::vector<std::string> header_list(const Request& request, std::string_view name) {
  std::vector<std::string> out;
  const auto [first, last] = request.headers.equal_range(name);
  for (auto it = first; it != last; ++it) {
    for (auto& item : split_list(it->second)) out.push_back(std::move(item));
  }
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
    const std::string text = lower(item);
    size_t at = text.find(';');
    range.type = trim(std::string_view(text).substr(0, at));
    while (at != std::string::npos) {
      const size_t next = text.find(';', at + 1);
      const std::string_view parameter =
          trim(std::string_view(text).substr(at + 1, next == std::string::npos ? next : next - at - 1));
      if (parameter.rfind("q=", 0) == 0) {
        double quality = 0.0;
        std::from_chars(parameter.data() + 2, parameter.data() + parameter.size(), quality);
        range.quality = std::clamp(quality, 0.0, 1.0);
      }
      at = next;
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

std::string_view without_weakness(std::string_view tag) { return tag.substr(0, 2) == "W/" ? tag.substr(2) : tag; }

}  // namespace

std::vector<std::string> split_list(std::string_view value) {
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
    if (value[i] == ',' && !is_quoted) {
      flush();
    } else {
      item += value[i];
    }
  }
  flush();
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
  for (const std::string& item : header_list(request, "prefer")) {
    const std::string text = lower(item);
    if (text == "respond-async") out.respond_async = true;
    if (text.rfind("wait=", 0) != 0) continue;
    double seconds = 0.0;
    const auto [end, error] = std::from_chars(text.data() + 5, text.data() + text.size(), seconds);
    if (error == std::errc() && end == text.data() + text.size() && seconds >= 0.0) out.wait_s = seconds;
  }
  return out;
}

bool has_current(const Request& request, std::string_view etag) {
  for (const std::string& tag : header_list(request, "if-none-match")) {
    if (tag == "*" || without_weakness(tag) == without_weakness(etag)) return true;
  }
  return false;
}

}  // namespace tilelight::server
