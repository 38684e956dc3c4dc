// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/child_process.h"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <utility>

namespace tilelight {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(int code, const char* doing) { throw std::system_error(code, std::generic_category(), doing); }

std::string name_of(std::string_view variable) { return std::string(variable.substr(0, variable.find('=') + 1)); }

// This process's environment with some variables set.
std::vector<std::string> environment_with(const std::vector<std::string>& set) {
  std::vector<std::string> all = set;
  for (char** variable = environ; *variable; ++variable) {
    const bool is_replaced =
        std::any_of(set.begin(), set.end(), [&](const std::string& s) { return name_of(s) == name_of(*variable); });
    if (!is_replaced) all.emplace_back(*variable);
  }
  return all;
}

std::vector<char*> pointers(std::vector<std::string>& strings) {
  std::vector<char*> out;
  for (std::string& s : strings) out.push_back(s.data());
  out.push_back(nullptr);
  return out;
}

// A file without a name that holds the text, at its beginning.
int open_text(std::string_view text) {
  const int file = ::memfd_create("input", MFD_CLOEXEC);
  if (file < 0) fail(errno, "memfd_create");
  while (!text.empty()) {
    const ssize_t n = ::write(file, text.data(), text.size());
    if (n < 0) fail(errno, "write");
    text.remove_prefix(static_cast<size_t>(n));
  }
  ::lseek(file, 0, SEEK_SET);
  return file;
}

// What was written to the file, which is closed.
std::string text_of(int file) {
  ::lseek(file, 0, SEEK_SET);
  std::string text;
  std::array<char, 1 << 16> part;
  for (ssize_t n = 0; (n = ::read(file, part.data(), part.size())) > 0;)
    text.append(part.data(), static_cast<size_t>(n));
  ::close(file);
  return text;
}

}  // namespace

ChildResult run_child(const std::string& program, const std::vector<std::string>& arguments, std::string_view input,
                      const std::vector<std::string>& environment, ChildErrors errors) {
  std::vector<std::string> words = arguments, variables = environment_with(environment);
  words.insert(words.begin(), program);
  const int in = open_text(input), out = open_text({});
  posix_spawn_file_actions_t streams;
  ::posix_spawn_file_actions_init(&streams);
  ::posix_spawn_file_actions_adddup2(&streams, in, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&streams, out, STDOUT_FILENO);
  if (errors == ChildErrors::in_output) ::posix_spawn_file_actions_adddup2(&streams, out, STDERR_FILENO);
  pid_t child = 0;
  const int error =
      ::posix_spawnp(&child, program.c_str(), &streams, nullptr, pointers(words).data(), pointers(variables).data());
  ::posix_spawn_file_actions_destroy(&streams);
  ::close(in);
  if (error != 0) ::close(out), fail(error, program.c_str());
  int status = 0;
  while (::waitpid(child, &status, 0) < 0)
    if (errno != EINTR) fail(errno, "waitpid");
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(out)};
}

TemporaryFolder::TemporaryFolder() : path_((fs::temp_directory_path() / "tilelight-XXXXXX").string()) {
  if (!::mkdtemp(path_.data())) fail(errno, "mkdtemp");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;  // a folder that stays behind is no reason to fail
  fs::remove_all(path_, ignored);
}

}  // namespace tilelight
