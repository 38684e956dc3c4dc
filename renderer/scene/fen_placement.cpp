// SPDX-License-Identifier: Apache-2.0
// fen_pattern.cpp has the same as a regular expression.
#include <algorithm>
#include <array>

#include "renderer/base/characters.h"
#include "renderer/scene/fen.h"

namespace tilelight {
namespace {

constexpr int kSquares = 8;

// Signs that may touch the first rank or the last one, beside stops. '~' is of a rank.
constexpr std::string_view kMarks = "!#$%&*+-.=?@\\^";

struct Range {
  char32_t first, last;
};

template <size_t kCount>
bool is_in(const std::array<Range, kCount>& ranges, char32_t code) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [code](const Range& range) { return code >= range.first && code <= range.last; });
}

// What pages put into long words and editors before a text.
bool has_no_width(char32_t code) {
  constexpr std::array<Range, 8> kRanges = {{{0xAD, 0xAD},
                                             {0x61C, 0x61C},
                                             {0x180E, 0x180E},
                                             {0x200B, 0x200F},
                                             {0x202A, 0x202E},
                                             {0x2060, 0x2064},
                                             {0x2066, 0x2069},
                                             {0xFEFF, 0xFEFF}}};
  return is_in(kRanges, code);
}

// Quotation marks, brackets and punctuation; beyond ASCII all of it.
bool is_stop(char32_t code) {
  constexpr std::array<Range, 8> kBeyondAscii = {{{0xA1, 0xAC},
                                                  {0xAE, 0xBF},
                                                  {0x2010, 0x2027},
                                                  {0x2030, 0x205E},
                                                  {0x3001, 0x301F},
                                                  {0xFF01, 0xFF0F},
                                                  {0xFF1A, 0xFF20},
                                                  {0xFF3B, 0xFF40}}};
  return code < 0x80 ? std::string_view("\"'`,;:|()[]{}<>").find(static_cast<char>(code)) != std::string_view::npos
                     : is_in(kBeyondAscii, code);
}

template <class Test>
size_t bytes_if(std::string_view text, size_t at, Test test) {
  if (at >= text.size()) return 0;
  const Character character = character_at(text, at);
  return test(character.code) ? character.bytes : 0;
}

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

// The blank or the sign that "%20" at `at` stands for.
std::optional<char> sign_at(std::string_view text, size_t at) {
  if (at + 2 >= text.size() || text[at] != '%') return std::nullopt;
  const int high = digit_of(text[at + 1]), low = digit_of(text[at + 2]);
  if (high < 0 || low < 0 || high > 7) return std::nullopt;
  const char c = static_cast<char>(16 * high + low);
  const bool is_sign = c == '/' || blank_at({&c, 1}, 0) > 0 || is_stop(static_cast<char32_t>(c)) ||
                       kMarks.find(c) != std::string_view::npos;
  return is_sign ? std::optional(c) : std::nullopt;
}

size_t skip_blanks(std::string_view text, size_t at) {
  while (const size_t bytes = blank_at(text, at)) at += bytes;
  return at;
}

bool is_word_end(std::string_view text, size_t at) {
  return at >= text.size() || stop_at(text, at) > 0 || (blank_at(text, at) > 0 && no_width_at(text, at) == 0);
}

size_t end_of_word(std::string_view text, size_t at) {
  while (!is_word_end(text, at)) at += character_at(text, at).bytes;
  return at;
}

size_t end_of_rank(std::string_view text, size_t at) {
  while (!is_word_end(text, at) && text[at] != '/') at += character_at(text, at).bytes;
  return at;
}

// The rank ends, where it is full, at a mark and at what has no width too.
size_t end_of_last_rank(std::string_view text, size_t at) {
  int squares = 0;
  while (!is_word_end(text, at) && text[at] != '/') {
    const size_t hidden = no_width_at(text, at);
    if (squares >= kSquares && (hidden > 0 || kMarks.find(text[at]) != std::string_view::npos)) break;
    if (hidden == 0 && text[at] != '~') squares += text[at] >= '1' && text[at] <= '8' ? text[at] - '0' : 1;
    at += character_at(text, at).bytes;
  }
  return at;
}

