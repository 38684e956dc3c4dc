// SPDX-License-Identifier: Apache-2.0
// The three descriptors that every program starts with, for programs that were started without some of them.
#pragma once

namespace tilelight {

// Puts something where standard input, output or error is closed, else the next file that is opened would take its
// place, and what is printed would go into that file. Reading and writing there fail (EBADF). To be called first.
void hold_standard_streams();

}  // namespace tilelight
