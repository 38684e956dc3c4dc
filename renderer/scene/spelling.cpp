// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/spelling.h"

#include <algorithm>
#include <vector>

#include "renderer/scene/problems.h"

namespace tilelight {
namespace {

// The number of insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`.
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

}  // namespace

std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  constexpr size_t kLongestWord = 64;  // the distance costs the product of the lengths,
  constexpr size_t kMostWork =
      1'000'000;  // milliseconds in all: a scene may have ten thousand names, and a hundred errors
  size_t work = 0;
  if (word.size() > kLongestWord) return "";
  const size_t reach = std::max<size_t>(1, word.size() / 3);
  std::string_view nearest;
  size_t least = reach + 1;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > word.size() + reach || word.size() > candidate.size() + reach) continue;
    work += word.size() * candidate.size();
    if (work > kMostWork) break;
    const size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      nearest = candidate;
    }
  }
  return nearest.empty() ? "" : "did you mean " + in_quotes(nearest) + "?";
}

}  // namespace tilelight
