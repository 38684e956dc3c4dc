// SPDX-License-Identifier: Apache-2.0
// Log: one line a request and one a job. Text on a terminal, JSON lines otherwise. A leaf; any thread; no globals, so
// two servers can live in one process.
// Who logs never waits for who reads: lines go through a queue to a thread that writes them. Where nobody reads, the
// oldest lines are dropped and counted, and a line tells how many once somebody does.
#pragma once

#include <unistd.h>

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace spdlog {
class async_logger;
namespace details {
class thread_pool;
}
}  // namespace spdlog

namespace tilelight::server {

enum class LogLevel { debug, info, warn, error };

struct LogOptions {
  int descriptor = STDERR_FILENO;
  size_t max_lines = 8192;    // that wait to be written; of 4 KB each at most
  double flush_ms = 1'000.0;  // for what waits when the log ends
};

class Log {
 public:
  using Value = std::variant<std::string, double, int64_t>;
  using Fields = std::initializer_list<std::pair<std::string_view, Value>>;

  // level: debug, info, warn, error, off.
  Log(const std::string& level, bool as_json, LogOptions options = {});
  ~Log();

  // log.write(LogLevel::info, "request", {{"method", "GET"}, {"status", int64_t{200}}});
  void write(LogLevel level, std::string_view event, Fields fields) const;

  // Lines that were dropped because nobody read, or could not be written.
  int64_t dropped() const;

  static bool standard_error_is_terminal();

 private:
  class Sink;

  const bool as_json_;
  const double flush_ms_;
  std::shared_ptr<Sink> sink_;
  std::shared_ptr<spdlog::details::thread_pool> writer_;
  std::shared_ptr<spdlog::async_logger> logger_;
};

// The line without its time and level. A line stays a line whatever a client sends, and shows what it holds
// (renderer/base/characters.h); long values are cut.
std::string log_line_text(std::string_view event, Log::Fields fields);
std::string log_line_json(std::string_view time, std::string_view level, std::string_view event, Log::Fields fields);

// What is kept of a value: 512 bytes, and then how many there were.
std::string cut_log_value(const std::string& value);

}  // namespace tilelight::server
