// SPDX-License-Identifier: Apache-2.0
// TextbookTracer: a whole renderer by the naive forms: float in the user's own units, Moeller-Trumbore under one
// bounding sphere a mesh, min/max slabs, b^2 - 4ac, rays lifted off surfaces by a fixed epsilon, facets without shading
// normals. Local light and shadows; no recursion. What it gets wrong on a scene is what users of such a renderer would
// have to scale away.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/check/kit/naive.h"
#include "renderer/compile/bodies.h"
#include "renderer/scene/scene.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight::check {

class TextbookTracer {
 public:
  explicit TextbookTracer(const Scene& scene, float epsilon = 1e-3f);

  struct Hit {
    float t = 0.0f;
    uint64_t id = ~uint64_t{0};  // as surface_id; all ones: nothing
    Vec3f normal{0.0f};          // unit, of the facet, towards the viewer
    bool is_hit() const { return id != ~uint64_t{0}; }
  };
  Hit nearest(const naive::RayF& ray, float t_min) const;
  bool is_blocked(const naive::RayF& ray, float t_min, float distance) const;

  struct Picture {
    std::vector<uint64_t> ids;  // width * height
    std::vector<uint8_t> rgb;   // sRGB, 3 bytes a pixel
    std::vector<uint8_t> lit;   // 1: at least one light reaches the first surface
    int64_t nonfinite = 0;      // samples
  };
  // Sample 0 of every pixel, as our own renderers place it. REQUIRES: a perspective camera.
  Picture picture(const View& view, const Camera& camera, TilePool& pool) const;

 private:
  struct Solid {
    BodyKind kind;
    glm::mat4 world_from_local{1.0f}, local_from_world{1.0f};
    Vec3f half{1.0f};
    Color ambient{0.0}, diffuse{0.0}, specular{0.0};
    float shininess = 0.0f;
    std::vector<Vec3f> corners;  // of triangles, world space, 3 each
    Vec3f ball_center{0.0f};     // about the mesh
    float ball_radius = 0.0f;
  };
  void offer(uint32_t body, const naive::RayF& ray, float t_min, Hit& best) const;
  glm::vec3 shade(const naive::RayF& ray, const Hit& hit, bool shadows, bool& is_lit) const;

  std::vector<Solid> solids_;
  std::vector<Light> lights_;
  Attenuation attenuation_;
  Background background_;
  Color ambient_;
  float epsilon_;
};

}  // namespace tilelight::check
