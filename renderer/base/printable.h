// SPDX-License-Identifier: Apache-2.0
// Text of others, made safe to show: what a terminal, an editor or a reader's eye would act on instead of showing it
// becomes an escape. That is Unicode's controls (C0, DEL, C1), its format characters (directions, zero widths, tags),
// line and paragraph separators, what is ignorable by default, and code points without a character.
#pragma once

#include <string>
#include <string_view>

namespace tilelight {

// Those as \uXXXX, beyond U+FFFF as \UXXXXXXXX; bytes that are no UTF-8 as \xXX. For people: backslashes stay as they
// are, so that it does not read back.
std::string printable(std::string_view text);

// The same, but line feeds stay.
std::string printable_lines(std::string_view text);

// Those of a JSON text as \uXXXX: it reads back to the same values. REQUIRES: valid JSON, so that they stand within
// strings.
std::string printable_json(std::string_view json);

}  // namespace tilelight
