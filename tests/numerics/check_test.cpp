// SPDX-License-Identifier: Apache-2.0
// Every row of the stress catalogue at its quick size. TILELIGHT_COMMAND is the built command.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include "renderer/check/check.h"
#include "renderer/check/child.h"

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

TEST(Catalogue, IsTheTableOfItsDocument) {
  std::ifstream file(TILELIGHT_SOURCE_DIR "/renderer/check/README.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  for (const Row& row : catalogue()) {
    std::string extreme = row.extreme;
    for (size_t at = 0; (at = extreme.find('|', at)) != std::string::npos; at += 2) extreme.insert(at, 1, '\\');
    const std::string line = std::string("| ") + row.id + " | " + row.name + " | " + extreme + " |";
    EXPECT_NE(document.find(line), std::string::npos) << line;
  }
}

}  // namespace
}  // namespace tilelight::check
