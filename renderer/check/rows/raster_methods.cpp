// SPDX-License-Identifier: Apache-2.0
// R2, R3: rays, the z-buffer and Warnock's subdivision see the same, but where an edge passes a sample so closely that
// the grid of corners decides.
#include <algorithm>

#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook_raster.h"
#include "renderer/check/rows/raster.h"

namespace tilelight::check {
namespace {

struct Case {
  const char* name;
  const char* objects;
  Vec3 eye, target;
  double fov_deg, height;  // of the two projections
  bool has_plane;
};
constexpr const char* kSpheresAndCubes = R"(
  {"type":"sphere","center":[0,1,0],"radius":1}, {"type":"sphere","center":[1.9,0.6,0.9],"radius":0.6},
  {"type":"sphere","center":[-1.4,0.4,1.3],"radius":0.4}, {"type":"cube","center":[-2,0.8,-0.6],"size":1.6,
  "rotate_deg":{"axis":[0,1,0],"angle":27}}, {"type":"cube","center":[1.1,0.45,2],"size":0.9,
  "rotate_deg":{"axis":[0.2,1,0.4],"angle":51}}, {"type":"box","min":[-4,-0.3,-4],"max":[4,0,4]})";
constexpr const char* kThroughEachOther = R"(
  {"type":"box","min":[-1,-1,-1],"max":[1,1,1],"rotate_deg":{"axis":[1,2,3],"angle":37}},
  {"type":"box","min":[-1.5,-0.5,-0.7],"max":[1.5,0.5,0.7],"rotate_deg":{"axis":[3,1,-1],"angle":71}},
  {"type":"box","min":[-0.3,-1.9,-0.3],"max":[0.3,1.9,0.3],"rotate_deg":{"axis":[-1,0.3,2],"angle":22}},
  {"type":"sphere","center":[0.4,0.3,0.2],"radius":1.15}, {"type":"sphere","center":[-0.5,-0.2,0.4],"radius":1.05})";
constexpr const char* kOnAPlane = R"(
  {"type":"plane","point":[0,0,0],"normal":[0.02,1,0.03]}, {"type":"sphere","center":[0,0.6,0],"radius":1},
  {"type":"cube","center":[2,0.2,-1],"size":1.5,"rotate_deg":{"axis":[1,1,0],"angle":33}},
  {"type":"chess_piece","piece":"knight","position":[-1.8,0,0.8],"scale":2,"detail":16})";
constexpr const char* kOpening =
    R"({"type":"chess_position","fen":"rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR","detail":24})";
const Case kCases[] = {
    {"opening of chess", kOpening, {6.2, 6.4, 9.7}, {0, 0.1, 0.2}, 40, 10.5, false},
    {"spheres and cubes", kSpheresAndCubes, {4.5, 4.2, 7.3}, {0, 0.5, 0}, 36, 6.1, false},
    {"boxes and spheres through each other", kThroughEachOther, {2.9, 2.1, 4.4}, {0, 0, 0}, 40, 4.2, false},
    {"on a plane", kOnAPlane, {2.5, 2.2, 6.3}, {0, 0.6, 0}, 42, 5.3, true},
};

ParsedScene scene_of_case(const Case& c, Projection projection, int side) {
  const std::string camera = projection == Projection::perspective
                                 ? R"("fov_y_deg":)" + text(c.fov_deg)
                                 : R"("type":"orthographic","height":)" + text(c.height);
  return scene_of(
      R"({"objects":[)" + std::string(c.objects) + R"(],"camera":{"position":)" + text(c.eye) + R"(,"target":)" +
      text(c.target) + "," + camera +
      R"(},"lights":[{"type":"point","position":[4,7,6],"intensity":9}],"attenuation":{"mode":"linear","k":4},
                  "render":{"tessellate":true,"chord_error_px":0.5,"max_depth":0},)" +
      image_text(side, side) + "}");
}

// Pixels of other ids, though no edge passes within reach.
int64_t apart_off_edges(const std::vector<uint64_t>& a, const std::vector<uint64_t>& b,
                        const std::vector<Beside>& beside) {
  int64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    const bool is_other_body = a[i] >> 32 != b[i] >> 32;
    count += beside[i] == Beside::same ? a[i] != b[i] : beside[i] == Beside::other_triangle && is_other_body;
  }
  return count;
}

double part_of(const std::vector<Beside>& beside, Beside least) {
  const auto count = std::count_if(beside.begin(), beside.end(), [&](Beside b) { return b >= least; });
  return percent(count, std::ssize(beside));
}

// The picture's bytes by both methods.
double pixels_apart(ParsedScene parsed, TilePool& pool) {
  parsed.view.render.algorithm = Algorithm::zbuffer;
  const Picture zbuffer = picture_of(parsed, pool);
  parsed.view.render.algorithm = Algorithm::warnock;
  return differing_bits(zbuffer.linear, picture_of(parsed, pool).linear);
}

}  // namespace

