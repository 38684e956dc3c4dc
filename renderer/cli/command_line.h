// SPDX-License-Identifier: Apache-2.0
// The command line: options to arguments, and the subcommand that was named.
#pragma once

#include "renderer/cli/exit_code.h"

namespace tilelight::cli {

ExitCode run_command_line(int argc, const char* const* argv);

}  // namespace tilelight::cli
