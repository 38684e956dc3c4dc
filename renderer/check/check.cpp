// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/check.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <utility>

namespace tilelight::check {

std::vector<Row> catalogue() {
  std::vector<Row> rows;
  for (const auto group :
       {sphere_rows, box_rows, triangle_rows, invariance_rows, camera_rows, light_rows, neighbour_rows, terminator_rows,
        bounce_rows, raster_rows, input_rows, accuracy_rows, determinism_rows}) {
    const std::span<const Row> some = group();
    rows.insert(rows.end(), some.begin(), some.end());
  }
  const auto place = [](const Row& row) {
    return std::pair(std::string_view("SBTICLHMRNJAD").find(row.id[0]), std::atoi(row.id + 1));
  };
  std::sort(rows.begin(), rows.end(), [&](const Row& a, const Row& b) { return place(a) < place(b); });
  return rows;
}

bool Verdict::passes() const {
  return !outcome.ours.empty() &&
         std::all_of(outcome.ours.begin(), outcome.ours.end(), [](const Measured& m) { return m.holds(); });
}

bool Verdict::naive_fails() const {
  return std::none_of(outcome.naive.begin(), outcome.naive.end(), [](const Measured& m) { return m.holds(); });
}

Verdict run_row(const Row& row, const Context& context) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Verdict verdict{row, row.run(context)};
  verdict.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  return verdict;
}

}  // namespace tilelight::check
