// SPDX-License-Identifier: Apache-2.0
// Hits made ready for the light equation, as surface.h has it, for a number R: one hit, or several side by side that
// are on one body. The only implementation. Included once for every instruction set.
#if defined(TILELIGHT_SURFACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_SURFACE_INL_H
#undef TILELIGHT_SURFACE_INL_H
#else
#define TILELIGHT_SURFACE_INL_H
#endif

#include "renderer/base/safe_length.h"
#include "renderer/compile/built_in.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"
#include "renderer/shade/reals-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// As LocalPoint.
template <class R>
struct LocalPointOf {
  Of3<R> position, geometric, shading;
  MaskOf<R> is_smooth;
};

template <class R>
struct SurfaceOf {
  Of3<R> position, geometric_normal, normal;
  MaskOf<R> from_outside;
  Of3<R> ambient, diffuse;
};

// What of a material the lights' reflections take.
template <class R>
struct GlossOf {
  Of3<R> specular;
  R shininess;
  MaskOf<R> is_specular;
};

// Corners and, of smooth meshes alone, their normals.
template <class R>
struct TriangleOf {
  Of3<R> corner[3], normal[3];
};

HWY_INLINE bool is_smooth(const CompiledMesh& mesh) {
  return is_built_in(Feature::smooth_normals) && !mesh.corner_normals.empty();
}

template <class R>
HWY_INLINE Of3<R> unit_vector(const Of3<R>& v) {
  const R square = dot(v, v);
  const auto is_ordinary = (square > R(1e-200)) & (square < R(1e200));
  Of3<R> unit = normalized(v);
  if (any(!is_ordinary))
    each_lane(
        !is_ordinary, unit, [](const Vec3& of) { return safe_normalize(of); }, v);
  return unit;
}

template <class R>
HWY_INLINE Of3<R> normal_of(const Of3<R>& a, const Of3<R>& b) {
  Of3<R> n = cross(a, b);
  const auto is_ordinary = dot(n, n) > R(1e-200);
  if (any(!is_ordinary))
    each_lane(
        !is_ordinary, n, [](const Vec3& u, const Vec3& v) { return glm::cross(scale_to_one(u).v, scale_to_one(v).v); },
        a, b);
  return n;
}

template <class R>
HWY_INLINE LocalPointOf<R> point_of_triangle(const TriangleOf<R>& triangle, bool has_normals, R b0, R b1) {
  const Of3<R>&a = triangle.corner[0], &b = triangle.corner[1], &c = triangle.corner[2];
  const R b2 = R(1.0) - b0 - b1;
  LocalPointOf<R> out;
  out.position = b0 * a + b1 * b + b2 * c;
  out.geometric = normal_of(b - a, c - a);
  out.shading = out.geometric;
  out.is_smooth = R(0.0) > R(0.0);
  if (has_normals) {
    out.shading = b0 * triangle.normal[0] + b1 * triangle.normal[1] + b2 * triangle.normal[2];
    const Of3<R>& n = out.shading;
    out.is_smooth = !((n.x == R(0.0)) & (n.y == R(0.0)) & (n.z == R(0.0)));  // opposite normals cancel
  }
  return out;
}

// Of what is no mesh: the hit in the body's space, reprojected, so that its error is that of the primitive and not of
// the ray's length.
template <class R>
HWY_INLINE LocalPointOf<R> point_of_solid(const CompiledBody& body, const Of3<R>& origin, const Of3<R>& direction, R t,
                                          R prim) {
  LocalPointOf<R> out;
  const Of3<R> zero = of<R>(Vec3(0.0));
  out.position =
      transform_point(body.local_from_world, origin) + t * transform_vector(Mat3(body.local_from_world), direction);
  out.geometric = out.shading = zero;
  out.is_smooth = R(0.0) > R(0.0);
  if (is_built_in(Feature::spheres) && body.kind == BodyKind::sphere)
    out.geometric = out.position = normalized(out.position);
  if (is_built_in(Feature::planes) && body.kind == BodyKind::plane) out.position.y = R(0.0), out.geometric.y = R(1.0);
  if (is_built_in(Feature::boxes) && body.kind == BodyKind::box) {
    const auto put = [&](double axis, double half, R& place, R& normal) HWY_ATTR {
      const auto is_lower = prim == R(2.0 * axis), is_upper = prim == R(2.0 * axis + 1.0);
      normal = select(is_upper, R(1.0), select(is_lower, R(-1.0), R(0.0)));
      place = select(is_upper | is_lower, normal * R(half), place);
    };
    put(0.0, body.half.x, out.position.x, out.geometric.x);
    put(1.0, body.half.y, out.position.y, out.geometric.y);
    put(2.0, body.half.z, out.position.z, out.geometric.z);
  }
  return out;
}

