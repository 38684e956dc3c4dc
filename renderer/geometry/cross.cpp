// SPDX-License-Identifier: Apache-2.0
#include "renderer/geometry/cross.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/base/elementary.h"
#include "renderer/geometry/weld.h"

namespace tilelight {
namespace {

int arm_segments(int detail) { return std::max(2, static_cast<int>(0.7 * std::sqrt(double(detail)) + 0.5)); }

// An arm's own frame: `along` from the centre to its end, `across` to its left as seen from the front (+z).
struct ArmFrame {
  Vec2 along;
  Vec3 at(double a, double b, double z, double center_y) const {
    return Vec3(along.x * a - along.y * b, center_y + along.y * a + along.x * b, z);
  }
  Vec3 turn(double a, double b, double z) const {
    return Vec3(along.x * a - along.y * b, along.y * a + along.x * b, z);
  }
};

constexpr std::array<ArmFrame, 4> kArms{{{{0, -1}}, {{1, 0}}, {{0, 1}}, {{-1, 0}}}};  // the first is the foot

void add_flat(MeshBuilder& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 n = unit_or_zero(glm::cross(c - a, d - b));
  const std::array<SurfacePoint, 4> quad{{{a, n}, {b, n}, {d, n}, {c, n}}};
  mesh.add_grid(quad, 2);
}

class CrossMaker {
 public:
  CrossMaker(MeshBuilder& mesh, const CrossShape& shape, int segments)
      : mesh_(mesh), shape_(shape), segments_(segments) {}

  void add() {
    for (const double side : {1.0, -1.0}) add_face(side);
    for (size_t k = 0; k < kArms.size(); ++k) {
      const bool is_foot = k == 0;
      for (const double side : {1.0, -1.0}) add_flank(kArms[k], side, is_foot);
      if (!is_foot) add_end(kArms[k]);
    }
  }

  // The corners of the foot's end, counter-clockwise seen from above.
  std::vector<Vec3> foot_loop() const {
    std::vector<Vec3> loop;
    for (const double side : {1.0, -1.0}) {
      const double z = side * shape_.depth, z_side = side * (shape_.depth - shape_.chamfer);
      loop.push_back(edge_point(kArms[0], side, segments_, 0.0, z_side, true));
      loop.push_back(edge_point(kArms[0], side, segments_, shape_.chamfer, z, true));
      loop.push_back(edge_point(kArms[0], -side, segments_, shape_.chamfer, z, true));
      loop.push_back(edge_point(kArms[0], -side, segments_, 0.0, z_side, true));
    }
    return loop;
  }

 private:
  // A point on an arm's outline moved inwards by `inset`; step 0 is at the centre's square, step segments_ at the end.
  // The foot's end is not moved, so that it stays in the disc's plane.
  Vec3 edge_point(const ArmFrame& arm, double side, int step, double inset, double z, bool is_foot) const {
    const double u = double(step) / segments_;
    const double from = shape_.neck - inset, to = is_foot ? shape_.reach : shape_.reach - inset;
    const double half = shape_.neck - inset + (shape_.tip - shape_.neck) * u * u;
    return arm.at(from + (to - from) * u, side * half, z, shape_.center_y);
  }

  Vec3 flank_normal(const ArmFrame& arm, double side, int step) const {
    const double u = double(step) / segments_;
    const double slope = 2.0 * u * (shape_.tip - shape_.neck) / (shape_.reach - shape_.neck);
    return glm::normalize(arm.turn(-slope, side, 0.0));
  }

  // The front (side 1) or the back: four arms around a square.
  void add_face(double side) {
    const double z = side * shape_.depth;
    const Vec3 n(0.0, 0.0, side);
    for (size_t k = 0; k < kArms.size(); ++k) {
      std::vector<SurfacePoint> strip;
      for (int i = 0; i <= segments_; ++i)
        for (const double left : {side, -side})
          strip.push_back({edge_point(kArms[k], left, i, shape_.chamfer, z, k == 0), n});
      mesh_.add_grid(strip, 2);
    }
    std::vector<SurfacePoint> square;
    for (const auto& [k, left] : {std::pair<int, double>{0, -side}, {0, side}, {2, side}, {2, -side}})
      square.push_back({edge_point(kArms[k], left, 0, shape_.chamfer, z, k == 0), n});
    mesh_.add_grid(square, 2);
  }

