// SPDX-License-Identifier: Apache-2.0
// Rays that go nearly the same way, walked through the scene's tree together. All that is decided here is
// decided in float with a margin above its rounding: a triangle that a ray meets beyond doubt, at a distance that no
// other's can be confused with. What cannot be said so is decided in double at once (a hair beside an edge), or the ray
// is left to the walk of single rays (two surfaces in one place, walk-inl.h). So the answers are those of that walk to
// the last bit, whatever the packet. Included once for every instruction set.
#if defined(TILELIGHT_PACKET_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_PACKET_INL_H
#undef TILELIGHT_PACKET_INL_H
#else
#define TILELIGHT_PACKET_INL_H
#endif

#include <algorithm>
#include <memory>
#include <span>

#include "renderer/trace/lone-inl.h"
#include "renderer/trace/sure_triangles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// Triangles: how triangles are met; another one in tests/bench shows what the care for numbers costs.
template <bool kAnyHit, class Triangles = SureTriangles<kAnyHit>>
class PacketWalk {
 public:
  explicit PacketWalk(const CompiledScene& scene)
      : scene_(scene),
        few_lanes_(few_lanes(scene.tree)),
        stack_size_(kRoots + (WideBvh::kWidth - 1) * (static_cast<size_t>(scene.tree.depth) + 2)),
        stacks_(new LoneEntry[stack_size_ * kPacketRays]) {}

