// SPDX-License-Identifier: Apache-2.0
// pov_scene: a scene as POV-Ray reads it, on standard output; what POV-Ray has no words for, on standard error.
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>

#include <CLI/CLI.hpp>

#include "renderer/renderer.h"
#include "renderer/study/pov_scene.h"
#include "tests/bench/bench_scene.h"

namespace tilelight::bench {
namespace {

int run(const std::string& document) {
  const auto parsed = parse_scene(document, Limits{});
  if (!parsed) {
    std::cerr << "pov_scene: " << parsed.error().errors[0].detail << "\n";
    return 1;
  }
  TilePool pool(1);
  const PovScene pov = pov_scene(parsed->scene, plan_view(*compile_scene(parsed->scene, pool), parsed->view).view);
  for (const std::string& difference : pov.differences) std::cerr << "pov_scene: " << difference << "\n";
  std::cout << pov.text;
  return 0;
}

}  // namespace
}  // namespace tilelight::bench

int main(int argc, char** argv) {
  CLI::App app{"A scene as POV-Ray reads it"};
  std::string path = "s";
  bool as_json = false;
  app.add_option("scene", path, "A scene file, or s, m, l: a scene of the benchmarks")->capture_default_str();
  app.add_flag("--json", as_json, "The document itself instead");
  CLI11_PARSE(app, argc, argv);
  std::string document;
  if (path == "s" || path == "m" || path == "l") {
    document = tilelight::bench::bench_scene(tilelight::bench::detail_of(path[0]));
  } else {
    std::ifstream file(path);
    if (!file) {
      std::cerr << "pov_scene: cannot read " << path << "\n";
      return 1;
    }
    document.assign(std::istreambuf_iterator<char>(file), {});
  }
  if (as_json) {
    std::cout << document << "\n";
    return 0;
  }
  return tilelight::bench::run(document);
}
