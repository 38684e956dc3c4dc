// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "renderer/base/characters.h"
#include "renderer/scene/fen.h"
#include "renderer/scene/problems.h"

namespace tilelight {
namespace {

bool is_same_word(std::string_view word, std::string_view lower_case) {
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

// Words that say that a position follows: UCI, the protocol of xboard, PGN.
bool is_label(std::string_view word) {
  constexpr std::array<std::string_view, 5> kLabels = {"position", "fen", "epd", "setboard", "setup"};
  return std::any_of(kLabels.begin(), kLabels.end(), [word](auto label) { return is_same_word(word, label); });
}

// Bytes of what is between words at `at`.
size_t gap_at(std::string_view text, size_t at) { return std::max(blank_at(text, at), stop_at(text, at)); }

// Without what `bytes_at` finds at both ends.
template <class BytesAt>
std::string_view trim(std::string_view text, BytesAt bytes_at) {
  size_t begin = 0, end = 0;
  while (const size_t bytes = bytes_at(text, begin)) begin += bytes;
  for (size_t at = begin; at < text.size();) {
    const size_t bytes = bytes_at(text, at);
    at += bytes > 0 ? bytes : character_at(text, at).bytes;
    if (bytes == 0) end = at;
  }
  return end > begin ? text.substr(begin, end - begin) : std::string_view();
}

std::string_view first_word(std::string_view text) {
  size_t end = 0;
  while (end < text.size() && gap_at(text, end) == 0) end += character_at(text, end).bytes;
  return text.substr(0, end);
}

// `text` from its first word on.
std::string_view behind_gap(std::string_view text) {
  size_t at = 0;
  while (const size_t bytes = gap_at(text, at)) at += bytes;
  return text.substr(at);
}

// Whether `field` may be the n-th of the five that follow the squares.
bool is_field(std::string_view field, int n) {
  const auto has_only = [field](std::string_view letters) {
    return field.find_first_not_of(letters) == std::string_view::npos;
  };
  switch (n) {
    case 0:
      return field == "w" || field == "b";
    case 1:  // castling; the files of rooks in Shredder-FEN and X-FEN
      return field == "-" || (field.size() <= 4 && has_only("KQkqABCDEFGHabcdefgh"));
    case 2:
      return field == "-" || (field.size() == 2 && has_only("abcdefgh12345678") && field[1] <= '8');
    default:
      return field.size() <= 6 && has_only("0123456789");
  }
}

}  // namespace

bool says_nothing(std::string_view text) {
  while (!(text = behind_gap(text)).empty()) {
    std::string_view word = first_word(text);
    text.remove_prefix(word.size());
    if (word.ends_with('=')) word.remove_suffix(1);  // "fen="
    if (!word.empty() && !is_label(word)) return false;
  }
  return true;
}

std::optional<std::string> left_before_fen(std::string_view before) {
  if (says_nothing(before)) return std::nullopt;
  return in_quotes(trim(before, blank_at)) + " is left out";
}

std::optional<std::string> left_behind_fen(std::string_view behind) {
  constexpr int kFields = 5;
  for (int n = 0; n < kFields; ++n) {
    behind = behind_gap(behind);
    const std::string_view field = first_word(behind);
    if (is_field(field, n)) behind.remove_prefix(field.size());
  }
  behind = trim(behind, gap_at);
  if (behind.empty()) return std::nullopt;
  const bool has_another = find_placement(behind).ranks.size() >= kFenRanks;
  return in_quotes(behind) + " is left out" + (has_another ? ": of several positions the first is drawn" : "");
}

}  // namespace tilelight
