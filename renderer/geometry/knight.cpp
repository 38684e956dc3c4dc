// SPDX-License-Identifier: Apache-2.0
// The knight: a turned foot and a carved horse. The horse's surface is a grid like a lathe's, whose rows are sections
// by planes that fan around the throat from the level table to the muzzle, and whose points are cast from the middle
// of each section onto the form.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/geometry/knight_form.h"
#include "renderer/geometry/lathe.h"
#include "renderer/geometry/staunton.h"
#include "renderer/geometry/weld.h"

namespace tilelight {
namespace {

constexpr double kTableY = 0.372;

// Even, so that columns run along the crest and under the jaw.
int knight_columns(int detail) { return round_up(detail + std::min(detail / 4, 16), 4); }

Profile foot_profile(int detail) {
  Profile profile = turned_foot({.radius = 0.325, .height = 0.30, .stem_radius = 0.215}, detail);
  profile.line_to({0.228, 0.304});
  profile.arc_to({0.238, 0.360}, 150.0);
  profile.line_to({0.232, kTableY});
  return profile;
}

// Two places of the outline in the plane of symmetry, (fore, up), that one section passes through: under the neck or
// jaw, and on the back, crest or face. `share` = of all rows, those up to the next section.
struct Section {
  Vec2 below, above;
  double share;
};
constexpr std::array<Section, 19> kSections{{{{0.245, kTableY}, {-0.245, kTableY}, 0.08},
                                             {{0.255, 0.460}, {-0.255, 0.460}, 0.08},
                                             {{0.255, 0.550}, {-0.265, 0.580}, 0.09},
                                             {{0.215, 0.640}, {-0.265, 0.740}, 0.09},
                                             {{0.165, 0.710}, {-0.245, 0.860}, 0.08},
                                             {{0.132, 0.752}, {-0.200, 0.990}, 0.06},
                                             {{0.122, 0.768}, {-0.130, 1.090}, 0.05},
                                             {{0.122, 0.768}, {-0.050, 1.170}, 0.04},
                                             {{0.126, 0.764}, {0.015, 1.215}, 0.04},
                                             {{0.132, 0.760}, {0.065, 1.225}, 0.05},
                                             {{0.140, 0.756}, {0.115, 1.200}, 0.06},
                                             {{0.155, 0.750}, {0.175, 1.150}, 0.09},
                                             {{0.178, 0.742}, {0.230, 1.065}, 0.07},
                                             {{0.208, 0.732}, {0.275, 0.990}, 0.06},
                                             {{0.242, 0.720}, {0.320, 0.930}, 0.05},
                                             {{0.270, 0.715}, {0.354, 0.892}, 0.05},
                                             {{0.286, 0.717}, {0.370, 0.876}, 0.05},
                                             {{0.300, 0.724}, {0.376, 0.862}, 0.03},
                                             {{0.312, 0.742}, {0.372, 0.846}, 0.00}}};

int section_rows(const Section& section, int detail) {
  const double all = 200.0 * detail / (detail + 75.0);  // eighty show the face well at the default detail
  return std::max(1, static_cast<int>(section.share * all + 0.5));
}

int muzzle_rows(int detail) { return std::max(2, static_cast<int>(0.9 * std::sqrt(double(detail)) + 0.5)); }

// Full rows of quads; the muzzle's last row is a fan.
int horse_rows(int detail) {
  int rows = muzzle_rows(detail) - 1;
  for (size_t i = 0; i + 1 < kSections.size(); ++i) rows += section_rows(kSections[i], detail);
  return rows;
}

Vec3 from_outline(Vec2 fore_up) { return Vec3(0.0, fore_up.y, -fore_up.x); }

// The outermost point of the form within `reach` on the ray from an inner point; the form is star-shaped about it but
// for the ears. Illinois' form of the secant rule ends the search.
Vec3 cast_onto_form(const Vec3& from, const Vec3& direction, double reach) {
  constexpr double kMinStep = 0.004;
  double outside = reach, inside = 0.0, d_outside = knight_form(from + reach * direction), d_inside = -1e-3;
  for (double t = reach; t > 0.0; t -= std::max(kMinStep, 0.5 * d_outside)) {
    const double d = knight_form(from + t * direction);
    if (d < 0.0) {
      inside = t;
      d_inside = d;
      break;
    }
    outside = t;
    d_outside = d;
  }
  for (int i = 0; i < 12 && outside - inside > 1e-9; ++i) {
    const double t = inside + (outside - inside) * (d_inside / (d_inside - d_outside));
    const double d = knight_form(from + t * direction);
    if (d < 0.0) {
      inside = t;
      d_inside = d;
      d_outside *= 0.5;
    } else {
      outside = t;
      d_outside = d;
      d_inside *= 0.5;
    }
  }
  return from + inside * direction;
}

class Horse {
 public:
  Horse(int columns, int detail) : columns_(columns), detail_(detail) {
    for (size_t i = 0; i + 1 < kSections.size(); ++i) {
      const Section &a = kSections[i], &b = kSections[i + 1];
      const int rows = section_rows(a, detail_);
      for (int row = 0; row < rows; ++row) {
        const double t = double(row) / rows;
        add_section(a.below + t * (b.below - a.below), a.above + t * (b.above - a.above));
      }
    }
    add_section(kSections.back().below, kSections.back().above);
    add_muzzle(kSections.back());
    add_points();
  }

  // Row 0 is level with the table; the last row is one point, the tip of the muzzle.
  const std::vector<SurfacePoint>& points() const { return points_; }

