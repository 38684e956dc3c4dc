// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>

#include "renderer/base/standard_streams.h"
#include "renderer/cli/command_line.h"
#include "renderer/cli/complain.h"
#include "renderer/cli/interrupt.h"

namespace tilelight::cli {
namespace {

// A full disk or a closed pipe may show only when what is buffered is written.
ExitCode check_printed(ExitCode code) {
  const bool was_written = !std::ferror(stdout);
  errno = 0;
  if (std::fflush(stdout) == 0 && std::cout.flush() && was_written) return code;
  if (code != kOk) return code;
  // Where it failed before, the reason is forgotten; one more line end fails for the same.
  const bool is_known = errno != 0 || ::write(STDOUT_FILENO, "\n", 1) < 0;
  return complain(kFailed, "cannot write standard output" + (is_known ? std::string(": ") + std::strerror(errno) : ""));
}

}  // namespace
}  // namespace tilelight::cli

int main(int argc, char** argv) {
  using namespace tilelight::cli;
  tilelight::hold_standard_streams();
  try {
    catch_interrupts();
    return check_printed(run_command_line(argc, argv));
  } catch (const std::exception& error) {
    return complain(kFailed, std::string("this is a bug, or memory is short: ") + error.what());
  }
}
