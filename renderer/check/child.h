// SPDX-License-Identifier: Apache-2.0
// A process of its own, for what is settled when one starts: the C library reads some of its environment only then.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tilelight::check {

// A process that starts with it has a C library that does without AVX2 and FMA, whose last bits are others.
struct Variable {
  const char *name, *value;
};
inline constexpr Variable kPlainLibrary{"GLIBC_TUNABLES",
                                        "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX2_Usable,-FMA_Usable"};

// Runs the program with `input` on its standard input, in this process's environment and `environment` ("NAME=value").
// Returns its exit code, or 128 + the signal that ended it. Throws std::system_error if it cannot be started.
int run_child(const std::string& program, const std::vector<std::string>& arguments, std::string_view input,
              const std::vector<std::string>& environment);

// The bytes of the half-float image that the tilelight command renders of the scene in a process of its own; empty if
// it fails.
std::string image_by_command(const std::string& command, std::string_view scene_json,
                             const std::vector<std::string>& environment);

}  // namespace tilelight::check
