// SPDX-License-Identifier: Apache-2.0
// Ctrl-C and SIGTERM as a flag that the command looks at; a second one ends the process at once.
#pragma once

namespace tilelight::cli {

void catch_interrupts();  // once, before any thread starts
bool is_interrupted();

}  // namespace tilelight::cli
