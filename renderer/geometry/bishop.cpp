// SPDX-License-Identifier: Apache-2.0
// The bishop: a mitre with a slanting cut on its +x side, and a ball on top.
#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"

namespace tilelight {
namespace {

// The cut lies between two planes y = height + kSlope * x and ends on a chord at the columns a quarter turn off +x.
constexpr double kSlope = 0.95, kLowerPlane = 1.122, kUpperPlane = 1.168;
constexpr double kMitreFoot = 0.952, kMitreTop = 1.322;

int bishop_columns(int detail) { return round_up(detail, 4); }

Profile stem_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.315, .height = 0.31, .stem_radius = 0.156}, detail);
  profile.curve_to({0.108, 0.36}, {0.080, 0.52}, {0.080, 0.800});
  profile.line_to({0.098, 0.804});
  add_bead(profile, 0.098, 0.836);
  add_collar(profile, 0.182, 0.864, 0.064, 0.104);
  profile.line_to({0.104, 0.900});
  add_bead(profile, 0.096, 0.930);
  profile.line_to({0.082, 0.932}).line_to({0.082, kMitreFoot});
  return profile;
}

Profile finial_profile(int detail) {
  Profile profile({0.034, kMitreTop}, detail);
  profile.ball_to({0.0, 1.402}, 2.0 * 68.0);
  return profile;
}

int rows_of(double density, int detail) {
  return std::max(2, static_cast<int>(density * std::sqrt(double(detail)) + 0.5));
}

// The mitre is turned from one smooth curve, 0 <= t <= 2, but its rows lean: from the level foot they tilt into the
// planes of the cut and back to the level top, so that the cut has clean edges at every detail.
class Mitre {
 public:
  explicit Mitre(int detail)
      : columns_(bishop_columns(detail)),
        rows_below_(rows_of(1.3, detail)),
        rows_beside_(rows_of(0.35, detail)),
        rows_above_(rows_of(0.9, detail)) {}

  void add_to(MeshBuilder& mesh) const {
    const int n = columns_.count(), quarter = n / 4;
    std::vector<double> foot(n + 1, 0.0), lower(n + 1), upper(n + 1), top(n + 1, 2.0);
    for (int j = 0; j <= n; ++j) {
      lower[j] = crossing(j % n, kLowerPlane);
      upper[j] = crossing(j % n, kUpperPlane);
    }
    add_rows(mesh, foot, lower, rows_below_, 0, n);
    add_rows(mesh, lower, upper, rows_beside_, quarter, 3 * quarter);
    add_rows(mesh, upper, top, rows_above_, 0, n);
    add_cut(mesh, lower, upper);
  }

  int64_t triangles() const {
    const int64_t n = columns_.count();
    const int64_t walls = 2 * (n - 2);  // over n / 2 columns; both end in a point on either side
    const int64_t beside = n * rows_beside_, floor = n * rows_beside_;
    return 2 * n * (rows_below_ + rows_above_) + beside + walls + floor;
  }

 private:
  static ProfilePoint at(double t) {
    static constexpr double kWide = 0.148, kWideY = 1.072;
    static const Cubic kLower{{0.082, kMitreFoot}, {0.112, 0.962}, {kWide, 1.005}, {kWide, kWideY}};
    static const Cubic kUpper{{kWide, kWideY}, {kWide, 1.165}, {0.066, 1.255}, {0.034, kMitreTop}};
    const Cubic& curve = t < 1.0 ? kLower : kUpper;
    const double u = t < 1.0 ? t : t - 1.0;
    const Vec2 tangent = curve.tangent(u);
    return {curve.position(u), glm::normalize(Vec2(tangent.y, -tangent.x))};
  }

  // Where column j meets the plane y = height + kSlope * x; it climbs through it once.
  double crossing(int j, double height) const {
    double below = 0.0, above = 2.0;
    for (int i = 0; i < 60; ++i) {
      const double t = 0.5 * (below + above);
      const Vec2 p = at(t).position;
      (p.y - kSlope * p.x * columns_.direction(j).x < height ? below : above) = t;
    }
    return 0.5 * (below + above);
  }

  // Row i of `rows` between two rows of curve parameters.
  static std::vector<double> between(const std::vector<double>& from, const std::vector<double>& to, int i, int rows) {
    if (i == rows) return to;
    std::vector<double> t(from.size());
    for (size_t j = 0; j < t.size(); ++j) t[j] = from[j] + (to[j] - from[j]) * i / rows;
    return t;
  }

  void add_rows(MeshBuilder& mesh, const std::vector<double>& from, const std::vector<double>& to, int rows, int first,
                int last) const {
    std::vector<SurfacePoint> points;
    for (int i = 0; i <= rows; ++i) {
      const std::vector<double> t = between(from, to, i, rows);
      for (int j = first; j <= last; ++j) points.push_back(turned_point(at(t[j]), columns_.direction(j)));
    }
    mesh.add_grid(points, last - first + 1);
  }

  // On the row t: the lip at column j (-quarter..quarter), or the point below it on the straight floor of the cut.
  Vec3 lip(const std::vector<double>& t, int j) const {
    const int column = (j + columns_.count()) % columns_.count();
    return turned_point(at(t[column]), columns_.direction(column)).position;
  }
  Vec3 chord(const std::vector<double>& t, int j) const {
    const int quarter = columns_.count() / 4;
    const Vec3 right = lip(t, -quarter), left = lip(t, quarter);
    return j == quarter ? left : right + (left - right) * (double(j + quarter) / (2 * quarter));
  }

  // Both walls of the cut and its floor.
  void add_cut(MeshBuilder& mesh, const std::vector<double>& lower, const std::vector<double>& upper) const {
    const int quarter = columns_.count() / 4;
    const Vec3 up = glm::normalize(Vec3(-kSlope, 1.0, 0.0)), out(1.0, 0.0, 0.0);
    std::vector<SurfacePoint> lower_wall, upper_wall, floor;
    for (int j = -quarter; j <= quarter; ++j) lower_wall.push_back({lip(lower, j), up});
    for (int j = -quarter; j <= quarter; ++j) lower_wall.push_back({chord(lower, j), up});
    for (int j = -quarter; j <= quarter; ++j) upper_wall.push_back({chord(upper, j), -up});
    for (int j = -quarter; j <= quarter; ++j) upper_wall.push_back({lip(upper, j), -up});
    for (int i = 0; i <= rows_beside_; ++i) {
      const std::vector<double> t = between(lower, upper, i, rows_beside_);
      for (int j = -quarter; j <= quarter; ++j) floor.push_back({chord(t, j), out});
    }
    for (const auto* patch : {&lower_wall, &upper_wall, &floor}) mesh.add_grid(*patch, 2 * quarter + 1);
  }

  Columns columns_;
  int rows_below_, rows_beside_, rows_above_;
};

}  // namespace

TriMesh make_bishop(int detail) {
  const Columns columns(bishop_columns(detail));
  MeshBuilder mesh;
  turn(mesh, stem_profile(detail), columns);
  Mitre(detail).add_to(mesh);
  turn(mesh, finial_profile(detail), columns);
  return mesh.finish();
}

int64_t bishop_triangles(int detail) {
  const int columns = bishop_columns(detail);
  return turned_triangles(stem_profile(detail), columns) + Mitre(detail).triangles() +
         turned_triangles(finial_profile(detail), columns);
}

}  // namespace tilelight
