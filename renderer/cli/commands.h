// SPDX-License-Identifier: Apache-2.0
// The subcommands: plain options in, exit code out. They print what they are asked for on standard output and what
// went wrong on standard error.
#pragma once

#include <string>
#include <vector>

#include "renderer/cli/exit_code.h"
#include "renderer/cli/scene_source.h"

namespace tilelight::cli {

struct RenderArguments {
  std::string output;     // a path ending in .png, .jpg, .exr or .svg; empty only with a pixel
  std::string report;     // a path, "-", or empty
  std::string error_map;  // a path ending in .png, .jpg or .exr, or empty
  ViewOptions view;
  int threads = 0;  // 0: one a core
  int tile_px = 0;  // 0: chosen by the renderer
  std::string isa = "auto";
  std::vector<int> pixel;  // none, or x and y: explain instead of rendering
  int sample = 0;          // which sample of the pixel
};
ExitCode run_render(const SceneText& source, const RenderArguments& arguments);

struct PlanArguments {
  ViewOptions view;
  std::string isa = "auto";
  bool json = false;
};
ExitCode run_plan(const SceneText& source, const PlanArguments& arguments);

struct ReportArguments {
  std::string output;  // a folder, made if it is not there
  ViewOptions view;    // of it width and height; without them a smaller picture than the scene's
  int most_samples = 32;
  int rounds = 5;
  bool with_povray = false;
  int threads = 0;
  std::string isa = "auto";
};
ExitCode run_report(const SceneText& source, const ReportArguments& arguments);

struct CompareArguments {
  std::string output;                          // a folder, made if it is not there
  std::vector<std::string> methods, shadings;  // words of the scene language; none: all
  ViewOptions view;                            // of it width and height
  int samples = 4, rounds = 3;
  int threads = 0;
  std::string isa = "auto";
};
ExitCode run_compare(const SceneText& source, const CompareArguments& arguments);

struct CheckArguments {
  std::vector<std::string> only;  // ids of rows, or their letters; empty: all
  bool is_quick = false;
  bool json = false;
  int threads = 0;
  std::string isa = "auto";
};
// kFailed if a row fails.
ExitCode run_check(const CheckArguments& arguments);

}  // namespace tilelight::cli
