// SPDX-License-Identifier: Apache-2.0
// The stress catalogue: scenes and rays at the ends of what numbers bear, each with an answer known from outside the
// code and a bound. Beside most of them stands the naive form, as textbooks print it: it has to break the bound where
// ours keeps it, else the case would show nothing. README.md tells where the bounds come from.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/schedule/tile_pool.h"

namespace tilelight::check {

// A number and the bound that it has to keep.
struct Measured {
  enum class Sense { at_most, at_least };
  std::string what;  // "pixels that show another surface, %"
  double value = 0.0;
  Sense sense = Sense::at_most;
  double bound = 0.0;

  bool holds() const { return sense == Sense::at_most ? value <= bound : value >= bound; }  // NaN never holds
};
inline Measured at_most(double bound, std::string what, double value) {
  return {std::move(what), value, Measured::Sense::at_most, bound};
}
inline Measured at_least(double bound, std::string what, double value) {
  return {std::move(what), value, Measured::Sense::at_least, bound};
}
// How far a value is from what is expected of it.
inline Measured within(double tolerance, std::string what, double value, double expected) {
  return {std::move(what), value > expected ? value - expected : expected - value, Measured::Sense::at_most, tolerance};
}

// The worse of the two stays; NaN counts as without bound.
inline void note(double& worst, double value) {
  if (!(value <= worst)) worst = value >= 0.0 ? value : std::numeric_limits<double>::infinity();
}

// How much longer code may take that a sanitizer has instrumented.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr double kSlowdown = 10.0;
#else
inline constexpr double kSlowdown = 1.0;
#endif

inline double percent(int64_t part, int64_t of) { return 100.0 * static_cast<double>(part) / static_cast<double>(of); }

struct Outcome {
  std::vector<Measured> ours;   // all have to hold
  std::vector<Measured> naive;  // none may hold; empty where there is no naive form
};

struct Context {
  TilePool& pool;
  bool is_quick = false;  // smaller images and fewer rays, for the tests
  std::string command;    // path of the tilelight command, for what needs a process of its own
};

// One case. Rows are data; `run` is a short function.
struct Row {
  const char* id;       // "S1"; never renumbered
  const char* name;     // "sphere far away"
  const char* extreme;  // what is extreme, in numbers
  const char* naive;    // the naive form, or ""
  Outcome (*run)(const Context&);
};

// The groups, in the order of the catalogue.
std::span<const Row> sphere_rows();       // S
std::span<const Row> box_rows();          // B
std::span<const Row> triangle_rows();     // T
std::span<const Row> invariance_rows();   // I
std::span<const Row> camera_rows();       // C
std::span<const Row> light_rows();        // L
std::span<const Row> neighbour_rows();    // H: surfaces that nearly touch
std::span<const Row> terminator_rows();   // H3, H8: where the light ends on smooth meshes
std::span<const Row> bounce_rows();       // M: mirrors and media
std::span<const Row> raster_rows();       // R: hidden surfaces and lines, drawn from triangles
std::span<const Row> input_rows();        // N, J
std::span<const Row> accuracy_rows();     // A: the error, and what is told of it
std::span<const Row> determinism_rows();  // D

// All rows.
std::vector<Row> catalogue();

struct Verdict {
  Row row{};
  Outcome outcome;
  double ms = 0.0;

  bool holds() const { return passes() && naive_fails(); }
  bool passes() const;       // all of ours hold, and there is one
  bool naive_fails() const;  // each naive number breaks its bound; true where there is none
};
Verdict run_row(const Row& row, const Context& context);

// A JSON object: {"passes": ..., "rows": [{id, name, extreme, verdict, ms, ours: [...], naive: [...]}]}.
std::string verdicts_json(std::span<const Verdict> verdicts);

}  // namespace tilelight::check