 private:
  // A ring of points from the crest around over +x and -x to the crest again, at even steps of an ellipse's parameter,
  // so that the narrow crest has its share.
  void add_section(Vec2 below, Vec2 above) {
    constexpr double kReach = 0.42;
    const Vec3 middle = from_outline(0.5 * (below + above)), up = glm::normalize(from_outline(above - below));
    const double half_chord = 0.5 * glm::length(above - below);
    const Vec3 top = cast_onto_form(middle, up, kReach), bottom = cast_onto_form(middle, -up, half_chord);
    const Vec3 center = 0.5 * (top + bottom), across(1.0, 0.0, 0.0);
    const double height = 0.5 * glm::length(top - bottom), width = cast_onto_form(center, across, kReach).x;
    // Rays that point down must not reach over the gap under the jaw to the chest: `below` lies in that gap.
    const double drop = half_chord + glm::dot(center - middle, up);
    const size_t first = positions_.size();
    positions_.push_back(top);
    for (int j = 1; j < columns_ / 2; ++j) {
      const double s = 2.0 * j / columns_;
      const double angle = elementary::kPi * s * (0.7 + 0.3 * s * s);  // closer on the face than under jaw and chest
      const Vec3 direction =
          glm::normalize(height * elementary::cos(angle) * up + width * elementary::sin(angle) * across);
      const double down = -glm::dot(direction, up);
      positions_.push_back(cast_onto_form(center, direction, down * kReach > drop ? drop / down : kReach));
    }
    positions_.push_back(bottom);
    for (int j = columns_ / 2 - 1; j >= 0; --j) positions_.push_back(mirrored(positions_[first + j]));
  }

  // The end of the muzzle: from the last section's middle the rays lean forwards, row by row, until they meet.
  void add_muzzle(const Section& last) {
    constexpr double kReach = 0.12;
    const Vec2 chord = last.above - last.below;
    tip_normal_ = glm::normalize(from_outline({chord.y, -chord.x}));
    const size_t ring = positions_.size() - (columns_ + 1);
    const Vec3 center = 0.5 * (positions_[ring] + positions_[ring + columns_ / 2]);
    const int rows = muzzle_rows(detail_);
    for (int row = 1; row < rows; ++row) {
      const double lean = 0.5 * elementary::kPi * row / rows;
      const size_t first = positions_.size();
      for (int j = 0; j <= columns_ / 2; ++j) {
        const Vec3 out = glm::normalize(positions_[ring + j] - center);
        const Vec3 direction = elementary::cos(lean) * out + elementary::sin(lean) * tip_normal_;
        positions_.push_back(cast_onto_form(center, direction, kReach));
      }
      for (int j = columns_ / 2 - 1; j >= 0; --j) positions_.push_back(mirrored(positions_[first + j]));
    }
    positions_.insert(positions_.end(), columns_ + 1, cast_onto_form(center, tip_normal_, kReach));
  }

  static Vec3 mirrored(const Vec3& v) { return Vec3(-v.x, v.y, v.z); }

  const Vec3& position(int row, int column) const { return positions_[row * (columns_ + 1) + column]; }

  // By differences between neighbours, not from the form: details finer than the grid are smoothed over, not aliased.
  Vec3 normal_at(int row, int column) const {
    const int last = static_cast<int>(positions_.size()) / (columns_ + 1) - 1;
    const int left = (column + columns_ - 1) % columns_, right = column + 1;
    const Vec3 across = position(row, right) - position(row, left);
    const Vec3 along = position(std::min(row + 1, last), column) - position(std::max(row - 1, 0), column);
    const Vec3 n = unit_or_zero(glm::cross(across, along));
    return column % (columns_ / 2) == 0 ? unit_or_zero(Vec3(0.0, n.y, n.z)) : n;
  }

  void add_points() {
    const int rows = static_cast<int>(positions_.size()) / (columns_ + 1);
    points_.resize(positions_.size());
    for (int row = 0; row < rows; ++row) {
      SurfacePoint* const ring = points_.data() + row * (columns_ + 1);
      for (int j = 0; j <= columns_ / 2; ++j) {
        const Vec3 n = row == rows - 1 ? tip_normal_ : normal_at(row, j);
        ring[j] = {position(row, j), n};
        ring[columns_ - j] = {position(row, columns_ - j), j == columns_ / 2 ? n : mirrored(n)};
      }
    }
  }

  int columns_, detail_;
  Vec3 tip_normal_{0.0};
  std::vector<Vec3> positions_;  // rows of columns_ + 1, the last column repeating the first
  std::vector<SurfacePoint> points_;
};

}  // namespace

TriMesh make_knight(int detail) {
  const int columns = knight_columns(detail);
  const Horse horse(columns, detail);
  MeshBuilder mesh;
  // The foot's column 0 looks back, under the crest, as the horse's does.
  std::vector<Vec2> directions;
  for (int j = 0; j <= columns; ++j) {
    const double angle = 2.0 * elementary::kPi * (j % columns) / columns;
    directions.push_back({elementary::sin(angle), elementary::cos(angle)});
  }
  const Profile foot = foot_profile(detail);
  turn(mesh, foot, Columns(directions));
  // The table between the foot's edge and the horse.
  std::vector<SurfacePoint> table;
  const Vec3 up(0.0, 1.0, 0.0);
  for (int j = 0; j <= columns; ++j)
    table.push_back({turned_point({foot.end(), Vec2(0.0, 1.0)}, directions[j]).position, up});
  for (int j = 0; j <= columns; ++j) table.push_back({horse.points()[j].position, up});
  mesh.add_grid(table, columns + 1);
  mesh.add_grid(horse.points(), columns + 1);
  return mesh.finish();
}

int64_t knight_triangles(int detail) {
  const int64_t columns = knight_columns(detail);
  const int64_t table = 2 * columns, tip = columns;
  return turned_triangles(foot_profile(detail), static_cast<int>(columns)) + table + 2 * columns * horse_rows(detail) +
         tip;
}

}  // namespace tilelight
