// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "renderer/base/facet.h"
#include "renderer/base/safe_length.h"
#include "renderer/compile/compiled_mesh.h"
#include "renderer/compile/cost_text.h"
#include "renderer/compile/normalise.h"
#include "renderer/compile/passes.h"

namespace tilelight {
namespace {

// Points whose convex hull holds the body, in the space that `to` leads to. Spheres are left to their callers.
template <class Visit>
void visit_hull(const CompiledBody& body, const Mat4& to, Visit visit) {
  const auto visit_box = [&](const Vec3& lo, const Vec3& hi) {
    for (int corner = 0; corner < 8; ++corner) {
      visit(transform_point(to, {corner & 1 ? hi.x : lo.x, corner & 2 ? hi.y : lo.y, corner & 4 ? hi.z : lo.z}));
    }
  };
  if (body.kind == BodyKind::box) {
    visit_box(-body.half, body.half);
  } else if (body.mesh->positions.empty()) {
    visit(transform_point(to, Vec3(0.0)));
  } else {
    for (const Box& octant : body.mesh->octants) {
      if (!octant.is_empty()) visit_box(octant.lo, octant.hi);
    }
  }
}

Box bounds_in(const CompiledBody& body, const Mat4& to) {
  Box box;
  if (body.kind == BodyKind::sphere) {
    // Half extent along an axis: the length of the matrix's row.
    Vec3 half;
    for (int axis = 0; axis < 3; ++axis) half[axis] = safe_length({to[0][axis], to[1][axis], to[2][axis]});
    box.grow(Vec3(to[3]) - half);
    box.grow(Vec3(to[3]) + half);
  } else {
    visit_hull(body, to, [&](const Vec3& p) { box.grow(p); });
  }
  return box;
}

double radius_about(const CompiledBody& body, const Mat4& to, const Vec3& center) {
  double radius = 0.0;
  if (body.kind == BodyKind::sphere) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column) largest = std::max(largest, safe_length(Vec3(to[column])));
    return safe_length(Vec3(to[3]) - center) + largest;
  }
  visit_hull(body, to, [&](const Vec3& p) { radius = std::max(radius, safe_length(p - center)); });
  return radius;
}

Mat3 cofactor(const Mat3& m) { return Mat3(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])); }

// The least thickness of a body in normalised units, so that three lengths in a product stay within a double. Nothing
// so thin can be seen.
constexpr double kLeastThickness = 0x1p-300;

// The unit is no smaller than lets the square of the farthest light's distance, and the distance of an eye 1e30 away,
// stay within a double.
double least_units(const std::vector<CompiledLight>& lights, const Vec3& center) {
  constexpr double kFarthest = 0x1p500, kLeast = 0x1p-900;
  double farthest = 0.0;
  for (const CompiledLight& light : lights) {
    if (light.kind == LightKind::point) farthest = std::max(farthest, safe_length(light.position - center));
  }
  return std::max(farthest / kFarthest, kLeast);
}

// The placement of a body in normalised units. The centre is subtracted before anything is added or scaled: exact where
// it can be, however far away the scene is.
Mat4 normalised(const Body& body, const CompiledMesh* mesh, const Vec3& center, double units) {
  Mat4 world = body.world_from_local;
  world[3] = Vec4(Vec3(world[3]) - center, 1.0);
  if (mesh) world = world * mesh->mesh_from_local;
  for (int column = 0; column < 4; ++column) {
    for (int axis = 0; axis < 3; ++axis) world[column][axis] /= units;
  }
  for (int column = 0; column < 3; ++column) {
    if (!(safe_length(Vec3(world[column])) < kLeastThickness)) continue;
    Vec3 way = unit_or_zero(Vec3(body.world_from_local[column]));
    if (way == Vec3(0.0)) way[column] = 1.0;  // lost in the user's own units
    world[column] = Vec4(kLeastThickness * way, 0.0);
  }
  return world;
}

// What more triangles would take: their indices and their places in a tree.
int64_t bytes_of_triangles(const CompiledMesh& mesh, int64_t count) {
  constexpr int64_t kTreeBytes = 61;  // a triangle, by bench_compile
  const int64_t indices = mesh.corner_normals.empty() ? 1 : 2;
  return count * (kTreeBytes + indices * static_cast<int64_t>(sizeof(mesh.triangles[0])));
}