  // REQUIRES: 1 to kPacketRays rays; they stay where they are until the last answer.
  void take(std::span<const BoundedRay> rays) {
    input_ = rays;
    inside_[0].body = inside_[1].body = kNone;
    lone_set_ = 0;
    read_rays(rays, given_);
    // What is met near the ray's end may lie before or behind it: as if another hit were there.
    make_lanes(given_, rays_, lane_.t_sure, lane_.low, lane_.high);
    const LaneTag tag;
    const LaneIntTag int_tag;
    for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
      hn::Store(hn::Set(tag, INFINITY), tag, lane_.doubt + i);
      hn::Store(hn::Set(int_tag, kNone), int_tag, lane_.body + i);
    }
  }

  // Whether the filter's margins hold for these rays.
  bool is_sound() const { return rays_.is_near; }

  // The lanes that are still undecided. REQUIRES: is_sound().
  LaneBits run() {
    const LaneBits all = first_lanes(input_.size());
    for (size_t i = scene_.finite_bodies; i < scene_.bodies.size(); ++i) visit_solid(static_cast<uint32_t>(i), all);
    if (!scene_.tree.nodes.empty()) {
      constexpr size_t kHalf = kPacketRays / 2;
      const LaneBits rest = input_.size() > kHalf ? walk_range<kPacketRays>(0) : walk_range<kHalf>(0);
      leave_apart(rest, 0, -INFINITY);
      if (apart_ != 0) walk_apart();
    }
    return end_walk();
  }
  // The answers of all lanes, of which the undecided are still to be asked for.
  HWY_INLINE void answer(std::span<Hit> hits) const {
    static_assert(sizeof(Hit) == 32 && offsetof(Hit, body) == 8 && offsetof(Hit, prim) == 12 &&
                  offsetof(Hit, b0) == 16);
    if (hits.size() == kPacketRays) {
      const DoubleTag tag;
      const hn::RebindToUnsigned<DoubleTag> bits_tag;
      const hn::Rebind<uint32_t, DoubleTag> int_tag;
      for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
        const auto body = hn::PromoteTo(bits_tag, hn::Load(int_tag, lane_.body + i)),
                   prim = hn::PromoteTo(bits_tag, hn::Load(int_tag, lane_.prim + i));
        const auto is_hit = hn::RebindMask(tag, hn::Ne(body, hn::Set(bits_tag, kNone)));
        const auto number = [&](const double* of)
                                HWY_ATTR { return hn::IfThenElseZero(is_hit, hn::Load(tag, of + i)); };
        const auto ids =
            hn::Or(hn::BitCast(tag, body), hn::IfThenElseZero(is_hit, hn::BitCast(tag, hn::ShiftLeft<32>(prim))));
        hn::StoreInterleaved4(hn::IfThenElse(is_hit, hn::Load(tag, t_ + i), hn::Load(tag, given_.t_max + i)), ids,
                              number(b0_), number(b1_), tag, reinterpret_cast<double*>(&hits[i]));
      }
      return;
    }
    for (size_t i = 0; i < hits.size(); ++i) {
      if (lane_.body[i] == kNone) {
        hits[i] = {given_.t_max[i], kNone, 0, 0.0, 0.0};
      } else {
        hits[i] = {t_[i], lane_.body[i], lane_.prim[i], b0_[i], b1_[i]};
      }
    }
  }
  HWY_INLINE void answer(std::span<uint8_t> is_blocked) const {
    const LaneBits open = lanes_equal(lane_.body, kNone);
    for (size_t i = 0; i < is_blocked.size(); ++i) is_blocked[i] = !(open & bit_of(i));
  }

 private:
  // So many walk apart. Where most of the tree lies beyond the caches, what a packet visits for a few of its lanes
  // costs them all the wait, and lanes apart wait together.
  static size_t few_lanes(const TriangleTree& tree) {
    constexpr int64_t kCached = int64_t{64} << 20;
    const bool is_cached = tree.memory_bytes() < kCached;
    return kAnyHit ? (is_cached ? 6 : 10) : (is_cached ? 3 : 4);
  }

  // As many together as go nearly the same way; returned are the others.
  template <size_t kCount>
  LaneBits walk_range(size_t first) {
    if (first >= input_.size()) return 0;
    if (bound_lanes<kCount>(first, given_, rays_)) {
      walk<kCount>();
      return 0;
    }
    if constexpr (kCount > 16) {
      return walk_range<kCount / 2>(first) | walk_range<kCount / 2>(first + kCount / 2);
    } else {
      return first_lanes(std::min(first + kCount, input_.size())) & ~first_lanes(first);
    }
  }

  // After the walk: computes the hits, and tells which lanes are undecided.
  LaneBits end_walk() {
    const LaneTag tag;
    LaneBits undecided = 0;
    for (size_t i = 0; i < kPacketRays; i += hn::MaxLanes(tag)) {
      const auto doubt = hn::Load(tag, lane_.doubt + i);
      undecided |=
          lane_bits(hn::And(hn::Lt(doubt, hn::Set(tag, INFINITY)), hn::Le(doubt, hn::Load(tag, lane_.high + i)))) << i;
    }
    if (kAnyHit) return undecided;
    if (Triangles::kInDouble) {
      const LaneBits all = first_lanes(input_.size());
      finish(all & ~(undecided | lanes_equal(lane_.body, kNone)));
    } else {
      for (int i = 0; i < kPacketRays; ++i) t_[i] = rays_.shift[i] + lane_.high[i];
    }
    return undecided;
  }

  template <size_t kCount>
  void walk() {
    const TriangleTree& tree = scene_.tree;
    const TreePlaces places(tree);
    // Apart, for what is stored as two numbers and read as one waits for its stores.
    struct {
      uint32_t node[kStackSize];
      float t[kStackSize];
      LaneBits lanes[kStackSize];
    } stack;
    int top = 1;
    stack.node[0] = 0, stack.t[0] = rays_.t_least, stack.lanes[0] = first_lanes(kCount) << rays_.first;
    float t_most = greatest_of<kCount>(lane_.high + rays_.first);
    while (top > 0) {
      const float t = stack.t[--top];
      if (t > t_most) continue;
      const uint32_t next = stack.node[top];
      const LaneBits lanes = stack.lanes[top];
      const bool is_few = hwy::PopCount(lanes) <= few_lanes_;
      if (next & WideBvh::kLeafBit) {
        const uint32_t leaf = next & ~WideBvh::kLeafBit;
        if (!is_built_in(Feature::triangles) || leaf & TriangleTree::kBodyBit) {
          visit_body(leaf & ~TriangleTree::kBodyBit, lanes);
        } else if (is_few) {
          visit_block_apart(tree.blocks[leaf], lanes);
        } else {
          visit_block<kCount>(tree.blocks[leaf], lanes);
        }
        t_most = greatest_of<kCount>(lane_.high + rays_.first);
        continue;
      }
      if (is_few) {
        leave_apart(lanes, next, t);
        continue;
      }
      const WideBvh::Node& node = tree.nodes[next];
      HWY_ALIGN float entry[WideBvh::kWidth];
      const auto plane = [&](int side, int axis, size_t i)
                             HWY_ATTR { return hn::Load(FloatTag(), node.bounds[side][axis] + i); };
      const int first = top;
      for (uint32_t boxes = boxes_met(rays_, plane, t_most, entry); boxes != 0; boxes &= boxes - 1) {
        const int c = hwy::Num0BitsBelowLS1Bit_Nonzero32(boxes);
        const LaneBits met = lanes_met<kCount>(rays_, node, c, lane_.high);
        if (met == 0) continue;
        prefetch_any(places, node.child[c]);
        int place = top++;
        for (; !kAnyHit && place > first && stack.t[place - 1] < entry[c]; --place) {
          stack.node[place] = stack.node[place - 1], stack.t[place] = stack.t[place - 1];
          stack.lanes[place] = stack.lanes[place - 1];
        }
        stack.node[place] = node.child[c], stack.t[place] = entry[c], stack.lanes[place] = met;
      }
    }
  }

  static constexpr int kRoots = 24;  // what is left to a lane at most, before it is walked

  // Lanes in a list, added without a branch.
  struct LaneList {
    uint32_t at[kPacketRays];
    size_t count = 0;
    HWY_INLINE void add_if(bool is_in, size_t lane) {
      at[count] = static_cast<uint32_t>(lane);
      count += is_in;
    }
  };

  LoneRay& lone_ray(size_t lane) {
    if (!(lone_set_ >> lane & 1)) lone_[lane].set(rays_, given_, lane, stacks_.get() + lane * stack_size_);
    lone_set_ |= bit_of(lane);
    return lone_[lane];
  }

  // Leaves a node to lanes that will walk by themselves, when the packet has come to its end: then many do, and their
  // ends lie nearer.
  HWY_NOINLINE void leave_apart(LaneBits lanes, uint32_t node, float t) {
    bool is_full = false;
    for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
      const size_t lane = lowest_of(rest);
      LoneRay& ray = lone_ray(lane);
      ray.push(node, t);
      is_full |= ray.top == kRoots;
    }
    apart_ |= lanes;
    if (is_full) walk_apart();
  }

  // Each of these lanes by itself. All take a step, then all the next: what a lane's step turns out to be, nobody
  // foresees, but the next lanes' do not depend on it.
  HWY_NOINLINE void walk_apart() {
    const TriangleTree& tree = scene_.tree;
    const TreePlaces places(tree);
    LaneList active, nodes, leaves, met;
    for (; apart_ != 0; apart_ &= apart_ - 1) {
      const size_t lane = lowest_of(apart_);
      // What was left first lies nearest.
      if (!kAnyHit) std::reverse(lone_[lane].stack, lone_[lane].stack + lone_[lane].top);
      active.add_if(true, lane);
    }
    while (active.count > 0) {
      choose_steps(places, active, nodes, leaves);
      for (size_t i = 0; i < nodes.count; ++i) {
        LoneRay& ray = lone_[nodes.at[i]];
        // Of shadow rays the first hit will do, in any order.
        push_children<!kAnyHit>(tree.nodes[ray.stack[ray.top].node], lane_.high[nodes.at[i]], ray);
      }
      met.count = 0;
      for (size_t i = 0; i < leaves.count; ++i) {
        const size_t lane = leaves.at[i];
        const uint32_t leaf = leaf_of(lone_[lane]);
        if (!is_built_in(Feature::triangles) || leaf & TriangleTree::kBodyBit) {
          visit_body(leaf & ~TriangleTree::kBodyBit, bit_of(lane));
        } else {
          sift(tree.blocks[leaf], lone_[lane], lane);
          met.add_if(is_met(lane), lane);
        }
      }
      for (size_t i = 0; i < met.count; ++i)
        take_hits(tree.blocks[leaf_of(lone_[met.at[i]])], sifts_[met.at[i]], met.at[i]);
    }
  }
  // Takes each lane's next step from its stack, which stays readable there until the lane pushes; who has none left is
  // active no more.
  HWY_INLINE void choose_steps(const TreePlaces& places, LaneList& active, LaneList& nodes, LaneList& leaves) {
    const size_t count = active.count;
    active.count = nodes.count = leaves.count = 0;
    for (size_t i = 0; i < count; ++i) {
      const size_t lane = active.at[i];
      LoneRay& ray = lone_[lane];
      const bool is_left = ray.top > 0;
      ray.top -= is_left;
      const LoneEntry next = ray.stack[ray.top];
      prefetch_any(places, next.node);
      const bool is_near = is_left & (next.t <= lane_.high[lane]), is_leaf = next.node & WideBvh::kLeafBit;
      active.add_if(is_left, lane);
      nodes.add_if(is_near & !is_leaf, lane);
      leaves.add_if(is_near & is_leaf, lane);
    }
  }
  static HWY_INLINE uint32_t leaf_of(const LoneRay& ray) { return ray.stack[ray.top].node & ~WideBvh::kLeafBit; }

  void visit_block_apart(const TriangleBlock& block, LaneBits lanes) {
    for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) sift(block, lone_ray(lowest_of(rest)), lowest_of(rest));
    for (LaneBits rest = lanes; rest != 0; rest &= rest - 1) {
      if (is_met(lowest_of(rest))) take_hits(block, sifts_[lowest_of(rest)], lowest_of(rest));
    }
  }
  HWY_INLINE void sift(const TriangleBlock& block, const LoneRay& ray, size_t lane) {
    sift_block<kAnyHit>(block, ray, lane_.t_sure[lane], lane_.low[lane], lane_.high[lane], sifts_[lane]);
  }
  bool is_met(size_t lane) const { return (sifts_[lane].surely | sifts_[lane].unsure) != 0; }
  HWY_INLINE void take_hits(const TriangleBlock& block, const LoneSift& sifted, size_t lane) {
    const auto each = [&](uint32_t triangles, const auto& visit) HWY_ATTR {
      for (; triangles != 0; triangles &= triangles - 1) {
        const int k = hwy::Num0BitsBelowLS1Bit_Nonzero32(triangles);
        const bool has_left = block.prim[k] == given_.left_prim[lane] && block.body[k] == given_.left_body[lane];
        if (!has_left && lane_.high[lane] != -INFINITY) visit(k, block.body[k], block.prim[k]);
      }
    };
    each(sifted.surely, [&](int k, uint32_t body, uint32_t prim) HWY_ATTR {
      if (kAnyHit) return block_lane(lane, body);
      if (sifted.high[k] < lane_.high[lane]) {
        lane_.doubt[lane] = std::min(lane_.doubt[lane], lane_.low[lane]);
        lane_.low[lane] = sifted.low[k], lane_.high[lane] = sifted.high[k];
        lane_.body[lane] = body, lane_.prim[lane] = prim;
        hwy::Prefetch(&scene_.bodies[body].mesh->triangles[prim]);  // for finish
      } else {
        lane_.doubt[lane] = std::min(lane_.doubt[lane], sifted.low[k]);
      }
    });
    each(sifted.unsure, [&](int, uint32_t body, uint32_t prim) HWY_ATTR { decide(body, prim, bit_of(lane)); });
  }

  // The rays in the space of a mesh. The last two are kept: a packet seldom sees more.
  const MeshLanes& inside(uint32_t index) {
    if (inside_[latest_].body != index) {
      latest_ = 1 - latest_;
      if (inside_[latest_].body != index)
        inside_[latest_].set(index, scene_.bodies[index], given_.origin, given_.direction);
    }
    return inside_[latest_];
  }

  // The hits of these lanes: with the triangles that were found; those with other bodies are known.
  void finish(LaneBits lanes) {
    while (lanes != 0) {
      const uint32_t index = lane_.body[lowest_of(lanes)];
      const LaneBits same = lanes & lanes_equal(lane_.body, index);
      lanes &= ~same;
      if (scene_.bodies[index].kind == BodyKind::mesh) finish_with(index, same);
    }
  }
  void finish_with(uint32_t index, LaneBits lanes) {
    const CompiledMesh& mesh = *scene_.bodies[index].mesh;
    const MeshLanes& in = inside(index);
    constexpr size_t kStep = hn::MaxLanes(LaneTag());
    for (size_t i = 0; i < kPacketRays; i += kStep) {
      const LaneBits here = lanes & first_lanes(kStep) << i;
      if (here != 0) finish_some(mesh, in, here, i);
    }
  }
  // Lanes of the register from `first` on.
  HWY_INLINE void finish_some(const CompiledMesh& mesh, const MeshLanes& in, LaneBits lanes, size_t first) {
    const DoubleTag tag;
    const hn::RebindToUnsigned<DoubleTag> bits_tag;
    const hn::Rebind<uint32_t, DoubleTag> int_tag;
    constexpr size_t kStep = hn::MaxLanes(tag);
    DoubleVec vertex[3][3][kHalves];
    hn::Vec<decltype(bits_tag)> prims[kHalves];
    for (size_t h = 0; h < kHalves; ++h) {
      prims[h] = hn::PromoteTo(bits_tag, hn::Load(int_tag, lane_.prim + first + h * kStep));
      for (auto& v : vertex)
        for (auto& k : v) k[h] = hn::Zero(tag);
    }
    // Who walked apart has a triangle of its own.
    for (LaneBits rest = lanes & lone_set_; rest != 0; rest &= rest - 1) {
      const auto& triangle = mesh.triangles[lane_.prim[lowest_of(rest)]];
      for (int v = 0; v < 3; ++v) hwy::Prefetch(&mesh.positions[triangle[v]]);
    }
    for (LaneBits rest = lanes; rest != 0;) {  // triangle by triangle: neighbours mostly meet the same
      const uint32_t prim = lane_.prim[lowest_of(rest)];
      const auto& triangle = mesh.triangles[prim];
      const double* corner[3] = {&mesh.positions[triangle[0]].x, &mesh.positions[triangle[1]].x,
                                 &mesh.positions[triangle[2]].x};
      for (size_t h = 0; h < kHalves; ++h) {
        const auto is_same = hn::Eq(prims[h], hn::Set(bits_tag, prim));
        const auto mask = hn::RebindMask(tag, is_same);
        for (size_t v = 0; v < 3; ++v) {
          for (int k = 0; k < 3; ++k)
            vertex[v][k][h] = hn::IfThenElse(mask, hn::Set(tag, corner[v][in.axis(k)]), vertex[v][k][h]);
        }
        uint8_t bits[8] = {};
        hn::StoreMaskBits(bits_tag, is_same, bits);
        rest &= ~(static_cast<LaneBits>(bits[0]) << (first + h * kStep));
      }
    }
    ExactHits hits;
    for (size_t h = 0; h < kHalves; ++h) {
      const size_t i = first + h * kStep;
      (void)in.meet_some(
          i, [&](int v, int k) HWY_ATTR { return vertex[v][k][h]; }, hits);
      const uint8_t bits[8] = {static_cast<uint8_t>(lanes >> i)};
      const auto mask = hn::LoadMaskBits(tag, bits);
      const auto keep = [&](const double* from, double* to) HWY_ATTR {
        hn::Store(hn::IfThenElse(mask, hn::Load(tag, from + i), hn::Load(tag, to + i)), tag, to + i);
      };
      keep(hits.t, t_), keep(hits.b0, b0_), keep(hits.b1, b1_);
    }
  }

  // A hit that was computed in double, at t: the best of its lane if it is nearer beyond doubt.
  void offer(size_t i, uint32_t body, uint32_t prim, double t, double b0, double b1) {
    const auto at = static_cast<float>(t - rays_.shift[i]);
    if (kAnyHit) {
      if (t < input_[i].t_max) block_lane(i, body);
      return;
    }
    const float off = rays_.tie[i] + 0x1p-22f * (1.0f + std::abs(at));
    if (at + off < lane_.high[i]) {
      lane_.doubt[i] = std::min(lane_.doubt[i], lane_.low[i]);
      lane_.low[i] = at - off, lane_.high[i] = at + off;
      lane_.body[i] = body, lane_.prim[i] = prim;
      t_[i] = t, b0_[i] = b0, b1_[i] = b1;
    } else {
      lane_.doubt[i] = std::min(lane_.doubt[i], at - off);
    }
  }
  void block_lane(size_t lane, uint32_t body) {
    lane_.body[lane] = body;
    lane_.high[lane] = -INFINITY;
    lone_[lane].top = 0;
  }

  HWY_NOINLINE void visit_body(uint32_t index, LaneBits lanes) {
    if (!is_built_in(Feature::triangles) || scene_.bodies[index].kind != BodyKind::mesh)
      return visit_solid(index, lanes);
    for (; lanes != 0; lanes &= lanes - 1) {
      const size_t i = lowest_of(lanes);
      if (lane_.high[i] == -INFINITY) continue;
      const Hit hit = Walk<kAnyHit>(scene_, input_[i]).run_body(index);
      if (!hit.is_hit()) continue;
      if (kAnyHit) {
        block_lane(i, index);
      } else {
        offer(i, index, hit.prim, hit.t, hit.b0, hit.b1);
      }
    }
  }

  HWY_NOINLINE void visit_solid(uint32_t index, LaneBits lanes) {
    constexpr size_t kFewLanes = 3;  // are asked one by one
    if (hwy::PopCount(lanes) <= kFewLanes) {
      for (; lanes != 0; lanes &= lanes - 1) ask_solid(index, lowest_of(lanes));
      return;
    }
    const CompiledBody& body = scene_.bodies[index];
    LocalLanes local;
    LaneSpans spans;
    transform_lanes(body.local_from_world, given_.origin, given_.direction, local);
    if (is_built_in(Feature::spheres) && body.kind == BodyKind::sphere) sphere_spans(local, spans);
    if (is_built_in(Feature::planes) && body.kind == BodyKind::plane) plane_spans(local, spans);
    if (is_built_in(Feature::boxes) && body.kind == BodyKind::box) box_spans(body.half, local, spans);
    for (; lanes != 0; lanes &= lanes - 1) {
      const size_t i = lowest_of(lanes);
      const double near = spans.near[i], far = spans.far[i], reach = given_.reach[i];
      double t = near;
      uint32_t prim = spans.near_prim[i];
      // Beyond `reach` the sign of t tells what lies ahead; within it, and on the body that the ray has left, the ray
      // does.
      bool is_told = given_.left_body[i] != index && (near > reach || near < -reach);
      if (is_told && near < 0.0) {
        if (far < -reach) continue;
        t = far, prim = spans.far_prim[i];
        is_told = far > reach;
      }
      if (is_told) {
        offer(i, index, prim, t, 0.0, 0.0);
      } else {
        ask_solid(index, i);
      }
    }
  }
  void ask_solid(uint32_t index, size_t lane) {
    double t = 0.0;
    uint32_t prim = 0;
    if (Walk<kAnyHit>(scene_, input_[lane]).meet_solid(index, t, prim)) offer(lane, index, prim, t, 0.0, 0.0);
  }

  template <size_t kCount>
  HWY_INLINE void visit_block(const TriangleBlock& block, LaneBits lanes) {
    HWY_ALIGN float entry[8];
    const auto plane = [&](int side, int axis, size_t i) HWY_ATTR {
      const FloatTag tag;
      const auto a = hn::Load(tag, block.vertex[0][axis] + i), b = hn::Load(tag, block.vertex[1][axis] + i),
                 c = hn::Load(tag, block.vertex[2][axis] + i);
      return side ? hn::Add(hn::Max(a, hn::Max(b, c)), hn::Set(tag, WideBvh::kWiden))
                  : hn::Sub(hn::Min(a, hn::Min(b, c)), hn::Set(tag, WideBvh::kWiden));
    };
    const float t_most = greatest_of<kCount>(lane_.high + rays_.first);
    uint32_t boxes = boxes_met(rays_, plane, t_most, entry);
    if (boxes == 0) return;
    const typename Triangles::Edges edges(block, rays_);
    struct {
      int triangle[8];
      LaneBits lanes[8];
      size_t count = 0;
    } maybe;  // filled without a branch: which triangles are met, nobody foresees
    for (; boxes != 0; boxes &= boxes - 1) {
      const int k = hwy::Num0BitsBelowLS1Bit_Nonzero32(boxes);
      maybe.triangle[maybe.count] = k;
      maybe.lanes[maybe.count] = lanes & Triangles::template may_meet<kCount>(block, edges, k, entry[k], rays_, lane_);
      maybe.count += maybe.lanes[maybe.count] != 0;
    }
    for (size_t i = 0; i < maybe.count; ++i) {
      const int k = maybe.triangle[i];
      const LaneBits unsure = Triangles::template meet<kCount>(block, edges, k, maybe.lanes[i], rays_, given_, lane_);
      if (unsure != 0) decide(block.body[k], block.prim[k], unsure);
    }
  }

  // In double, which rays meet a triangle, and where.
  HWY_NOINLINE void decide(uint32_t body, uint32_t prim, LaneBits lanes) {
    const CompiledMesh& mesh = *scene_.bodies[body].mesh;
    const auto& triangle = mesh.triangles[prim];
    const Vec3 vertex[3] = {mesh.positions[triangle[0]], mesh.positions[triangle[1]], mesh.positions[triangle[2]]};
    ExactHits hits;
    for (lanes = inside(body).meet(lanes, vertex, hits); lanes != 0; lanes &= lanes - 1) {
      const size_t i = lowest_of(lanes);
      const double t = hits.t[i], reach = given_.reach[i];
      if (t > reach) {
        offer(i, body, prim, t, hits.b0[i], hits.b1[i]);
      } else if (t >= -reach) {
        decide_alone(body, prim, i);
      }
    }
  }
  void decide_alone(uint32_t body, uint32_t prim, size_t lane) {
    const Walk<kAnyHit> walk(scene_, input_[lane]);
    Hit hit;
    if (walk.meet_triangle(walk.inside(body), prim, hit)) offer(lane, body, prim, hit.t, hit.b0, hit.b1);
  }

  const CompiledScene& scene_;
  const size_t few_lanes_;  // walk apart
  std::span<const BoundedRay> input_;
  PacketRays rays_;
  LaneHits lane_;
  GivenRays given_;
  alignas(64) double t_[kPacketRays], b0_[kPacketRays], b1_[kPacketRays];  // of the best hit; of triangles at the end
  MeshLanes inside_[2];
  LoneRay lone_[kPacketRays];
  LaneBits lone_set_ = 0;  // the lanes whose lone_ is set
  LaneBits apart_ = 0;     // those to which something is left
  LoneSift sifts_[kPacketRays];
  size_t stack_size_;                    // of a lane; the last node's children are written eight at once
  std::unique_ptr<LoneEntry[]> stacks_;  // left as it is where nothing is pushed
  int latest_ = 0;                       // which of inside_ was asked for last
};

// All rays, a packet of neighbours at a time. Answer: Hit, or uint8_t for whether a ray is blocked. ask(ray): for what
// packets do not decide. Packet: a PacketWalk.
template <class Packet, class Answer, class Ask>
HWY_INLINE void trace_packets(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<Answer> answers,
                              const Ask& ask) {
  constexpr size_t kFewRays = 5;  // fewer are better walked one by one
  Packet packet(scene);
  for (size_t first = 0; first < rays.size(); first += kPacketRays) {
    const auto rest = rays.subspan(first);
    const auto some = rest.first(std::min<size_t>(kPacketRays, rest.size()));
    LaneBits undecided = ~LaneBits{0};
    if (some.size() >= kFewRays) {
      packet.take(some);
      if (packet.is_sound()) {
        undecided = packet.run();
        packet.answer(answers.subspan(first, some.size()));
      }
    }
    for (undecided &= first_lanes(some.size()); undecided != 0; undecided &= undecided - 1)
      ask(first + lowest_of(undecided));
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
