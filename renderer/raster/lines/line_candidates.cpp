// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_candidates.h"

#include <optional>

namespace tilelight::lines {
namespace {

// Faces that meet at less than half a degree are one to the eye: triangles of one flat face, or of a finely cut round
// one whose mesh has no normals.
constexpr double kFlatCosine = 0.99996;

class Edges {
 public:
  Edges(const LineBody& body, const LineView& view) : body_(body), view_(view) {}

  std::optional<LineKind> kind_of(const LineEdge& edge) const {
    if (edge.face[1] == kNoFace) return LineKind::silhouette;
    if (is_front(edge, 0) != is_front(edge, 1)) return LineKind::silhouette;
    if (edge.sharpness == Sharpness::smooth) return std::nullopt;
    if (edge.sharpness == Sharpness::sharp) return LineKind::crease;
    const double cosine = glm::dot(body_.normals[edge.face[0]], body_.normals[edge.face[1]]);
    return (edge.is_turned ? -cosine : cosine) < kFlatCosine ? std::optional(LineKind::crease) : std::nullopt;
  }

  // Of a solid: no face towards the eye, or in the notch between one that is and one that is not.
  bool is_behind_own_body(const LineEdge& edge) const {
    if (!body_.hides_backs) return false;
    const bool first = is_front(edge, 0), second = is_front(edge, 1);
    if (!first && !second) return true;
    return first != second && !body_.shape->is_convex && is_concave(edge);
  }

 private:
  bool is_front(const LineEdge& edge, int side) const {
    const int facing = body_.facing[edge.face[side]];
    return (side == 1 && edge.is_turned ? -facing : facing) > 0;
  }

  bool is_concave(const LineEdge& edge) const {
    const LineFace& other = body_.shape->faces[edge.face[1]];
    for (uint32_t c = 0; c < other.corners; ++c) {
      const Vec3 off = body_.points[other.vertex[c]] - body_.points[edge.vertex[0]];
      if (glm::dot(body_.normals[edge.face[0]], off) > view_.touch()) return true;
    }
    return false;
  }

  const LineBody& body_;
  const LineView& view_;
};

}  // namespace

std::vector<Candidate> edge_candidates(const LineBodies& bodies, uint32_t body, const LineView& view,
                                       bool with_hidden) {
  const LineBody& placed = bodies.finite[body];
  const Edges edges(placed, view);
  std::vector<Candidate> out;
  for (const LineEdge& edge : placed.shape->edges) {
    const std::optional<LineKind> kind = edges.kind_of(edge);
    if (!kind) continue;
    const bool is_behind = edges.is_behind_own_body(edge);
    if (is_behind && !with_hidden) continue;
    const Vec3 &from = placed.points[edge.vertex[0]], &to = placed.points[edge.vertex[1]];
    const Span span = view.in_image(from, to);
    if (span.is_empty() || !(glm::length(to - from) > view.touch())) continue;
    out.push_back({from, to, span, *kind, is_behind, body, body, {FaceId{body, edge.face[0]}, {body, edge.face[1]}}});
  }
  return out;
}

}  // namespace tilelight::lines
