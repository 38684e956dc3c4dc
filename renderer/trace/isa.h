// SPDX-License-Identifier: Apache-2.0
// The instruction set the kernels are dispatched to. By default the best that the CPU has.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/result.h"

namespace tilelight {

// Names of the sets that this build has and this CPU can run, best first: "AVX3" (AVX-512), "AVX2", "SSE4", "SCALAR".
std::vector<std::string> available_isas();

// The set in use.
std::string current_isa();

// Restricts dispatch to the named set (not case-sensitive); "auto" lifts it. For the whole process, for tests and the
// command line; not while renders run. Errors: unknown_name, not_available.
Result<void> select_isa(std::string_view name);

}  // namespace tilelight
