// SPDX-License-Identifier: Apache-2.0
// A drawing of a scene's edges with what is hidden taken away or dashed, by the method of L. G. Roberts (Machine
// perception of three-dimensional solids, 1963). Lengths in pixels from the image's top left corner, y down.
// Deterministic: the same lines in the same order on any number of threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "renderer/compile/compile.h"

namespace tilelight {

enum class LineKind : uint8_t {
  silhouette,  // a face towards the eye on one side, none on the other
  crease,      // a sharp edge
  junction     // where faces of two bodies cross
};

struct DrawnLine {
  Vec2 from{0.0}, to{0.0};  // within the image
  LineKind kind = LineKind::silhouette;
  bool is_hidden = false;
  uint32_t body = 0, other = 0;  // indices into CompiledScene::bodies; `other` only of junctions
  double along = 0.0;            // from the start of the chain of lines that this one goes on with; dashes run through
};

// What the drawing took, counted.
struct LineWork {
  int64_t convex_bodies = 0;      // that hide as a whole
  int64_t faces = 0;              // of all finite bodies
  int64_t edges = 0;              // that were looked at: silhouette, crease or neither
  int64_t junction_segments = 0;  // found between faces
  int64_t occlusion_tests = 0;    // a line against a convex body, a face or a plane
  int64_t drawn_lines = 0;
};

struct LineDrawing {
  int width = 0, height = 0;     // pixels
  std::vector<DrawnLine> lines;  // one after the other along their chains
  LineWork work;
};

// Spheres are not drawn: they enter as meshes or not at all. Throws Stopped soon after `stop` is set.
LineDrawing draw_lines(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool, bool with_hidden,
                       const std::atomic<bool>* stop = nullptr);

constexpr double kVisibleLinePx = 1.5, kHiddenLinePx = 1.0;  // widths
constexpr double kDashPx = 6.0, kDashGapPx = 4.0;            // of hidden lines

// A whole document, black on white. Numbers to 1/1000 px.
std::string line_drawing_svg(const LineDrawing& drawing);

}  // namespace tilelight
