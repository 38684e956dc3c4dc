// SPDX-License-Identifier: Apache-2.0
#include "renderer/raster/lines/half_space.h"

#include <algorithm>

namespace tilelight::lines {

void unite(std::vector<Span>& spans, double gap) {
  std::erase_if(spans, [](const Span& s) { return s.is_empty(); });
  std::sort(spans.begin(), spans.end(),
            [](const Span& a, const Span& b) { return a.from != b.from ? a.from < b.from : a.to < b.to; });
  size_t last = 0;
  for (size_t i = 1; i < spans.size(); ++i) {
    if (spans[i].from <= spans[last].to + gap)
      spans[last].to = std::max(spans[last].to, spans[i].to);
    else
      spans[++last] = spans[i];
  }
  if (!spans.empty()) spans.resize(last + 1);
}

std::vector<Span> uncovered(const Span& whole, const std::vector<Span>& united, double least) {
  std::vector<Span> left;
  double from = whole.from;
  const auto keep_until = [&](double to) {
    if (to - from > least) left.push_back({from, to});
  };
  for (const Span& s : united) {
    if (s.to <= from) continue;
    if (s.from >= whole.to) break;
    keep_until(s.from);
    from = s.to;
  }
  keep_until(whole.to);
  return left;
}

std::vector<Span> covered(const Span& whole, const std::vector<Span>& united, double least) {
  std::vector<Span> found;
  for (const Span& s : united) {
    const Span part{std::max(s.from, whole.from), std::min(s.to, whole.to)};
    if (part.to - part.from > least) found.push_back(part);
  }
  return found;
}

}  // namespace tilelight::lines
