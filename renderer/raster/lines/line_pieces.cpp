// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/line_pieces.h"

#include <algorithm>
#include <utility>

#include "renderer/raster/lines/line_occluders.h"

namespace tilelight::lines {
namespace {

std::pair<Vec2, Vec2> ends_in_image(const Candidate& line, const LineView& view) {
  const Vec2 size(view.width(), view.height());
  const auto pixel_at = [&](double t) {
    return glm::clamp(view.pixel(between(line.from, line.to, t)), Vec2(0.0), size);
  };
  return {pixel_at(line.in_image.from), pixel_at(line.in_image.to)};
}

double distance_from_line(const Vec3& p, const Candidate& line) {
  return glm::length(glm::cross(p - line.from, glm::normalize(line.to - line.from)));
}

// Lines that coincide are drawn once. The first of them is.
class Coincidences {
 public:
  Coincidences(const std::vector<Candidate>& lines, const LineView& view)
      : lines_(lines), touch_(view.touch()), grid_(view.width(), view.height(), boxes_of(lines, view)) {}

  // The parts of a line that lie in earlier ones.
  std::vector<Span> covered_by_earlier(uint32_t index, const Vec2& from, const Vec2& to) const {
    std::vector<Span> spans;
    const Candidate& line = lines_[index];
    grid_.visit(from, to, [&](uint32_t earlier) {
      if (earlier < index) add_overlap(line, lines_[earlier], spans);
      return false;
    });
    unite(spans, 0.0);
    return spans;
  }

 private:
  static std::vector<ScreenBox> boxes_of(const std::vector<Candidate>& lines, const LineView& view) {
    std::vector<ScreenBox> boxes(lines.size());
    for (size_t i = 0; i < lines.size(); ++i) {
      const auto [from, to] = ends_in_image(lines[i], view);
      boxes[i].grow(from), boxes[i].grow(to);
    }
    return boxes;
  }

  void add_overlap(const Candidate& line, const Candidate& other, std::vector<Span>& spans) const {
    const Vec3 way = line.to - line.from, other_way = other.to - other.from;
    const double squared = glm::dot(way, way);
    // The longer one tells where their line lies.
    const bool is_longer = squared >= glm::dot(other_way, other_way);
    const Candidate &base = is_longer ? line : other, &checked = is_longer ? other : line;
    if (distance_from_line(checked.from, base) > touch_ || distance_from_line(checked.to, base) > touch_) return;
    const double a = glm::dot(other.from - line.from, way) / squared, b = glm::dot(other.to - line.from, way) / squared;
    const Span span{std::max(0.0, std::min(a, b)), std::min(1.0, std::max(a, b))};
    if (!span.is_empty()) spans.push_back(span);
  }

  const std::vector<Candidate>& lines_;
  double touch_;
  ScreenGrid grid_;
};

// One line's visible and hidden pieces.
class PieceFinder {
 public:
  PieceFinder(const std::vector<Candidate>& lines, const LineOccluders& occluders, const LineView& view,
              bool with_hidden)
      : lines_(lines), occluders_(occluders), view_(view), coincidences_(lines, view), with_hidden_(with_hidden) {}

  // Returns the number of occlusion tests.
  int64_t find(uint32_t index, std::vector<LinePiece>& out) const {
    const Candidate& line = lines_[index];
    const double least = view_.touch() / glm::length(line.to - line.from);
    const auto [from, to] = ends_in_image(line, view_);
    const std::vector<Span> covered_spans = coincidences_.covered_by_earlier(index, from, to);
    const std::vector<Span> own = uncovered(line.in_image, covered_spans, least);
    if (own.empty()) return 0;
    int64_t tests = 0;
    std::vector<Span> hidden;
    if (line.is_behind_own_body)
      hidden.push_back(line.in_image);
    else
      tests = occluders_.hide(line, from, to, hidden);
    unite(hidden, least);
    for (const Span& part : own) {
      std::vector<std::pair<Span, bool>> pieces;
      for (const Span& s : uncovered(part, hidden, least)) pieces.emplace_back(s, false);
      if (with_hidden_)
        for (const Span& s : covered(part, hidden, least)) pieces.emplace_back(s, true);
      std::sort(pieces.begin(), pieces.end(), [](const auto& a, const auto& b) { return a.first.from < b.first.from; });
      for (const auto& [span, is_hidden] : pieces)
        out.push_back({between(line.from, line.to, span.from), between(line.from, line.to, span.to), index, is_hidden});
    }
    return tests;
  }

 private:
  const std::vector<Candidate>& lines_;
  const LineOccluders& occluders_;
  const LineView& view_;
  Coincidences coincidences_;
  bool with_hidden_;
};

std::vector<Candidate> all_candidates(const LineBodies& bodies, const LineView& view, TilePool& pool, bool with_hidden,
                                      LineWork& work, const std::atomic<bool>* stop) {
  std::vector<std::vector<Candidate>> by_body(bodies.finite.size());
  pool.parallel_for(
      static_cast<int64_t>(by_body.size()), Priority::normal,
      [&](int64_t i) {
        if (bodies.finite[i].shape) by_body[i] = edge_candidates(bodies, static_cast<uint32_t>(i), view, with_hidden);
      },
      stop);
  std::vector<Candidate> out;
  for (const auto& part : by_body) out.insert(out.end(), part.begin(), part.end());
  const std::vector<Candidate> junctions = junction_candidates(bodies, view, pool, with_hidden, stop);
  work.junction_segments = static_cast<int64_t>(junctions.size());
  out.insert(out.end(), junctions.begin(), junctions.end());
  // Of lines that coincide the first is drawn: the two sides of a flat box have their edges in one place.
  std::stable_partition(out.begin(), out.end(), [](const Candidate& line) { return !line.is_behind_own_body; });
  return out;
}

}  // namespace

LinePieces find_line_pieces(const CompiledScene& scene, const LineView& view, TilePool& pool, bool with_hidden,
                            const std::atomic<bool>* stop) {
  constexpr int64_t kChunk = 64;  // lines; enough work for a thread to come for
  LinePieces out;
  const LineBodies bodies = place_bodies(scene, view, pool);
  for (const LineBody& body : bodies.finite) {
    if (!body.shape) continue;
    out.work.faces += static_cast<int64_t>(body.shape->faces.size());
    out.work.edges += static_cast<int64_t>(body.shape->edges.size());
  }
  out.candidates = all_candidates(bodies, view, pool, with_hidden, out.work, stop);
  const LineOccluders occluders(bodies, view);
  out.work.convex_bodies = occluders.whole_bodies();

  struct Part {
    std::vector<LinePiece> pieces;
    int64_t tests = 0;
  };
  const PieceFinder finder(out.candidates, occluders, view, with_hidden);
  const auto count = static_cast<int64_t>(out.candidates.size());
  std::vector<Part> parts((count + kChunk - 1) / kChunk);
  pool.parallel_for(
      static_cast<int64_t>(parts.size()), Priority::normal,
      [&](int64_t p) {
        for (int64_t i = p * kChunk; i < std::min(count, (p + 1) * kChunk); ++i)
          parts[p].tests += finder.find(static_cast<uint32_t>(i), parts[p].pieces);
      },
      stop);
  for (const Part& part : parts) {
    out.pieces.insert(out.pieces.end(), part.pieces.begin(), part.pieces.end());
    out.work.occlusion_tests += part.tests;
  }
  return out;
}

}  // namespace tilelight::lines
