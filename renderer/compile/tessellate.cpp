// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/tessellate.h"

#include <algorithm>
#include <map>

#include "renderer/base/safe_length.h"
#include "renderer/compile/compiled_mesh.h"
#include "renderer/geometry/sphere_mesh.h"

namespace tilelight {
namespace {

// Each about 1.4 times the one before: a moved camera seldom changes the detail, and many spheres share a mesh.
constexpr int kDetails[] = {2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, kMaxSphereDetail};

bool is_sphere(const CompiledBody& body) { return body.kind == BodyKind::sphere; }

}  // namespace

int sphere_detail(const CompiledBody& sphere, const Eye& eye, double chord_error_px) {
  double radius = 0.0;  // the longest half axis
  for (int column = 0; column < 3; ++column)
    radius = std::max(radius, safe_length(Vec3(sphere.world_from_local[column])));
  double px = safe_length(eye.step_x);  // edge of a pixel at the sphere's nearest point
  if (eye.projection == Projection::perspective) {
    const double depth = eye.lead + glm::dot(Vec3(sphere.world_from_local[3]) - eye.start, eye.forward);
    px *= std::max(depth - radius, radius / 16.0);
  }
  for (const int detail : kDetails) {
    if (radius * sphere_mesh_error(detail) <= chord_error_px * px) return detail;
  }
  return kMaxSphereDetail;
}

SphereCut sphere_cut(const CompiledScene& scene, const Eye& eye, double chord_error_px) {
  SphereCut cut{chord_error_px, 0};
  for (;;) {
    int64_t spheres = 0;
    cut.triangles = 0;
    for (const CompiledBody& body : scene.bodies) {
      if (!is_sphere(body)) continue;
      const int64_t detail = sphere_detail(body, eye, cut.chord_error_px);
      cut.triangles += 8 * detail * detail;
      ++spheres;
    }
    const bool is_coarsest = cut.triangles == spheres * 8 * kDetails[0] * kDetails[0];
    if (cut.triangles <= kMostSphereTriangles || is_coarsest) return cut;
    cut.chord_error_px *= 2.0;
  }
}

std::shared_ptr<const CompiledScene> drawn_scene(const std::shared_ptr<const CompiledScene>& scene,
                                                 const ViewPlan& plan, TilePool& pool) {
  if (!is_tessellated(plan.view.render)) return scene;
  if (std::none_of(scene->bodies.begin(), scene->bodies.end(), is_sphere)) return scene;
  const double chord_error_px = sphere_cut(*scene, plan.eye, plan.view.render.chord_error_px).chord_error_px;
  auto out = std::make_shared<CompiledScene>(*scene);
  struct Made {
    const CompiledMesh* mesh = nullptr;
    const TriangleTree* tree = nullptr;
  };
  std::map<int, Made> made;
  for (CompiledBody& body : out->bodies) {
    if (!is_sphere(body)) continue;
    const int detail = sphere_detail(body, plan.eye, chord_error_px);
    Made& one = made[detail];
    if (!one.mesh) {
      out->meshes.push_back(compile_mesh(make_sphere_mesh(detail)));
      one.mesh = out->meshes.back().get();
      out->mesh_trees.push_back(std::make_shared<const TriangleTree>(build_mesh_tree(*one.mesh, pool)));
      one.tree = out->mesh_trees.back().get();
      out->plan.triangles_stored += static_cast<int64_t>(one.mesh->triangles.size());
      out->plan.memory_bytes += one.mesh->memory_bytes() + one.tree->memory_bytes();
    }
    // A mesh with a tree of its own takes the sphere's place in the scene's tree: it lies inside the same box.
    body.kind = BodyKind::mesh;
    body.mesh = one.mesh;
    body.tree = one.tree;
    out->plan.triangles_instanced += static_cast<int64_t>(one.mesh->triangles.size());
  }
  return out;
}

}  // namespace tilelight
