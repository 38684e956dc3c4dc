// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/profile.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"

namespace tilelight {
namespace {

Vec2 right_of(Vec2 tangent) { return glm::normalize(Vec2(tangent.y, -tangent.x)); }

}  // namespace

Vec2 Cubic::position(double t) const {
  const double s = 1.0 - t;
  return s * s * s * p0 + 3.0 * s * s * t * p1 + 3.0 * s * t * t * p2 + t * t * t * p3;
}

Vec2 Cubic::tangent(double t) const {
  const double s = 1.0 - t;
  const Vec2 d = s * s * (p1 - p0) + 2.0 * s * t * (p2 - p1) + t * t * (p3 - p2);
  if (d != Vec2(0.0)) return d;
  return t < 0.5 ? p2 - p0 : p3 - p1;  // a control point lies on its end point
}

Profile::Profile(Vec2 start, int detail) : detail_(detail) { runs_.push_back({{start, Vec2(0.0, -1.0)}}); }

int Profile::segments() const {
  int sum = 0;
  for (const ProfileRun& run : runs_) sum += static_cast<int>(run.size()) - 1;
  return sum;
}

// The sagitta of n chords of an arc is about length * turn / (8 n^2): equal errors ask for n ~ sqrt(length * turn).
int Profile::segments_of(double length, double turn_rad) const {
  constexpr double kDensity = 1.5;
  const double n = kDensity * std::sqrt(length * turn_rad * detail_);
  return std::max(2, static_cast<int>(n + 0.5));
}

// A new run begins where the direction turns by more than 8 degrees.
void Profile::start_element(Vec2 tangent) {
  constexpr double kSmoothCosine = 0.99;
  const Vec2 normal = right_of(tangent);
  ProfileRun& run = runs_.back();
  if (run.size() == 1) {
    run.back().normal = normal;
  } else if (glm::dot(run.back().normal, normal) < kSmoothCosine) {
    const Vec2 corner = end();
    runs_.push_back({{corner, normal}});
  }
}

void Profile::add(Vec2 position, Vec2 tangent) { runs_.back().push_back({position, right_of(tangent)}); }

Profile& Profile::line_to(Vec2 to) {
  const Vec2 tangent = to - end();
  start_element(tangent);
  add(to, tangent);
  return *this;
}

Profile& Profile::arc_to(Vec2 to, double turn_deg) {
  add_arc(to, elementary::rad_from_deg(turn_deg), 1.0);
  return *this;
}

Profile& Profile::ball_to(Vec2 to, double turn_deg) {
  add_arc(to, elementary::rad_from_deg(turn_deg), 1.7);
  return *this;
}

void Profile::add_arc(Vec2 to, double turn, double fineness) {
  const double half = 0.5 * turn;
  const Vec2 from = end(), chord = to - from;
  const double c = elementary::cos(half), s = elementary::sin(half);
  const Vec2 center = 0.5 * (from + to) + 0.5 * (c / s) * Vec2(-chord.y, chord.x);
  const Vec2 spoke = from - center;
  const double side = turn > 0.0 ? 1.0 : -1.0;
  start_element(side * Vec2(-spoke.y, spoke.x));
  const double radius = glm::length(spoke);
  const int n = static_cast<int>(fineness * segments_of(radius * std::fabs(turn), std::fabs(turn)) + 0.5);
  for (int i = 1; i <= n; ++i) {
    const double ci = elementary::cos(turn * i / n), si = elementary::sin(turn * i / n);
    const Vec2 p(ci * spoke.x - si * spoke.y, si * spoke.x + ci * spoke.y);
    add(i == n ? to : center + p, side * Vec2(-p.y, p.x));
  }
}

Profile& Profile::curve_to(Vec2 control0, Vec2 control1, Vec2 to) {
  const Cubic cubic{end(), control0, control1, to};
  constexpr int kProbes = 32;
  double length = 0.0, turn = 0.0;
  for (int i = 0; i < kProbes; ++i) {
    const double t0 = double(i) / kProbes, t1 = double(i + 1) / kProbes;
    length += glm::length(cubic.position(t1) - cubic.position(t0));
    const Vec2 a = cubic.tangent(t0), b = cubic.tangent(t1);
    turn += std::fabs(elementary::atan2(a.x * b.y - a.y * b.x, glm::dot(a, b)));
  }
  start_element(cubic.tangent(0.0));
  const int n = segments_of(length, turn);
  for (int i = 1; i <= n; ++i) add(i == n ? to : cubic.position(double(i) / n), cubic.tangent(double(i) / n));
  return *this;
}

}  // namespace tilelight
