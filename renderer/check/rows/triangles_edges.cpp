// SPDX-License-Identifier: Apache-2.0
// T1, T2, T5, T9, T10, T11: single rays against meshes, where rounding decides between a hit and a leak.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/rows/triangles.h"
#include "renderer/trace/intersect.h"

namespace tilelight::check {
namespace {

// A ball of the size at size * offset, and rays from inside it and from where it faces the eye: each has to hit.
struct Ball {
  Rimmed mesh;
  Vec3 center{0.0};
  double size = 1.0;

  Ball(double s, const Vec3& offset) : mesh(placed(icosphere(3), s, offset)), center(s * offset), size(s) {}
  RayScene::Aim aim_at(const Target& target, bool from_inside, Random& random) const {
    const Vec3 shift = 0.3 * size * random.direction();
    const Vec3 eye = from_inside ? center + shift : center + random.between(2.0, 5.0) * (target.at - center) + shift;
    return {eye, target.at - eye};
  }
};

struct Leaks {
  std::atomic<int64_t> edge{0}, vertex{0};
};

// `count` rays at edges and as many at vertices through hits(target, aim).
template <class Hits>
void count_leaks(const Ball& ball, int count, uint64_t seed, const Hits& hits, Leaks& leaks) {
  Random random(seed);
  for (int i = 0; i < count; ++i) {
    const Target edge = ball.mesh.on_edge(random), vertex = ball.mesh.on_vertex(random);
    leaks.edge += !hits(edge, ball.aim_at(edge, i % 2 == 0, random));
    leaks.vertex += !hits(vertex, ball.aim_at(vertex, i % 2 == 0, random));
  }
}

bool kernel_hits(const Rimmed& mesh, const Target& target, const RayScene::Aim& aim) {
  const Shear shear(aim.direction);
  return mesh.any(target, [&](size_t t) {
    TriangleHit hit{};
    return intersect_triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), aim.origin, shear, hit) &&
           hit.t > 0.0;
  });
}

// A fan about one corner of the quad [0, 1] x [0, h], along the two sides that the corner is not on.
constexpr int kFan = 1000;
constexpr double kFanHeight = 5e-4;  // so that a triangle is 1 long and 1e-6 high
MeshData fan() {
  MeshData mesh;
  mesh.positions.push_back(Vec3(0.0));
  for (int j = 0; j <= kFan / 2; ++j) mesh.positions.push_back(kAcross + kFanHeight * j / (kFan / 2) * kAlong);
  for (int j = 1; j <= kFan / 2; ++j)
    mesh.positions.push_back((1.0 - j / (kFan / 2.0)) * kAcross + kFanHeight * kAlong);
  for (uint32_t k = 1; k <= kFan; ++k) mesh.indices.insert(mesh.indices.end(), {0, k, k + 1});
  return mesh;
}

// A ray from anywhere in front of the quad's plane to a point in it.
RayScene::Aim to_plane(const Vec3& at, Random& random) {
  Vec3 back = random.direction();
  if (glm::dot(back, kNormal) < 0.0) back = -back;
  const Vec3 eye = at + random.between(1.0, 3.0) * glm::normalize(back + 0.05 * kNormal);
  return {eye, at - eye};
}

// A point of the quad: inside it, or on an edge between two of the fan's triangles.
Vec3 in_fan(const MeshData& mesh, bool on_edge, Random& random) {
  if (on_edge) return random.between(0.001, 0.999) * mesh.positions[2 + random.next() % (kFan - 1)];
  return random.between(0.001, 0.999) * kAcross + kFanHeight * random.between(0.001, 0.999) * kAlong;
}

// A point of the plane beside the quad, by 1e-9 to 1e-3.
Vec3 beside_fan(Random& random) {
  const double gap = elementary::pow(10.0, random.between(-9.0, -3.0));
  const double along = random.unit(), across = kFanHeight * random.unit();
  switch (random.next() % 4) {
    case 0:
      return -gap * kAcross + across * kAlong;
    case 1:
      return (1.0 + gap) * kAcross + across * kAlong;
    case 2:
      return along * kAcross - gap * kAlong;
    default:
      return along * kAcross + (kFanHeight + gap) * kAlong;
  }
}

// By how many of its own ulps t lies outside of what the triangle's corners span along the ray. The bounds are formed
// in extended precision.
template <class Real>
double ulps_beyond(const Rimmed& mesh, size_t triangle, const RayScene::Aim& aim, Real t) {
  if (std::isnan(t)) return std::numeric_limits<double>::infinity();
  using Wide = glm::vec<3, long double>;
  const Wide direction = glm::normalize(Wide(aim.direction));
  long double low = std::numeric_limits<long double>::infinity(), high = -low;
  for (int k = 0; k < 3; ++k) {
    const long double at = glm::dot(Wide(mesh.corner(triangle, k)) - Wide(aim.origin), direction);
    low = std::min(low, at), high = std::max(high, at);
  }
  const Real ulp = std::nextafter(t, std::numeric_limits<Real>::infinity()) - t;
  return static_cast<double>(std::max({low - t, t - high, 0.0L}) / ulp);
}

