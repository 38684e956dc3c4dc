// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/methods_report.h"

#include <cstdio>

#include <nlohmann/json.hpp>

#include "renderer/render/plot.h"

namespace tilelight::bench {
namespace {

using Json = nlohmann::ordered_json;

std::string slope_text(const std::optional<PowerLaw>& law) {
  if (!law) return "-";
  char text[16];
  std::snprintf(text, sizeof text, "%.2f", law->slope);
  return text;
}

std::string exponent_text(const std::optional<PowerLaw>& law) {
  if (!law) return "-";
  char text[64];
  std::snprintf(text, sizeof text, "%.2f (%.2f - %.2f)", law->slope, law->low, law->high);
  return text;
}

Json exponent_json(const std::optional<PowerLaw>& law) {
  if (!law) return nullptr;
  return {{"exponent", law->slope}, {"low", law->low}, {"high", law->high}};
}

std::string theory_of(const Sweep& sweep, const std::string& method) {
  const auto at = sweep.theory.find(method);
  return at == sweep.theory.end() ? "-" : at->second;
}

}  // namespace

Growth growth_of(const Sweep& sweep, const std::string& method) {
  std::vector<Sample> samples;
  for (const SweepPoint& point : sweep.points) {
    if (const auto at = point.ms.find(method); at != point.ms.end()) samples.push_back({point.value, at->second});
  }
  std::vector<Sample> added;
  for (size_t i = 1; i < samples.size(); ++i)
    added.push_back({samples[i].x - samples[0].x, samples[i].y - samples[0].y});
  return {fit_power_law(samples), fit_power_law(added)};
}

void print_sweep(const Sweep& sweep, const std::vector<std::string>& methods) {
  std::printf("\n%-28s", sweep.label.c_str());
  for (const std::string& method : methods) std::printf(" %12s", method.c_str());
  for (const SweepPoint& point : sweep.points) {
    std::printf("\n%-28.0f", point.value);
    for (const std::string& method : methods) {
      const auto at = point.ms.find(method);
      if (at == point.ms.end())
        std::printf(" %12s", "-");
      else
        std::printf(" %12.2f", at->second);
    }
  }
  std::printf("\n");
  for (const std::string& method : methods) {
    const Growth growth = growth_of(sweep, method);
    std::printf("  %-12s exponent %-22s of what is added %-22s theory %s\n", method.c_str(),
                exponent_text(growth.whole).c_str(), exponent_text(growth.added).c_str(),
                theory_of(sweep, method).c_str());
  }
}

std::string sweeps_svg(const std::vector<Sweep>& sweeps, const std::vector<std::string>& methods) {
  constexpr int kWidth = 760, kHeight = 540;  // of a plot with its legend
  const int rows = (static_cast<int>(sweeps.size()) + 1) / 2;
  std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" + std::to_string(2 * kWidth) + "\" height=\"" +
                    std::to_string(rows * kHeight) + "\">\n<rect width=\"100%\" height=\"100%\" " +
                    "fill=\"#ffffff\"/>\n";
  for (size_t i = 0; i < sweeps.size(); ++i) {
    Plot plot{"Cost by " + sweeps[i].name, sweeps[i].label, "milliseconds of the processor", {}};
    for (const std::string& method : methods) {
      PlotCurve& curve = plot.curves.emplace_back();
      const Growth growth = growth_of(sweeps[i], method);
      curve.name = method + ": exponent " + slope_text(growth.whole) + ", of what is added " +
                   slope_text(growth.added) + "; theory " + theory_of(sweeps[i], method);
      for (const SweepPoint& point : sweeps[i].points) {
        if (const auto at = point.ms.find(method); at != point.ms.end())
          curve.points.push_back({.x = point.value, .y = at->second});
      }
    }
    out += "<g transform=\"translate(" + std::to_string(static_cast<int>(i % 2) * kWidth) + " " +
           std::to_string(static_cast<int>(i / 2) * kHeight) + ")\">\n" + plot_svg(plot) + "</g>\n";
  }
  return out + "</svg>\n";
}

std::string sweeps_json(const std::vector<Sweep>& sweeps, const std::vector<std::string>& methods) {
  Json out = Json::array();
  for (const Sweep& sweep : sweeps) {
    Json points = Json::array(), growth = Json::object();
    for (const SweepPoint& point : sweep.points) points.push_back({{"value", point.value}, {"cpu_ms", point.ms}});
    for (const std::string& method : methods) {
      const Growth found = growth_of(sweep, method);
      growth[method] = {{"whole", exponent_json(found.whole)},
                        {"added", exponent_json(found.added)},
                        {"theory", theory_of(sweep, method)}};
    }
    out.push_back({{"sweep", sweep.name}, {"points", points}, {"growth", growth}});
  }
  return out.dump(2);
}

}  // namespace tilelight::bench
