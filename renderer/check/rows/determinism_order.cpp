// SPDX-License-Identifier: Apache-2.0
// D5, D6: the same bytes from a replay, and from the same objects in another order.
#include <algorithm>

#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/rays.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/determinism.h"
#include "renderer/check/rows/determinism_scenes.h"

namespace tilelight::check {
namespace {

// Samples averaged pass by pass, and the passes' means into a running one.
std::vector<float> textbook_means(const std::vector<int>& passes) {
  Random random(5);
  std::vector<float> rgb;
  for (int pixel = 0; pixel < 3000; ++pixel) {
    float mean = 0.0f;
    int done = 0;
    for (const int samples : passes) {
      float sum = 0.0f;
      for (int i = 0; i < samples; ++i) sum += static_cast<float>(random.unit());
      done += samples;
      mean += (sum / static_cast<float>(samples) - mean) * static_cast<float>(samples) / static_cast<float>(done);
    }
    rgb.push_back(mean);
  }
  return rgb;
}

std::string plates_json(int count) {
  std::string objects;
  for (int i = 0; i < count; ++i) {
    const std::string n = std::to_string(i);
    objects += std::string(i ? ", " : "") + R"({"type": "mesh", "mesh": "plate", "translate": [)" + n + "e-2, 0, " + n +
               R"(e-5], "material": {"diffuse": )" + std::to_string(10 + 2 * i) + "e-2}}";
  }
  return R"({"image": {"width": 120, "height": 120}, "render": {"samples": 1},
    "camera": {"position": [100, 80, 1000], "target": [1, 1, 0], "fov_y_deg": 0.15},
    "meshes": {"plate": {"positions": [0,0,0, 2,0,0, 2,2,0, 0,2,0], "indices": [0,1,2, 0,2,3]}}, "objects": [)" +
         objects + "]}";
}

ParsedScene reversed(ParsedScene parsed) {
  std::reverse(parsed.scene.objects.begin(), parsed.scene.objects.end());
  return parsed;
}

}  // namespace

Outcome of_replays(const Context& context) {
  ParsedScene parsed = scene_of(kShowcase);
  parsed.view.render.samples = 8;
  // Ended by its error, after samples that followed it.
  View following = parsed.view;
  following.render.samples = 4096;
  following.render.rmse = 0.01;
  following.render.adaptive = true;
  Bits first, followed;
  {
    TilePool pool(7);
    const auto scene = compile_scene(parsed.scene, pool);
    first = bits_of(scene, parsed.view, pool);
    followed = bits_of(scene, following, pool);
  }
  const IsaChoice choice;
  double replay_off = 0.0, split_off = 0.0, followed_off = 0.0;
  for (const std::string& isa : available_isas()) {
    if (context.is_quick && isa != available_isas().back()) continue;
    (void)select_isa(isa);
    const auto scene = compile_scene(parsed.scene, context.pool);
    View replay = parsed.view;
    replay.render.samples.reset();
    replay.render.passes = first.passes;
    note(replay_off, differing_bits(first.rgb, bits_of(scene, replay, context.pool, 13).rgb));
    replay.render.adaptive = true;
    replay.render.passes = followed.passes;
    note(followed_off, differing_bits(followed.rgb, bits_of(scene, replay, context.pool, 13).rgb));
    replay.render.adaptive = false;
    replay.render.passes = {3, 5};
    note(split_off, differing_bits(first.rgb, bits_of(scene, replay, context.pool).rgb));
  }
  return {{at_least(2, "passes of the first render", static_cast<double>(first.passes.size())),
           at_most(0, "pixels that differ in the replay, %", replay_off),
           at_most(0, "pixels that differ in the replay of one whose samples followed the error, %", followed_off),
           at_most(0, "pixels that differ in passes of 3 and 5, %", split_off)},
          {at_most(0, "means that differ, %", differing_bits(textbook_means({1, 1, 2, 4}), textbook_means({3, 5})))}};
}

Outcome of_object_order(const Context& context) {
  double off = 0.0;
  const std::string plates = plates_json(40);
  for (const std::string& json : {plates, std::string(kShowcase)}) {
    const ParsedScene there = scene_of(json), back = reversed(there);
    const Bits a = bits_of(compile_scene(there.scene, context.pool), there.view, context.pool);
    const Bits b = bits_of(compile_scene(back.scene, context.pool), back.view, context.pool);
    note(off, differing_bits(a.rgb, b.rgb));
  }
  const ParsedScene there = scene_of(plates), back = reversed(there);
  const auto textbook = [&](const ParsedScene& parsed) {
    return TextbookTracer(parsed.scene).picture(parsed.view, *parsed.view.camera, context.pool).rgb;
  };
  return {{at_most(0, "pixels that differ, %", off)},
          {at_most(0, "pixels that differ, %", differing_pixels(textbook(there), textbook(back)))}};
}

}  // namespace tilelight::check
