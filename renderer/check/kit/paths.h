// SPDX-License-Identifier: Apache-2.0
// PathScene: the whole way of one sample by the fast renderer's own kernel, ray by ray, in the user's units.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/compile/compile.h"
#include "renderer/scene/parse.h"
#include "renderer/trace/eye_media.h"

namespace tilelight::check {

struct PathRay {
  int depth = 0;
  char kind = 'p';                   // primary, reflected, refracted: 'p', 'm', 't'
  Vec3 origin{0.0}, direction{0.0};  // the origin behind the surfaces that the ray passed unseen
  Color weight{1.0};
  uint64_t id = ~uint64_t{0};  // as surface_id; all ones: nothing is hit
  Vec3 hit_point{0.0};

  bool is_hit() const { return id != ~uint64_t{0}; }
  uint32_t body() const { return static_cast<uint32_t>(id >> 32); }
};
struct Path {
  std::vector<PathRay> rays;  // breadth first
  Color color{0.0};           // of ambient light and sky
  double untraced_weight = 0.0;
  int64_t spent = 0;  // rays after the primary one
};

class PathScene {
 public:
  PathScene(std::string_view json, TilePool& pool);
  PathScene(const ParsedScene& parsed, TilePool& pool);
  // Sample 0 of the pixel.
  Path path(int x, int y) const;
  const ViewPlan& plan() const { return plan_; }
  const CompiledScene& compiled() const { return *scene_; }

 private:
  std::shared_ptr<const CompiledScene> scene_;
  ViewPlan plan_;
  EyeMedia eye_media_;
};

}  // namespace tilelight::check
