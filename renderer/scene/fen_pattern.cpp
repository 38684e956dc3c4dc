// SPDX-License-Identifier: Apache-2.0
// What parse_fen takes, as a regular expression: the same parts in the same order.
#include <string>

#include "renderer/scene/fen.h"

namespace tilelight {
namespace {

std::string make_pattern() {
  // Insides of classes: as blank_at and quote_at have them.
  const std::string blank =
      R"(\t-\r _\u0085\u00a0\u00ad\u061c\u1680\u180e\u2000-\u200f\u2028-\u202f\u205f-\u2064\u2066-\u2069\u3000\ufeff)";
  const std::string quote = R"("'`\u00ab\u00b4\u00bb\u2018-\u201f\u2039\u203a)";
  const std::string men = "PNBRQKSMpnbrqksm";

  const std::string gap = "[" + blank + quote + "]*", blanks = "[" + blank + "]*";
  const std::string label =
      "(?:[Pp][Oo][Ss][Ii][Tt][Ii][Oo][Nn]|[Ff][Ee][Nn]|[Ee][Pp][Dd]|[Ss][Ee][Tt][Bb][Oo][Aa][Rr][Dd]|"
      "[Ss][Ee][Tt][Uu][Pp])[" +
      blank + "]";
  const std::string before = gap + "(?:(?:[0-9A-Za-z-]+" + gap + "[:=]|" + label + ")" + gap + ")*";
  const std::string tag = gap + R"(\[(?:[\s\S]*\[)?[Ff][Ee][Nn][)" + blank + "]+\"" + blanks;
  const std::string rank = "(?:[1-8]|[" + men + "]~?){1,8}";
  const std::string pocket = R"((?:\[[)" + men + R"(~-]*\]|/[PNBRQpnbrq~-]*)?)";
  return "^(?:" + before + "|" + tag + ")" + rank + "(?:" + blanks + "/" + blanks + rank + "){7}" + pocket + "(?:[,;" +
         blank + quote + "]|$)";
}

}  // namespace

std::string_view fen_pattern() {
  static const std::string pattern = make_pattern();
  return pattern;
}

}  // namespace tilelight
