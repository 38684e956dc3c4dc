// SPDX-License-Identifier: Apache-2.0
// What bench_methods has measured, told: as a table, as plots, as JSON.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"
#include "renderer/study/statistics.h"

namespace tilelight::bench {

struct Subject {
  Scene scene;
  View view;
};
struct SweepPoint {
  double value = 0.0;  // what is swept
  std::function<Subject()> make;
  std::map<std::string, double> ms;  // by method; none where it would have taken too long
};
struct Sweep {
  std::string name, label;
  std::map<std::string, std::string> theory;  // by method, the cost of n
  std::vector<SweepPoint> points;
};

// The power law through the times; and the one through what they and the values are above their smallest, none where
// nothing is added.
struct Growth {
  std::optional<PowerLaw> whole, added;
};
Growth growth_of(const Sweep& sweep, const std::string& method);

void print_sweep(const Sweep& sweep, const std::vector<std::string>& methods);
// All of them in one document, two beside each other.
std::string sweeps_svg(const std::vector<Sweep>& sweeps, const std::vector<std::string>& methods);
std::string sweeps_json(const std::vector<Sweep>& sweeps, const std::vector<std::string>& methods);

}  // namespace tilelight::bench
