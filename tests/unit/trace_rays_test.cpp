// SPDX-License-Identifier: Apache-2.0
// The ray kernels against closed forms and against the laws they promise: watertight, the same on every instruction
// set.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/shots.h"
#include "renderer/compile/compile.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/intersect.h"
#include "renderer/trace/isa.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight {
namespace {

using check::icosphere, check::scene_of_shapes;

Hit closest(const CompiledScene& scene, const Ray& ray) {
  const BoundedRay bounded{ray};
  Hit hit;
  trace_closest(scene, {&bounded, 1}, {&hit, 1});
  return hit;
}

class TraceRays : public testing::Test {
 protected:
  void TearDown() override { (void)select_isa("auto"); }
  TilePool pool_{2};
};

constexpr auto kAhead = [](double t, uint32_t) { return t > 0.0; };
constexpr auto kExact = [] { return Vec3(0.0); };

TEST_F(TraceRays, TakeTheFacetsNormalWhereOppositeOnesCancel) {
  MeshData square;  // normals to the viewer on the left, from him on the right
  square.positions = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  square.indices = {0, 1, 2, 0, 2, 3};
  square.normals = {{0, 0, 1}, {0, 0, -1}, {0, 0, -1}, {0, 0, 1}};
  Scene scene = scene_of_shapes({MeshShape{0}});
  scene.meshes = {square};
  const auto compiled = compile_scene(scene, pool_);
  for (const double y : {-0.75, -0.5, -0.125, 0.25, 0.5}) {
    const Ray ray{Vec3(0.0, y, 2.0), Vec3(0.0, 0.0, -1.0), {}, {}};
    const Hit hit = closest(*compiled, ray);
    ASSERT_TRUE(hit.is_hit());
    EXPECT_EQ(make_surface(*compiled, ray, hit).normal, Vec3(0.0, 0.0, 1.0)) << y;
  }
}

TEST_F(TraceRays, AimedAtEdgesAndVerticesOfAClosedMeshNeverLeakThrough) {
  for (const double far : {0.0, 1e2, 1e4, 1e7}) {
    Scene scene = scene_of_shapes({MeshShape{0}});
    scene.meshes = {icosphere(3)};
    const MeshData& mesh = scene.meshes[0];
    const auto compiled = compile_scene(scene, pool_);
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int leaks = 0;
    for (size_t i = 0; i < mesh.indices.size(); ++i) {
      const Vec3 a = mesh.positions[mesh.indices[i]];
      const Vec3 b = mesh.positions[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]];
      const Vec3 aim = i % 4 == 0 ? a : glm::mix(a, b, unit(random));
      const Vec3 from = aim * (3.0 + far) + Vec3(unit(random), unit(random), unit(random));
      // The compiled scene is normalised about the ball's own centre and radius.
      const Vec3 o = (from - compiled->center) / compiled->units, p = (aim - compiled->center) / compiled->units;
      leaks += !closest(*compiled, {o, glm::normalize(p - o), {}}).is_hit();
    }
    EXPECT_EQ(leaks, 0) << "of " << mesh.indices.size() << " rays from " << far << " away";
  }
}

TEST_F(TraceRays, HitASphereWhereTheQuadraticSays) {
  const auto compiled = compile_scene(scene_of_shapes({SphereShape{{0, 0, 0}, 1}}), pool_);
  for (const double distance : {2.0, 1e3, 1e6}) {
    for (const double b : {0.0, 0.3, 0.9, 0.999}) {
      const Hit hit = closest(*compiled, {{b, 0, distance}, {0, 0, -1}, {}});
      ASSERT_TRUE(hit.is_hit());
      EXPECT_NEAR(hit.t, distance - std::sqrt(1 - b * b), 1e-12 * distance);
    }
    EXPECT_FALSE(closest(*compiled, {{1.0 + 1e-6, 0, distance}, {0, 0, -1}, {}}).is_hit());
  }
  EXPECT_NEAR(closest(*compiled, {{0, 0, 0}, {0, 0, -1}, {}}).t, 1.0, 1e-15);  // from inside
}

