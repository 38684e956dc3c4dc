// SPDX-License-Identifier: Apache-2.0
#include "renderer/cli/progress_line.h"

#include <unistd.h>

#include <cstdio>
#include <iomanip>
#include <sstream>

namespace tilelight::cli {
namespace {

std::string duration_text(double ms) {
  std::ostringstream out;
  const double s = ms / 1000.0;
  const int whole = static_cast<int>(s);
  if (s < 100.0) {
    out << std::fixed << std::setprecision(1) << s << " s";
  } else {
    out << whole / 60 << " min " << whole % 60 << " s";
  }
  return out.str();
}

}  // namespace

std::string progress_text(const RenderProgress& progress) {
  constexpr int kBar = 24;
  const int full = static_cast<int>(progress.fraction * kBar);
  std::ostringstream out;
  out << '[' << std::string(static_cast<size_t>(full), '#') << std::string(static_cast<size_t>(kBar - full), '.')
      << "] " << std::setw(3) << static_cast<int>(progress.fraction * 100.0) << " %   " << progress.spp << " samples   "
      << duration_text(progress.elapsed_ms);
  if (progress.eta_ms >= 0.0) out << "   " << duration_text(progress.eta_ms) << " left";
  return out.str();
}

ProgressLine::ProgressLine() : is_terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const std::string& text) {
  if (!is_terminal_) return;
  // Back to the line's start, and away with what was longer (ECMA-48: erase in line).
  std::fprintf(stderr, "\r%s\x1b[K", text.c_str());
  is_shown_ = true;
}

void ProgressLine::clear() {
  if (is_shown_) std::fputs("\r\x1b[K", stderr);
  is_shown_ = false;
}

}  // namespace tilelight::cli
