// SPDX-License-Identifier: Apache-2.0
#include "server/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include "server/clock.h"

namespace tilelight::server {
namespace {

constexpr std::string_view kLevelNames[] = {"debug", "info", "warn", "error"};
constexpr spdlog::level::level_enum kSpdLevels[] = {spdlog::level::debug, spdlog::level::info, spdlog::level::warn,
                                                    spdlog::level::err};

// Control characters and quotes become escapes; a value with spaces is quoted.
std::string text_value(const std::string& value) {
  std::string out;
  bool quote = value.empty();
  for (const unsigned char c : value) {
    if (c < 0x20 || c == 0x7f) {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\x%02x", c);
      out += escape;
      continue;
    }
    quote |= c == ' ' || c == '"' || c == '=';
    if (c == '"' || c == '\\') out += '\\';
    out += static_cast<char>(c);
  }
  return quote ? "\"" + out + "\"" : out;
}

}  // namespace

Log::Log(const std::string& level, bool as_json)
    : as_json_(as_json),
      logger_(std::make_shared<spdlog::logger>("tilelightd", std::make_shared<spdlog::sinks::stderr_color_sink_mt>())) {
  logger_->set_pattern(as_json ? "%v" : "%H:%M:%S.%e %^%-5l%$ %v");
  logger_->set_level(level == "warn" ? spdlog::level::warn : spdlog::level::from_str(level));
  logger_->flush_on(spdlog::level::info);
}

void Log::write(LogLevel level, std::string_view event, Fields fields) const {
  const auto index = static_cast<size_t>(level);
  if (!logger_->should_log(kSpdLevels[index])) return;
  const std::string line = as_json_ ? log_line_json(rfc3339(SystemClock().wall_ms()), kLevelNames[index], event, fields)
                                    : log_line_text(event, fields);
  logger_->log(kSpdLevels[index], "{}", line);
}

bool Log::standard_error_is_terminal() { return isatty(STDERR_FILENO) == 1; }

std::string log_line_text(std::string_view event, Log::Fields fields) {
  std::string out(event);
  for (const auto& [name, value] : fields) {
    out.append(" ").append(name).append("=");
    if (const auto* text = std::get_if<std::string>(&value)) {
      out += text_value(*text);
    } else if (const auto* whole = std::get_if<int64_t>(&value)) {
      out += std::to_string(*whole);
    } else {
      out += fmt::format("{:.2f}", std::get<double>(value));
    }
  }
  return out;
}

}  // namespace tilelight::server
