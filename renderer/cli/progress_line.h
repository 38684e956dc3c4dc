// SPDX-License-Identifier: Apache-2.0
// ProgressLine: one line on a terminal that tells how far the work is. Silent where standard error is no terminal.
#pragma once

#include <string>

#include "renderer/render/render.h"

namespace tilelight::cli {

// "[#########...........]  45 %   8 samples   1.2 s   1.5 s left"
std::string progress_text(const RenderProgress& progress);

class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const std::string& text);
  void show(const RenderProgress& progress) { show(progress_text(progress)); }
  void clear();
  bool is_terminal() const { return is_terminal_; }

 private:
  const bool is_terminal_;
  bool is_shown_ = false;
};

}  // namespace tilelight::cli
