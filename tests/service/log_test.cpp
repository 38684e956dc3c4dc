// SPDX-License-Identifier: Apache-2.0
// The log: its lines, and what becomes of them where nobody reads.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "server/log.h"

namespace tilelight::server {
namespace {

TEST(LogLine, StaysALineWhateverAClientSends) {
  const Log::Fields fields = {{"path", "/a\nb \"c\""}, {"status", int64_t{200}}, {"ms", 1.5}};
  EXPECT_EQ(log_line_text("request", fields), "request path=\"/a\\nb \\\"c\\\"\" status=200 ms=1.50");
  const auto json = nlohmann::json::parse(log_line_json("now", "info", "request", fields));
  EXPECT_EQ(json.at("path"), "/a\nb \"c\"");
  EXPECT_EQ(log_line_json("now", "info", "x", {{"y", "\xff\n"}}).find('\n'), std::string::npos);
}

TEST(LogLine, ShowsControlsAndFormatsInBothForms) {
  // C1's CSI, DEL, a right-to-left override, a tag, a line separator; a byte that is no UTF-8.
  const std::string steering = "a\xc2\x9b\x7f\xe2\x80\xae\xf3\xa0\x81\x81\xe2\x80\xa8", broken = "b\x9b";
  const Log::Fields fields = {{"path", steering}, {"broken", broken}};
  EXPECT_EQ(log_line_text("x", fields), "x path=\"a\\u009b\\u007f\\u202e\\U000e0041\\u2028\" broken=\"b\\x9b\"");
  const std::string json = log_line_json("now", "info", "x", fields);
  EXPECT_NE(json.find("a\\u009b\\u007f\\u202e\\udb40\\udc41\\u2028"), std::string::npos) << json;
  EXPECT_EQ(nlohmann::json::parse(json).at("path"), steering) << "and reads back to what was sent";
}

TEST(LogLine, CannotBeForgedByABackslashBeforeAQuote) {
  EXPECT_EQ(log_line_text("x", {{"path", "a\\\" status=200 b"}}), R"(x path="a\\\" status=200 b")");
}

TEST(LogLine, CutsALongValueBetweenTwoCharacters) {
  EXPECT_EQ(cut_log_value(std::string(512, 'x')), std::string(512, 'x'));
  EXPECT_EQ(cut_log_value(std::string(513, 'x')), std::string(512, 'x') + "... (513 bytes)");
  std::string umlauts = "x";
  while (umlauts.size() < 600) umlauts += "\xc3\xbc";
  EXPECT_EQ(cut_log_value(umlauts), umlauts.substr(0, 511) + "... (601 bytes)");
}

struct Pipe {
  Pipe() { EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0); }
  ~Pipe() { close_reader(), close_writer(); }
  void close_reader() { close_end(ends[0]); }
  void close_writer() { close_end(ends[1]); }
  static void close_end(int& fd) {
    if (fd >= 0) ::close(fd);
    fd = -1;
  }
  // All that comes until the last writer has gone.
  std::string drain() const {
    std::string text;
    char block[4096];
    for (ssize_t got; (got = read(ends[0], block, sizeof block)) > 0;) text.append(block, static_cast<size_t>(got));
    return text;
  }
  int ends[2] = {-1, -1};
};

// What a log's lines tell: how many there were of an event, and how many were dropped before the last of them.
struct Told {
  int64_t lines = 0, dropped = 0;
};
Told read_json_lines(const std::string& text) {
  Told told;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    const auto json = nlohmann::json::parse(line);
    if (json.at("event") == "log_lines_dropped") {
      told.dropped += json.at("count").get<int64_t>();
      EXPECT_EQ(json.at("total"), told.dropped);
    } else {
      ++told.lines;
    }
  }
  return told;
}

TEST(Log, WritesEveryLineThatSomebodyReads) {
  Pipe pipe;
  std::string text;
  std::jthread reader([&] { text = pipe.drain(); });
  {
    const Log log("info", true, {.descriptor = pipe.ends[1]});
    std::vector<std::jthread> writers;
    for (int64_t who = 0; who < 4; ++who) {
      writers.emplace_back([&log, who] {
        for (int64_t i = 0; i < 500; ++i) log.write(LogLevel::info, "line", {{"who", who}, {"i", i}});
      });
    }
    writers.clear();
    EXPECT_EQ(log.dropped(), 0);
    log.write(LogLevel::debug, "unasked", {});
  }
  pipe.close_writer();
  reader.join();
  EXPECT_EQ(read_json_lines(text).lines, 2000);
}

TEST(Log, ThatNobodyReadsKeepsNobodyWaitingAndTellsLaterWhatWasLost) {
  constexpr int64_t kLines = 5000;
  Pipe pipe;
  std::string text;
  int64_t dropped = 0;
  std::jthread reader;
  {
    const Log log("info", true, {.descriptor = pipe.ends[1], .max_lines = 64, .flush_ms = 30'000.0});
    for (int64_t i = 0; i < kLines; ++i) log.write(LogLevel::info, "line", {{"text", std::string(100, 'x')}});
    dropped = log.dropped();
    EXPECT_GT(dropped, 0);
    reader = std::jthread([&] { text = pipe.drain(); });
  }
  pipe.close_writer();
  reader.join();
  const Told told = read_json_lines(text);
  EXPECT_EQ(told.dropped, dropped);
  EXPECT_EQ(told.lines + told.dropped, kLines) << "each was either written or counted";
}

TEST(Log, ThatNobodyReadsEndsAllTheSame) {
  Pipe pipe;
  {
    const Log log("info", true, {.descriptor = pipe.ends[1], .max_lines = 1024, .flush_ms = 20.0});
    for (int64_t i = 0; i < 2000; ++i) log.write(LogLevel::info, "line", {{"text", std::string(100, 'x')}});
  }
  pipe.close_writer();
  EXPECT_GT(read_json_lines(pipe.drain()).lines, 100) << "what the pipe had room for";
}

TEST(Log, WhoseReaderHasGoneCountsItsLines) {
  std::signal(SIGPIPE, SIG_IGN);  // as the daemon does
  Pipe pipe, read_only;
  pipe.close_reader();
  for (const int gone : {pipe.ends[1], read_only.ends[0], -1}) {
    const Log log("info", false, {.descriptor = gone, .flush_ms = 20.0});
    for (int i = 0; i < 10; ++i) log.write(LogLevel::warn, "line", {});
    while (log.dropped() < 10) std::this_thread::yield();
    EXPECT_EQ(log.dropped(), 10);
  }
}

}  // namespace
}  // namespace tilelight::server
