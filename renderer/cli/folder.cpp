// SPDX-License-Identifier: Apache-2.0
#include "renderer/cli/folder.h"

#include <filesystem>

#include "renderer/cli/complain.h"
#include "renderer/cli/files.h"

namespace tilelight::cli {

ExitCode make_folder(const std::string& folder, const std::string& page) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) return complain(kFailed, folder + ": " + error.message());
  const std::string path = (std::filesystem::path(folder) / page).string();
  if (auto writable = check_can_write(path); !writable) return complain(kFailed, writable.error().detail);
  return kOk;
}

ExitCode write_files(const std::vector<File>& files, const std::string& folder) {
  for (const auto& [name, bytes] : files) {
    if (!bytes) return complain(kFailed, bytes.error().detail);
    if (auto written = write_output((std::filesystem::path(folder) / name).string(), *bytes); !written)
      return complain(kFailed, written.error().detail);
  }
  return kOk;
}

}  // namespace tilelight::cli