void set_world(CompiledBody& body, const Mat4& world_from_local) {
  body.world_from_local = world_from_local;
  // Brought to about 1 by a power of two before products are formed, so that neither bodies that are tiny or huge
  // beside the scene nor planes in a scene of tiny units under- or overflow.
  double largest = 0.0;
  for (int i = 0; i < 9; ++i) largest = std::max(largest, std::abs(world_from_local[i / 3][i % 3]));
  int exponent = 0;
  std::frexp(largest, &exponent);
  const auto scaled_rows = [exponent](Mat4 m, int columns) {
    for (int i = 0; i < 3 * columns; ++i) m[i / 3][i % 3] = std::ldexp(m[i / 3][i % 3], -exponent);
    return m;
  };
  const Mat4 about_one = scaled_rows(world_from_local, 4);
  body.local_from_world = scaled_rows(glm::inverse(about_one), 3);
  const Mat3 linear(about_one);
  const Mat3 unit = linear / std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
  body.world_from_normal = glm::determinant(unit) < 0.0 ? -cofactor(unit) : cofactor(unit);
}

using MeshMap = std::map<const TriMesh*, std::shared_ptr<const CompiledMesh>>;

MeshMap compile_meshes(const std::vector<Body>& bodies, CompiledScene& out) {
  MeshMap compiled;
  for (const Body& body : bodies) {
    if (!body.mesh || compiled.contains(body.mesh.get())) continue;
    const auto& mesh = compiled[body.mesh.get()] = compile_mesh(*body.mesh);
    out.meshes.push_back(mesh);
    out.plan.triangles_stored += static_cast<int64_t>(mesh->triangles.size());
    out.plan.memory_bytes += mesh->memory_bytes();
    if (body.mesh->degenerate_dropped == 0) continue;
    out.plan.left_out.push_back(
        {std::to_string(body.mesh->degenerate_dropped) + " triangles of " + body.name, "they have no area",
         bytes_text(bytes_of_triangles(*mesh, static_cast<int64_t>(body.mesh->degenerate_dropped)))});
  }
  return compiled;
}

// What does not depend on where the others are.
CompiledBody as_listed(const Body& body, uint32_t id, const MeshMap& meshes) {
  CompiledBody c;
  c.kind = body.kind;
  c.has_solid_pattern = body.kind == BodyKind::sphere;
  c.has_inside = body.has_inside;
  c.may_touch_itself = body.may_touch_itself;
  c.layer = body.layer;
  c.rank = body.rank;
  c.material = body.material;
  c.body = id;
  c.half = body.half;
  c.name = body.name;
  c.pattern_from_local = body.pattern_from_local;
  if (!body.mesh) return c;
  c.mesh = meshes.at(body.mesh.get()).get();
  c.pattern_from_local = c.pattern_from_local * c.mesh->mesh_from_local;
  return c;
}

// The numbers of a document are rounded to doubles: the face of a box by half of this times its size, and what is added
// up of several (a position and where it is moved to) as often as it is added to.
constexpr double kPlaceRounding = 0x1p-52;

double largest(const Vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Chooses centre and units, and sets all bodies in place.
void set_in_place(const std::vector<Body>& bodies, const std::vector<Mat4>& user_from_local, const Box& bounds,
                  CompiledScene& out) {
  const Normalisation n = normalise(bounds);
  out.center = n.center;
  out.units = n.units;
  for (const double least = least_units(out.lights, n.center); out.units < least;) out.units *= 2.0;
  out.bounding_center = 0.5 * bounds.lo + 0.5 * bounds.hi;
  out.bounding_radius = out.finite_bodies == 0 ? 1.0 : 0.0;
  for (size_t i = 0; i < out.bodies.size(); ++i) {
    CompiledBody& body = out.bodies[i];
    if (i < out.finite_bodies) {
      out.bounding_radius = std::max(out.bounding_radius, radius_about(body, user_from_local[i], out.bounding_center));
    }
    const Body& source = bodies[body.body];
    set_world(body, normalised(source, body.mesh, out.center, out.units));
    for (int column = 0; column < 3; ++column)
      body.rounding += glm::abs(Vec3(body.local_from_world[column])) * (source.rounding[column] / out.units);
    body.face_rounding /= out.units;
  }
}

}  // namespace