TEST_F(TraceRays, ABoxKeepsTheRaysThatRunInItsFaces) {
  double t = 0.0;
  uint32_t face = 0;
  for (const double zero : {0.0, -0.0}) {
    EXPECT_TRUE(intersect_box(Vec3(1.0), {{1.0, 0.3, 5.0}, {zero, 0.0, -1.0}}, kNone, kAhead, kExact, t, face));
    EXPECT_DOUBLE_EQ(t, 4.0);
    EXPECT_FALSE(
        intersect_box(Vec3(1.0), {{1.0 + 1e-15, 0.3, 5.0}, {zero, 0.0, -1.0}}, kNone, kAhead, kExact, t, face));
  }
  // Flat: hit once, from both sides.
  EXPECT_TRUE(intersect_box({1, 0, 1}, {{0.2, 3, 0.1}, {0, -1, 0}}, kNone, kAhead, kExact, t, face));
  EXPECT_DOUBLE_EQ(t, 3.0);
  EXPECT_FALSE(intersect_box({1, 0, 1}, {{0.2, 0, 0.1}, {0, -1, 0}}, face, kAhead, kExact, t, face));
}

TEST_F(TraceRays, AimedAtEdgesOfABoxNearlyAlongAFaceNeverMissIt) {
  std::mt19937_64 random(13);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto any = [&] {
    const double x = unit(random), y = unit(random), z = unit(random);
    return Vec3(x, y, z);
  };
  int misses = 0;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 lower = any() * (i % 4 ? 1.0 : 1000.0), upper = lower + 0.1 + any();
    // The larger box beside it takes the middle of the scene away from the middle of the box.
    const auto compiled =
        compile_scene(scene_of_shapes({BoxShape{lower, upper}, BoxShape{lower - 9.0, lower - 8.0}}), pool_);
    Vec3 target = glm::mix(lower, upper, any()), direction = any() - 0.5;
    target[i % 3] = lower[i % 3], target[(i + 1) % 3] = upper[(i + 1) % 3];
    direction[i % 3] *= i % 2 ? 1.0 : 1e-6;
    const Vec3 from = target + 4.0 * direction;
    misses +=
        !closest(*compiled, {(from - compiled->center) / compiled->units, glm::normalize(target - from), {}}).is_hit();
  }
  EXPECT_EQ(misses, 0);
}

TEST_F(TraceRays, DoNotSlipBetweenTwoBoxesThatShareAFace) {
  std::vector<Shape> wall;
  for (int i = 0; i < 64; ++i) wall.push_back(BoxShape{{0.1 * i, -0.3, 0.1}, {0.1 * (i + 1), 0.4, 0.7}});
  const auto compiled = compile_scene(scene_of_shapes(wall), pool_);
  for (int i = 1; i < 64; ++i) {
    const Vec3 from(0.1 * i, 0.05, 3.0);
    EXPECT_TRUE(closest(*compiled, {(from - compiled->center) / compiled->units, {0, 0, -1}, {}}).is_hit()) << i;
  }
}

TEST_F(TraceRays, FromASheetOnAFloorReachTheLightWhereverTheSheetIsSeen) {
  constexpr double kGap = 5e-14;  // more than the noise of a ray from the eye, less than that of one from a surface
  const auto compiled = compile_scene(
      scene_of_shapes({BoxShape{{-1, -1, -1}, {1, 0, 1}}, BoxShape{{-0.8, kGap, -0.8}, {0.8, kGap, 0.8}}}), pool_);
  const Ray down{Vec3(0.3, 1.0, 0.2) - compiled->center, {0, -1, 0}, {}};
  const Hit hit = closest(*compiled, down);
  ASSERT_TRUE(hit.is_hit());
  ASSERT_EQ(compiled->bodies[hit.body].body, 1u);
  const Vec3 place = down.origin + hit.t * down.direction;
  EXPECT_FALSE(closest(*compiled, {place, {0, 1, 0}, {hit.body, hit.prim}, Coincident::before}).is_hit());
}