// Baldwin and Weber 2016 (JCGT 5(3)) in float: the rows of the matrix from world to the triangle's own coordinates,
// one of whose columns is free.
bool baldwin_weber(const Vec3f& v0, const Vec3f& v1, const Vec3f& v2, const naive::RayF& ray, float& t) {
  const Vec3f e1 = v1 - v0, e2 = v2 - v0, n = glm::cross(e1, e2), size = glm::abs(n);
  const int z = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2, x = (z + 1) % 3, y = (z + 2) % 3;
  const float n_z = n[z], c1 = glm::cross(v1, v0)[z], c2 = glm::cross(v2, v0)[z];
  const auto plane = [&](const Vec3f& p) { return p[z] + n[x] / n_z * p[x] + n[y] / n_z * p[y]; };
  t = -(plane(ray.origin) - glm::dot(n, v0) / n_z) / plane(ray.direction);
  const Vec3f at = ray.origin + t * ray.direction;
  const float b1 = e2[y] / n_z * at[x] - e2[x] / n_z * at[y] + c2 / n_z;
  const float b2 = -e1[y] / n_z * at[x] + e1[x] / n_z * at[y] - c1 / n_z;
  return t > 0.0f && b1 >= 0.0f && b2 >= 0.0f && b1 + b2 <= 1.0f;
}

// A tube of `kSides` sides with caps; its long edges are 1e8 times the short ones.
MeshData tube() {
  constexpr uint32_t kSides = 12;
  MeshData mesh;
  const double radius = 1e-8 / elementary::sin(elementary::kPi / kSides);  // a side is 2e-8
  for (const double end : {-1.0, 1.0}) {
    mesh.positions.push_back(end * kNormal);
    for (uint32_t i = 0; i < kSides; ++i) {
      const double a = 2.0 * elementary::kPi * i / kSides;
      mesh.positions.push_back(end * kNormal + radius * (elementary::cos(a) * kAcross + elementary::sin(a) * kAlong));
    }
  }
  for (uint32_t i = 0; i < kSides; ++i) {
    const uint32_t a = 1 + i, b = 1 + (i + 1) % kSides, c = a + kSides + 1, d = b + kSides + 1;
    mesh.indices.insert(mesh.indices.end(), {0, a, b, a, c, b, b, c, d, kSides + 1, d, c});
  }
  return mesh;
}

}  // namespace

// 28 places and sizes, so many rays each that a million go to edges and a million to vertices.
Outcome edges_and_vertices(const Context& context) {
  constexpr double kOffsets[] = {0.0, 1e2, 1e4, 1e7}, kSizes[] = {1e-15, 1e-9, 1e-3, 1.0, 1e3, 1e9, 1e15};
  const int count = context.is_quick ? 2'000 : 36'000;
  Leaks rebased, bare, textbook;
  context.pool.parallel_for(std::size(kOffsets) * std::size(kSizes), Priority::normal, [&](int64_t i) {
    const double offset = kOffsets[i % 4], size = kSizes[i / 4];
    const Ball ball(size, offset * Vec3(1.0, -0.7, 0.3));
    const RayScene scene(mesh_document(ball.mesh.mesh()), context.pool);
    const auto seed = static_cast<uint64_t>(i);
    count_leaks(
        ball, count, seed,
        [&](const Target&, const RayScene::Aim& a) { return scene.nearest(a.origin, a.direction).is_hit; }, rebased);
    if (size != 1.0) return;
    if (offset <= 1e4)
      count_leaks(
          ball, context.is_quick ? count : 334'000, seed,
          [&](const Target& at, const RayScene::Aim& a) { return kernel_hits(ball.mesh, at, a); }, bare);
    if (offset == 0.0)
      count_leaks(
          ball, count, seed,
          [&](const Target& at, const RayScene::Aim& a) { return textbook_hits(ball.mesh, at, a.origin, a.direction); },
          textbook);
  });
  return {{at_most(0, "rays at edges that leak", static_cast<double>(rebased.edge)),
           at_most(0, "rays at vertices that leak", static_cast<double>(rebased.vertex)),
           at_most(0, "the same in the bare kernel, edges, offsets to 1e4", static_cast<double>(bare.edge)),
           at_most(0, "the same in the bare kernel, vertices", static_cast<double>(bare.vertex))},
          {at_most(0, "rays at edges that leak, %", percent(textbook.edge, count)),
           at_most(0, "rays at vertices that leak, %", percent(textbook.vertex, count))}};
}

