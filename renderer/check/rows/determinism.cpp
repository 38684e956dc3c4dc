// SPDX-License-Identifier: Apache-2.0
// D: the same bytes whatever runs them.
#include "renderer/check/rows/determinism.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "renderer/check/kit/child.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/rays.h"
#include "renderer/check/rows/determinism_scenes.h"
#include "renderer/film/tone.h"

namespace tilelight::check {

Bits bits_of(const std::shared_ptr<const CompiledScene>& scene, const View& view, TilePool& pool, int tile_px) {
  RenderOptions options;
  options.tile_px = tile_px;
  const auto render = Render::start(pool, Priority::normal, scene, plan_view(*scene, view), options);
  while (!render->wait_ms(1e9)) continue;
  if (render->progress().state != RenderState::done) throw std::logic_error("a render of the catalogue failed");
  return {render->image()->rgb, render->report().passes};
}

Bits bits_of(std::string_view json, TilePool& pool, int tile_px) {
  const ParsedScene parsed = scene_of(json);
  return bits_of(compile_scene(parsed.scene, pool), parsed.view, pool, tile_px);
}

namespace {

constexpr const char* kScenes[] = {kShowcase, kChess, kExtremes};

// Every thread its own source of random numbers: what a pixel gets depends on who comes to it.
std::vector<float> textbook_samples(int threads) {
  constexpr int kPixels = 1000;
  std::vector<float> rgb;
  for (int thread = 0; thread < threads; ++thread) {
    Random random(static_cast<uint64_t>(thread));
    for (int i = thread * kPixels / threads; i < (thread + 1) * kPixels / threads; ++i)
      rgb.insert(rgb.end(), 3, static_cast<float>(random.unit()));
  }
  return rgb;
}

Outcome of_threads_and_tiles(const Context& context) {
  double threads_off = 0.0, tiles_off = 0.0, textbook_off = 0.0;
  for (const char* json : kScenes) {
    const ParsedScene parsed = scene_of(json);
    Bits first;
    for (const int threads : {1, 2, 7, 16}) {
      TilePool pool(threads);
      const auto scene = compile_scene(parsed.scene, pool);
      const Bits whole = bits_of(scene, parsed.view, pool);
      if (first.rgb.empty()) first = whole;
      note(threads_off, differing_bits(first.rgb, whole.rgb));
      if (context.is_quick && threads != 7) continue;
      for (const int tile_px : {4, 8, 20, 64, 1000})
        note(tiles_off, differing_bits(first.rgb, bits_of(scene, parsed.view, pool, tile_px).rgb));
    }
  }
  for (const int threads : {2, 7, 16})
    note(textbook_off, differing_bits(textbook_samples(1), textbook_samples(threads)));
  return {{at_most(0, "pixels that differ with the threads, %", threads_off),
           at_most(0, "pixels that differ with the tiles, %", tiles_off)},
          {at_most(0, "pixels that differ with the threads, %", textbook_off)}};
}

// b^2 - ac as it stands and as a compiler contracts it.
double contraction(int count) {
  Random random(2);
  int differ = 0;
  for (int i = 0; i < count; ++i) {
    const double b = random.between(-9.0, 9.0), a = random.unit(), c = random.unit();
    differ += b * b - a * c != std::fma(b, b, -(a * c));
  }
  return 100.0 * differ / count;
}

Outcome of_instruction_sets(const Context& context) {
  double isas_off = 0.0;
  int64_t other_images = 0, other_rays = 0;
  for (const char* json : kScenes) {
    const IsaChoice choice;
    Bits first;
    for (const std::string& isa : available_isas()) {
      if (!select_isa(isa)) throw std::logic_error(isa + " is not available after all");
      const Bits bits = bits_of(json, context.pool);
      if (first.rgb.empty()) first = bits;
      note(isas_off, differing_bits(first.rgb, bits.rgb));
    }
    if (context.is_quick && json != kShowcase) continue;
    const std::vector<std::string> masked = {std::string(kPlainLibrary.name) + "=" + kPlainLibrary.value};
    const std::string image = image_by_command(context.command, json, {});
    other_images += image.empty() || image != image_by_command(context.command, json, masked);
    for (const int at : {10, 17, 24}) {  // the image has 11 bits a value, these have all
      const std::string rays = rays_by_command(context.command, json, at, at, {});
      other_rays += rays.empty() || rays != rays_by_command(context.command, json, at, at, masked);
    }
  }
  return {{at_least(2, "instruction sets", static_cast<double>(available_isas().size())),
           at_most(0, "pixels that differ with the instruction set, %", isas_off),
           at_most(0, "images that differ without AVX2 and FMA in the C library", static_cast<double>(other_images)),
           at_most(0, "pixels whose rays differ there in a bit", static_cast<double>(other_rays))},
          {at_most(0, "values that differ, %", contraction(1000))}};
}

// A thread of a host that computes by other rules.
enum class Host { standard, flushing, upwards };

template <class Work>
void run_on(Host host, const Work& work) {
  std::thread([&] {
    if (host == Host::upwards) std::fesetround(FE_UPWARD);
#if defined(__SSE2__)
    constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x40;
    if (host == Host::flushing) _mm_setcsr(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
#endif
    work();
  }).join();
}

// Whether the textbook's rays hit a sphere of radius 1e-20, whose discriminants are subnormal.
std::vector<float> textbook_hits() {
  std::vector<float> hits;
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const Vec3f direction = glm::normalize(Vec3f(random.direction()) + Vec3f(0.0f, 0.0f, 1.5f));
    const bool is_hit = naive::sphere({Vec3f(0.0f), direction}, Vec3f(0.0f, 0.0f, 2e-20f), 1e-20f, 0.0f).has_value();
    hits.insert(hits.end(), 3, is_hit ? 1.0f : 0.0f);
  }
  return hits;
}

Outcome of_host_floats(const Context& context) {
  double off = 0.0;
  int64_t bytes_off = 0, lost = 0;
  for (const char* json : kScenes) {
    if (context.is_quick && json == kChess) continue;
    Bits expected;
    std::vector<uint8_t> expected_bytes;
    for (const Host host : {Host::standard, Host::flushing, Host::upwards}) {
      run_on(host, [&] {
        const int rounding = std::fegetround();
        const volatile float tiny = 1e-38f;
        const float tenth = tiny * 0.1f;
        TilePool pool(3);
        const Bits bits = bits_of(json, pool);
        const auto bytes = to_srgb8({1, static_cast<int>(bits.rgb.size() / 3), bits.rgb}, -1.0);
        lost += std::fegetround() != rounding || tiny * 0.1f != tenth;
        if (host == Host::standard) expected = bits, expected_bytes = bytes;
        note(off, differing_bits(expected.rgb, bits.rgb));
        bytes_off += bytes != expected_bytes;
      });
    }
  }
  std::vector<float> textbook, textbook_flushed;
  run_on(Host::standard, [&] { textbook = textbook_hits(); });
  run_on(Host::flushing, [&] { textbook_flushed = textbook_hits(); });
  return {{at_most(0, "pixels that differ with the host's floats, %", off),
           at_most(0, "pictures that differ in a byte", static_cast<double>(bytes_off)),
           at_most(0, "hosts that did not get their own back", static_cast<double>(lost))},
          {at_most(0, "rays that differ, %", differing_bits(textbook, textbook_flushed))}};
}

constexpr Row kRows[] = {
    {"D1", "threads and tiles", "1, 2, 7, 16 threads; tiles of 4, 8, 20, 64, 1000 pixels",
     "a random source of its own in every thread", of_threads_and_tiles},
    {"D2", "instruction sets", "all that the CPU can run, and a C library without AVX2 and FMA",
     "b^2 - ac contracted to a fused multiply-add", of_instruction_sets},
    {"D3", "twin in double", "glass, chess, and lengths from 1e-6 to 1e7", "a renderer in float", of_twins},
    {"D4", "the host's floating point", "subnormals flushed to zero; rounding upwards",
     "subnormal discriminants in float", of_host_floats},
    {"D5", "replay of passes", "on another instruction set, by other splits", "a running mean of pass means in float",
     of_replays},
    {"D6", "order of the objects", "40 plates 1e-5 apart, 1e3 away, reversed", "the first of equal distances in float",
     of_object_order},
};

}  // namespace

std::span<const Row> determinism_rows() { return kRows; }

}  // namespace tilelight::check
