// SPDX-License-Identifier: Apache-2.0
#include "renderer/cli/command_line.h"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>

#include "renderer/cli/commands.h"
#include "renderer/cli/complain.h"
#include "renderer/scene/words.h"

namespace tilelight::cli {
namespace {

// A subcommand writes its exit code here once its options are read.
using Run = std::function<ExitCode()>;

template <class Enum, size_t n>
std::vector<std::string> names_of(const std::array<NamedValue<Enum>, n>& table) {
  std::vector<std::string> names;
  for (const auto& entry : table) names.emplace_back(entry.name);
  return names;
}

void add_view_options(CLI::App& app, ViewOptions& view) {
  app.add_option("--width", view.width, "Width of the image, in pixels; without it the scene's");
  app.add_option("--height", view.height, "Height of the image, in pixels; without it the scene's");
  app.add_option("--algorithm", view.algorithm, "Hidden-surface method")->check(CLI::IsMember(names_of(kAlgorithms)));
  app.add_option("--shading", view.shading, "Shading rule")->check(CLI::IsMember(names_of(kShadings)));
  app.add_flag("--hidden-lines", view.hidden_lines, "Line drawings: hidden lines too, dashed");
  app.add_option("--samples", view.samples, "Stop at that many samples a pixel; stop rules replace the scene's own");
  app.add_option("--rmse", view.rmse, "Stop once the error is below: root mean square of the display's range 0 to 1");
  app.add_option("--time-ms", view.time_ms, "Stop at that time, in milliseconds");
}

void add_isa_option(CLI::App& app, std::string& isa) {
  app.add_option("--isa", isa, "Instruction set of the kernels: auto, AVX3, AVX2, SSE4, ...; the image is the same")
      ->capture_default_str();
}

void add_scene_option(CLI::App& app, std::string& path) {
  app.add_option("scene", path, "The scene, JSON; - reads standard input")->required();
}

CLI::Option* add_output_options(CLI::App& app, RenderArguments& arguments) {
  CLI::Option* output = app.add_option(
      "-o,--output", arguments.output,
      "The image: .png, .jpg, .exr (linear, 32-bit floats) or, of the lines that --algorithm roberts draws, .svg");
  add_view_options(app, arguments.view);
  app.add_option("--threads", arguments.threads, "Threads; 0 is one a core")->check(CLI::Range(0, 1024));
  app.add_option("--tile", arguments.tile_px,
                 "Edge of a tile, in pixels, rounded up to a multiple of 4; the image is the same")
      ->check(CLI::Range(1, 65536));
  add_isa_option(app, arguments.isa);
  app.add_option("--report", arguments.report, "Also write the report, JSON: error and time by pass; - prints it");
  app.add_option("--error-map", arguments.error_map,
                 "Also write the error by pixel: .png or .jpg in false colours, .exr as numbers");
  return output;
}

void add_render(CLI::App& app, Run& run) {
  struct Options {
    std::string scene;
    RenderArguments render;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("render", "Render a scene to an image file");
  add_scene_option(*command, options->scene);
  CLI::Option* output = add_output_options(*command, options->render);
  CLI::Option* pixel = command
                           ->add_option("--pixel", options->render.pixel,
                                        "x,y: print the rays behind one pixel, JSON, and do not render")
                           ->delimiter(',')
                           ->expected(2);
  pixel->excludes(output);
  command->add_option("--sample", options->render.sample, "Which sample of the pixel, from 0")->needs(pixel);
  command->footer(
      "Examples:\n"
      "  tilelight render scene.json -o scene.png\n"
      "  tilelight render scene.json -o big.exr --width 3840 --height 2160 --samples 64 --report report.json\n"
      "  tilelight render scene.json -o scene.png --rmse 0.004 --error-map error.png\n"
      "  tilelight render scene.json --algorithm roberts --hidden-lines -o lines.svg\n"
      "  tilelight render scene.json --pixel 640,360\n"
      "  generate-scene | tilelight render - -o out.jpg");
  command->callback([options, output, pixel, &run] {
    if (output->count() + pixel->count() == 0) throw CLI::RequiredError("--output or --pixel");
    run = [options] {
      const auto source = read_scene(options->scene);
      if (const ExitCode* code = std::get_if<ExitCode>(&source)) return *code;
      return run_render(std::get<SceneText>(source), options->render);
    };
  });
}

void add_plan(CLI::App& app, Run& run) {
  struct Options {
    std::string scene;
    PlanArguments plan;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("plan", "Say what a render will do, what was left out and why");
  add_scene_option(*command, options->scene);
  add_view_options(*command, options->plan.view);
  add_isa_option(*command, options->plan.isa);
  command->add_flag("--json", options->plan.json, "As a JSON object");
  command->footer("Examples:\n  tilelight plan scene.json\n  tilelight plan scene.json --json | jq .plan.left_out");
  command->callback([options, &run] {
    run = [options] {
      const auto source = read_scene(options->scene);
      if (const ExitCode* code = std::get_if<ExitCode>(&source)) return *code;
      return run_plan(std::get<SceneText>(source), options->plan);
    };
  });
}

void add_report(CLI::App& app, Run& run) {
  struct Options {
    std::string scene, against;
    ReportArguments report;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("report", "Measure error against run time: a study of a scene, to look at");
  add_scene_option(*command, options->scene);
  command->add_option("-o,--output", options->report.output, "The folder for report.html and the numbers behind it")
      ->required();
  command->add_option("--samples", options->report.most_samples, "Samples a pixel of the finest run")
      ->capture_default_str()
      ->check(CLI::IsMember({8, 16, 32, 64, 128, 256}));
  command->add_option("--rounds", options->report.rounds, "Rounds of every run, each with a seed of its own")
      ->capture_default_str()
      ->check(CLI::Range(3, 100));
  command->add_option("--width", options->report.view.width, "Pixels; without width and height about 32,000 in all");
  command->add_option("--height", options->report.view.height, "Pixels");
  command->add_option("--threads", options->report.threads, "Threads; 0 is one a core")->check(CLI::Range(0, 1024));
  command
      ->add_option("--against", options->against,
                   "Another program beside ours, at its best settings, where it is installed")
      ->check(CLI::IsMember({"povray"}));
  add_isa_option(*command, options->report.isa);
  command->footer(
      "Every method, with samples for all alike and where the error is, beside a reference of many more samples.\n"
      "Takes some minutes; the machine should have nothing else to do.\n"
      "Examples:\n  tilelight report scene.json -o report\n"
      "  tilelight report scene.json -o report --against povray --samples 32");
  command->callback([options, &run] {
    run = [options] {
      options->report.with_povray = options->against == "povray";
      const auto source = read_scene(options->scene);
      if (const ExitCode* code = std::get_if<ExitCode>(&source)) return *code;
      return run_report(std::get<SceneText>(source), options->report);
    };
  });
}

void add_chess(CLI::App& app, Run& run) {
  struct Options {
    std::string fen;
    int detail = 48;
    bool scene = false;
    RenderArguments render;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("chess", "Render a chess position");
  command
      ->add_option("fen", options->fen,
                   "The position: a FEN, or its placement field alone; what programs write around it is left out, with "
                   "a warning")
      ->required();
  CLI::Option* output = add_output_options(*command, options->render);
  command->add_option("--detail", options->detail, "Segments around the axis of a man")
      ->capture_default_str()
      ->check(CLI::Range(8, 512));
  CLI::Option* scene = command->add_flag("--scene", options->scene, "Print the scene, JSON, and do not render");
  command->footer(
      "Examples:\n"
      "  tilelight chess \"r1bqkbnr/pppp1ppp/2n5/4p3/2B1P3/5N2/PPPP1PPP/RNBQK2R b KQkq - 3 3\" -o italian.png\n"
      "  tilelight chess \"8/8/8/4k3/8/8/4P3/4K3\" --scene > endgame.json");
  command->callback([options, output, scene, &run] {
    if (output->count() + scene->count() == 0) throw CLI::RequiredError("--output or --scene");
    run = [options] {
      const auto position = parse_fen(options->fen);
      if (!position) return complain(kBadInput, position.error());
      const std::string text = chess_scene_json(options->fen, options->detail);
      if (!options->scene) return run_render({"<chess>", text}, options->render);
      for (const std::string& sentence : position->left_out) complain(kOk, "warning: " + sentence);
      std::fputs(text.c_str(), stdout);
      return kOk;
    };
  });
}

void add_compare(CLI::App& app, Run& run) {
  struct Options {
    std::string scene;
    CompareArguments compare;
  };
  const auto options = std::make_shared<Options>();
  CompareArguments& compare = options->compare;
  CLI::App* command = app.add_subcommand("compare", "Draw a scene by several methods and lay them side by side");
  add_scene_option(*command, options->scene);
  command->add_option("-o,--output", compare.output, "The folder for compare.html and the pictures beside it")
      ->required();
  command->add_option("--methods", compare.methods, "Hidden-surface methods, by commas; all without it")
      ->delimiter(',')
      ->check(CLI::IsMember(names_of(kAlgorithms)));
  command->add_option("--shadings", compare.shadings, "Shading rules, by commas; all without it")
      ->delimiter(',')
      ->check(CLI::IsMember(names_of(kShadings)));
  command->add_option("--samples", compare.samples, "Samples a pixel")
      ->capture_default_str()
      ->check(CLI::Range(1, 256));
  command->add_option("--rounds", compare.rounds, "How often each is timed")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  command->add_option("--width", compare.view.width, "Pixels");
  command->add_option("--height", compare.view.height, "Pixels");
  command->add_option("--threads", compare.threads, "Threads; 0 is one a core")->check(CLI::Range(0, 1024));
  add_isa_option(*command, compare.isa);
  command->footer(
      "Pictures, what they cost, what the methods did for them, and how they differ from the whole light model and\n"
      "from rays that draw the same.\n"
      "Examples:\n  tilelight compare scene.json -o compare\n"
      "  tilelight compare scene.json --methods raytrace,zbuffer --shadings gouraud,phong -o compare");
  command->callback([options, &run] {
    run = [options] {
      const auto source = read_scene(options->scene);
      if (const ExitCode* code = std::get_if<ExitCode>(&source)) return *code;
      return run_compare(std::get<SceneText>(source), options->compare);
    };
  });
}

void add_check(CLI::App& app, Run& run) {
  const auto options = std::make_shared<CheckArguments>();
  CLI::App* command = app.add_subcommand("check", "Run the stress catalogue: hard scenes with known answers");
  command->add_option("--only", options->only, "Rows by id or by letter: S4,T1,D")->delimiter(',');
  command->add_flag("--quick", options->is_quick, "Smaller images and fewer rays: seconds in place of minutes");
  command->add_flag("--json", options->json, "As a JSON object");
  command->add_option("--threads", options->threads, "Threads; 0 is one a core")->check(CLI::Range(0, 1024));
  add_isa_option(*command, options->isa);
  command->footer(
      "Each row measures ours against its bound, and the naive form of textbooks, which has to break it.\n"
      "Examples:\n  tilelight check\n  tilelight check --only S4,T1 --json | jq .rows");
  command->callback([options, &run] { run = [options] { return run_check(*options); }; });
}

void add_schema(CLI::App& app, Run& run) {
  CLI::App* command = app.add_subcommand("schema", "Print the JSON Schema of the scene language");
  command->footer("Example:\n  tilelight schema > scene.schema.json");
  command->callback([&run] {
    run = [] {
      std::printf("%s\n", scene_schema_json(Limits{}).c_str());
      return kOk;
    };
  });
}

}  // namespace

ExitCode run_command_line(int argc, const char* const* argv) {
  Run run;
  CLI::App app("Renders scenes: the same scene gives the same bytes on every machine.", "tilelight");
  app.set_version_flag("--version", "tilelight " TILELIGHT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 done; 1 the render failed or a file could not be read or written; 2 the command line or the\n"
      "scene is wrong; 130 interrupted. `tilelight COMMAND --help` tells more of a command.");
  add_render(app, run);
  add_plan(app, run);
  add_report(app, run);
  add_compare(app, run);
  add_chess(app, run);
  add_check(app, run);
  add_schema(app, run);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (const auto words = app.remaining(); error.get_exit_code() != 0 && !words.empty() && words[0][0] != '-') {
      return complain(kBadInput, "no command is called '" + words[0] +
                                     "'; there are render, plan, report, compare, chess, check and schema");
    }
    std::ostringstream wrong;  // or it is the help or the version, for standard output
    const int code = app.exit(error, std::cout, wrong);
    std::fputs(printable_lines(wrong.str()).c_str(), stderr);
    return code == 0 ? kOk : kBadInput;
  }
  return run();
}

}  // namespace tilelight::cli