  // One long side of an arm with its two chamfers.
  void add_flank(const ArmFrame& arm, double side, bool is_foot) {
    const double z = shape_.depth, z_side = shape_.depth - shape_.chamfer;
    struct Line {
      double inset, z;
    };
    const std::array<Line, 4> lines{{{shape_.chamfer, -z}, {0.0, -z_side}, {0.0, z_side}, {shape_.chamfer, z}}};
    for (int strip = 0; strip < 3; ++strip) {
      std::vector<SurfacePoint> points;
      for (int i = 0; i <= segments_; ++i) {
        const Vec3 n = glm::normalize(flank_normal(arm, side, i) + Vec3(0.0, 0.0, strip - 1.0));
        const SurfacePoint back{edge_point(arm, side, i, lines[strip].inset, lines[strip].z, is_foot), n};
        const SurfacePoint front{edge_point(arm, side, i, lines[strip + 1].inset, lines[strip + 1].z, is_foot), n};
        points.push_back(side > 0.0 ? back : front);
        points.push_back(side > 0.0 ? front : back);
      }
      mesh_.add_grid(points, 2);
    }
  }

  void add_end(const ArmFrame& arm) {
    const double z = shape_.depth, z_side = shape_.depth - shape_.chamfer, c = shape_.chamfer;
    const auto at = [&](double side, double inset, double depth) {
      return edge_point(arm, side, segments_, inset, depth, false);
    };
    add_flat(mesh_, at(1, c, z), at(-1, c, z), at(-1, 0, z_side), at(1, 0, z_side));
    add_flat(mesh_, at(1, 0, z_side), at(-1, 0, z_side), at(-1, 0, -z_side), at(1, 0, -z_side));
    add_flat(mesh_, at(1, 0, -z_side), at(-1, 0, -z_side), at(-1, c, -z), at(1, c, -z));
  }

  MeshBuilder& mesh_;
  CrossShape shape_;
  int segments_;
};

// The flat ring between two loops around the y axis, both counter-clockwise seen from above: a zip by angle.
void add_ring(MeshBuilder& mesh, const std::vector<Vec3>& outer, const std::vector<Vec3>& inner) {
  const auto angle = [](const Vec3& p) { return elementary::atan2(-p.z, p.x); };
  // Both loops are taken from their first corner past angle 0, with the angle after a full turn for the last.
  struct Corner {
    Vec3 position;
    double angle;
  };
  const auto sorted = [&](const std::vector<Vec3>& loop) {
    std::vector<Corner> corners;
    for (const Vec3& p : loop) corners.push_back({p, angle(p) < -1e-9 ? angle(p) + 2.0 * elementary::kPi : angle(p)});
    std::sort(corners.begin(), corners.end(), [](const Corner& a, const Corner& b) { return a.angle < b.angle; });
    corners.push_back({corners.front().position, corners.front().angle + 2.0 * elementary::kPi});
    return corners;
  };
  const std::vector<Corner> a = sorted(outer), b = sorted(inner);
  const Vec3 up(0.0, 1.0, 0.0);
  for (size_t i = 0, j = 0; i + 1 < a.size() || j + 1 < b.size();) {
    const bool step_outer = j + 1 == b.size() || (i + 1 < a.size() && a[i + 1].angle <= b[j + 1].angle);
    const Vec3 third = step_outer ? a[i + 1].position : b[j + 1].position;
    mesh.add_triangle({a[i].position, up}, {third, up}, {b[j].position, up});
    ++(step_outer ? i : j);
  }
}

}  // namespace

void add_cross(MeshBuilder& mesh, const CrossShape& shape, double disc_radius, const Columns& columns, int detail) {
  CrossMaker maker(mesh, shape, arm_segments(detail));
  maker.add();
  std::vector<Vec3> circle;
  for (int j = 0; j < columns.count(); ++j)
    circle.push_back(
        Vec3(disc_radius * columns.direction(j).x, shape.center_y - shape.reach, disc_radius * columns.direction(j).y));
  add_ring(mesh, circle, maker.foot_loop());
}

int64_t cross_triangles(int detail, int columns) {
  const int64_t n = arm_segments(detail);
  const int64_t faces = 2 * (4 * 2 * n + 2), flanks = 4 * 2 * 3 * 2 * n, ends = 3 * 3 * 2, ring = columns + 8;
  return faces + flanks + ends + ring;
}

}  // namespace tilelight
