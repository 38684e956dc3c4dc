// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/check/check.h"

namespace tilelight::check {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no infinities: what is not finite is told by name.
Json number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "NaN" : value > 0.0 ? "Infinity" : "-Infinity";
}

Json list(const std::vector<Measured>& measured) {
  Json items = Json::array();
  for (const Measured& m : measured) {
    items.push_back({{"what", m.what},
                     {"value", number(m.value)},
                     {m.sense == Measured::Sense::at_most ? "at_most" : "at_least", number(m.bound)},
                     {"holds", m.holds()}});
  }
  return items;
}

}  // namespace

std::string verdicts_json(std::span<const Verdict> verdicts) {
  Json rows = Json::array();
  bool passes = true;
  for (const Verdict& v : verdicts) {
    const bool is_pass = v.holds();
    passes &= is_pass;
    rows.push_back({{"id", v.row.id},
                    {"name", v.row.name},
                    {"extreme", v.row.extreme},
                    {"verdict", is_pass ? "pass" : "FAIL"},
                    {"ms", v.ms},
                    {"ours", list(v.outcome.ours)},
                    {"naive_form", v.row.naive},
                    {"naive", list(v.outcome.naive)}});
  }
  return Json{{"passes", passes}, {"rows", rows}}.dump(2);
}

}  // namespace tilelight::check
