// SPDX-License-Identifier: Apache-2.0
// Where a command's scene comes from, and how what is wrong with it is told: one line an error, as compilers print
// them.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "renderer/cli/exit_code.h"
#include "renderer/scene/parse.h"

namespace tilelight::cli {

// Options that say something of the view. A stop rule among them replaces those of the scene.
struct ViewOptions {
  std::optional<int> width, height, samples;
  std::optional<double> rmse, time_ms;
  std::optional<std::string> algorithm, shading;  // words of the scene language
  bool hidden_lines = false;                      // false: as the scene says
};

struct SceneText {
  std::string name;  // the path, "<stdin>", or what else stands for the file in messages
  std::string text;
};

// "scene.json:12:3: /objects/0/radius: -1 is ... (hint)" for every error, each with its line feed.
std::string errors_text(const std::string& name, const std::vector<SceneError>& errors);

// "scene.json: warning: /meshes/0: ..." on standard error.
void print_warnings(const std::string& name, const std::vector<SceneWarning>& warnings);

// Reads "-" from standard input. What went wrong is told on standard error; then the exit code is handed back.
std::variant<SceneText, ExitCode> read_scene(const std::string& path);
std::variant<ParsedScene, ExitCode> parse_with_options(const SceneText& source, const ViewOptions& options);

}  // namespace tilelight::cli
