// SPDX-License-Identifier: Apache-2.0
// Every row of the stress catalogue at its quick size. TILELIGHT_COMMAND is the built command.
#include <gtest/gtest.h>

#include <bit>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include "renderer/check/check.h"
#include "renderer/check/kit/child.h"

namespace tilelight::check {

void PrintTo(const Row& row, std::ostream* out) { *out << row.id << ", " << row.name; }  // for GoogleTest

namespace {

class CatalogueRow : public testing::TestWithParam<Row> {};

TEST_P(CatalogueRow, KeepsItsBoundsWhereTheNaiveFormBreaksThem) {
  TilePool pool;
  const Verdict verdict = run_row(GetParam(), {pool, true, TILELIGHT_COMMAND});
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

// The bits of a few thousand values of the C library's own functions.
uint64_t bits_of_the_c_library() {
  uint64_t bits = 0;
  for (int i = 1; i < 20'000; ++i) {
    for (const double y : {std::exp(1e-3 * i), std::sin(0.7 * i), std::log(1.1 * i), std::pow(1.0 + 1e-4 * i, 7.3)})
      bits = std::rotl(bits, 5) ^ std::bit_cast<uint64_t>(y);
  }
  return bits;
}

// Row D2 would show nothing if the library took no notice.
TEST(TheMaskOfD2, ChangesTheBitsOfTheCLibrary) {
#if defined(__x86_64__)
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "this CPU has no FMA to be masked";
#endif
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the program starts anew, and the library with it
  const char* const kUnmasked = "BITS_OF_THE_UNMASKED_LIBRARY";
  const std::string here = std::to_string(bits_of_the_c_library());
  if (!std::getenv(kUnmasked)) ::setenv(kUnmasked, here.c_str(), 1);
  ::setenv(kPlainLibrary.name, kPlainLibrary.value, 1);
  EXPECT_EXIT(std::_Exit(here == std::getenv(kUnmasked) ? 1 : 0), testing::ExitedWithCode(0), "");
  ::unsetenv(kPlainLibrary.name);
  ::unsetenv(kUnmasked);
}

// The cells of a line of a table; "\\|" is a bar inside one.
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (size_t i = 1; i < line.size(); ++i) {
    if (line.compare(i, 2, "\\|") == 0)
      cells.back() += line[++i];
    else if (line[i] == '|')
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  cells.pop_back();
  for (std::string& cell : cells) cell = cell.substr(1, cell.size() - 2);
  return cells;
}

// Its lines by id and in order: neither may have a row that the other has not. What is kept is told in fewer words.
TEST(Catalogue, IsTheTableOfItsDocument) {
  std::ifstream file(TILELIGHT_SOURCE_DIR "/renderer/check/README.md");
  std::vector<std::string> told, rows;
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("| ") || line.size() < 4 || !std::isdigit(line[3])) continue;
    const std::vector<std::string> cells = cells_of(line);
    ASSERT_EQ(cells.size(), 5u) << line;
    told.push_back(cells[0] + "; " + cells[1] + "; " + cells[2] + "; " + cells[4]);
  }
  for (const Row& row : catalogue())
    rows.push_back(std::string(row.id) + "; " + row.name + "; " + row.extreme + "; " + row.naive);
  EXPECT_EQ(told, rows);
}

}  // namespace
}  // namespace tilelight::check
