// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/textbook.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include <nlohmann/json.hpp>

#include "renderer/compile/compiled_scene.h"
#include "tests/bench/timing.h"
#include "tests/bench/waves.h"

namespace tilelight::bench {
namespace {

using Vec3f = glm::vec3;
constexpr float kEpsilon = 1e-4f;

struct Triangle {
  Vec3f corner, to_second, to_third;
};
struct Ball {  // a mesh and the sphere around it
  Vec3f center;
  float radius2;
  std::vector<Triangle> triangles;
};

std::vector<Ball> balls_of(const CompiledScene& scene) {
  std::vector<Ball> balls;
  for (const CompiledBody& body : scene.bodies) {
    Box bounds;
    for (const Vec3& p : body.mesh->positions) bounds.grow(transform_point(body.world_from_local, p));
    Ball ball{Vec3f(0.5 * (bounds.lo + bounds.hi)), 0.0f, {}};
    for (const auto& t : body.mesh->triangles) {
      Vec3f corner[3];
      for (size_t v = 0; v < 3; ++v) {
        corner[v] = Vec3f(transform_point(body.world_from_local, body.mesh->positions[t[v]]));
        const Vec3f off = corner[v] - ball.center;
        ball.radius2 = std::max(ball.radius2, glm::dot(off, off));
      }
      ball.triangles.push_back({corner[0], corner[1] - corner[0], corner[2] - corner[0]});
    }
    balls.push_back(std::move(ball));
  }
  return balls;
}

// The nearest hit's body and triangle; kNone: none. any_hit: the first that is found.
std::pair<uint32_t, uint32_t> trace(const std::vector<Ball>& balls, const BoundedRay& ray, bool any_hit) {
  const Vec3f o(ray.ray.origin), d(ray.ray.direction);
  float nearest = ray.t_max < 1e30 ? static_cast<float>(ray.t_max) : std::numeric_limits<float>::infinity();
  std::pair<uint32_t, uint32_t> best{kNone, 0};
  for (uint32_t b = 0; b < balls.size(); ++b) {
    const Vec3f to = balls[b].center - o;
    const float along = glm::dot(to, d);
    if (glm::dot(to, to) - along * along > balls[b].radius2) continue;
    for (uint32_t t = 0; t < balls[b].triangles.size(); ++t) {
      const Triangle& tri = balls[b].triangles[t];
      const Vec3f p = glm::cross(d, tri.to_third);
      const float inverse = 1.0f / glm::dot(tri.to_second, p);
      const Vec3f s = o - tri.corner;
      const float u = glm::dot(s, p) * inverse;
      if (!(u >= 0.0f && u <= 1.0f)) continue;
      const Vec3f q = glm::cross(s, tri.to_second);
      const float v = glm::dot(d, q) * inverse;
      if (!(v >= 0.0f && u + v <= 1.0f)) continue;
      const float at = glm::dot(tri.to_third, q) * inverse;
      if (!(at > kEpsilon && at < nearest)) continue;
      nearest = at;
      best = {b, t};
      if (any_hit) return best;
    }
  }
  return best;
}

}  // namespace

std::string compare_with_textbook(const std::string& name, const std::string& document, TilePool& pool, int rounds) {
  constexpr size_t kEvery = 256;  // all rays would take minutes
  const ParsedScene parsed = parse_scene(document, Limits{}).value();
  const auto scene = compile_scene(parsed.scene, pool);
  const ViewPlan plan = plan_view(*scene, parsed.view);
  const std::vector<Ball> balls = balls_of(*scene);
  std::printf("\n%s: %lld triangles, one part of the rays in %zu\n%-18s %10s %14s %14s   %-24s %s\n", name.c_str(),
              static_cast<long long>(plan.plan.triangles_instanced), kEvery, "rays", "rays", "ours Mrays/s",
              "book Mrays/s", "book / ours, time", "other answers");
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  const FrameWaves frame = waves_of(*scene, plan, pool);
  for (const WaveKind& kind : kinds_of(frame)) {
    const FrameWaves some = only(frame, kind, kEvery);
    std::vector<double> ours_s, book_s;
    int64_t others = 0, count = 0;
    for (int round = 0; round < rounds; ++round) {
      ours_s.push_back(trace_waves(*scene, some, pool));
      std::vector<std::vector<std::pair<uint32_t, uint32_t>>> answers(some.size());
      SpentTime spent;
      pool.parallel_for(static_cast<int64_t>(some.size()), Priority::normal, [&](int64_t i) {
        const auto at = static_cast<size_t>(i);
        spent.spend([&] {
          for (const Wave& wave : some[at])
            for (const BoundedRay& ray : wave.rays) answers[at].push_back(trace(balls, ray, wave.any_hit));
        });
      });
      book_s.push_back(spent.seconds() / pool.thread_count());
      others = count = 0;
      for (size_t b = 0; b < some.size(); ++b) {
        size_t at = 0;
        for (const Wave& wave : some[b]) {
          std::vector<Hit> hits(wave.rays.size());
          trace_closest(*scene, wave.rays, hits);
          for (const Hit& hit : hits) {
            const auto& answer = answers[b][at++];
            others += wave.any_hit ? (answer.first != kNone) != hit.is_hit()
                                   : answer != std::pair(hit.body, hit.is_hit() ? hit.prim : 0);
          }
        }
        count += static_cast<int64_t>(at);
      }
    }
    const Ratio ratio = ratio_of(book_s, ours_s);
    const auto rays = static_cast<double>(count);
    std::printf("%-18s %10.0f %14.2f %14.4f   %.0f (%.0f - %.0f)%*s%.4f%%\n", kind.name().c_str(), rays,
                1e-6 * rays / median(ours_s), 1e-6 * rays / median(book_s), ratio.middle, ratio.least, ratio.most, 8,
                "", 100.0 * static_cast<double>(others) / rays);
    rows.push_back({{"rays", kind.name()},
                    {"count", count},
                    {"ours_mrays_s", 1e-6 * rays / median(ours_s)},
                    {"textbook_mrays_s", 1e-6 * rays / median(book_s)},
                    {"time_ratio", {ratio.least, ratio.middle, ratio.most}},
                    {"other_answers", others}});
  }
  return nlohmann::ordered_json{{"scene", name}, {"baseline", "textbook"}, {"rows", rows}}.dump();
}

}  // namespace tilelight::bench
