// SPDX-License-Identifier: Apache-2.0
// Series side by side: what error each has after the same time, and what time each takes to the same error. Pure.
#pragma once

#include <optional>
#include <vector>

#include "renderer/study/study.h"

namespace tilelight::study {

struct TableRow {
  double at = 0.0;                            // ms, or rmse
  std::vector<std::optional<double>> values;  // by series, between its own runs; none beyond them
};

// At the times of the first series' runs: rmse.
std::vector<TableRow> equal_time(const Study& study);
// At round errors: ms.
std::vector<TableRow> equal_error(const Study& study);

}  // namespace tilelight::study