TEST_F(TraceRays, CoincidentBodiesShowTheLowestEverywhere) {
  const auto compiled =
      compile_scene(scene_of_shapes({BoxShape{{-1, -1, 0}, {1, 1, 0}}, BoxShape{{-1, -1, 0}, {1, 1, 0}}}), pool_);
  for (int i = 0; i < 200; ++i) {
    const Vec3 aim(0.009 * (i - 100), 0.007 * (i - 90), 0.0), from(0.3, 0.2, 2.0);
    const Hit hit = closest(*compiled, {from, glm::normalize(aim - from), {}});
    ASSERT_TRUE(hit.is_hit());
    EXPECT_EQ(compiled->bodies[hit.body].body, 0u);
  }
}

TEST_F(TraceRays, TellSpheresApartThatHalveSixtyTimesTowardsTheOrigin) {
  std::vector<Shape> row;
  for (int k = 0; k <= 60; ++k) row.push_back(SphereShape{{3.0 * std::ldexp(1.0, -k), 0, 0}, std::ldexp(1.0, -k)});
  const auto compiled = compile_scene(scene_of_shapes(row), pool_);
  const auto from = [&](const Vec3& eye, const Vec3& direction) {
    return closest(*compiled, {(eye - compiled->center) / compiled->units, direction, {}});
  };
  for (int k = 0; k <= 60; ++k) {
    const double radius = std::ldexp(1.0, -k);
    const Hit hit = from({3.0 * radius, 9.0 * radius, 0.0}, {0, -1, 0});
    ASSERT_TRUE(hit.is_hit()) << k;
    EXPECT_EQ(compiled->bodies[hit.body].body, static_cast<uint32_t>(k));
    EXPECT_DOUBLE_EQ(hit.t * compiled->units, 8.0 * radius);
  }
  EXPECT_EQ(compiled->bodies[from(Vec3(0.0), {1, 0, 0}).body].body, 60u);
}

TEST_F(TraceRays, ThatTouchASphereBehindThemDoNotHitIt) {
  double t = 0.0;
  for (const double x : {1.0, -1.0}) {
    EXPECT_FALSE(intersect_sphere({{x, 0.5, 0}, {0, 1, 0}}, false, kAhead, t));  // both roots are -0.5
    EXPECT_FALSE(intersect_sphere({{x, 0.0, 0}, {0, 1, 0}}, false, kAhead, t));  // both are 0
    ASSERT_TRUE(intersect_sphere({{x, -0.5, 0}, {0, 1, 0}}, false, kAhead, t));
    EXPECT_EQ(t, 0.5);
  }
}

