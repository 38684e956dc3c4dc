// SPDX-License-Identifier: Apache-2.0
// What the operating system says of this process (Linux). A leaf; any thread.
#pragma once

namespace tilelight::server {

double cpu_seconds();     // user and system, all threads
double resident_bytes();  // of /proc/self/statm; 0 where it cannot be read

}  // namespace tilelight::server
