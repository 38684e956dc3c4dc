// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/cost_text.h"

#include <cmath>
#include <sstream>

namespace tilelight {
namespace {

// Two digits and no exponent: more would claim to know.
std::string two_digits(double value) {
  double unit = 0.01;
  while (value >= 99.5 * unit) unit *= 10.0;
  std::ostringstream out;
  out.precision(12);
  out << std::round(value / unit) * unit;
  return out.str();
}

// Three digits, rounded up: it is a bound.
std::string three_digits_up(double value) {
  double unit = 0.01;
  while (value > 999.0 * unit) unit *= 10.0;
  std::ostringstream out;
  out.precision(12);
  out << std::ceil(value / unit * (1.0 - 1e-12)) * unit;
  return out.str();
}

std::string bound_text(double count) {
  if (count >= 1e9) return three_digits_up(count / 1e9) + " billion";
  if (count >= 1e6) return three_digits_up(count / 1e6) + " million";
  return three_digits_up(count);
}

struct KernelPrice {
  KernelVariant chosen, other;
  int percent;  // of the chosen one's time; 0: not measurable
};
constexpr KernelPrice kKernelPrices[] = {
    {KernelVariant::local, KernelVariant::mirrors, 0},
    {KernelVariant::local, KernelVariant::glass, 1},
    {KernelVariant::local_shadows, KernelVariant::mirrors_shadows, 0},
    {KernelVariant::local_shadows, KernelVariant::glass_shadows, 3},
    {KernelVariant::mirrors, KernelVariant::glass, 3},
    {KernelVariant::mirrors_shadows, KernelVariant::glass_shadows, 6},
};

}  // namespace

std::string bytes_text(int64_t bytes) {
  constexpr double kKibi = 1024.0;
  const auto size = static_cast<double>(bytes);
  if (size < kKibi) return std::to_string(bytes) + " bytes";
  return size < kKibi * kKibi ? two_digits(size / kKibi) + " KiB" : two_digits(size / (kKibi * kKibi)) + " MiB";
}

std::string first_hits_text(const View& view, int64_t times, const std::string& what) {
  const RenderSpec& spec = view.render;
  const bool is_known = spec.samples && !spec.samples_implied && spec.passes.empty();
  const double hits =
      static_cast<double>(times) * view.image.width * view.image.height * (is_known ? *spec.samples : 1);
  return "up to " + bound_text(hits) + " " + what + " at first hits" + (is_known ? "" : ", for each sample a pixel");
}

std::optional<std::string> kernel_cost_text(const FeatureSet& features, Feature more) {
  FeatureSet with = features;
  with.add(more);
  for (const KernelPrice& price : kKernelPrices) {
    if (price.chosen != choose_variant(features) || price.other != choose_variant(with)) continue;
    return (price.percent > 0 ? "about " + std::to_string(price.percent) : "under 1") + " % of the time of a frame";
  }
  return std::nullopt;
}

}  // namespace tilelight