size_t end_of_men(std::string_view text, size_t at) {
  return std::min(text.find_first_not_of("PNBRQpnbrq~-", at), text.size());
}

// Men alone behind the slash at `at`. A king is never in a pocket: with a king it is a ninth rank.
bool is_slash_pocket(std::string_view text, size_t at) {
  const size_t end = end_of_men(text, at + 1);
  return is_word_end(text, end) || no_width_at(text, end) > 0 || kMarks.find(text[end]) != std::string_view::npos;
}

// Where the pocket at `at` ends: `at`, if there is none.
size_t end_of_pocket(std::string_view text, size_t at) {
  if (at < text.size() && text[at] == '/') at = end_of_men(text, at + 1);
  if (at >= text.size() || text[at] != '[') return at;
  const size_t bracket = text.find(']', at);
  return bracket == std::string_view::npos ? at : bracket + 1;
}

// The ranks from `at` on. They may be spread over lines.
Placement cut_placement(std::string_view text, size_t at) {
  Placement out;
  size_t end = at;
  for (bool more = true; more;) {
    end = out.ranks.size() + 1 == kFenRanks ? end_of_last_rank(text, at) : end_of_rank(text, at);
    out.ranks.push_back(text.substr(at, end - at));
    const size_t slash = out.ranks.size() < kFenRanks ? skip_blanks(text, end) : end;
    more =
        slash < text.size() && text[slash] == '/' && !(out.ranks.size() == kFenRanks && is_slash_pocket(text, slash));
    at = more ? skip_blanks(text, slash + 1) : end;
  }
  std::string_view& first = out.ranks[0];
  first.remove_prefix(first.find_last_of(kMarks) + 1);  // npos + 1 is 0
  out.before = text.substr(0, static_cast<size_t>(first.data() - text.data()));
  const size_t pocket_end = out.ranks.size() == kFenRanks ? end_of_pocket(text, end) : end;
  out.pocket = text.substr(end, pocket_end - end);
  out.behind = text.substr(pocket_end);
  return out;
}

// Past what is of no word, and past slashes that follow no rank.
size_t skip_to_word(std::string_view text, size_t at) {
  const auto skipped = [text](size_t i) {
    const size_t bytes = std::max(blank_at(text, i), stop_at(text, i));
    return bytes == 0 && i < text.size() && text[i] == '/' ? 1 : bytes;
  };
  while (const size_t bytes = skipped(at)) at += bytes;
  return at;
}

}  // namespace

size_t no_width_at(std::string_view text, size_t at) { return bytes_if(text, at, has_no_width); }

size_t blank_at(std::string_view text, size_t at) {
  return bytes_if(text, at, [](char32_t c) { return c == U'_' || is_white_space(c) || has_no_width(c); });
}

size_t stop_at(std::string_view text, size_t at) {
  return text.substr(std::min(at, text.size())).starts_with("://") ? 0 : bytes_if(text, at, is_stop);
}

std::string unescaped_fen(std::string_view text) {
  std::string out;
  for (size_t at = 0; at < text.size(); ++at) {
    const auto sign = sign_at(text, at);
    if (!sign && text.substr(at).starts_with("\\/")) ++at;
    out += sign.value_or(text[at]);
    if (sign) at += 2;
  }
  return out;
}

Placement find_placement(std::string_view text) {
  Placement most;
  for (size_t at = skip_to_word(text, 0); at < text.size(); at = skip_to_word(text, at)) {
    const size_t end = end_of_word(text, at);
    if (text.substr(at, end - at).find("://") != std::string_view::npos) {
      at = end;
      continue;
    }
    Placement found = cut_placement(text, at);
    at = text.size() - found.behind.size();
    if (found.ranks.size() > most.ranks.size()) most = std::move(found);
    if (most.ranks.size() >= kFenRanks) break;
  }
  return most;
}

}  // namespace tilelight
