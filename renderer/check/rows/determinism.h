// SPDX-License-Identifier: Apache-2.0
// What the rows of the same bytes share.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/check/check.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/render/render.h"
#include "renderer/trace/isa.h"

namespace tilelight::check {

// A render of the document from its text on: linear RGB, and the passes that replay it.
struct Bits {
  std::vector<float> rgb;
  std::vector<double> passes;
};
Bits bits_of(const std::shared_ptr<const CompiledScene>& scene, const View& view, TilePool& pool, int tile_px = 0);
Bits bits_of(std::string_view json, TilePool& pool, int tile_px = 0);

// Puts the choice of the instruction set back where it was.
class IsaChoice {
 public:
  ~IsaChoice() { (void)select_isa(before_ == available_isas().front() ? "auto" : before_); }

 private:
  std::string before_ = current_isa();
};

// The rows of determinism_order.cpp and determinism_twin.cpp.
Outcome of_replays(const Context& context);
Outcome of_object_order(const Context& context);
Outcome of_twins(const Context& context);

}  // namespace tilelight::check
