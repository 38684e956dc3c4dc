// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/spend.h"

#include "renderer/film/error_map.h"

namespace tilelight {
namespace {

constexpr uint32_t kMostSamples = 1u << 20;  // of a pixel

// A doubling of a cell's samples.
struct Offer {
  float worth;  // fall of the variance for a sample, up to a common factor
  uint32_t cell;
  int64_t cost;  // samples
  bool operator<(const Offer& other) const {
    if (worth != other.worth) return worth > other.worth;
    return cell != other.cell ? cell < other.cell : cost < other.cost;
  }
};

}  // namespace

std::vector<uint32_t> spend(const Film& film, const std::vector<float>& variances, double samples) {
  std::vector<Offer> offers;
  offers.reserve(2 * variances.size());
  uint32_t cell = 0;
  for_each_cell({0, 0, film.width(), film.height()}, [&](const TileRect& rect) {
    const uint32_t now = film.samples()[cell];
    const int64_t cost = now * rect.pixel_count();
    const double worth = variances[cell] / static_cast<double>(cost);
    if (now <= kMostSamples / 2) offers.push_back({static_cast<float>(worth), cell, cost});
    if (now <= kMostSamples / 4) offers.push_back({static_cast<float>(0.5 * kEdgeDecay * worth), cell, 2 * cost});
    ++cell;
  });
  std::sort(offers.begin(), offers.end());
  std::vector<uint32_t> targets = film.samples();
  int64_t left = static_cast<int64_t>(samples * film.width() * static_cast<double>(film.height()));
  bool is_any = false;
  for (const Offer& offer : offers) {
    if (is_any && offer.cost > left) break;
    left -= offer.cost;
    targets[offer.cell] *= 2;
    is_any = true;
  }
  return targets;
}

}  // namespace tilelight
