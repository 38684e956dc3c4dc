// SPDX-License-Identifier: Apache-2.0
#include "server/log.h"

#include <spdlog/async_logger.h>
#include <spdlog/details/null_mutex.h>
#include <spdlog/details/thread_pool.h>
#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <functional>

#include "renderer/base/characters.h"
#include "server/clock.h"
#include "server/descriptor_writer.h"

namespace tilelight::server {
namespace {

constexpr std::string_view kLevelNames[] = {"debug", "info", "warn", "error"};
constexpr spdlog::level::level_enum kSpdLevels[] = {spdlog::level::debug, spdlog::level::info, spdlog::level::warn,
                                                    spdlog::level::err};
constexpr std::string_view kColors[] = {"\x1b[36m", "\x1b[32m", "\x1b[33m", "\x1b[31m"}, kNoColor = "\x1b[m";

std::string line_of(bool as_json, LogLevel level, std::string_view event, Log::Fields fields) {
  return as_json
             ? log_line_json(rfc3339(SystemClock().wall_ms()), kLevelNames[static_cast<size_t>(level)], event, fields)
             : log_line_text(event, fields);
}

// Quotes, backslashes and what does not show become escapes; a value with spaces is quoted.
std::string text_value(const std::string& value) {
  std::string out;
  bool quote = value.empty();
  for (const char c : cut_log_value(value)) {
    quote |= c == ' ' || c == '"' || c == '=' || static_cast<unsigned char>(c) >= 0x80;
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  out = printable(out);
  return quote ? "\"" + out + "\"" : out;
}

}  // namespace

// Runs on the queue's one thread.
class Log::Sink final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  Sink(int descriptor, bool as_json)
      : as_json_(as_json), has_colors_(isatty(descriptor) == 1 && !as_json), out_(descriptor) {}

  // Of the queue, by which it tells what was dropped there.
  void watch(std::function<size_t()> overrun) { overrun_ = std::move(overrun); }
  void limit_wait_ms(double ms) { out_.limit_wait_ms(ms); }
  int64_t lost() const { return lost_.load(std::memory_order_relaxed); }
  void note_lost() { lost_.fetch_add(1, std::memory_order_relaxed); }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    if (!put(message)) note_lost();
    tell_dropped();
  }
  void flush_() override {}

 private:
  void tell_dropped() {
    const int64_t dropped = lost() + static_cast<int64_t>(overrun_());
    if (dropped == reported_drops_) return;
    const std::string line = line_of(as_json_, LogLevel::warn, "log_lines_dropped",
                                     {{"count", dropped - reported_drops_}, {"total", dropped}});
    if (put({"", spdlog::level::warn, line})) reported_drops_ = dropped;
  }

  bool put(const spdlog::details::log_msg& message) {
    spdlog::memory_buf_t formatted;
    formatter_->format(message, formatted);
    std::string line(formatted.data(), formatted.size());
    if (has_colors_ && message.color_range_end > message.color_range_start) {
      const auto level = static_cast<size_t>(message.level) - static_cast<size_t>(spdlog::level::debug);
      line.insert(message.color_range_end, kNoColor);
      line.insert(message.color_range_start, kColors[level]);
    }
    return out_.write(line);
  }

  const bool as_json_, has_colors_;
  DescriptorWriter out_;
  std::function<size_t()> overrun_;
  std::atomic<int64_t> lost_ = 0;  // relaxed: a count
  int64_t reported_drops_ = 0;
};

Log::Log(const std::string& level, bool as_json, LogOptions options)
    : as_json_(as_json),
      flush_ms_(options.flush_ms),
      sink_(std::make_shared<Sink>(options.descriptor, as_json)),
      writer_(std::make_shared<spdlog::details::thread_pool>(options.max_lines, 1)),
      logger_(std::make_shared<spdlog::async_logger>("tilelightd", sink_, writer_,
                                                     spdlog::async_overflow_policy::overrun_oldest)) {
  sink_->watch([writer = writer_.get()] { return writer->overrun_counter(); });
  logger_->set_pattern(as_json ? "%v" : "%H:%M:%S.%e %^%-5l%$ %v");
  logger_->set_level(level == "warn" ? spdlog::level::warn : spdlog::level::from_str(level));
  // The library's own handler prints on standard error, and waits for its reader.
  logger_->set_error_handler([sink = sink_](const std::string&) { sink->note_lost(); });
}

Log::~Log() {
  sink_->limit_wait_ms(flush_ms_);
  writer_.reset();  // writes what waits, or drops it once the time is over, and ends its thread
}

void Log::write(LogLevel level, std::string_view event, Fields fields) const {
  const auto spd_level = kSpdLevels[static_cast<size_t>(level)];
  if (!logger_->should_log(spd_level)) return;
  try {
    const std::string line = line_of(as_json_, level, event, fields);
    logger_->log(spd_level, spdlog::string_view_t(line.data(), line.size()));
  } catch (const std::exception&) {  // no memory for it: that must not end the thread that logs
    sink_->note_lost();
  }
}

int64_t Log::dropped() const { return sink_->lost() + static_cast<int64_t>(writer_->overrun_counter()); }

bool Log::standard_error_is_terminal() { return isatty(STDERR_FILENO) == 1; }

std::string cut_log_value(const std::string& value) {
  constexpr size_t kMostBytes = 512;
  if (value.size() <= kMostBytes) return value;
  size_t end = kMostBytes;
  while (end > kMostBytes - 4 && (static_cast<unsigned char>(value[end]) & 0xc0) == 0x80)
    --end;  // not within a character
  return value.substr(0, end) + "... (" + std::to_string(value.size()) + " bytes)";
}

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
