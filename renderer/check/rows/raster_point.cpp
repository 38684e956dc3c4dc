// SPDX-License-Identifier: Apache-2.0
// R5: Warnock's subdivision ends at one pixel, whatever meets in it.
#include <bit>
#include <ctime>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/methods.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/shots.h"
#include "renderer/check/rows/raster.h"
#include "renderer/raster/warnock.h"

namespace tilelight::check {
namespace {

constexpr int kEdges = 1000;
const Vec2 kApex(0.3137, 0.2071);  // in the picture's plane, of which the height is 2

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// A cone whose point is seen in the middle of a pixel's inside: faces that share their edges, or blades that cut
// through each other.
MeshData fan(bool is_cone) {
  MeshData mesh;
  mesh.positions.emplace_back(kApex.x, kApex.y, 0.0);
  Random random(5);
  for (uint32_t i = 0; i < kEdges; ++i) {
    const double turn = 2.0 * elementary::kPi * i / kEdges, z = is_cone ? -0.5 : random.between(-0.9, 0.9);
    mesh.positions.emplace_back(kApex.x + 0.6 * elementary::cos(turn), kApex.y + 0.6 * elementary::sin(turn), z);
    const uint32_t next = is_cone ? (i + 1) % kEdges : (i + 250) % kEdges;
    mesh.indices.insert(mesh.indices.end(), {0, i + 1, next + 1});
  }
  return mesh;
}

ParsedScene before_camera(MeshData mesh, int side_px) {
  ParsedScene parsed;
  parsed.scene = scene_of_shapes({MeshShape{0}});
  parsed.scene.meshes.push_back(std::move(mesh));
  parsed.view.image = {side_px, side_px};
  Camera& camera = parsed.view.camera.emplace();
  camera.projection = Projection::orthographic;
  camera.position = Vec3(0.0, 0.0, 3.0);
  camera.height = 2.0;
  return parsed;
}

// How often a window around the apex is cut in four until at most one face is left in it, if it may be cut below a
// pixel; up to `most` times.
int textbook_depth(const MeshData& mesh, int most) {
  Vec2 low(-1.0), high(1.0);
  for (int depth = 0; depth < most; ++depth) {
    int inside = 0;
    for (size_t t = 0; t < mesh.indices.size(); t += 3) {
      bool is_apart = false;
      for (size_t c = 0; c < 3; ++c) {  // by an edge that has the whole window on its outer side
        const Vec2 a(mesh.positions[mesh.indices[t + c]]), b(mesh.positions[mesh.indices[t + (c + 1) % 3]]);
        const Vec2 inward(a.y - b.y, b.x - a.x);
        const Vec2 innermost(inward.x > 0.0 ? high.x : low.x, inward.y > 0.0 ? high.y : low.y);
        is_apart |= glm::dot(innermost - a, inward) < 0.0;
      }
      inside += !is_apart;
    }
    if (inside <= 1) return depth;
    const Vec2 middle = 0.5 * (low + high);
    for (int axis = 0; axis < 2; ++axis) (kApex[axis] < middle[axis] ? high : low)[axis] = middle[axis];
  }
  return most;
}

}  // namespace

Outcome edges_in_one_pixel(const Context& context) {
  const int side = context.is_quick ? 256 : 1024;
  const auto log2_side = static_cast<double>(std::bit_width(static_cast<unsigned>(side - 1)));
  Outcome out;
  for (const bool is_cone : {true, false}) {
    const std::string name = is_cone ? "cone" : "blades";
    const DrawnScene drawn(before_camera(fan(is_cone), side), context.pool);
    const RasterScene raster(drawn.scene(), drawn.plan(), context.pool);
    const double start = processor_seconds();
    const std::vector<uint64_t> ids = drawn.ids(Algorithm::warnock);
    const double seconds = processor_seconds() - start;
    const WarnockCounts counts = WarnockScene(raster, context.pool).visit([](const auto&...) {});
    out.ours.push_back(at_most(log2_side, name + ": depth of the subdivision", counts.depth));
    out.ours.push_back(at_most(1.0 * kSlowdown, "s of processor time", seconds));
    out.ours.push_back(
        at_most(0, "ids apart from the z-buffer's, %", differing_ids(ids, drawn.ids(Algorithm::zbuffer))));
  }
  out.naive.push_back(at_most(log2_side, "depth until one face is left, cut off at 50", textbook_depth(fan(true), 50)));
  return out;
}

}  // namespace tilelight::check
