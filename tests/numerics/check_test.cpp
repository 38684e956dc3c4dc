// SPDX-License-Identifier: Apache-2.0
// Every row of the stress catalogue at its quick size.
#include <gtest/gtest.h>

#include <set>

#include "renderer/check/check.h"

namespace tilelight::check {

void PrintTo(const Row& row, std::ostream* out) { *out << row.id << ", " << row.name; }  // for GoogleTest

namespace {

class CatalogueRow : public testing::TestWithParam<Row> {};

TEST_P(CatalogueRow, KeepsItsBoundsWhereTheNaiveFormBreaksThem) {
  TilePool pool;
  const Verdict verdict = run_row(GetParam(), {pool, true});
  EXPECT_FALSE(verdict.outcome.ours.empty());
  for (const Measured& m : verdict.outcome.ours)
    EXPECT_TRUE(m.holds()) << m.what << ": " << m.value << ", bound " << m.bound;
  for (const Measured& m : verdict.outcome.naive)
    EXPECT_FALSE(m.holds()) << "the naive form keeps the bound: " << m.what << ": " << m.value << ", bound " << m.bound;
}

INSTANTIATE_TEST_SUITE_P(Check, CatalogueRow, testing::ValuesIn(catalogue()),
                         [](const auto& param) { return std::string(param.param.id); });

TEST(Catalogue, NamesEveryRowOnce) {
  std::set<std::string> ids;
  for (const Row& row : catalogue()) EXPECT_TRUE(ids.insert(row.id).second) << row.id;
}

}  // namespace
}  // namespace tilelight::check
