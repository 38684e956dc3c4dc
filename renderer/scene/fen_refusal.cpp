// SPDX-License-Identifier: Apache-2.0
// Why a text is no position that can be drawn, in the words of who wrote it.
#include <algorithm>

#include "renderer/base/characters.h"
#include "renderer/scene/fen.h"

namespace tilelight {
namespace {

constexpr int kMostFiles = 1000;  // more are told as so many

// The files of a rank on a board of any size: digits are read together ("10"), every other character is a man, but for
// the signs of promoted ones.
int files_of(std::string_view rank) {
  int files = 0, run = 0;
  for (size_t at = 0; at < rank.size(); at += character_at(rank, at).bytes) {
    const char c = rank[at];
    const bool is_digit = c >= '0' && c <= '9';
    if (is_digit) run = std::min(10 * run + (c - '0'), kMostFiles);
    if (is_digit) continue;
    files = std::min(files + run + (c == '+' || c == '~' ? 0 : 1), kMostFiles);
    run = 0;
  }
  return std::min(files + run, kMostFiles);
}

std::string game_of(size_t ranks, int files) {
  if (ranks == 10 && files == 9) return ", as in xiangqi";
  if (ranks == 9 && files == 9) return ", as in shogi";
  if (ranks == 8 && files == 10) return ", as in capablanca chess";
  return "";
}

constexpr std::string_view kAllowed =
    "; allowed: 8 ranks of 8 files, from the eighth rank to the first, divided by \"/\"";

// Chess symbols, and what diagrams are made of.
bool is_of_diagram(char32_t code) {
  return code == U'.' || code == U'|' || code == U'\n' || code == U'\r' || (code >= 0x2654 && code <= 0x265F) ||
         (code >= 0x2500 && code <= 0x25FF);
}

bool is_diagram(std::string_view text) {
  constexpr int kFewest = 7;  // lines are parted so often
  int parts = 0;
  for (size_t at = 0; at < text.size();) {
    const auto [code, bytes] = character_at(text, at);
    parts += is_of_diagram(code);
    at += bytes;
  }
  return parts >= kFewest && text.find('/') == std::string_view::npos;
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

// "https://lichess.org/...", "lichess.org/...".
bool is_address(std::string_view text) {
  const std::string_view host = text.substr(0, text.find('/'));
  const size_t dot = std::min(host.rfind('.'), host.size());
  const bool has_dot = dot > 0 && dot + 1 < host.size() && is_letter(host[dot - 1]) && is_letter(host[dot + 1]);
  const bool is_word = host.find(' ') == std::string_view::npos && host.size() < text.size();
  return text.find("://") != std::string_view::npos || (has_dot && is_word);
}

// "[Event" first.
bool has_tags(std::string_view text) {
  size_t at = 0;
  while (const size_t bytes = blank_at(text, at)) at += bytes;
  return at + 1 < text.size() && text[at] == '[' && is_letter(text[at + 1]);
}

}  // namespace

std::optional<std::string> other_board(const std::vector<std::string_view>& ranks) {
  constexpr size_t kFewestRanks = 6;  // fewer are a part of a board
  if (ranks.size() < kFewestRanks) return std::nullopt;
  const int files = files_of(ranks[0]);
  const bool is_chess = ranks.size() == 8 && files == 8;
  if (is_chess || files == 0) return std::nullopt;
  if (std::any_of(ranks.begin(), ranks.end(), [files](std::string_view rank) { return files_of(rank) != files; }))
    return std::nullopt;
  return "found " + std::to_string(ranks.size()) + " ranks of " + std::to_string(files) + " files" +
         game_of(ranks.size(), files) + std::string(kAllowed);
}

std::string why_no_fen(std::string_view text, const std::vector<std::string_view>& ranks) {
  if (auto board = other_board(ranks)) return *board;
  if (is_diagram(text))
    return "found a diagram, no FEN" + std::string(kAllowed) + ", men as letters and empty squares as numbers";
  if (is_address(text)) return "found an address; allowed: a FEN alone, which is the part of it with seven slashes";
  if (text.find("startpos") != std::string_view::npos)
    return "found \"startpos\", which names a position without its squares; allowed: a FEN";
  if (has_tags(text)) return "found the tags of a game, but no tag [FEN \"...\"]; allowed: a FEN";
  if (ranks.size() <= 1) return "found no \"/\" between ranks" + std::string(kAllowed);
  return "found " + std::to_string(ranks.size()) + " ranks" + std::string(kAllowed);
}

}  // namespace tilelight