// Any hit is sometimes accepted in float; the nearest hit never is.
TEST_F(TraceRays, OfAnyHitAgreeWithThoseOfTheNearest) {
  for (const double size : {1.0, 1e-9}) {
    Scene scene = scene_of_shapes({MeshShape{0}, MeshShape{0}, PlaneShape{{0, -1, 0}, {0, 1, 0}}});
    scene.meshes = {icosphere(3)};
    scene.objects[1].world_from_shape = Mat4(size);
    scene.objects[1].world_from_shape[3] = Vec4(1.2, 0.3, 0, 1);
    const auto compiled = compile_scene(scene, pool_);
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto direction = [&] { return glm::normalize(Vec3(unit(random), unit(random), unit(random))); };
    std::vector<BoundedRay> first(20'000), rays;
    const auto towards = [&](const Vec3& from) { return glm::normalize(0.9 * direction() - from); };
    for (BoundedRay& ray : first) {
      const Vec3 from = 3.0 * direction();
      ray = {{from, towards(from), {}}};
    }
    std::vector<Hit> hits(first.size());
    trace_closest(*compiled, first, hits);
    for (size_t i = 0; i < first.size(); ++i) {  // from surfaces, to just before, at and beyond what comes next
      if (!hits[i].is_hit()) continue;
      const Vec3 place = first[i].ray.origin + hits[i].t * first[i].ray.direction;
      BoundedRay ray{{place, towards(place), {hits[i].body, hits[i].prim}, Coincident::before}};
      Hit next;
      trace_closest(*compiled, {&ray, 1}, {&next, 1});
      for (const double factor : {1.0 - 1e-15, 1.0, 1.0 + 1e-15, 0.5, 1.0 - 1e-7, 1.0 + 1e-7}) {
        ray.t_max = next.t * factor;
        rays.push_back(ray);
      }
    }
    std::vector<Hit> expected(rays.size());
    trace_closest(*compiled, rays, expected);
    ASSERT_GT(std::count_if(expected.begin(), expected.end(), [](const Hit& h) { return h.is_hit(); }), 1000);
    for (const std::string& isa : available_isas()) {
      ASSERT_TRUE(select_isa(isa).has_value());
      std::vector<uint8_t> is_blocked(rays.size());
      trace_any(*compiled, rays, is_blocked);
      int differing = 0;
      for (size_t i = 0; i < rays.size(); ++i) differing += static_cast<bool>(is_blocked[i]) != expected[i].is_hit();
      EXPECT_EQ(differing, 0) << isa << ", size " << size;
    }
  }
}

// A packet keeps its hits to within a float at first, also those that it has computed in double.
TEST_F(TraceRays, MeetNothingAtTheirEndsOrBeyondThem) {
  for (const Shape& shape : {Shape(MeshShape{0}), Shape(SphereShape{{0, 0, 0}, 1.0})}) {
    Scene scene = scene_of_shapes({shape});
    scene.meshes = {icosphere(3)};
    const auto compiled = compile_scene(scene, pool_);
    std::vector<BoundedRay> rays;
    for (int i = 0; i < 32; ++i) {
      const Vec3 from(0.01 * (i % 8), 0.01 * (i / 8), 3.0);
      rays.push_back({{from, glm::normalize(Vec3(0.1, 0.2, 0.0) - from), {}}});
    }
    std::vector<Hit> nearest(rays.size()), hits(rays.size());
    trace_closest(*compiled, rays, nearest);
    for (const double factor : {1.0 - 1e-7, 1.0 - 1e-12, 1.0, 1.0 + 1e-12, 1.0 + 1e-7}) {
      for (size_t i = 0; i < rays.size(); ++i) rays[i].t_max = nearest[i].t * factor;
      for (const std::string& isa : available_isas()) {
        ASSERT_TRUE(select_isa(isa).has_value());
        trace_closest(*compiled, rays, hits);
        for (size_t i = 0; i < rays.size(); ++i) {
          ASSERT_TRUE(nearest[i].is_hit());
          EXPECT_EQ(hits[i].is_hit(), nearest[i].t < rays[i].t_max) << isa << ", ray " << i << ", " << factor;
        }
      }
    }
  }
}

// Neighbouring rays are walked together, through a tree that holds most meshes' triangles; what they meet may not
// depend on that in a bit.
TEST_F(TraceRays, MeetInBundlesWhatTheyMeetOneByOneAndInMeshesTreesOfTheirOwn) {
  Scene scene = scene_of_shapes({MeshShape{0}, SphereShape{{1.5, 0, 0}, 0.7}, BoxShape{{-3, -1, -1}, {-1.2, 1, 1}},
                                 BoxShape{{-2, -1.5, -2}, {2, -1, 2}}, PlaneShape{{0, -1.5, 0}, {0, 1, 0}},
                                 MeshShape{0}, MeshShape{0}, MeshShape{0}});
  scene.meshes = {icosphere(3)};
  scene.objects[5].world_from_shape = Mat4(Mat3(0.01, 0, 0, 0, 2, 0, 0, 0, 0.3));
  scene.objects[5].world_from_shape[3] = Vec4(0.2, 0.4, 1.6, 1.0);
  scene.objects[6].world_from_shape = Mat4(Mat3(1e-5));
  scene.objects[6].world_from_shape[3] =
      Vec4(0.0, 1.0, 0.0, 1.0);  // a grain on top of the ball; the last is the ball again
  const auto compiled = compile_scene(scene, pool_);
  const TriangleTree own = build_mesh_tree(*compiled->meshes[0], pool_);
  CompiledScene apart = *compiled;
  int merged = 0;
  for (CompiledBody& body : apart.bodies) {
    if (body.kind != BodyKind::mesh) continue;
    merged += body.tree == nullptr;
    body.tree = &own;
  }
  apart.tree = build_scene_tree(apart, pool_);
  EXPECT_EQ(merged, 3);  // all but the grain
  const Vec3 lamp = (Vec3(3.0, 4.0, 2.0) - compiled->center) / compiled->units;
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto anywhere = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  const auto one_by_one = [&](const std::vector<BoundedRay>& rays) {
    std::vector<Hit> hits(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) trace_closest(*compiled, {&rays[i], 1}, {&hits[i], 1});
    return hits;
  };
  std::vector<std::vector<BoundedRay>> bundles;
  for (int i = 0; i < 600; ++i) {
    const double distance = std::pow(10.0, i % 6 * 2.0 - 1.0), spread = std::pow(10.0, -0.5 * (i % 11));
    const Vec3 target = i % 5 == 0 ? (Vec3(0.0, 1.0, 0.0) - compiled->center) / compiled->units : 0.5 * anywhere();
    const Vec3 eye = target + distance * glm::normalize(anywhere());
    std::vector<BoundedRay> rays, shadows;
    for (int k = 0; k < 5 + i % 40; ++k)
      rays.push_back({{eye, glm::normalize(target + 0.3 * spread * anywhere() - eye), {}}});
    const std::vector<Hit> hits = one_by_one(rays);
    for (size_t k = 0; k < rays.size(); ++k) {
      if (!hits[k].is_hit()) continue;
      const Surface surface = make_surface(*compiled, rays[k].ray, hits[k]);
      const double to_lamp = glm::length(lamp - surface.position);
      shadows.push_back(
          {{surface.position, (lamp - surface.position) / to_lamp, surface.here, Coincident::before}, to_lamp});
    }
    bundles.push_back(rays);
    if (!shadows.empty()) bundles.push_back(shadows);
  }
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    int differing = 0, blocked_otherwise = 0, met = 0;
    for (const auto& rays : bundles) {
      const std::vector<Hit> expected = one_by_one(rays);
      for (const CompiledScene* same : {compiled.get(), static_cast<const CompiledScene*>(&apart)}) {
        std::vector<Hit> hits(rays.size());
        std::vector<uint8_t> is_blocked(rays.size());
        trace_closest(*same, rays, hits);
        trace_any(*same, rays, is_blocked);
        for (size_t i = 0; i < rays.size(); ++i) {
          const Hit &a = hits[i], &b = expected[i];
          differing += a.t != b.t || a.body != b.body || a.prim != b.prim || a.b0 != b.b0 || a.b1 != b.b1;
          blocked_otherwise += static_cast<bool>(is_blocked[i]) != b.is_hit();
          met += b.is_hit();
        }
      }
    }
    EXPECT_EQ(differing, 0) << isa;
    EXPECT_EQ(blocked_otherwise, 0) << isa;
    EXPECT_GT(met, 5000) << isa;
  }
}

