// SPDX-License-Identifier: Apache-2.0
// The few statistics that a study needs. Pure; any thread.
#pragma once

#include <optional>
#include <vector>

namespace tilelight {

// Of an even number the mean of the middle two. REQUIRES: values is not empty.
double median(std::vector<double> values);

// y = c * x^slope, by least squares on logarithms; low and high hold the slope in 95 % of cases (Student's t).
struct PowerLaw {
  double slope = 0.0, low = 0.0, high = 0.0;
};
struct Sample {
  double x = 0.0, y = 0.0;
};
// None from fewer than three samples, of one x alone, or with values that are not positive.
std::optional<PowerLaw> fit_power_law(const std::vector<Sample>& samples);

// What the curve through samples (straight between them on logarithmic axes, x rising) has at x. None outside it.
std::optional<double> on_curve(const std::vector<Sample>& curve, double x);

// Which samples no other one beats in both x and y, less being better.
std::vector<bool> pareto_front(const std::vector<Sample>& samples);

// Places of samples, by rising x: the least x; from there on, each time that y has fallen by the factor, the least x
// that has it so low; at last the least y.
std::vector<size_t> steps_of_front(const std::vector<Sample>& samples, double factor);

}  // namespace tilelight
