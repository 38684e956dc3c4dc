// SPDX-License-Identifier: Apache-2.0
// How the reference renderer meets one body: rays in world space and double, hits in the body's local space. Written
// from the model, independently of the kernels. Lengths in scene units. Immutable after construction; any thread.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderer/compile/bodies.h"
#include "renderer/measure/box_tree.h"

namespace tilelight::reference {

inline constexpr uint32_t kNoBody = ~0u;

// Distances under kRounding * (size of the numbers involved) are rounding noise: transforming a point into a local
// frame and back costs some 20 roundings of 2^-53 each; the rest is margin.
inline constexpr double kRounding = 0x1p-46;

// A point on a body's surface, kept in local space, where it can lie on the surface exactly.
struct Hit {
  double t = 0.0;  // along the ray, in lengths of its direction
  uint32_t body = kNoBody;
  uint32_t primitive = 0;  // meshes: the triangle; boxes: 2 * axis of the face, + 1 on the positive side
  Vec3 local{0.0};         // meshes: rounded; other kinds: on the surface
  Vec3 barycentric{0.0};   // meshes
};

// What a ray that starts on a surface does with other bodies' surfaces in the very same place. They lie there in the
// order of Body::rank: films, opaque things, media. On the way on from a film those after it are met, on the way back
// the films before it. Media in one place are crossed together: a ray that goes on from them meets none.
enum class Coincident { none, after, before };

struct Ray {
  Vec3 origin{0.0}, direction{0.0};  // direction of unit length
  Hit left{};                        // the surface it starts on; body = kNoBody for a ray from the eye
  Coincident coincident = Coincident::none;
  double noise = 0.0;  // distances of this size around the origin are rounding
};

// One mesh with its tree; shared by instances.
struct MeshTree {
  explicit MeshTree(std::shared_ptr<const TriMesh> m);
  std::shared_ptr<const TriMesh> mesh;
  BoxTree tree;  // local space
};

// A body with its matrices ready. local = local_from_world * (world - translation).
struct ReferenceBody {
  explicit ReferenceBody(const Body& body, std::shared_ptr<const MeshTree> mesh_tree);

  BodyKind kind;
  Mat3 world_from_local, local_from_world, normal_from_local;
  Vec3 translation;
  Vec3 half;
  Mat4 pattern_from_local;
  Mat3 pattern_normal_from_local;
  MaterialId material;
  std::shared_ptr<const MeshTree> mesh;
  bool has_inside;  // light can be bent on its way in and out
  // Asked of every mesh of a document that light goes through, so that no search for such places is trusted.
  bool may_touch_itself;
  Layer layer;
  uint32_t rank;
  Box bounds;            // world space; infinite for planes
  double extent;         // largest coordinate of the bounds; planes: of their point
  double face_rounding;  // how far a face may lie from where the document puts it

  Vec3 local_point(const Vec3& world) const { return local_from_world * (world - translation); }
  Vec3 world_point(const Vec3& local) const { return world_from_local * local + translation; }
};

// Where a surface lies and how it is turned; normals of unit length, outward.
struct SurfacePoint {
  Vec3 point;      // world
  Vec3 geometric;  // of the surface itself
  Vec3 shading;    // interpolated on meshes with vertex normals
};
SurfacePoint surface_at(const ReferenceBody& body, const Hit& hit);

// Meshes with vertex normals stand for a curved surface. How far above the facet that surface is taken to be, seen from
// outside or from inside: each corner's tangent plane is asked, and the answers mixed as the normals are (Hanika 2021,
// Ray Tracing Gems II ch. 4). A world vector; none on other surfaces.
std::optional<Vec3> lift_to_curve(const ReferenceBody& body, const Hit& hit, bool is_inside);
// How far a facet is turned from the normals at its corners (the length of the difference of unit vectors), and its
// size, in the world. REQUIRES: a mesh with vertex normals.
struct RoundedFacet {
  double turn = 0.0, longest_edge = 0.0;
};
RoundedFacet rounded_facet(const ReferenceBody& body, const Hit& hit);
// Whether the triangles of two hits meet in a corner without a crease. REQUIRES: the same.
bool are_of_one_curve(const ReferenceBody& body, const Hit& one, const Hit& other);
Vec3 geometric_normal(const ReferenceBody& body, const Hit& hit);
// The largest angle between a facet's normal and those given to its corners, radians; 0 on other surfaces.
double facet_spread(const ReferenceBody& body, const Hit& hit);

// The colour's place in the body's checker: the pattern point, and the axis that does not count (-1: all three do).
struct PatternPoint {
  Vec3 point;
  int ignored_axis;
};
PatternPoint pattern_at(const ReferenceBody& body, const Hit& hit);

// Where a ray meets a sphere, box or plane, nearest first; places with t <= 0 are among them, the surface that the ray
// has just left is not.
struct AnalyticHits {
  std::array<Hit, 2> hits;
  int count = 0;
};
AnalyticHits analytic_hits(const ReferenceBody& body, uint32_t id, const Ray& ray);

// A ray in a mesh's local space, sheared so that it runs along +z (Woop, Benthin, Wald 2013, JCGT 2(1)): the edge
// functions of an edge shared by two triangles are then exact opposites, so nothing slips between them.
struct ShearedRay {
  ShearedRay(const Vec3& local_origin, const Vec3& local_direction);
  Vec3 origin, direction;
  int kx, ky, kz;
  double sx, sy, sz;
};
std::optional<Hit> triangle_hit(const TriMesh& mesh, uint32_t body, uint32_t triangle, const ShearedRay& ray);

// Where a neighbouring ray meets the same surface, extended beyond its edges. None if it misses.
std::optional<Hit> hit_same_surface(const ReferenceBody& body, const Hit& hit, const Vec3& origin,
                                    const Vec3& direction);

// Of a solid around a point: how far it is along `direction` to where the solid ends. A mesh whose shells overlap may
// be around it several times, and ends as often; none: the point is outside.
std::vector<double> exit_distances(const ReferenceBody& body, const Vec3& point, const Vec3& direction);

}  // namespace tilelight::reference
