// SPDX-License-Identifier: Apache-2.0
// Threads of hosts that compute by other rules than IEEE 754's default.
#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <cfenv>
#include <thread>

namespace tilelight::test {

enum class Host { standard, flushing, upwards };

#if defined(__SSE2__)
inline constexpr bool kCanFlush = true;
inline void flush_subnormals() {
  constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
  _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
}
#else
inline constexpr bool kCanFlush = false;
inline void flush_subnormals() {}
#endif

template <class Work>
void on_host(Host host, const Work& work) {
  std::thread([&] {
    if (host == Host::upwards) std::fesetround(FE_UPWARD);
    if (host == Host::flushing) flush_subnormals();
    work();
  }).join();
}

}  // namespace tilelight::test
