// SPDX-License-Identifier: Apache-2.0
// Method: how the samples of a view are drawn, by the view's algorithm. Made ready once a render, from then on
// immutable; any thread may draw with it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/trace/tile_job.h"

namespace tilelight {

// What a method has to do for one sample of every pixel, beside shading.
struct MethodWork {
  struct Count {
    std::string name;  // "windows divided", ...
    double value = 0.0;
  };
  std::vector<Count> counts;
  // Where in the picture the work lies, linear; and what it shows.
  std::optional<Image> picture;
  std::string caption;
};

class Method {
 public:
  virtual ~Method() = default;
  // Draws the samples of one work item.
  virtual void draw(const TileJob& job) const = 0;
  // Found anew by every call, at the price of about one sample of every pixel.
  virtual MethodWork work() const { return {}; }
  virtual int64_t memory_bytes() const { return 0; }
  // The picture's lines as an SVG document; empty where it has none.
  virtual std::string lines_svg() const { return {}; }
};

// Runs on the calling thread and on idle threads of the pool. REQUIRES: a scene without spheres, if the view is drawn
// from triangles; both outlive the method. Throws Stopped soon after `stop` is set, and std::length_error where the
// method cannot hold the scene.
std::unique_ptr<const Method> make_method(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool,
                                          const std::atomic<bool>* stop = nullptr);

}  // namespace tilelight
