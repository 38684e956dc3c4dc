// SPDX-License-Identifier: Apache-2.0
#include "server/clock.h"

#include <cstdio>
#include <ctime>

namespace tilelight::server {

double SystemClock::mono_ms() const { return ms_between({}, Steady::now()); }

int64_t SystemClock::wall_ms() const {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

std::string rfc3339(int64_t wall_ms) {
  const auto seconds = static_cast<std::time_t>(wall_ms / 1000);
  std::tm utc{};
  gmtime_r(&seconds, &utc);
  char day[32], text[48];
  std::strftime(day, sizeof day, "%Y-%m-%dT%H:%M:%S", &utc);
  std::snprintf(text, sizeof text, "%s.%03dZ", day, static_cast<int>(wall_ms % 1000));
  return text;
}

}  // namespace tilelight::server
