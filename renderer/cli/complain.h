// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <string>

#include "renderer/base/characters.h"
#include "renderer/cli/exit_code.h"

namespace tilelight::cli {

// Tells what went wrong on standard error, and hands the code back.
inline ExitCode complain(ExitCode code, const std::string& what) {
  std::fprintf(stderr, "tilelight: %s\n", printable_lines(what).c_str());
  return code;
}

}  // namespace tilelight::cli
