// SPDX-License-Identifier: Apache-2.0
// What the rows of the M group share: square orthographic views whose rays are known, and what is seen of a whole path.
#pragma once

#include <string>

#include "renderer/check/check.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/paths.h"

namespace tilelight::check {

inline const Vec3 kFront(0.0, 0.0, 5.0), kBackward(0.0, 0.0, -1.0);  // an eye before the scene, and its view

// Members of a document: no light, and rays that go on until they leave. direction: of the view, from `from` on.
std::string long_paths(int size, double height, const Vec3& from, const Vec3& direction, int max_depth);

// visit(path) for every pixel, over the threads of the pool: the largest of what it returns.
template <class Visit>
double worst_path(const PathScene& scene, TilePool& pool, Visit visit) {
  const int width = scene.plan().view.image.width, height = scene.plan().view.image.height;
  std::vector<double> rows(static_cast<size_t>(height), 0.0);
  pool.parallel_for(height, Priority::batch, [&](int64_t y) {
    for (int x = 0; x < width; ++x) {
      note(rows[static_cast<size_t>(y)], visit(scene.path(x, static_cast<int>(y))));
    }
  });
  double worst = 0.0;
  for (const double value : rows) note(worst, value);
  return worst;
}

// The pixels whose rays do not meet the same surfaces in the same order as the reference's, ray by ray.
double differing_paths(std::string_view json, TilePool& pool);

double arcsine(double x);

// Snell's law in float as shading languages have it; no direction (all 0) in total reflection.
Vec3f naive_refract(const Vec3f& direction, const Vec3f& normal, float eta);

// bounces_mirrors.cpp
Outcome facing_mirrors(const Context& context);
Outcome corner_cube(const Context& context);
Outcome thousand_mirrors(const Context& context);
// bounces_glass.cpp
Outcome glass_tree(const Context& context);
Outcome furnace(const Context& context);
Outcome bubble(const Context& context);
Outcome plates(const Context& context);
Outcome ball_lens(const Context& context);
// bounces_interface.cpp
Outcome total_reflection(const Context& context);
Outcome grazing_fresnel(const Context& context);
// bounces_media.cpp
Outcome overlapping_media(const Context& context);
Outcome plane_through_glass(const Context& context);
Outcome nested_media(const Context& context);
// bounces_touching.cpp
Outcome touching_media(const Context& context);
Outcome curved_facets(const Context& context);

}  // namespace tilelight::check
