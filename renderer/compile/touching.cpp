// SPDX-License-Identifier: Apache-2.0
// Which media may have a surface in one place with another's: only there does a ray ask what else lies where it is.
#include <cmath>
#include <vector>

#include "renderer/compile/passes.h"

namespace tilelight {
namespace {

// Wider than the boxes of the tree are, so that their rounding to float does not count.
constexpr double kMargin = 2.0 * WideBvh::kWiden;

bool overlap(const Box& a, const Box& b) {
  return glm::all(glm::lessThanEqual(a.lo, b.hi + kMargin)) && glm::all(glm::greaterThanEqual(a.hi, b.lo - kMargin));
}

// The radius of a body that is round; negative: it is none.
double radius_of(const CompiledBody& body) {
  if (body.kind != BodyKind::sphere) return -1.0;
  const double radius = glm::length(Vec3(body.world_from_local[0]));
  for (int column = 0; column < 3; ++column) {
    const Vec3 axis = Vec3(body.world_from_local[column]), next = Vec3(body.world_from_local[(column + 1) % 3]);
    if (std::abs(glm::length(axis) - radius) > kMargin || std::abs(glm::dot(axis, next)) > kMargin) return -1.0;
  }
  return radius;
}

// Balls that cross each other share a line alone, which no ray meets.
bool may_touch(const CompiledBody& a, const CompiledBody& b) {
  const double r = radius_of(a), s = radius_of(b);
  if (r < 0.0 || s < 0.0) return true;
  const double apart = glm::length(Vec3(a.world_from_local[3]) - Vec3(b.world_from_local[3]));
  return std::abs(apart - (r + s)) <= kMargin || std::abs(apart - std::abs(r - s)) <= kMargin;
}

class NeighbourSearch {
 public:
  explicit NeighbourSearch(const CompiledScene& scene) : scene_(scene) {}

  // Whether another medium, or its triangle, lies in the box of this one.
  bool has_neighbour(uint32_t index) {
    const TriangleTree& tree = scene_.tree;
    const Box box = body_bounds(scene_.bodies[index]);
    stack_.assign(tree.nodes.empty() ? 0 : 1, 0u);
    while (!stack_.empty()) {
      const uint32_t reference = stack_.back();
      stack_.pop_back();
      if (reference & WideBvh::kLeafBit) {
        if (is_neighbour(index, box, reference & ~WideBvh::kLeafBit)) return true;
      } else {
        push_children(tree.nodes[reference], box);
      }
    }
    return false;
  }

 private:
  void push_children(const WideBvh::Node& node, const Box& box) {
    for (int c = 0; c < WideBvh::kWidth; ++c) {
      if (node.child[c] == WideBvh::kEmpty) continue;
      Box of_child;
      of_child.lo = {node.bounds[0][0][c], node.bounds[0][1][c], node.bounds[0][2][c]};
      of_child.hi = {node.bounds[1][0][c], node.bounds[1][1][c], node.bounds[1][2][c]};
      if (overlap(of_child, box)) stack_.push_back(node.child[c]);
    }
  }

  bool is_neighbour(uint32_t index, const Box& box, uint32_t leaf) const {
    const auto is_other_medium = [&](uint32_t body) { return body != index && is_medium(scene_, body); };
    if (leaf & TriangleTree::kBodyBit) {
      const uint32_t body = leaf & ~TriangleTree::kBodyBit;
      return is_other_medium(body) && overlap(body_bounds(scene_.bodies[body]), box) &&
             may_touch(scene_.bodies[index], scene_.bodies[body]);
    }
    const TriangleBlock& block = scene_.tree.blocks[leaf];
    for (int lane = 0; lane < 8; ++lane) {
      if (block.body[lane] == TriangleBlock::kNobody || !is_other_medium(block.body[lane])) continue;
      Box of_triangle;
      for (const auto& vertex : block.vertex) of_triangle.grow({vertex[0][lane], vertex[1][lane], vertex[2][lane]});
      if (overlap(of_triangle, box)) return true;
    }
    return false;
  }

  const CompiledScene& scene_;
  std::vector<uint32_t> stack_;  // of node references
};

}  // namespace

void find_touching_media(CompiledScene& scene) {
  NeighbourSearch search(scene);
  for (uint32_t i = 0; i < scene.finite_bodies; ++i) {
    if (!is_medium(scene, i)) continue;
    CompiledBody& body = scene.bodies[i];
    body.may_touch_media = body.may_touch_itself || (scene.media > 1 && search.has_neighbour(i));
  }
}

}  // namespace tilelight
