// SPDX-License-Identifier: Apache-2.0
// On what a benchmark ran, so that its figures can say so.
#pragma once

#include <string>

namespace tilelight::bench {

// As "AMD EPYC, 2 processors"; by /proc/cpuinfo.
std::string machine_name();

// Today, as 2026-01-31, UTC.
std::string today();

}  // namespace tilelight::bench
