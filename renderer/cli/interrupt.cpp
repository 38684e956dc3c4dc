// SPDX-License-Identifier: Apache-2.0
#include "renderer/cli/interrupt.h"

#include <csignal>

namespace tilelight::cli {
namespace {

// The one global of the command: a signal handler reaches nothing else.
volatile std::sig_atomic_t interrupted = 0;

void note_interrupt(int) { interrupted = 1; }

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = note_interrupt;
  // RESETHAND: the second signal has its usual effect. RESTART: reads and writes under way go on.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool is_interrupted() { return interrupted != 0; }

}  // namespace tilelight::cli
