// SPDX-License-Identifier: Apache-2.0
// Clock: the one source of time for everything that expires or is stamped, so that tests move time by hand. Waiting for
// an event uses the real steady clock: its end is an event, not a date.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace tilelight::server {

using Steady = std::chrono::steady_clock;

class Clock {
 public:
  virtual ~Clock() = default;
  virtual double mono_ms() const = 0;   // never goes back; its zero means nothing
  virtual int64_t wall_ms() const = 0;  // since 1970, UTC
};

class SystemClock final : public Clock {
 public:
  double mono_ms() const override;
  int64_t wall_ms() const override;
};

// "2024-05-01T12:00:00.000Z" (RFC 3339).
std::string rfc3339(int64_t wall_ms);
// "Wed, 01 May 2024 12:00:00 GMT" (IMF-fixdate, RFC 9110, 5.6.7).
std::string http_date(int64_t wall_ms);

inline double ms_between(Steady::time_point from, Steady::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}
inline double ms_since(Steady::time_point from) { return ms_between(from, Steady::now()); }
inline Steady::time_point after_ms(double ms) {
  return Steady::now() + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double, std::milli>(ms));
}

}  // namespace tilelight::server
