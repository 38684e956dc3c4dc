// SPDX-License-Identifier: Apache-2.0
#include "renderer/cli/scene_source.h"

#include <cstdio>

#include "renderer/cli/complain.h"
#include "renderer/cli/files.h"

namespace tilelight::cli {
namespace {

// The options as a view document, so that they meet the same limits and the same words as a scene's own.
std::string view_json(const ViewOptions& options) {
  std::string image, render;
  const auto add = [](std::string& members, const char* name, const std::string& value) {
    members += (members.empty() ? "\"" : ", \"") + std::string(name) + "\": " + value;
  };
  const auto number = [](double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.17g", value);
    return std::string(text);
  };
  if (options.width) add(image, "width", number(*options.width));
  if (options.height) add(image, "height", number(*options.height));
  if (options.algorithm) add(render, "algorithm", "\"" + *options.algorithm + "\"");
  if (options.shading) add(render, "shading", "\"" + *options.shading + "\"");
  if (options.hidden_lines) add(render, "hidden_lines", "true");
  if (options.samples || options.rmse || options.time_ms) {
    add(render, "samples", options.samples ? number(*options.samples) : "null");
    add(render, "rmse", options.rmse ? number(*options.rmse) : "null");
    add(render, "time_ms", options.time_ms ? number(*options.time_ms) : "null");
    add(render, "passes", "null");
  }
  return R"({"image": {)" + image + R"(}, "render": {)" + render + "}}";
}

}  // namespace

std::string errors_text(const std::string& name, const std::vector<SceneError>& errors) {
  std::string text;
  for (const SceneError& error : errors) {
    std::string line = name;
    if (error.line > 0) line += ":" + std::to_string(error.line) + ":" + std::to_string(error.column);
    line += ": " + (error.pointer.empty() ? "" : error.pointer + ": ") + error.detail;
    if (!error.hint.empty()) line += " (" + error.hint + ")";
    text += printable(line) + "\n";
  }
  return text;
}

void print_warnings(const std::string& name, const std::vector<SceneWarning>& warnings) {
  for (const SceneWarning& warning : warnings) {
    const std::string where = warning.pointer.empty() ? "" : warning.pointer + ": ";
    std::fprintf(stderr, "%s\n", printable(name + ": warning: " + where + warning.detail).c_str());
  }
}

std::variant<SceneText, ExitCode> read_scene(const std::string& path) {
  auto text = read_input(path, Limits{}.bytes);
  if (!text) return complain(kFailed, text.error().detail);
  return SceneText{path == "-" ? "<stdin>" : path, std::move(*text)};
}

std::variant<ParsedScene, ExitCode> parse_with_options(const SceneText& source, const ViewOptions& options) {
  const Limits limits;
  auto parsed = parse_scene(source.text, limits);
  if (!parsed) {
    std::fputs(errors_text(source.name, parsed.error().errors).c_str(), stderr);
    return kBadInput;
  }
  print_warnings(source.name, parsed->warnings);
  auto view = parse_view(view_json(options), parsed->view, limits);
  if (!view) {
    for (SceneError& error : view.error().errors) error.line = 0;  // of a text that nobody wrote
    std::fputs(errors_text("tilelight: options", view.error().errors).c_str(), stderr);
    return kBadInput;
  }
  parsed->view = std::move(*view);
  return std::move(*parsed);
}

}  // namespace tilelight::cli
