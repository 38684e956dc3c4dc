// SPDX-License-Identifier: Apache-2.0
// RayScene: single rays against a scene by the fast renderer's own traversal, in the user's units. Random: the rays'
// source, the same on every machine.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "renderer/compile/compile.h"
#include "renderer/scene/scene.h"

namespace tilelight::check {

class RayScene {
 public:
  // json: a document that is known to be good.
  RayScene(std::string_view json, TilePool& pool);
  RayScene(const Scene& scene, TilePool& pool);

  struct Hit {
    bool is_hit = false;
    double t = 0.0;    // scene units
    uint64_t id = 0;   // as surface_id; where is_hit
    Vec3 normal{0.0};  // geometric, unit, towards the viewer
  };
  // direction: any length but 0; t counts in scene units along it.
  Hit nearest(const Vec3& origin, const Vec3& direction) const;
  struct Aim {
    Vec3 origin{0.0}, direction{0.0};
  };
  std::vector<Hit> nearest(std::span<const Aim> rays) const;

  const CompiledScene& compiled() const { return *scene_; }

 private:
  std::shared_ptr<const CompiledScene> scene_;
};

// Of unit vectors, rad; exact for small angles too (Kahan).
double angle_between(const Vec3& a, const Vec3& b);

// SplitMix64 (Steele, Lea and Flood 2014).
class Random {
 public:
  explicit Random(uint64_t seed) : state_(seed) {}
  uint64_t next();
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }  // [0, 1)
  double between(double low, double high) { return low + (high - low) * unit(); }
  Vec3 direction();  // unit, uniform on the sphere

 private:
  uint64_t state_;
};

}  // namespace tilelight::check
