// SPDX-License-Identifier: Apache-2.0
// judge: the fast renderer against the reference in double, one sample a pixel, scene by scene. Exit 1 if a scene
// fails.
//
//   judge [scene.json ...] [--size WxH] [--json] [--pixels N]
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

#include "renderer/measure/judge.h"
#include "renderer/scene/parse.h"

namespace tilelight {
namespace {

struct Size {
  int width = 0, height = 0;
};

struct Options {
  std::vector<std::string> scenes;
  std::optional<Size> size;
  bool json = false;
  int pixels = 0;  // differing pixels to show of every scene
};

// The example scenes: every document there that is a scene (the index beside them is a list).
std::vector<std::string> example_scenes() {
  std::vector<std::string> paths;
  for (const auto& entry : std::filesystem::directory_iterator(TILELIGHT_SOURCE_DIR "/web/scenes"))
    if (entry.path().extension() == ".json" && entry.path().stem() != "index") paths.push_back(entry.path().string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::optional<ParsedScene> read_scene(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    std::cerr << path << ": cannot be read\n";
    return std::nullopt;
  }
  const std::string text(std::istreambuf_iterator<char>(in), {});
  auto parsed = parse_scene(text, Limits{});
  if (parsed) return *std::move(parsed);
  for (const SceneError& error : parsed.error().errors)
    std::cerr << path << " " << error.pointer << ": " << error.detail << "\n";
  return std::nullopt;
}

void print_head() {
  std::cout << std::left << std::setw(16) << "scene" << std::right << std::setw(9) << "pixels" << std::setw(9) << "ids"
            << std::setw(10) << "ids %" << std::setw(9) << "q8" << std::setw(10) << "q8 %" << std::setw(8) << ">1"
            << std::setw(6) << "max" << std::setw(10) << "rmse" << std::setw(16) << "fine checker" << std::setw(10)
            << "fast ms" << std::setw(10) << "ref ms"
            << "\n";
}

void print_row(const std::string& path, const Verdict& v) {
  const ImageDifference& d = v.difference;
  const std::string fine = std::to_string(d.fine_checker_differing) + "/" + std::to_string(d.fine_checker);
  std::cout << std::left << std::setw(16) << std::filesystem::path(path).stem().string() << std::right << std::setw(9)
            << d.pixels << std::setw(9) << d.id_mismatches << std::setw(10) << std::fixed << std::setprecision(4)
            << 100.0 * d.id_mismatch_rate() << std::setw(9) << d.q8_differing << std::setw(10) << 100.0 * d.q8_rate()
            << std::setw(8) << d.q8_over_one << std::setw(6) << d.max_levels << std::setw(10) << std::setprecision(6)
            << d.rmse << std::setw(16) << fine << std::setw(10) << std::setprecision(0) << v.fast_ms << std::setw(10)
            << v.reference_ms << (v.passes() ? "  PASS" : "  FAIL") << std::endl;
}

std::string json_row(const std::string& path, const Verdict& v) {
  const ImageDifference& d = v.difference;
  std::ostringstream row;
  row << "{\"scene\": " << std::quoted(path) << ", \"width\": " << v.width << ", \"height\": " << v.height
      << ", \"id_mismatches\": " << d.id_mismatches << ", \"q8_differing\": " << d.q8_differing
      << ", \"q8_over_one\": " << d.q8_over_one << ", \"max_levels\": " << d.max_levels << ", \"rmse\": " << d.rmse
      << ", \"fine_checker\": " << d.fine_checker << ", \"fine_checker_differing\": " << d.fine_checker_differing
      << ", \"fast_ms\": " << v.fast_ms << ", \"reference_ms\": " << v.reference_ms
      << ", \"pass\": " << (v.passes() ? "true" : "false") << "}";
  return row.str();
}

void print_pixels(const Verdict& v, int most) {
  const auto id = [](uint64_t surface) {
    return surface == kNothingHit ? std::string("nothing")
                                  : std::to_string(surface >> 32) + ":" + std::to_string(surface & 0xffffffffu);
  };
  const auto rgb = [](const ShownImage& image, size_t i) {
    return "(" + std::to_string(image.rgb[3 * i]) + " " + std::to_string(image.rgb[3 * i + 1]) + " " +
           std::to_string(image.rgb[3 * i + 2]) + ")";
  };
  for (size_t i = 0; i < v.reference.size() && most > 0; ++i) {
    if (v.reference[i].checker_cell_px < kFineCheckerPx) continue;
    if (v.fast.primary_ids[i] == v.shown_reference.primary_ids[i] && rgb(v.fast, i) == rgb(v.shown_reference, i))
      continue;
    --most;
    std::cout << "  pixel " << i % v.width << "," << i / v.width << "  fast " << id(v.fast.primary_ids[i]) << " "
              << rgb(v.fast, i) << "  reference " << id(v.shown_reference.primary_ids[i]) << " "
              << rgb(v.shown_reference, i) << "\n";
  }
}

int judge_scenes(const Options& options) {
  TilePool pool;
  bool all_pass = true;
  std::vector<std::string> rows;
  if (!options.json) print_head();
  for (const std::string& path : options.scenes) {
    std::optional<ParsedScene> parsed = read_scene(path);
    if (!parsed) return 2;
    if (options.size) parsed->view.image.width = options.size->width, parsed->view.image.height = options.size->height;
    const Verdict verdict = judge_view(parsed->scene, parsed->view, pool);
    all_pass &= verdict.passes();
    if (options.json) {
      rows.push_back(json_row(path, verdict));
      continue;
    }
    print_row(path, verdict);
    print_pixels(verdict, options.pixels);
  }
  if (options.json) {
    std::cout << "[";
    for (size_t i = 0; i < rows.size(); ++i) std::cout << (i ? ",\n " : "") << rows[i];
    std::cout << "]\n";
  }
  return all_pass ? 0 : 1;
}

}  // namespace
}  // namespace tilelight

int main(int argc, char** argv) {
  tilelight::Options options;
  std::string size;
  CLI::App app(
      "The fast renderer against the reference in double, one sample a pixel. Bounds: 0.01 % of the pixels by "
      "first surface, 0.05 % by 8-bit colour; checkers of cells under 1/4 pixel are counted apart.");
  app.add_option("scenes", options.scenes, "scene files; default: web/scenes")->check(CLI::ExistingFile);
  app.add_option("--size", size, "image size WxH in place of the scene's");
  app.add_flag("--json", options.json, "a JSON array in place of the table");
  app.add_option("--pixels", options.pixels, "show so many differing pixels of every scene");
  CLI11_PARSE(app, argc, argv);
  if (!size.empty()) {
    tilelight::Size s;
    if (std::sscanf(size.c_str(), "%dx%d", &s.width, &s.height) != 2 || s.width < 1 || s.height < 1) {
      std::cerr << "--size " << size << ": not of the form WxH, such as 640x360\n";
      return 2;
    }
    options.size = s;
  }
  if (options.scenes.empty()) options.scenes = tilelight::example_scenes();
  return tilelight::judge_scenes(options);
}
