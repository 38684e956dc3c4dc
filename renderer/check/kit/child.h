// SPDX-License-Identifier: Apache-2.0
// A process of its own, for what is settled when one starts: the C library reads some of its environment only then.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/child_process.h"

namespace tilelight::check {

// A process that starts with it has a C library that does without AVX2 and FMA, whose last bits are others.
struct Variable {
  const char *name, *value;
};
inline constexpr Variable kPlainLibrary{"GLIBC_TUNABLES",
                                        "glibc.cpu.hwcaps=-AVX2,-FMA,-AVX512F,-AVX2_Usable,-FMA_Usable"};

// The bytes of the half-float image that the tilelight command renders of the scene in a process of its own; empty if
// it fails.
std::string image_by_command(const std::string& command, std::string_view scene_json,
                             const std::vector<std::string>& environment);

// All doubles of the rays behind one pixel (origins, directions, distances, normals, light) as the same command prints
// them, to the last bit; empty if it fails.
std::string rays_by_command(const std::string& command, std::string_view scene_json, int x, int y,
                            const std::vector<std::string>& environment);

}  // namespace tilelight::check