Outcome methods_agree(const Context& context) {
  // How many pixels have an edge in reach grows with the number of edges: triangles of some ten pixels, where spheres
  // are cut to half a pixel.
  Outcome out;
  for (const Case& c : context.is_quick ? std::span(kCases).subspan(1) : std::span(kCases)) {
    const bool counts_edges = c.objects == kSpheresAndCubes;
    const int side = context.is_quick && !counts_edges ? 256 : 512;  // the smaller, the more edges a pixel
    for (const Projection projection : {Projection::perspective, Projection::orthographic}) {
      const ParsedScene parsed = scene_of_case(c, projection, side);
      const DrawnScene drawn(parsed, context.pool);
      const std::string name = std::string(c.name) + (projection == Projection::perspective ? "" : ", orthographic");
      const std::vector<uint64_t> rays = drawn.ids(Algorithm::raytrace), ids = drawn.ids(Algorithm::zbuffer);
      const std::vector<Beside> beside = drawn.beside();
      const auto off_edges = static_cast<double>(apart_off_edges(rays, ids, beside));
      out.ours.push_back(at_most(0, name + ": other ids than by rays, off edges", off_edges));
      out.ours.push_back(at_most(0.05, "other ids at all, %", differing_ids(rays, ids)));
      out.ours.push_back(at_most(0.05, "pixels with an outline in reach, %", part_of(beside, Beside::other_body)));
      if (counts_edges)
        out.ours.push_back(at_most(0.05, "pixels with any edge in reach, %", part_of(beside, Beside::other_triangle)));
      out.ours.push_back(at_most(0, "Warnock, other ids, %", differing_ids(ids, drawn.ids(Algorithm::warnock))));
      out.ours.push_back(at_most(0, "Warnock, pixels that differ in a bit, %", pixels_apart(parsed, context.pool)));
      if (c.has_plane) continue;
      for (const double steps : {1.0, 16.0}) {
        const std::vector<uint64_t> naive = textbook_ids(drawn, {.steps_per_px = steps});
        const std::string corners = steps == 1.0 ? "whole pixels" : "1/16 pixel";
        out.naive.push_back(at_most(0.05, name + ", " + corners + ": other ids at all, %", differing_ids(rays, naive)));
      }
    }
  }
  return out;
}

// Triangles of which one or two corners lie behind the eye, each alone in a picture.
Outcome through_the_eye_plane(const Context& context) {
  const int side = context.is_quick ? 64 : 256, count = context.is_quick ? 10 : 40;
  Random random(3);
  int64_t zbuffer = 0, warnock = 0, naive = 0;
  double apart = 0.0, naive_apart = 0.0, seen = 0.0;  // %, %, part of the pictures
  for (int i = 0; i < count; ++i) {
    MeshData mesh;
    mesh.indices = {0, 1, 2};
    for (int corner = 0; corner < 3; ++corner) {
      const double w = (corner == 0 || (corner == 1 && i % 2) ? -1.0 : 1.0) * random.between(0.0, 1e3);
      mesh.positions.emplace_back(random.between(-600, 600), random.between(-600, 600), -w);
    }
    const ParsedScene parsed = scene_of(R"({"lights":[],"meshes":{"m":)" + mesh_text(mesh) +
                                        R"(},"objects":[{"type":"mesh","mesh":"m"}],"camera":{"position":[0,0,0],
                                        "target":[0,0,-1],"fov_y_deg":80},)" +
                                        image_text(side, side) + "}");
    const DrawnScene drawn(parsed, context.pool);
    const std::vector<uint64_t> rays = drawn.ids(Algorithm::raytrace), ids = drawn.ids(Algorithm::zbuffer);
    const std::vector<uint64_t> textbook = textbook_ids(drawn, {});
    const std::vector<Beside> beside = drawn.beside();
    zbuffer += apart_off_edges(rays, ids, beside);
    warnock += apart_off_edges(rays, drawn.ids(Algorithm::warnock), beside);
    naive += apart_off_edges(rays, textbook, beside);
    apart += differing_ids(rays, ids) / count, naive_apart += differing_ids(rays, textbook) / count;
    seen += coverage(rays, 0) / count;
  }
  return {{at_most(0, "z-buffer: other ids than by rays, off edges", static_cast<double>(zbuffer)),
           at_most(0, "Warnock: other ids than by rays, off edges", static_cast<double>(warnock)),
           at_most(0.05, "other ids at all, %", apart),
           at_least(0.1, "part of the pictures that the triangles cover", seen)},
          {at_most(0, "other ids than by rays, off edges", static_cast<double>(naive)),
           at_most(0.05, "other ids at all, %", naive_apart)}};
}

}  // namespace tilelight::check
