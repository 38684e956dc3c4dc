// SPDX-License-Identifier: Apache-2.0
// StandardFloats: while one lives, its thread computes as IEEE 754 has it: to nearest, with subnormal numbers, without
// traps. Then the thread gets back what its host had set. Stands at the doors of the library and in the pool's threads:
// threads inherit the settings of the one that starts them, and a host that flushes subnormals to zero, as audio
// programs do, would get other bytes.
#pragma once

#include <cfenv>

namespace tilelight {

class StandardFloats {
 public:
  StandardFloats();
  ~StandardFloats();
  StandardFloats(const StandardFloats&) = delete;
  StandardFloats& operator=(const StandardFloats&) = delete;

 private:
  std::fenv_t host_;
};

}  // namespace tilelight
