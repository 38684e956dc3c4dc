// SPDX-License-Identifier: Apache-2.0
// A folder of results, with a page to look at. What goes wrong is told on standard error.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "renderer/base/result.h"
#include "renderer/cli/exit_code.h"

namespace tilelight::cli {

// Makes the folder, if it is not there, and sees that the page can be written: before the work and not after it.
ExitCode make_folder(const std::string& folder, const std::string& page);

using File = std::pair<std::string, Result<std::string>>;  // name and bytes, or why there are none

// Each whole or not at all, in this order.
ExitCode write_files(const std::vector<File>& files, const std::string& folder);

}  // namespace tilelight::cli
