// SPDX-License-Identifier: Apache-2.0
// Method: how the samples of a view are drawn, by the view's algorithm. Made ready once a render, from then on
// immutable; any thread may draw with it.
#pragma once

#include <memory>

#include "renderer/trace/tile_job.h"

namespace tilelight {

class Method {
 public:
  virtual ~Method() = default;
  // Draws the samples of one work item.
  virtual void draw(const TileJob& job) const = 0;
  virtual int64_t memory_bytes() const { return 0; }
};

// Runs on the calling thread and on idle threads of the pool. REQUIRES: a scene without spheres, if the view is drawn
// from triangles; both outlive the method.
std::unique_ptr<const Method> make_method(const CompiledScene& scene, const ViewPlan& plan, TilePool& pool);

}  // namespace tilelight
