// SPDX-License-Identifier: Apache-2.0
// The reference renderer: a small recursive ray tracer (Whitted 1980) in double, scalar and plain, written from the
// model and not from the kernels. It judges them, so it is made to be believed and not to be fast: an opening position
// of chess at 1280x720 takes a minute or two. Deterministic; any thread.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "renderer/measure/reference_scene.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight {

inline constexpr uint64_t kNothingHit = ~uint64_t{0};

// The body in the upper half, its triangle or face (2 * axis, + 1 on the positive side) in the lower one.
constexpr uint64_t surface_id(uint32_t body, uint32_t primitive) { return uint64_t{body} << 32 | primitive; }

// What one sample saw.
struct ReferencePixel {
  Color color{0.0};                   // linear RGB
  uint64_t primary_id = kNothingHit;  // the first surface that is shown on the ray from the eye
  // The smallest edge of a checker cell among all that the sample saw, directly, in mirrors and through glass, in
  // pixels; 0 where it cannot be told. Under about 1/4 two renderers cannot be expected to agree on the cell.
  double checker_cell_px = std::numeric_limits<double>::infinity();
  // Sum of the path weights that max_depth, weight_cutoff or ray_budget left untraced.
  Color untraced{0.0};
};

// The eye, made ready for one view.
struct ReferenceEye {
  Vec3 position{0.0};                        // scene units
  Vec3 forward{0.0}, right{0.0}, down{0.0};  // right and down: from one pixel to the next, on the plane at forward
  bool is_perspective = true;
  double center_x = 0.0, center_y = 0.0;  // of the image, pixels
  std::vector<uint32_t> media;            // perspective: in which the eye lies, outermost first
  RenderSpec render;
};
ReferenceEye make_reference_eye(const ReferenceScene& scene, const View& view, const Camera& camera);

enum class ReferenceRayKind { primary, reflected, refracted };

// One ray of a sample's tree, for tests and explanations. A ray that passes through hidden surfaces is one ray.
struct ReferenceRay {
  ReferenceRayKind kind = ReferenceRayKind::primary;
  int depth = 0;
  Vec3 origin{0.0}, direction{0.0};
  Color weight{1.0};
  uint64_t hit_id = kNothingHit;  // of the surface that was shaded
  Vec3 hit_point{0.0};
};

// One sample at a point of the image: pixels, the upper left corner of the upper left pixel is (0, 0), y down.
// `rays`, if given, receives every ray that was traced, breadth first.
ReferencePixel reference_sample(const ReferenceScene& scene, const ReferenceEye& eye, const Vec2& image_point,
                                std::vector<ReferenceRay>* rays = nullptr);

// width * height samples, row by row from the top: the same one of every pixel's sequence.
std::vector<ReferencePixel> reference_image(const ReferenceScene& scene, const View& view, const Camera& camera,
                                            TilePool& pool, uint32_t sample = 0);

}  // namespace tilelight
