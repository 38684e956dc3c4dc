// SPDX-License-Identifier: Apache-2.0
// Names for GLM's types as the project uses them. Set-up code works in double; colours are linear RGB.
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace tilelight {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Mat3 = glm::dmat3;
using Mat4 = glm::dmat4;
using Color = glm::dvec3;  // linear RGB

inline Vec3 transform_point(const Mat4& m, const Vec3& p) { return Vec3(m * Vec4(p, 1.0)); }
inline Vec3 transform_vector(const Mat4& m, const Vec3& v) { return Mat3(m) * v; }

}  // namespace tilelight
