// SPDX-License-Identifier: Apache-2.0
// The hidden-surface methods and shading rules side by side: one scene by each of them, with what they cost, what they
// do and how far they are from the whole light model and from rays that draw the same.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/measure/image_error.h"
#include "renderer/raster/method.h"
#include "renderer/render/render.h"
#include "renderer/scene/parse.h"

namespace tilelight {

struct CompareOptions {
  std::vector<Algorithm> methods = {};  // none: all
  std::vector<Shading> shadings = {};   // none: all
  int samples = 4;                      // a pixel
  int rounds = 3;                       // for times
  int reference_samples = 64;
  // What is being done, and which part of the whole is done; by the calling thread.
  std::function<void(const std::string&, double)> on_progress = {};
  // Asked between renders; true ends the comparison early, with no result.
  std::function<bool()> is_cancelled = {};
};

// How a picture differs from the one by rays of the same light, shading and samples, both of 8 bits.
struct Difference {
  double part = 0.0;  // of the pixels that differ at all
  double rms = 0.0;   // of displayed values, white is 1
  int most = 0;       // of 255, in any channel
};

// One method with one shading.
struct CompareRow {
  std::string method, shading;                                  // shading: empty for lines
  double time_ms = 0.0, time_low_ms = 0.0, time_high_ms = 0.0;  // of rounds: median, least and most
  RayCounts rays;
  ImageError error;  // to the whole light model
  std::optional<Difference> to_rays = {};
  int64_t memory_bytes = 0;            // of what the method keeps beside the scene
  std::shared_ptr<const Image> image;  // linear
  std::vector<float> off = {};         // by pixel: the error to the whole light model
  std::vector<float> off_rays = {};    // by pixel: the difference from rays; empty without to_rays
};

// What a method does for one sample of every pixel, whatever the shading.
struct CompareWork {
  std::string method;
  MethodWork work;
};

struct Comparison {
  std::string scene_name, scene_id, isa;
  int threads = 0, width = 0, height = 0, samples = 0, rounds = 0, reference_samples = 0;
  double exposure = 0.0;
  std::shared_ptr<const Image> reference;  // linear
  std::vector<CompareRow> rows;
  std::vector<CompareWork> works;
  std::string lines_svg;  // of roberts; empty without it
};

// None if it was cancelled. Throws std::runtime_error where a render fails.
std::optional<Comparison> compare_methods(const ParsedScene& parsed, const std::string& name, TilePool& pool,
                                          const CompareOptions& options);

// "zbuffer-gouraud": what the files of a row are called, with what stands behind it.
std::string file_stem(const CompareRow& row);

std::string comparison_json(const Comparison& comparison);
// A page to look at, which shows the pictures beside it: reference.png; of every row STEM.png, STEM-off.png and, with
// to_rays, STEM-rays.png; of every work with a picture METHOD-work.png.
std::string comparison_html(const Comparison& comparison);

}  // namespace tilelight
