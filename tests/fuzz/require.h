// SPDX-License-Identifier: Apache-2.0
// REQUIRE: what has to hold for any input. A broken one ends the program, and libFuzzer keeps the input.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string>

namespace tilelight::fuzz {

[[noreturn]] inline void fail(const char* file, int line, const char* condition, const std::string& told) {
  std::fprintf(stderr, "%s:%d: does not hold: %s\n%s\n", file, line, condition, told.c_str());
  std::abort();
}

}  // namespace tilelight::fuzz

// told: a std::string, made only if the condition does not hold.
#define REQUIRE(condition, told) \
  ((condition) ? void() : ::tilelight::fuzz::fail(__FILE__, __LINE__, #condition, (told)))
