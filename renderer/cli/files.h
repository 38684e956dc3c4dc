// SPDX-License-Identifier: Apache-2.0
// Files of the command: input with a limit, output all or nothing.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "renderer/base/result.h"

namespace tilelight::cli {

// The whole file, or standard input for "-". Reads no more than max_bytes + 1: enough to see that it is too long.
Result<std::string> read_input(const std::string& path, int64_t max_bytes);

// An error if no file could be made at this path; so that a render does not find it out at its end.
Result<void> check_can_write(const std::string& path);

// Writes beside the target and renames, so that the path holds the old file or the whole new one, never a part.
// "-" and what is no regular file (a pipe, a device) are written to as they are.
Result<void> write_output(const std::string& path, std::string_view bytes);

}  // namespace tilelight::cli
