// SPDX-License-Identifier: Apache-2.0
// What parse_fen takes, as a regular expression: what find_placement looks for.
#include <string>

#include "renderer/scene/fen.h"

namespace tilelight {
namespace {

std::string make_pattern() {
  // Insides of classes: as no_width_at, blank_at, stop_at and the marks of find_placement have them.
  const std::string no_width = R"(\u00ad\u061c\u180e\u200b-\u200f\u202a-\u202e\u2060-\u2064\u2066-\u2069\ufeff)";
  const std::string white = R"(\t-\r _\u0085\u00a0\u1680\u2000-\u200a\u2028\u2029\u202f\u205f\u3000)";
  const std::string blank = white + no_width;
  const std::string stop =
      R"("'`,;:|()\[\]{}<>\u00a1-\u00ac\u00ae-\u00bf\u2010-\u2027\u2030-\u205e\u3001-\u301f\uff01-\uff0f)"
      R"(\uff1a-\uff20\uff3b-\uff40)";
  const std::string mark = R"(!#$%&*+.=?@\\\^\-)";

  const std::string hidden = "[" + no_width + "]*";
  const std::string blank_sign = "%(?:20|0[9AaDd])", slash_sign = R"((?:\\?/|%2[Ff]))";
  const std::string blanks = "(?:[" + blank + "]|" + blank_sign + ")*";
  // What has no width before the first blank is of the rank: so that there is one way to match it.
  const std::string slash = "(?:(?:[" + white + "]|" + blank_sign + ")" + blanks + ")?" + slash_sign + blanks;
  const std::string rank = "(?:(?:[1-8]|[PNBRQKSMpnbrqksm](?:" + hidden + "~)?)" + hidden + "){1,8}";
  // A rank begins a word, or a mark is before it in the word. A sign that is percent-encoded begins another word.
  const std::string letter = "(?:[^/%" + blank + stop + "]|%(?![0-7][0-9A-Fa-f]))";
  const std::string begin =
      "(?:^|[" + blank + stop + "]|%(?!2[Ff])[0-7][0-9A-Fa-f])" + slash_sign + "*(?:" + letter + "*[" + mark + "])?";
  const std::string end = "(?:" + slash_sign + "[PNBRQpnbrq~-]*)?(?:[" + blank + stop + mark + "]|$)";
  return begin + rank + "(?:" + slash + rank + "){7}" + end;
}

}  // namespace

std::string_view fen_pattern() {
  static const std::string pattern = make_pattern();
  return pattern;
}

}  // namespace tilelight
