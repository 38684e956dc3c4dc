// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "renderer/base/characters.h"
#include "renderer/scene/fen.h"
#include "renderer/scene/problems.h"

namespace tilelight {
namespace {

// Characters without width, which pages put into long words and editors before a text.
bool is_invisible(char32_t code) {
  return code == 0xAD || code == 0x61C || code == 0x180E || (code >= 0x200B && code <= 0x200F) ||
         (code >= 0x202A && code <= 0x202E) || (code >= 0x2060 && code <= 0x2064) ||
         (code >= 0x2066 && code <= 0x2069) || code == 0xFEFF;
}

bool is_quote(char32_t code) {
  return code == U'"' || code == U'\'' || code == U'`' || code == 0xAB || code == 0xB4 || code == 0xBB ||
         (code >= 0x2018 && code <= 0x201F) || code == 0x2039 || code == 0x203A;
}

template <class Test>
size_t bytes_if(std::string_view text, size_t at, Test test) {
  if (at >= text.size()) return 0;
  const Character character = character_at(text, at);
  return test(character.code) ? character.bytes : 0;
}

bool is_word_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
}

bool is_same_word(std::string_view word, std::string_view lower_case) {
  return std::equal(word.begin(), word.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

// Words that say that a position follows: UCI, the protocol of xboard, PGN.
bool is_label(std::string_view word) {
  constexpr std::array<std::string_view, 5> kLabels = {"position", "fen", "epd", "setboard", "setup"};
  return std::any_of(kLabels.begin(), kLabels.end(), [word](auto label) { return is_same_word(word, label); });
}

size_t skip_blanks_and_quotes(std::string_view text, size_t at) {
  for (size_t bytes; (bytes = blank_at(text, at) + quote_at(text, at)) > 0;) at += bytes;
  return at;
}

bool is_blank_alone(std::string_view text) {
  size_t at = 0;
  while (const size_t bytes = blank_at(text, at)) at += bytes;
  return at == text.size();
}

std::string_view trim(std::string_view text) {
  const auto skipped = [](std::string_view t, size_t at) { return blank_at(t, at) + stop_at(t, at); };
  size_t begin = 0, end = 0;
  while (const size_t bytes = skipped(text, begin)) begin += bytes;
  for (size_t at = begin; at < text.size();) {
    const size_t bytes = skipped(text, at);
    at += bytes > 0 ? bytes : character_at(text, at).bytes;
    if (bytes == 0) end = at;
  }
  return end > begin ? text.substr(begin, end - begin) : std::string_view();
}

// The value of a game's tag FEN, to the end of the text.
::tl::expected<std::string_view, std::string> skip_before_tag(std::string_view text,
                                                              std::vector<std::string>& left_out) {
  for (size_t at = 0; (at = text.find('[', at)) != std::string_view::npos;) {
    size_t next = ++at + 3;
    if (!is_same_word(text.substr(at, 3), "fen") || blank_at(text, next) == 0) continue;
    while (const size_t bytes = blank_at(text, next)) next += bytes;
    if (next >= text.size() || text[next] != '"') continue;
    for (++next; blank_at(text, next) > 0;) next += blank_at(text, next);
    const std::string_view value = text.substr(std::min(next, text.size()));
    const size_t end = std::min(value.find('"'), value.size());
    const size_t bracket = value.find(']', end);
    const bool has_more = bracket != std::string_view::npos && !is_blank_alone(value.substr(bracket + 1));
    if (has_more || !is_blank_alone(text.substr(0, at - 1)))
      left_out.emplace_back("the other tags and the moves of the game are left out");
    return value.substr(0, end);
  }
  return ::tl::unexpected(
      std::string("found '[' first, as before the tags of a game, but no tag [FEN \"...\"]; allowed: a FEN"));
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

std::string_view first_field(std::string_view text) {
  size_t end = 0;
  while (end < text.size() && blank_at(text, end) == 0) end += character_at(text, end).bytes;
  return text.substr(0, end);
}

bool has_another_position(std::string_view text) {
  constexpr int kSlashes = 7;
  for (text = trim(text); !text.empty();) {
    const std::string_view field = first_field(text);
    if (std::count(field.begin(), field.end(), '/') >= kSlashes) return true;
    text = trim(text.substr(field.size()));
  }
  return false;
}

}  // namespace

size_t blank_at(std::string_view text, size_t at) {
  return bytes_if(text, at, [](char32_t c) { return c == U'_' || is_white_space(c) || is_invisible(c); });
}

size_t quote_at(std::string_view text, size_t at) { return bytes_if(text, at, is_quote); }

size_t stop_at(std::string_view text, size_t at) {
  return bytes_if(text, at, [](char32_t c) { return c == U',' || c == U';' || is_quote(c); });
}

::tl::expected<std::string_view, std::string> skip_before_fen(std::string_view text,
                                                              std::vector<std::string>& left_out) {
  size_t at = skip_blanks_and_quotes(text, 0);
  std::optional<size_t> first_name;  // where what is no label of ours begins, and behind the last of it
  size_t names_end = 0;
  if (at < text.size() && text[at] == '[') return skip_before_tag(text.substr(at), left_out);
  while (at < text.size()) {
    size_t end = at;
    while (end < text.size() && is_word_letter(text[end])) ++end;
    const std::string_view word = text.substr(at, end - at);
    const size_t next = skip_blanks_and_quotes(text, end);
    const std::string_view behind = text.substr(next);
    const bool has_colon =
        !word.empty() && (behind.starts_with(':') || behind.starts_with('=')) && !behind.starts_with("://");
    if (!has_colon && !(is_label(word) && blank_at(text, end) > 0)) break;
    if (has_colon && !is_label(word)) first_name = first_name.value_or(at), names_end = next + 1;
    at = skip_blanks_and_quotes(text, has_colon ? next + 1 : next);
  }
  if (first_name) left_out.push_back(in_quotes(text.substr(*first_name, names_end - *first_name)) + " is left out");
  if (at == text.size()) return ::tl::unexpected(std::string("found an empty position; allowed: a FEN"));
  return text.substr(at);
}

std::optional<std::string> left_behind_fen(std::string_view rest) {
  constexpr int kFields = 5;
  rest = trim(rest);
  for (int n = 0; n < kFields && !rest.empty(); ++n) {
    const std::string_view field = first_field(rest);
    if (is_field(trim(field), n)) rest = trim(rest.substr(field.size()));
  }
  if (rest.empty()) return std::nullopt;
  return in_quotes(rest) + " is left out" +
         (has_another_position(rest) ? ": of several positions the first is drawn" : "");
}

}  // namespace tilelight
