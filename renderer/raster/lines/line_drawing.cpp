// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_drawing.h"

#include "renderer/base/standard_floats.h"
#include "renderer/raster/lines/chains.h"
#include "renderer/raster/lines/line_pieces.h"

namespace tilelight {

LineDrawing draw_lines(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, bool with_hidden,
                       const std::atomic<bool>* stop) {
  constexpr double kLeastPx = 1e-6;  // edges that point to the eye
  const StandardFloats floats;
  const lines::LineView view(plan);
  const lines::LinePieces found = lines::find_line_pieces(scene, view, pool, with_hidden, stop);
  const Vec2 size(view.width(), view.height());
  std::vector<DrawnLine> drawn;
  for (const lines::LinePiece& piece : found.pieces) {
    const lines::Candidate& line = found.candidates[piece.candidate];
    const Vec2 from = glm::clamp(view.pixel(piece.from), Vec2(0.0), size);
    const Vec2 to = glm::clamp(view.pixel(piece.to), Vec2(0.0), size);
    if (glm::length(to - from) > kLeastPx)
      drawn.push_back({from, to, line.kind, piece.is_hidden, line.body, line.other, 0.0});
  }
  LineDrawing out{view.width(), view.height(), lines::in_chains(drawn), found.work};
  out.work.drawn_lines = static_cast<int64_t>(out.lines.size());
  return out;
}

}  // namespace tilelight
