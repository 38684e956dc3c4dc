// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/statistics.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

using elementary::exp;
using elementary::log;

// Student's t that 2.5 % lie above, by degrees of freedom from 1.
double t_95(size_t freedom) {
  constexpr std::array<double, 30> kTable{12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                          2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                          2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
  return freedom <= kTable.size() ? kTable[freedom - 1] : 1.96 + 2.4 / static_cast<double>(freedom);
}

}  // namespace

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::optional<PowerLaw> fit_power_law(const std::vector<Sample>& samples) {
  if (samples.size() < 3) return std::nullopt;
  const double n = static_cast<double>(samples.size());
  double mean_x = 0.0, mean_y = 0.0;
  for (const Sample& s : samples) {
    if (!(s.x > 0.0) || !(s.y > 0.0)) return std::nullopt;
    mean_x += log(s.x) / n, mean_y += log(s.y) / n;
  }
  double xx = 0.0, xy = 0.0;
  for (const Sample& s : samples) {
    const double x = log(s.x) - mean_x;
    xx += x * x, xy += x * (log(s.y) - mean_y);
  }
  if (!(xx > 1e-12)) return std::nullopt;
  const double slope = xy / xx;
  double residuals = 0.0;
  for (const Sample& s : samples) {
    const double off = log(s.y) - mean_y - slope * (log(s.x) - mean_x);
    residuals += off * off;
  }
  const double reach = t_95(samples.size() - 2) * std::sqrt(residuals / (n - 2.0) / xx);
  return PowerLaw{slope, slope - reach, slope + reach};
}

std::optional<double> on_curve(const std::vector<Sample>& curve, double x) {
  for (size_t i = 0; i + 1 < curve.size(); ++i) {
    const Sample &a = curve[i], &b = curve[i + 1];
    if (!(a.x > 0.0 && a.y > 0.0 && b.y > 0.0) || x < a.x || x > b.x || !(a.x < b.x)) continue;
    const double part = log(x / a.x) / log(b.x / a.x);
    return a.y * exp(part * log(b.y / a.y));
  }
  return std::nullopt;
}

std::vector<bool> pareto_front(const std::vector<Sample>& samples) {
  std::vector<bool> out(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    out[i] = std::none_of(samples.begin(), samples.end(), [&mine = samples[i]](const Sample& other) {
      return other.x <= mine.x && other.y <= mine.y && (other.x < mine.x || other.y < mine.y);
    });
  }
  return out;
}

std::vector<size_t> steps_of_front(const std::vector<Sample>& samples, double factor) {
  const std::vector<bool> is_on_front = pareto_front(samples);
  std::vector<size_t> front, out;
  for (size_t i = 0; i < samples.size(); ++i)
    if (is_on_front[i]) front.push_back(i);
  std::sort(front.begin(), front.end(), [&](size_t a, size_t b) { return samples[a].x < samples[b].x; });
  double wanted = INFINITY;
  for (const size_t i : front) {
    if (samples[i].y > wanted && i != front.back()) continue;
    out.push_back(i);
    wanted = samples[i].y / factor;
  }
  return out;
}

}  // namespace tilelight
