// SPDX-License-Identifier: Apache-2.0
// What the command returns. Scripts rely on it: never renumber.
#pragma once

namespace tilelight::cli {

enum ExitCode : int {
  kOk = 0,
  kFailed = 1,         // the render failed, or a file could not be read or written
  kBadInput = 2,       // the command line or the scene is wrong
  kInterrupted = 130,  // by Ctrl-C or SIGTERM, as shells count it
};

}  // namespace tilelight::cli