Outcome sliver_fan(const Context& context) {
  const Rimmed mesh(fan());
  const RayScene scene(mesh_document(mesh.mesh()), context.pool);
  const int count = context.is_quick ? 20'000 : 200'000;
  int64_t leaks = 0, claimed_otherwise = 0, false_hits = 0, textbook_leaks = 0;
  double worst = 0.0, textbook_worst = 0.0;
  Random random(2);
  for (int i = 0; i < count; ++i) {
    const bool on_edge = i % 2 == 0;
    const RayScene::Aim aim = to_plane(in_fan(mesh.mesh(), on_edge, random), random);
    const RayScene::Hit hit = scene.nearest(aim.origin, aim.direction);
    leaks += !hit.is_hit;
    if (hit.is_hit) note(worst, ulps_beyond(mesh, hit.id & 0xFFFF'FFFFu, aim, hit.t));
    const RayScene::Aim past = to_plane(beside_fan(random), random);
    false_hits += scene.nearest(past.origin, past.direction).is_hit;
    if (i % 100 > 1) continue;  // what follows tries every triangle
    const Shear shear(aim.direction);
    const naive::RayF ray{Vec3f(aim.origin), Vec3f(glm::normalize(aim.direction))};
    int claims = 0, textbook_claims = 0;
    for (size_t t = 0; t < kFan; ++t) {
      const Vec3 &a = mesh.corner(t, 0), &b = mesh.corner(t, 1), &c = mesh.corner(t, 2);
      TriangleHit found{};
      claims += intersect_triangle(a, b, c, aim.origin, shear, found);
      const auto textbook = naive::triangle(ray, Vec3f(a), Vec3f(b), Vec3f(c), 0.0f, 0.0f);
      if (!textbook) continue;
      ++textbook_claims;
      note(textbook_worst, ulps_beyond(mesh, t, aim, textbook->t));
    }
    claimed_otherwise += on_edge ? claims < 1 || claims > 2 : claims != 1;
    textbook_leaks += textbook_claims == 0;
  }
  return {{at_most(0, "rays that leak", leaks), at_most(0, "rays beside the quad that hit it", false_hits),
           at_most(0, "rays not met once (on an edge: once or twice)", claimed_otherwise),
           at_most(4, "t outside of the triangle's bounds, ulp", worst)},
          {at_most(0, "rays that leak, %", percent(textbook_leaks, count / 50)),
           at_most(4, "t outside of the triangle's bounds, ulp of float", textbook_worst)}};
}

// The triangle's plane passes at distance 1 below the eye.
Outcome giant_triangle(const Context& context) {
  const auto at = [](double x, double y) { return x * kAcross + y * kAlong; };
  const Vec3 corners[] = {at(-1e7, -1e7), at(1e7, -1e7), at(0.0, 1e7)};
  const RayScene scene(mesh_document({"", {corners[0], corners[1], corners[2]}, {0, 1, 2}, {}, 30.0}), context.pool);
  const Vec3 eye = at(123.4, -56.7) + kNormal;
  const int count = context.is_quick ? 10'000 : 100'000;
  int64_t misses = 0, trumbore_off = 0, baldwin_misses = 0;
  double worst = 0.0;
  Random random(5);
  for (int i = 0; i < count; ++i) {
    Vec3 direction = random.direction();
    double slope = -glm::dot(direction, kNormal);
    if (slope < 0.0) direction = -direction, slope = -slope;
    if (slope < 1e-3) continue;
    const RayScene::Hit hit = scene.nearest(eye, direction);
    misses += !hit.is_hit;
    note(worst, std::abs(hit.t * slope - 1.0));
    const naive::RayF ray{Vec3f(eye), Vec3f(direction)};
    const auto textbook = naive::triangle(ray, Vec3f(corners[0]), Vec3f(corners[1]), Vec3f(corners[2]), 0.0f);
    trumbore_off += !textbook || !(std::abs(textbook->t * slope - 1.0) <= 1e-6);
    float t = 0.0f;
    baldwin_misses += !baldwin_weber(Vec3f(corners[0]), Vec3f(corners[1]), Vec3f(corners[2]), ray, t) ||
                      !(std::abs(t * slope - 1.0) <= 1e-6);
  }
  return {{at_most(0, "rays that miss", misses), at_most(1e-6, "t, relative error", worst)},
          {at_most(0, "Moeller-Trumbore: t off by more than 1e-6 or missed, %", percent(trumbore_off, count)),
           at_most(0, "Baldwin-Weber: t off by more than 1e-6 or missed, %", percent(baldwin_misses, count))}};
}

// From the axis of the tube every ray meets it.
Outcome needle_triangles(const Context& context) {
  const Rimmed mesh(tube());
  const RayScene scene(mesh_document(mesh.mesh()), context.pool);
  const int count = context.is_quick ? 20'000 : 200'000;
  int64_t leaks = 0, textbook_leaks = 0;
  Random random(9);
  for (int i = 0; i < count; ++i) {
    const Target target = i % 2 ? mesh.on_edge(random) : mesh.on_vertex(random);
    const Vec3 eye = random.between(-0.9, 0.9) * kNormal;
    leaks += !scene.nearest(eye, target.at - eye).is_hit;
    textbook_leaks += !textbook_hits(mesh, target, eye, target.at - eye, 0.0f);
  }
  return {{at_most(0, "rays that leak", leaks)}, {at_most(0, "rays that leak, %", percent(textbook_leaks, count))}};
}

// An affine map takes the triangle that a ray meets to the triangle that the mapped ray meets.
Outcome squeezed_instance(const Context& context) {
  const Vec3 squeeze(1e-8, 1.0, 1e8);
  const Rimmed mesh(icosphere(3));
  Rimmed squeezed = [&] {
    MeshData data = mesh.mesh();
    for (Vec3& p : data.positions) p *= squeeze;
    return Rimmed(data);
  }();
  const RayScene scene(mesh_document(mesh.mesh(), R"(,"scale":)" + text(squeeze)), context.pool);
  const int count = context.is_quick ? 10'000 : 100'000;
  int64_t leaks = 0, others = 0, textbook_leaks = 0;
  Random random(10);
  for (int i = 0; i < count; ++i) {
    const Target target = i % 2 ? mesh.on_edge(random) : mesh.on_vertex(random);
    const Vec3 eye = 0.3 * random.direction(), direction = (target.at - eye) * squeeze;
    leaks += !scene.nearest(eye * squeeze, direction).is_hit;
    textbook_leaks += !textbook_hits(squeezed, target, eye * squeeze, direction, 0.0f);

    const size_t triangle = random.next() % mesh.triangle_count();
    const double b0 = random.between(0.01, 0.49), b1 = random.between(0.01, 0.49);
    const Vec3 inside =
        b0 * mesh.corner(triangle, 0) + b1 * mesh.corner(triangle, 1) + (1.0 - b0 - b1) * mesh.corner(triangle, 2);
    const RayScene::Hit hit = scene.nearest(eye * squeeze, (inside - eye) * squeeze);
    others += !hit.is_hit || (hit.id & 0xFFFF'FFFFu) != triangle;
  }
  return {{at_most(0, "rays that leak", leaks), at_most(0, "rays that meet another triangle", others)},
          {at_most(0, "rays that leak, %", percent(textbook_leaks, count))}};
}

// A ball of two open meshes, which meet along the edges of its triangles: from inside no ray passes between them. The
// lower half is stored twice as large and the upper one half as large, and their instances undo that. (Placements that
// round, such as different shifts, part the seam by that rounding; then no test a mesh at a time can close it.)
Outcome seam_of_meshes(const Context& context) {
  const Rimmed ball(icosphere(3));
  MeshData halves[2] = {placed(ball.mesh(), 2.0, Vec3(0.0)), placed(ball.mesh(), 0.5, Vec3(0.0))};
  std::vector<int> halves_of(ball.mesh().positions.size(), 0);  // by vertex, a bit each
  for (MeshData& half : halves) half.indices.clear();
  for (size_t t = 0; t < ball.triangle_count(); ++t) {
    const size_t half = ball.corner(t, 0).y + ball.corner(t, 1).y + ball.corner(t, 2).y < 0.0 ? 0 : 1;
    for (size_t i = 3 * t; i < 3 * t + 3; ++i) {
      halves[half].indices.push_back(ball.mesh().indices[i]);
      halves_of[ball.mesh().indices[i]] |= 1 << half;
    }
  }
  const RayScene scene(R"({"lights":[],"meshes":{"lower":)" + mesh_text(halves[0]) + R"(,"upper":)" +
                           mesh_text(halves[1]) + R"(},"objects":[{"type":"mesh","mesh":"lower","scale":0.5},
                           {"type":"mesh","mesh":"upper","scale":2}]})",
                       context.pool);
  const int count = context.is_quick ? 10'000 : 100'000;
  int64_t leaks = 0, textbook_leaks = 0;
  Random random(11);
  for (int i = 0; i < count;) {
    const Target target = ball.on_edge(random);
    if (halves_of[target.a] != 3 || halves_of[target.b] != 3) continue;
    const Vec3 eye = 0.3 * random.direction();
    leaks += !scene.nearest(eye, target.at - eye).is_hit;
    textbook_leaks += !textbook_hits(ball, target, eye, target.at - eye, 0.0f);
    ++i;
  }
  return {{at_most(0, "rays at the seam that leak", leaks)},
          {at_most(0, "rays at the seam that leak, %", percent(textbook_leaks, count))}};
}

}  // namespace tilelight::check
