// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/transform.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/scene/grammar.h"
#include "renderer/scene/readers.h"

namespace tilelight {
namespace {

// The greatest magnitude among the entries of a transform: products of the language's greatest numbers.
constexpr double kMaxEntry = kMaxMagnitude * kMaxMagnitude * 8.0;

// Unit length, also from vectors whose squares leave the range of a double. REQUIRES: v is not zero.
template <class Vector>
Vector unit(Vector v) {
  double largest = 0.0;
  for (int i = 0; i < Vector::length(); ++i) largest = std::max(largest, std::fabs(v[i]));
  v /= largest;
  return v / std::sqrt(glm::dot(v, v));
}

Mat3 read_scale(Value object) {
  const Value scale = find_accepted(object, "scale");
  const Vec3 factors =
      scale && scale.is(JsonKind::number) ? Vec3(scale.number()) : read_vector(object, "scale", Vec3(1.0));
  Mat3 matrix(0.0);
  for (int i = 0; i < 3; ++i) matrix[i][i] = factors[i];
  return matrix;
}

Mat3 rotation_from_quaternion(const Vec4& xyzw) {
  const Vec4 q = unit(xyzw);
  return glm::mat3_cast(glm::dquat(q.w, q.x, q.y, q.z));
}

Mat3 read_rotation(Value object) {
  if (const Value quaternion = find_accepted(object, "rotate_quat")) {
    const auto q = quaternion.numbers();
    return rotation_from_quaternion({q[0], q[1], q[2], q[3]});
  }
  const Value rotation = find_accepted(object, "rotate_deg");
  if (!rotation) return Mat3(1.0);
  return rotation_about(read_vector(rotation, "axis", {0.0, 1.0, 0.0}), read_number(rotation, "angle", 0.0));
}

Mat4 affine(const Mat3& linear, const Vec3& translation) {
  Mat4 matrix(linear);
  matrix[3] = Vec4(translation, 1.0);
  return matrix;
}

Mat4 read_matrix(Value value, Problems& problems) {
  Mat4 matrix(1.0);
  const auto numbers = value.numbers();
  for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[static_cast<size_t>(i)];
  const Vec4 last_row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
  if (last_row != Vec4(0.0, 0.0, 0.0, 1.0)) {
    problems.add(value, {"not_affine",
                         "found " + number_text(last_row[0]) + ", " + number_text(last_row[1]) + ", " +
                             number_text(last_row[2]) + ", " + number_text(last_row[3]) +
                             " at places 3, 7, 11 and 15; allowed: 0, 0, 0, 1",
                         {},
                         "matrices are column-major: a translation stands at places 12, 13, 14"});
  } else if (is_singular(Mat3(matrix))) {
    problems.add(value, {"singular",
                         "found a matrix of determinant 0, which flattens the object; allowed: any other",
                         {},
                         "a box may be flat by itself: give it min = max along one axis"});
  }
  return matrix;
}

bool is_moderate(const Mat4& matrix) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!(std::fabs(matrix[column][row]) <= kMaxEntry)) return false;
    }
  }
  return true;
}

}  // namespace

Mat3 rotation_about(const Vec3& axis, double angle_deg) {
  const double turn = std::fmod(angle_deg, 360.0);  // exact
  const double quarters = turn / 90.0;
  double sine, cosine;
  if (quarters == std::floor(quarters)) {
    constexpr double kSines[] = {0.0, 1.0, 0.0, -1.0};
    const int quarter = (static_cast<int>(quarters) + 4) % 4;
    sine = kSines[quarter];
    cosine = kSines[(quarter + 1) % 4];
  } else {
    sine = elementary::sin(elementary::rad_from_deg(turn));
    cosine = elementary::cos(elementary::rad_from_deg(turn));
  }
  // Rodrigues: R v = v cos + (a x v) sin + a (a.v) (1 - cos).
  const Vec3 a = unit(axis);
  Mat3 rotation(0.0);
  for (int column = 0; column < 3; ++column) {
    Vec3 v(0.0);
    v[column] = 1.0;
    rotation[column] = v * cosine + glm::cross(a, v) * sine + a * (a[column] * (1.0 - cosine));
  }
  return rotation;
}

bool is_singular(const Mat3& linear) {
  Mat3 m = linear;
  for (int row = 0; row < 3; ++row) {
    const double largest = std::max({std::fabs(m[0][row]), std::fabs(m[1][row]), std::fabs(m[2][row])});
    if (largest == 0.0) return true;
    for (int column = 0; column < 3; ++column) m[column][row] /= largest;
  }
  for (int column = 0; column < 3; ++column) {
    const double largest = std::max({std::fabs(m[column][0]), std::fabs(m[column][1]), std::fabs(m[column][2])});
    if (largest == 0.0) return true;
    m[column] /= largest;
  }
  constexpr double kRounding = 1e-15;  // of a determinant of entries up to 1, a few ulp
  return std::fabs(glm::determinant(m)) <= kRounding;
}

void read_transform(Value value, const Vec3& center, Object& object, Problems& problems) {
  if (const Value matrix = find_accepted(value, "matrix")) {
    object.world_from_shape = read_matrix(matrix, problems);
    return;
  }
  const Vec3 translation = read_vector(value, "translate", Vec3(0.0));
  // Without a scale or rotation the center must not round the translation.
  if (!value.find("scale") && !value.find("rotate_deg") && !value.find("rotate_quat")) {
    object.world_from_shape = affine(Mat3(1.0), translation);
    return;
  }
  const Mat3 linear = read_rotation(value) * read_scale(value);
  object.world_from_shape = affine(linear, center + translation);
  object.pivot = center;
  if (is_moderate(object.world_from_shape) && !is_singular(linear)) return;
  const Value scale = value.find("scale");
  problems.add(scale ? scale : value,
               {"out_of_range",
                "found a transform whose numbers leave the range of doubles; allowed: entries that "
                "are neither all lost to rounding nor beyond " +
                    number_text(kMaxEntry),
                {},
                ""});
}

}  // namespace tilelight
