// SPDX-License-Identifier: Apache-2.0
// The drawing in space, before it is projected: what is seen and what is hidden of each candidate.
#pragma once

#include "renderer/raster/lines/line_candidates.h"

namespace tilelight::lines {

struct LinePiece {
  Vec3 from{0.0}, to{0.0};  // view space
  uint32_t candidate = 0;
  bool is_hidden = false;
};

struct LinePieces {
  std::vector<Candidate> candidates;
  std::vector<LinePiece> pieces;  // by candidate, then along it
  LineWork work;                  // all but drawn_lines
};

LinePieces find_line_pieces(const CompiledScene& scene, const LineView& view, TilePool& pool, bool with_hidden,
                            const std::atomic<bool>* stop = nullptr);

}  // namespace tilelight::lines