Box body_bounds(const CompiledBody& body) { return bounds_in(body, body.world_from_local); }

Stiffness find_stiffness(const CompiledScene& scene) {
  Stiffness out;
  const Vec3 &low = scene.plan.bounds_min, &high = scene.plan.bounds_max;
  out.extent = safe_length(high - low);
  if (out.extent > 0.0) out.offset_ratio = safe_length(0.5 * low + 0.5 * high) / out.extent;
  // Bodies of no size, as a mesh without triangles, have no ratio.
  double largest = 0.0, smallest = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < scene.finite_bodies; ++i) {
    const Box box = body_bounds(scene.bodies[i]);
    const double size = safe_length(box.hi - box.lo);
    if (!(size > 0.0)) continue;
    largest = std::max(largest, size), smallest = std::min(smallest, size);
  }
  if (largest > 0.0) out.size_ratio = largest / smallest;
  for (const CompiledMaterial& m : scene.materials) out.shininess = std::max(out.shininess, m.source.shininess);
  double brightest = 0.0, dimmest = std::numeric_limits<double>::infinity();
  for (const CompiledLight& light : scene.lights) {
    const double intensity = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    brightest = std::max(brightest, intensity), dimmest = std::min(dimmest, intensity);
  }
  if (brightest > 0.0 && dimmest > 0.0) out.intensity_ratio = brightest / dimmest;
  return out;
}

void rebase_and_normalise(const std::vector<Body>& bodies, CompiledScene& out) {
  const MeshMap meshes = compile_meshes(bodies, out);
  // User's space first: the bounds say where the centre is and how large a unit is.
  std::vector<Mat4> user_from_local;
  Box bounds;
  for (const bool finite : {true, false}) {
    for (size_t i = 0; i < bodies.size(); ++i) {
      if ((bodies[i].kind != BodyKind::plane) != finite) continue;
      CompiledBody c = as_listed(bodies[i], static_cast<uint32_t>(i), meshes);
      Mat4 to = bodies[i].world_from_local;
      if (c.mesh) {
        to = to * c.mesh->mesh_from_local;
        out.plan.triangles_instanced += static_cast<int64_t>(c.mesh->triangles.size());
      }
      if (finite) {
        const Box box = bounds_in(c, to);
        c.face_rounding = largest(bodies[i].rounding) + kPlaceRounding * std::max(largest(box.lo), largest(box.hi));
        bounds.grow(box);
      } else {
        c.face_rounding = kPlaceRounding * glm::dot(glm::abs(unit_or_zero(Vec3(to[1]))), glm::abs(Vec3(to[3])));
      }
      user_from_local.push_back(to);
      out.bodies.push_back(std::move(c));
    }
    if (finite) out.finite_bodies = out.bodies.size();
  }
  if (bounds.is_empty()) {  // planes alone: look at the first one's point
    bounds.grow(Vec3(user_from_local[0][3]) - Vec3(1.0));
    bounds.grow(Vec3(user_from_local[0][3]) + Vec3(1.0));
  }
  set_in_place(bodies, user_from_local, bounds, out);
  out.plan.bodies = static_cast<int64_t>(out.bodies.size());
  out.plan.bounds_min = bounds.lo;
  out.plan.bounds_max = bounds.hi;
}

void build_trees(TilePool& pool, CompiledScene& out) {
  const std::vector<bool> merged = find_merged(out);
  std::map<const CompiledMesh*, const TriangleTree*> own;
  for (size_t i = 0; i < out.bodies.size(); ++i) {
    CompiledBody& body = out.bodies[i];
    if (body.kind != BodyKind::mesh || merged[i]) continue;
    const TriangleTree*& tree = own[body.mesh];
    if (!tree) {
      out.mesh_trees.push_back(std::make_shared<const TriangleTree>(build_mesh_tree(*body.mesh, pool)));
      tree = out.mesh_trees.back().get();
      out.plan.memory_bytes += tree->memory_bytes();
    }
    body.tree = tree;
  }
  out.tree = build_scene_tree(out, pool);
  out.plan.memory_bytes += out.tree.memory_bytes();
}

}  // namespace tilelight