// The filter of packets knows how far its float numbers may be off. Here they are off by about as much as a ray is
// from an edge: triangles large and tiny, near and far, thin and edge-on, and rays a few roundings beside their edges.
TEST_F(TraceRays, AimedBesideEdgesMeetInBundlesWhatTheyMeetOneByOne) {
  std::mt19937_64 random(31);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto anywhere = [&] { return Vec3(unit(random), unit(random), unit(random)); };
  constexpr uint32_t kTriangles = 3000;
  MeshData soup;
  for (uint32_t i = 0; i < kTriangles; ++i) {
    const double size = std::ldexp(1.0, -static_cast<int>(i % 12)), thin = i % 5 == 0 ? 1e-3 : 1.0;
    const Vec3 corner = 0.9 * anywhere(), e = size * anywhere();
    for (const Vec3& p : {corner, corner + e, corner + 0.4 * e + thin * size * anywhere()}) {
      soup.indices.push_back(static_cast<uint32_t>(soup.positions.size()));
      soup.positions.push_back(glm::clamp(p, Vec3(-1.0), Vec3(1.0)));
    }
  }
  Scene scene = scene_of_shapes({MeshShape{0}});
  scene.meshes = {soup};
  const auto compiled = compile_scene(scene, pool_);
  ASSERT_EQ(compiled->bodies[0].tree, nullptr);  // merged
  const auto in_scene = [&](const Vec3& p) { return (p - compiled->center) / compiled->units; };
  std::vector<std::vector<BoundedRay>> bundles;
  for (uint32_t i = 0; i < 12'000; ++i) {
    const uint32_t* corners = &soup.indices[3 * (i % kTriangles)];
    const Vec3 a = in_scene(soup.positions[corners[i / 7 % 3]]), b = in_scene(soup.positions[corners[(i / 7 + 1) % 3]]);
    const double distance = std::ldexp(1.0, static_cast<int>(random() % 18) - 6);            // 0.016 to 2048
    const Vec3 aside = i % 6 == 0 ? glm::normalize(b - a + 1e-3 * anywhere()) : anywhere();  // some look along the edge
    const bool is_sparse = i % 4 == 3;                                                       // they go each its own way
    std::vector<BoundedRay> rays;
    for (int k = 0; k < 32; ++k) {
      const Vec3 on_edge = glm::mix(a, b, 0.5 + 0.5 * unit(random));
      const Vec3 aim = on_edge + std::ldexp(unit(random), -21 - static_cast<int>(random() % 8)) * anywhere();
      const Vec3 eye = a + distance * (is_sparse ? anywhere() : aside);
      rays.push_back({{eye, glm::normalize(aim - eye), {}}, k % 8 == 7 ? glm::length(aim - eye) : INFINITY});
    }
    bundles.push_back(rays);
  }
  std::vector<std::vector<Hit>> expected;
  int met = 0, beside = 0;
  for (const auto& rays : bundles) {
    auto& hits = expected.emplace_back(rays.size());
    for (size_t i = 0; i < rays.size(); ++i) trace_closest(*compiled, {&rays[i], 1}, {&hits[i], 1});
    met += static_cast<int>(std::count_if(hits.begin(), hits.end(), [](const Hit& h) { return h.is_hit(); }));
    for (const Hit& h : hits) beside += h.is_hit() && std::min({h.b0, h.b1, 1.0 - h.b0 - h.b1}) < 1e-5;
  }
  EXPECT_GT(met, 100'000);
  EXPECT_GT(beside, 20'000);
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    int differing = 0, blocked_otherwise = 0;
    for (size_t b = 0; b < bundles.size(); ++b) {
      std::vector<Hit> hits(bundles[b].size());
      std::vector<uint8_t> is_blocked(bundles[b].size());
      trace_closest(*compiled, bundles[b], hits);
      trace_any(*compiled, bundles[b], is_blocked);
      for (size_t i = 0; i < hits.size(); ++i) {
        const Hit &x = hits[i], &y = expected[b][i];
        differing += x.t != y.t || x.body != y.body || x.prim != y.prim || x.b0 != y.b0 || x.b1 != y.b1;
        blocked_otherwise += static_cast<bool>(is_blocked[i]) != y.is_hit();
      }
    }
    EXPECT_EQ(differing, 0) << isa;
    EXPECT_EQ(blocked_otherwise, 0) << isa;
  }
}

// Where slopes are a little above 1 and every rounding falls the worst way, the filter's bounds are nearly used up.
TEST_F(TraceRays, FallTheWorstWayAndStillMeetWhatTheyMeetOneByOne) {
  constexpr double kUlp = 0x1p-24;
  struct Case {
    Vec3 origin, direction, vertex;
  };
  const Case cases[] = {{{0.0, -0.00072032211799232752, -0.00098729136429610669},
                         {0.0, 0.70700951770244436, 0.7072040312937683},
                         {0.0, 0.99998077750355008, 0.99998673796504733}},
                        {{0.0, -7.1585176610460617e-05, -6.4134599543103836e-05},
                         {0.0, 0.70711371396555289, 0.7070998483395694},
                         {0.0, 0.99999317526966336, 0.99997863173335788}}};
  for (const Case& c : cases) {
    for (int height = -64; height <= 64; ++height) {
      // A sliver across the ray's plane, its base a few roundings above or below its tip; the frame keeps the scene in
      // place.
      MeshData sliver, frame;
      const double base = c.vertex.y + height * kUlp;
      sliver.positions = {c.vertex, {0.0023, base, c.vertex.z}, {-0.0023, base, c.vertex.z}};
      sliver.indices = {0, 1, 2};
      frame.positions = {{-1, -1, -1}, {-1, -1, -0.9}, {-1, -0.9, -1}, {1, 1, 1}, {1, 1, 0.9}, {1, 0.9, 1}};
      frame.indices = {0, 1, 2, 3, 4, 5};
      Scene scene = scene_of_shapes({MeshShape{0}, MeshShape{1}});
      scene.meshes = {sliver, frame};
      const auto compiled = compile_scene(scene, pool_);
      ASSERT_EQ(compiled->center, Vec3(0.0));
      ASSERT_EQ(compiled->units, 1.0);
      std::vector<BoundedRay> rays(32, {{c.origin, glm::normalize(c.direction), {}}});
      for (size_t i = 16; i < 32; ++i) rays[i].ray.direction = glm::normalize(Vec3(0.0, 1.0 - 3e-4, 1.0));
      Hit alone;
      trace_closest(*compiled, {&rays[0], 1}, {&alone, 1});
      for (const std::string& isa : available_isas()) {
        ASSERT_TRUE(select_isa(isa).has_value());
        std::vector<Hit> hits(rays.size());
        trace_closest(*compiled, rays, hits);
        EXPECT_EQ(hits[0].body, alone.body) << isa << ", base at " << height;
        EXPECT_EQ(hits[0].t, alone.t) << isa << ", base at " << height;
      }
    }
  }
}

TEST_F(TraceRays, GiveTheSameBitsOnEveryInstructionSet) {
  Scene scene = scene_of_shapes(
      {MeshShape{0}, SphereShape{{1.5, 0, 0}, 0.7}, BoxShape{{-3, -1, -1}, {-1.2, 1, 1}}, PlaneShape{}});
  scene.meshes = {icosphere(3)};
  const auto compiled = compile_scene(scene, pool_);
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  std::vector<BoundedRay> rays;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 from(unit(random) * 2, unit(random) * 2, unit(random) * 2);
    const Vec3 to(unit(random), unit(random), unit(random));
    rays.push_back({{from, glm::normalize(to - from), {}}});
  }
  std::vector<Hit> expected(rays.size());
  trace_closest(*compiled, rays, expected);
  ASSERT_GE(available_isas().size(), 2u);
  for (const std::string& isa : available_isas()) {
    ASSERT_TRUE(select_isa(isa).has_value());
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> is_blocked(rays.size());
    trace_closest(*compiled, rays, hits);
    trace_any(*compiled, rays, is_blocked);
    int differing = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      differing += hits[i].t != expected[i].t || hits[i].body != expected[i].body || hits[i].prim != expected[i].prim;
      differing += static_cast<bool>(is_blocked[i]) != expected[i].is_hit();
    }
    EXPECT_EQ(differing, 0) << isa;
  }
  EXPECT_FALSE(select_isa("MMX").has_value());
}

}  // namespace
}  // namespace tilelight
