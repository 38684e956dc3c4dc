// SPDX-License-Identifier: Apache-2.0
// Another program, run to its end, and a folder for what it leaves.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tilelight {

struct ChildResult {
  int status = 0;  // the exit code, or 128 + the signal that ended it
  std::string output;
};
enum class ChildErrors { pass_through, in_output };  // where its standard error goes

// Runs the program (by PATH, if its name has no slash) with `input` on its standard input, in this process's
// environment and `environment` ("NAME=value"). Throws std::system_error if it cannot be started.
ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments, std::string_view input,
                      const std::vector<std::string>& environment, ChildErrors errors = ChildErrors::pass_through);

// Empty at first, and gone with this object. Throws std::system_error.
class TemporaryFolder {
 public:
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace tilelight
