// SPDX-License-Identifier: Apache-2.0
// Candidates: the segments in view space that are drawn where nothing hides them. Pure; any thread.
#pragma once

#include "renderer/raster/lines/line_bodies.h"
#include "renderer/raster/lines/line_drawing.h"

namespace tilelight::lines {

struct Candidate {
  Vec3 from{0.0}, to{0.0};
  Span in_image;  // the part of it that the image shows
  LineKind kind = LineKind::silhouette;
  bool is_behind_own_body = false;  // all of it, for certain
  uint32_t body = 0, other = 0;
  std::array<FaceId, 2> faces;  // in which it lies: they do not hide it
};

// What is within the image of one body's edges: silhouettes and creases, by index of the edge.
std::vector<Candidate> edge_candidates(const LineBodies& bodies, uint32_t body, const LineView& view, bool with_hidden);

// The segments in which faces of two bodies cross, or those of a body and a plane: by lower and higher body.
std::vector<Candidate> junction_candidates(const LineBodies& bodies, const LineView& view, TilePool& pool,
                                           bool with_hidden, const std::atomic<bool>* stop);

}  // namespace tilelight::lines
