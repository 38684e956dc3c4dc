// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/place.h"

#include <algorithm>
#include <charconv>
#include <numeric>
#include <vector>

#include "renderer/base/characters.h"

namespace tilelight {
namespace {

constexpr std::string_view kBlank = " \t\r\n";

// One request with its pointer cut into raw tokens, and the offset found for it.
struct Wanted {
  std::vector<std::string> tokens;
  bool at_key = false;
  size_t offset = std::string_view::npos;
};

std::vector<std::string> split_pointer(std::string_view pointer) {
  std::vector<std::string> tokens;
  for (size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~' && i + 1 < pointer.size()) {
      tokens.back() += pointer[++i] == '1' ? '/' : '~';
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

// The string whose JSON spelling, without quotes, is `raw`.
std::string unescape(std::string_view raw) {
  constexpr std::string_view kLetters = "bfnrt", kMeanings = "\b\f\n\r\t";
  const auto code_at = [&](size_t i) {
    return static_cast<char32_t>(std::stoul(std::string(raw.substr(i, 4)), nullptr, 16));
  };
  std::string out;
  for (size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] != '\\') {
      out += raw[i];
    } else if (raw[++i] != 'u') {
      const size_t letter = kLetters.find(raw[i]);
      out += letter == std::string_view::npos ? raw[i] : kMeanings[letter];
    } else {
      char32_t code = code_at(i + 1);
      i += 4;
      if (code >= 0xD800 && code < 0xDC00) {  // the first half of a surrogate pair
        code = 0x10000 + ((code - 0xD800) << 10) + (code_at(i + 3) - 0xDC00);
        i += 6;
      }
      append_utf8(code, out);
    }
  }
  return out;
}

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  // Scans one value; `wanted` are the requests whose first `depth` tokens lead here.
  void scan(const std::vector<Wanted*>& wanted, size_t depth) {
    skip_blank();
    for (Wanted* want : wanted) {
      if (want->tokens.size() == depth && !want->at_key) want->offset = at_;
    }
    const bool descend =
        std::any_of(wanted.begin(), wanted.end(), [depth](const Wanted* want) { return want->tokens.size() > depth; });
    if (!descend) {
      skip_value();
    } else if (text_[at_] == '{') {
      scan_object(wanted, depth);
    } else if (text_[at_] == '[') {
      scan_array(wanted, depth);
    } else {
      skip_value();
    }
  }

 private:
  static size_t index_from_token(const std::string& token) {
    size_t index = std::string::npos;
    std::from_chars(token.data(), token.data() + token.size(), index);
    return index;
  }

  void scan_object(const std::vector<Wanted*>& wanted, size_t depth) {
    std::vector<std::pair<std::string_view, Wanted*>> by_key;  // a million keys are not compared with every request
    for (Wanted* want : wanted) {
      if (want->tokens.size() > depth) by_key.emplace_back(want->tokens[depth], want);
    }
    std::sort(by_key.begin(), by_key.end());
    std::vector<Wanted*> inside;
    ++at_;
    for (skip_blank(); text_[at_] != '}'; skip_blank()) {
      const size_t key_at = at_;
      skip_string();
      const std::string key = unescape(text_.substr(key_at + 1, at_ - key_at - 2));
      inside.clear();
      auto same = std::lower_bound(by_key.begin(), by_key.end(), key,
                                   [](const auto& entry, const std::string& k) { return entry.first < k; });
      for (; same != by_key.end() && same->first == key; ++same) inside.push_back(same->second);
      for (Wanted* want : inside) {
        if (want->at_key && want->tokens.size() == depth + 1) want->offset = key_at;
      }
      skip_blank();
      ++at_;  // the colon
      scan(inside, depth + 1);
      skip_comma();
    }
    ++at_;
  }

  void scan_array(const std::vector<Wanted*>& wanted, size_t depth) {
    std::vector<std::pair<size_t, Wanted*>> by_index;  // lists are long: look only at the next index asked for
    for (Wanted* want : wanted) {
      if (want->tokens.size() > depth) by_index.emplace_back(index_from_token(want->tokens[depth]), want);
    }
    std::sort(by_index.begin(), by_index.end());
    auto next = by_index.begin();
    std::vector<Wanted*> inside;
    ++at_;
    skip_blank();
    for (size_t index = 0; text_[at_] != ']'; ++index) {
      inside.clear();
      for (; next != by_index.end() && next->first == index; ++next) inside.push_back(next->second);
      scan(inside, depth + 1);
      skip_comma();
      skip_blank();
    }
    ++at_;
  }

  void skip_blank() { at_ = std::min(text_.find_first_not_of(kBlank, at_), text_.size() - 1); }

  void skip_comma() {
    skip_blank();
    if (text_[at_] == ',') ++at_;
  }

  void skip_string() {
    for (++at_; text_[at_] != '"'; ++at_) {
      if (text_[at_] == '\\') ++at_;
    }
    ++at_;
  }

  void skip_value() {
    int open = 0;
    do {
      const char c = text_[at_];
      if (c == '"') {
        skip_string();
      } else if (c == '{' || c == '[') {
        ++open, ++at_;
      } else if (c == '}' || c == ']') {
        --open, ++at_;
      } else if (c == ',' || c == ':' || kBlank.find(c) != std::string_view::npos) {
        ++at_;
      } else {
        at_ = std::min(text_.find_first_of(" \t\r\n,:]}", at_), text_.size());
      }
    } while (open > 0);
  }

  std::string_view text_;
  size_t at_ = 0;
};

// Turns offsets, asked for in ascending order, into places by one pass over the text.
class PlaceCounter {
 public:
  explicit PlaceCounter(std::string_view text) : text_(text) {}

  TextPlace advance_to(size_t offset) {
    for (offset = std::min(offset, text_.size()); at_ < offset; ++at_) {
      if (text_[at_] == '\n') {
        ++place_.line;
        place_.column = 1;
      } else if ((static_cast<unsigned char>(text_[at_]) & 0xC0) != 0x80) {  // not the inside of a character
        ++place_.column;
      }
    }
    return place_;
  }

 private:
  std::string_view text_;
  size_t at_ = 0;
  TextPlace place_{1, 1};
};

}  // namespace

TextPlace place_of_offset(std::string_view text, size_t offset) { return PlaceCounter(text).advance_to(offset); }

void find_places(std::string_view text, std::span<PlaceRequest> requests) {
  std::vector<Wanted> wanted;
  std::vector<Wanted*> all;
  wanted.reserve(requests.size());
  for (const PlaceRequest& request : requests) {
    wanted.push_back({split_pointer(request.pointer), request.at_key});
    all.push_back(&wanted.back());
  }
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  const size_t mark = text.starts_with(kByteOrderMark) ? kByteOrderMark.size() : 0;
  Scanner(text.substr(mark)).scan(all, 0);
  std::vector<size_t> in_order(requests.size());
  std::iota(in_order.begin(), in_order.end(), size_t{0});
  std::sort(in_order.begin(), in_order.end(), [&](size_t a, size_t b) { return wanted[a].offset < wanted[b].offset; });
  PlaceCounter counter(text.substr(mark));
  for (const size_t i : in_order) {
    if (wanted[i].offset != std::string_view::npos) requests[i].place = counter.advance_to(wanted[i].offset);
  }
}

}  // namespace tilelight
