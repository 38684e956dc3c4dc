// SPDX-License-Identifier: Apache-2.0
// Log: one line a request and one a job. Text on a terminal, JSON lines otherwise. A leaf; any thread; no globals, so
// two servers can live in one process.
#pragma once

#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

namespace spdlog {
class logger;
}

namespace tilelight::server {

enum class LogLevel { debug, info, warn, error };

class Log {
 public:
  using Value = std::variant<std::string, double, int64_t>;
  using Fields = std::initializer_list<std::pair<std::string_view, Value>>;

  // level: debug, info, warn, error, off. Writes to standard error.
  Log(const std::string& level, bool as_json);

  // log.write(LogLevel::info, "request", {{"method", "GET"}, {"status", int64_t{200}}});
  void write(LogLevel level, std::string_view event, Fields fields) const;

  static bool standard_error_is_terminal();

 private:
  const bool as_json_;
  const std::shared_ptr<spdlog::logger> logger_;
};

// The line without its time and level. Values are escaped: a line stays a line whatever a client sends.
std::string log_line_text(std::string_view event, Log::Fields fields);
std::string log_line_json(std::string_view time, std::string_view level, std::string_view event, Log::Fields fields);

}  // namespace tilelight::server
