// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <exception>

#include "renderer/cli/command_line.h"
#include "renderer/cli/interrupt.h"

int main(int argc, char** argv) {
  try {
    tilelight::cli::catch_interrupts();
    return tilelight::cli::run_command_line(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tilelight: this is a bug, or memory is short: %s\n", error.what());
    return tilelight::cli::kFailed;
  }
}
