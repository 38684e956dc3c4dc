// SPDX-License-Identifier: Apache-2.0
// T7, T8: what no plane can part, and sizes that halve sixty times.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>

#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/triangles.h"
#include "renderer/compile/compiled_scene.h"
#include "renderer/film/sampling.h"

namespace tilelight::check {
namespace {

constexpr int kTriangles = 100'000;

// A triangle about the origin of the plane z = 0; gauge(p): the size of the one that has p on its rim.
MeshData triangle_of_size(double size) {
  return {"", {{-size, -size, 0}, {size, -size, 0}, {0, size, 0}}, {0, 1, 2}, {}, 30.0};
}
double gauge(const Vec3& p) { return std::max(-p.y, 2.0 * std::abs(p.x) + p.y); }

MeshData coincident() {
  MeshData mesh = triangle_of_size(2.0);
  for (int i = 1; i < kTriangles; ++i) mesh.indices.insert(mesh.indices.end(), {0, 1, 2});
  return mesh;
}
// Triangle i is 1 + i / kTriangles large: the boxes of all have one centre.
MeshData concentric() {
  MeshData mesh;
  for (uint32_t i = 0; i < kTriangles; ++i) {
    const MeshData one = triangle_of_size(1.0 + static_cast<double>(i) / kTriangles);
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    mesh.indices.insert(mesh.indices.end(), {3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

// Rays from an eye before the plane through side x side points of it that do not show the lowest id there; those
// within rounding of a rim are left out.
double wrong_ids(const RayScene& scene, bool is_concentric, int side, TilePool& pool) {
  std::atomic<int64_t> wrong{0};
  pool.parallel_for(side, Priority::normal, [&](int64_t row) {
    for (int column = 0; column < side; ++column) {
      const Vec3 at((column + 0.5) / side * 4.0 - 2.0, (static_cast<double>(row) + 0.5) / side * 4.0 - 2.0, 0.0);
      const Vec3 eye(0.3, 0.2, 4.0);
      // The lowest id that reaches the point, as a real number.
      const double step = is_concentric ? kTriangles : 1e9;
      const double place = std::max(0.0, (gauge(at) - (is_concentric ? 1.0 : 2.0)) * step);
      if (place > 0.0 && std::abs(place - std::round(place)) < 1e-4) continue;
      const auto expected = static_cast<uint64_t>(std::ceil(place));
      const RayScene::Hit hit = scene.nearest(eye, at - eye);
      wrong += expected < kTriangles ? !hit.is_hit || hit.id != expected : hit.is_hit;
    }
  });
  return static_cast<double>(wrong);
}

// How deep halving the extent of the centroids gets, given up at `limit`.
int midpoint_split_depth(std::vector<double> centroids, int limit) {
  int depth = 0;
  while (centroids.size() > 8 && depth < limit) {
    const auto [lo, hi] = std::minmax_element(centroids.begin(), centroids.end());
    const double middle = 0.5 * (*lo + *hi);
    const auto right = std::partition(centroids.begin(), centroids.end(), [&](double c) { return c < middle; });
    if (right - centroids.begin() > centroids.end() - right)
      centroids.erase(right, centroids.end());
    else
      centroids.erase(centroids.begin(), right);
    ++depth;
  }
  return depth;
}

constexpr int kSpheres = 61;

std::string stadium_document(const Vec3& eye, const Vec3& target, int side) {
  std::string out = R"({"lights":[],"objects":[)";
  for (int k = 0; k < kSpheres; ++k) {
    const double r = std::ldexp(1.0, -k);
    out += R"({"type":"sphere","center":)" + text(Vec3(3.0 * r, 0.0, 0.0)) + R"(,"radius":)" + text(r) + "},";
  }
  out.back() = ']';
  return out + R"(,"camera":{"position":)" + text(eye) + R"(,"target":)" + text(target) + R"(},"image":{"width":)" +
         std::to_string(side) + R"(,"height":)" + std::to_string(side) + "}}";
}

// The picture's rays by the quadratic in float, with a fixed offset from the eye.
double textbook_mismatch(const ParsedScene& parsed, const std::vector<uint64_t>& expected, TilePool& pool) {
  const auto compiled = compile_scene(parsed.scene, pool);  // for its eye alone
  const Eye eye = plan_view(*compiled, parsed.view).eye;
  const int side = parsed.view.image.width;
  std::vector<uint64_t> ids(expected.size(), kNothingHit);
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const SamplePoint p = sample_point(x, y, parsed.view.render.seed, 0);
      const Vec3 at = eye.corner + (x + p.x) * eye.step_x + (y + p.y) * eye.step_y;
      const naive::RayF ray{Vec3f(parsed.view.camera->position), Vec3f(glm::normalize(at))};
      float best = std::numeric_limits<float>::infinity();
      for (uint32_t k = 0; k < kSpheres; ++k) {
        const float r = std::ldexp(1.0f, -static_cast<int>(k));
        const auto t = naive::sphere(ray, Vec3f(3.0f * r, 0.0f, 0.0f), r, 1e-4f);
        if (t && *t < best) best = *t, ids[static_cast<size_t>(y * side + x)] = surface_id(k, 0);
      }
    }
  }
  return differing_ids(ids, expected);
}

}  // namespace

Outcome coincident_triangles(const Context& context) {
  const int side = context.is_quick ? 8 : 64;
  constexpr int kDeepest = 24;  // levels of eight; 1e5 triangles fill six
  Outcome out;
  for (const bool is_concentric : {false, true}) {
    const Scene parsed = scene_of(mesh_document(is_concentric ? concentric() : coincident())).scene;
    const std::clock_t start =
        std::clock();  // of the processor: on an idle machine the build takes no longer than this
    const RayScene scene(parsed, context.pool);
    const double build_s = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    const CompiledScene& compiled = scene.compiled();
    const std::string which = is_concentric ? "one centroid: " : "coincident: ";
    out.ours.push_back(at_most(0, which + "rays that show another id than the lowest",
                               wrong_ids(scene, is_concentric, side, context.pool)));
    out.ours.push_back(at_most(2 * kSlowdown, which + "build, s of all threads", build_s));
    out.ours.push_back(at_most(kDeepest, which + "depth of the tree", compiled.tree.depth));
  }
  std::vector<double> centroids;  // along y
  const MeshData mesh = coincident();
  for (size_t i = 0; i < mesh.indices.size(); i += 3)
    centroids.push_back(
        (mesh.positions[mesh.indices[i]] + mesh.positions[mesh.indices[i + 1]] + mesh.positions[mesh.indices[i + 2]])
            .y);
  out.naive.push_back(
      at_most(kDeepest, "coincident: depth of the tree, given up at 1000", midpoint_split_depth(centroids, 1000)));
  return out;
}

// Each sphere touches the next, which is half as large: from anywhere near the origin the row looks the same.
Outcome stadium(const Context& context) {
  const int side = context.is_quick ? 128 : 512;
  Outcome out;
  const auto judge = [&](const std::string& from, const Vec3& eye, const Vec3& target) {
    const ParsedScene parsed = scene_of(stadium_document(eye, target, side));
    const std::vector<uint64_t> expected = reference_ids(parsed, context.pool);
    const std::string what = "other first surfaces from " + from + ", %";
    out.ours.push_back(at_most(0.01, what, differing_ids(picture_of(parsed, context.pool).ids, expected)));
    return std::pair(what, textbook_mismatch(parsed, expected, context.pool));
  };
  const auto [what, value] = judge("the origin", Vec3(0.0), Vec3(1.0, 0.0, 0.0));
  out.naive.push_back(at_most(0.01, what, value));
  for (const int k : {0, 20, 40, 60}) {
    const double r = std::ldexp(1.0, -k);
    const auto beside = judge("beside sphere " + std::to_string(k), r * Vec3(3.0, 2.0, 9.0), r * Vec3(3.0, 0.0, 0.0));
    if (k >= 20) out.naive.push_back(at_most(0.01, beside.first, beside.second));
  }
  return out;
}

}  // namespace tilelight::check
