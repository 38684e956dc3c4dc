// SPDX-License-Identifier: Apache-2.0
#include "renderer/cli/files.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace tilelight::cli {
namespace {

namespace fs = std::filesystem;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

File open_file(const std::string& path, const char* mode) { return {std::fopen(path.c_str(), mode), &std::fclose}; }

::tl::unexpected<Error> io_error(const std::string& doing, const std::string& path) {
  return fail("io", "cannot " + doing + " " + path + ": " + std::strerror(errno));
}

fs::path folder_of(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

bool is_replaced(const std::string& path) {
  std::error_code ignored;
  const fs::file_status status = fs::status(path, ignored);
  return !fs::exists(status) || fs::is_regular_file(status);
}

// Closing is part of writing: a full disk may show only there.
bool write_all(File file, std::string_view bytes) {
  const bool is_written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  return std::fclose(file.release()) == 0 && is_written;
}

}  // namespace

Result<std::string> read_input(const std::string& path, int64_t max_bytes) {
  const bool is_stdin = path == "-";
  File opened(nullptr, &std::fclose);
  if (!is_stdin) {
    opened = open_file(path, "rb");
    if (!opened) return io_error("read", path);
  }
  std::FILE* in = is_stdin ? stdin : opened.get();
  const size_t limit = static_cast<size_t>(max_bytes) + 1;
  std::string text;
  std::array<char, 65536> block;
  for (size_t n; text.size() < limit && (n = std::fread(block.data(), 1, block.size(), in)) > 0;)
    text.append(block.data(), std::min(n, limit - text.size()));
  if (std::ferror(in)) return io_error("read", path);
  return text;
}

Result<void> check_can_write(const std::string& path) {
  if (path == "-") return {};
  std::error_code ignored;  // what is wrong with the path shows when it is opened
  if (fs::is_directory(path, ignored))
    return fail("io", "cannot write " + path + ": it is a folder; name a file in it");
  const std::string target = is_replaced(path) ? folder_of(path).string() : path;
  if (::access(target.c_str(), W_OK) != 0) return io_error("write in", target);
  return {};
}

Result<void> write_output(const std::string& path, std::string_view bytes) {
  if (path == "-") {
    if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() || std::fflush(stdout) != 0)
      return io_error("write", "standard output");
    return {};
  }
  const bool is_renamed = is_replaced(path);
  const std::string target = is_renamed ? path + ".part-" + std::to_string(::getpid()) : path;
  File file = open_file(target, "wb");
  if (!file) return io_error("write", target);
  const bool is_written = write_all(std::move(file), bytes);
  if (is_written && (!is_renamed || std::rename(target.c_str(), path.c_str()) == 0)) return {};
  const auto error = io_error("write", path);
  if (is_renamed) std::remove(target.c_str());
  return error;
}

}  // namespace tilelight::cli
