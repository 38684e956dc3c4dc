// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "renderer/check/check.h"
#include "renderer/cli/commands.h"
#include "renderer/cli/complain.h"
#include "renderer/cli/interrupt.h"
#include "renderer/trace/isa.h"

namespace tilelight::cli {
namespace {

using check::Measured;
using check::Row;
using check::Verdict;

bool is_named(const Row& row, const std::string& name) {
  const std::string id = row.id;
  return id == name || (name.size() == 1 && id[0] == name[0]);
}

// The rows that were asked for, in the order of the catalogue; nothing, with a word on standard error, if a name is
// none.
std::vector<Row> chosen_rows(const std::vector<std::string>& only) {
  std::vector<Row> rows = check::catalogue();
  if (only.empty()) return rows;
  for (const std::string& name : only) {
    if (std::any_of(rows.begin(), rows.end(), [&](const Row& row) { return is_named(row, name); })) continue;
    std::string letters;
    for (const Row& row : rows) {
      if (letters.empty() || letters.back() != row.id[0])
        letters += (letters.empty() ? "" : ", ") + std::string(1, row.id[0]);
    }
    complain(kBadInput, "no row is called '" + name + "'; the groups are " + letters + ", their rows S1, S2, ...");
    return {};
  }
  std::erase_if(rows, [&](const Row& row) {
    return std::none_of(only.begin(), only.end(), [&](const std::string& name) { return is_named(row, name); });
  });
  return rows;
}

std::string number_text(double value) {
  std::ostringstream out;
  const bool is_count = std::abs(value) < 1e12 && value == std::floor(value);
  out << std::setprecision(is_count ? 12 : 4) << value;
  return out.str();
}

std::string bound_text(const Measured& m) {
  return (m.sense == Measured::Sense::at_most ? "<= " : ">= ") + number_text(m.bound);
}

constexpr int kWhatWidth = 56, kNumberWidth = 12, kBoundWidth = 12;

void print_line(const std::string& who, const Measured& m, const char* verdict) {
  std::printf("      %-6s %-*s %*s  %-*s %s\n", who.c_str(), kWhatWidth, m.what.c_str(), kNumberWidth,
              number_text(m.value).c_str(), kBoundWidth, bound_text(m).c_str(), verdict);
}

void print_verdict(const Verdict& v) {
  std::printf("%-4s  %s: %s  (%.1f s)  %s\n", v.row.id, v.row.name, v.row.extreme, v.ms / 1000.0,
              v.holds() ? "pass" : "FAIL");
  for (const Measured& m : v.outcome.ours) print_line("ours", m, m.holds() ? "" : "FAIL");
  for (const Measured& m : v.outcome.naive)
    print_line("naive", m, m.holds() ? "FAIL: the case does not bite" : "breaks it, as it should");
  if (v.outcome.ours.empty()) std::printf("      nothing was measured: FAIL\n");
  std::fflush(stdout);
}

}  // namespace

ExitCode run_check(const CheckArguments& arguments) {
  if (auto isa = select_isa(arguments.isa); !isa) return complain(kBadInput, isa.error().detail);
  const std::vector<Row> rows = chosen_rows(arguments.only);
  if (rows.empty()) return kBadInput;

  TilePool pool(arguments.threads);
  std::vector<Verdict> verdicts;
  double ms = 0.0;
  for (const Row& row : rows) {
    if (is_interrupted()) return kInterrupted;
    verdicts.push_back(check::run_row(row, {pool, arguments.is_quick, "/proc/self/exe"}));
    ms += verdicts.back().ms;
    if (!arguments.json) print_verdict(verdicts.back());
  }
  const auto failed = std::count_if(verdicts.begin(), verdicts.end(), [](const Verdict& v) { return !v.holds(); });
  if (arguments.json) {
    std::printf("%s\n", check::verdicts_json(verdicts).c_str());
  } else {
    std::printf("\n%zu rows, %td failed, %.1f s on %d threads (%s)\n", rows.size(), failed, ms / 1000.0,
                pool.thread_count(), current_isa().c_str());
  }
  return failed == 0 ? kOk : kFailed;
}

}  // namespace tilelight::cli