// Cells of a checker: on curved spheres in three dimensions, else on the two axes other than the dominant one of the
// geometric normal, all in the pattern frame.
template <class R>
HWY_INLINE Of3<R> checker_color(const Checker& checker, const CompiledBody& body, const LocalPointOf<R>& p) {
  const Of3<R> place = transform_point(body.pattern_from_local, p.position);
  const R size(checker.size), one(1.0), none(0.0);
  Of3<R> counts = {one, one, one};
  if (!body.has_solid_pattern) {
    // The pattern frame differs from the local one by a uniform scale and a shift, so normals keep their direction.
    // Of axes that rounding cannot tell apart (facets at 45 degrees) the first counts.
    const R x = magnitude(p.geometric.x), y = magnitude(p.geometric.y), z = magnitude(p.geometric.z);
    const R nearly = R(1.0 - 0x1p-20) * greater(greater(x, y), z);
    const auto is_x = x >= nearly;
    const auto is_y = (!is_x) & (y >= nearly);
    counts = {select(is_x, none, one), select(is_y, none, one), select(is_x | is_y, one, none)};
  }
  const R cells =
      counts.x * floored(place.x / size) + counts.y * floored(place.y / size) + counts.z * floored(place.z / size);
  const auto is_even = cells - R(2.0) * floored(R(0.5) * cells) == R(0.0);
  return select(is_even, of<R>(checker.a), of<R>(checker.b));
}

template <class R>
HWY_INLINE Of3<R> paint_color(const Paint& paint, const CompiledBody& body, const LocalPointOf<R>& p) {
  const auto* color = std::get_if<Color>(&paint);
  if (!is_built_in(Feature::checker) || color) return of<R>(*color);
  return checker_color(std::get<Checker>(paint), body, p);
}

template <class R>
HWY_INLINE void turn(SurfaceOf<R>& surface, const Of3<R>& looking) {
  const auto is_seen = dot(surface.geometric_normal, looking) < R(0.0);
  surface.geometric_normal = select(is_seen, surface.geometric_normal, -surface.geometric_normal);
  surface.from_outside = select(is_seen, surface.from_outside, !surface.from_outside);
  const auto is_against = dot(surface.normal, surface.geometric_normal) < R(0.0);
  surface.normal = select(is_against, -surface.normal, surface.normal);
}

// A place on the body, seen along a direction.
template <class R>
HWY_INLINE SurfaceOf<R> surface_at(const CompiledScene& scene, const CompiledBody& body, const LocalPointOf<R>& local,
                                   const Of3<R>& direction) {
  const Material& material = scene.materials[body.material].source;
  SurfaceOf<R> out;
  out.position = transform_point(body.world_from_local, local.position);
  out.geometric_normal = unit_vector(transform_vector(body.world_from_normal, local.geometric));
  out.normal = out.geometric_normal;
  if (any(local.is_smooth)) {
    const Of3<R> shading = select(local.is_smooth, local.shading, local.geometric);
    out.normal =
        select(local.is_smooth, unit_vector(transform_vector(body.world_from_normal, shading)), out.geometric_normal);
  }
  out.from_outside = R(0.0) < R(1.0);
  turn(out, direction);
  out.ambient = paint_color(material.ambient, body, local);
  out.diffuse = paint_color(material.diffuse, body, local);
  return out;
}

template <class R>
HWY_INLINE Of3<R> reflected(const Of3<R>& d, const Of3<R>& n) {
  return normalized(d - (R(2.0) * dot(d, n)) * n);
}
// About the shading normal; about the geometric one where that would lead under the surface.
template <class R>
HWY_INLINE Of3<R> mirror_direction_at(const Of3<R>& normal, const Of3<R>& geometric_normal, const Of3<R>& incoming) {
  const Of3<R> mirrored = reflected(incoming, normal);
  const auto is_above = dot(mirrored, geometric_normal) > R(0.0);
  if (!any(!is_above)) return mirrored;
  return select(is_above, mirrored, reflected(incoming, geometric_normal));
}

// The place above a point of a rounded surface, a triangle of a smooth mesh, on the curved surface that the facet
// stands for. It is taken from the tangent planes at the corners (Hanika 2021, Hacking the Shadow Terminator, Ray
// Tracing Gems II ch. 4): of a sphere one sagitta outside of it, so that no tangent from there meets the facets. Never
// under the facet.
template <class R>
HWY_INLINE Of3<R> place_on_curve(const CompiledBody& body, const TriangleOf<R>& triangle, R b0, R b1,
                                 const Of3<R>& position, MaskOf<R> from_outside) {
  const R weight[3] = {b0, b1, R(1.0) - b0 - b1};
  const Of3<R>(&corner)[3] = triangle.corner;
  const Of3<R> facet = weight[0] * corner[0] + weight[1] * corner[1] + weight[2] * corner[2];
  Of3<R> up = normal_of(corner[1] - corner[0], corner[2] - corner[0]);
  up = select(from_outside, up, -up);
  Of3<R> lift = of<R>(Vec3(0.0));
  for (int i = 0; i < 3; ++i) {
    Of3<R> n = triangle.normal[i];
    n = select(dot(n, up) < R(0.0), -n, n);     // given against the winding, or seen from inside
    const R under = dot(corner[i] - facet, n);  // the tangent plane at the corner
    const R height = select(under > R(0.0), under, R(0.0));
    lift = lift + (weight[i] * height) * n;
  }
  return position + transform_vector(Mat3(body.world_from_local), lift);
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
