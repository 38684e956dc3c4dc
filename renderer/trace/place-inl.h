// SPDX-License-Identifier: Apache-2.0
// All surfaces in the place where a ray starts, by the exact tests: what walk-inl.h is for the nearest hit. Included
// once for every instruction set.
#if defined(TILELIGHT_PLACE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_PLACE_INL_H
#undef TILELIGHT_PLACE_INL_H
#else
#define TILELIGHT_PLACE_INL_H
#endif

#include <vector>

#include "renderer/trace/walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

class PlaceSearch {
 public:
  // owner: the body on whose surface the ray starts. The ray has left nothing.
  PlaceSearch(const CompiledScene& scene, const Ray& ray, uint32_t owner, std::vector<Hit>& found)
      : scene_(scene), ray_(ray), owner_(scene.bodies[owner]), found_(found) {
    const double size = std::abs(ray.origin.x) + std::abs(ray.origin.y) + std::abs(ray.origin.z);
    noise_ = noise_at(size), reach_ = reach_at(size);
  }

  void run() {
    for (size_t i = scene_.finite_bodies; i < scene_.bodies.size(); ++i) ask_solid(static_cast<uint32_t>(i));
    visit_tree(scene_.tree, kNone,
               make_filter_ray({ray_.origin, ray_.direction}, strayed(ray_.origin), -reach_, reach_));
  }

 private:
  void visit_tree(const TriangleTree& tree, uint32_t mesh, const FilterRay& filter) {
    if (tree.nodes.empty()) return;
    const FilterShear shear(filter);
    StackEntry stack[kStackSize];
    int top = 1;
    stack[0] = {0, filter.t_min};
    while (top > 0) {
      const uint32_t node = stack[--top].node;
      if (!(node & WideBvh::kLeafBit)) {
        top = push_children(tree, node, filter, filter.t_max, stack, top);
        continue;
      }
      const uint32_t leaf = node & ~WideBvh::kLeafBit;
      if (leaf & TriangleTree::kBodyBit) {
        visit_body(leaf & ~TriangleTree::kBodyBit);
      } else {
        visit_block(tree.blocks[leaf], mesh, filter, shear);
      }
    }
  }

  void visit_body(uint32_t index) {
    const CompiledBody& body = scene_.bodies[index];
    if (body.kind == BodyKind::mesh) {
      visit_tree(*body.tree, index, make_filter_ray(to_local(body, ray_), 0.0, -reach_, reach_));
    } else {
      ask_solid(index);
    }
  }

  void visit_block(const TriangleBlock& block, uint32_t mesh, const FilterRay& filter, const FilterShear& shear) {
    uint32_t lanes = sift_triangles<false>(block, filter, shear, 0.0f, filter.t_max).maybe;
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(lanes);
      const uint32_t body = mesh == kNone ? block.body[lane] : mesh, prim = block.prim[lane];
      const CompiledMesh& of = *scene_.bodies[body].mesh;
      const auto& tri = of.triangles[prim];
      const LocalRay local = to_local(scene_.bodies[body], ray_);
      double shift = 0.0;
      const Vec3 moved = moved_origin(local, shift);
      TriangleHit hit;
      if (intersect_triangle(of.positions[tri[0]], of.positions[tri[1]], of.positions[tri[2]], moved,
                             Shear(local.direction), hit))
        offer(local, {shift + hit.t, body, prim, hit.b0, hit.b1});
    }
  }

  // Offers every root: none is told to lie ahead.
  void ask_solid(uint32_t index) {
    const CompiledBody& body = scene_.bodies[index];
    const LocalRay local = to_local(body, ray_);
    const auto is_ahead = [&](double t, uint32_t prim) {
      offer(local, {t, index, prim, 0.0, 0.0});
      return false;
    };
    double t = 0.0;
    uint32_t prim = 0;
    switch (body.kind) {
      case BodyKind::sphere:
        (void)intersect_sphere(local, false, is_ahead, t);
        break;
      case BodyKind::box:
        (void)intersect_box(
            body.half, local, kNone, is_ahead, [&] { return local_rounding(body, ray_); }, t, prim);
        break;
      case BodyKind::plane:
        (void)intersect_plane(local, false, is_ahead, t);
        break;
      case BodyKind::mesh:
        break;
    }
  }

  void offer(const LocalRay& local, const Hit& hit) {
    if (!(std::abs(hit.t) <= reach_)) return;
    const CompiledBody& body = scene_.bodies[hit.body];
    const double across = std::abs(hit.t) * steepness(body, local, ray_.direction, hit.prim, hit.t);
    if (across <= noise_ + face_rounding(body, owner_)) found_.push_back(hit);
  }

  const CompiledScene& scene_;
  const Ray& ray_;
  const CompiledBody& owner_;
  std::vector<Hit>& found_;
  double noise_, reach_;
};

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
