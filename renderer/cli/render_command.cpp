// SPDX-License-Identifier: Apache-2.0
#include <cstdio>

#include "renderer/cli/commands.h"
#include "renderer/cli/complain.h"
#include "renderer/cli/files.h"
#include "renderer/cli/interrupt.h"
#include "renderer/cli/progress_line.h"
#include "renderer/renderer.h"
#include "renderer/trace/isa.h"

namespace tilelight::cli {
namespace {

// Everything that can be refused before a ray is traced.
ExitCode check_arguments(const RenderArguments& arguments) {
  if (auto isa = select_isa(arguments.isa); !isa) return complain(kBadInput, isa.error().detail);
  if (!arguments.pixel.empty()) return kOk;
  for (const std::string& path : {arguments.output, arguments.error_map})
    if (!path.empty() && !image_format_from_extension(path))
      return complain(kBadInput, path + ": the ending names the format: .png, .jpg, .exr or, of line drawings, .svg");
  if (image_format_from_extension(arguments.error_map) == ImageFormat::svg)
    return complain(kBadInput, arguments.error_map + ": the error by pixel has no lines; use .png, .jpg or .exr");
  for (const std::string& path : {arguments.output, arguments.report, arguments.error_map})
    if (auto writable = check_can_write(path); !path.empty() && !writable)
      return complain(kFailed, writable.error().detail);
  return kOk;
}

// What can be refused only once the scene has been read.
ExitCode check_output(const RenderArguments& arguments, const View& view) {
  for (const std::string& path : {arguments.output, arguments.error_map}) {
    const auto format = image_format_from_extension(path);
    if (!format) continue;  // there is none to write
    if (auto fits = check_image_size(*format, view.image.width, view.image.height); !fits)
      return complain(kBadInput, path + ": " + fits.error().detail);
  }
  if (image_format_from_extension(arguments.output) != ImageFormat::svg || draws_lines(view)) return kOk;
  return complain(kBadInput, arguments.output + ": an SVG holds lines, which --algorithm roberts alone draws");
}

ExitCode explain(const std::shared_ptr<const CompiledScene>& scene, const ViewPlan& plan, TilePool& pool,
                 const RenderArguments& arguments) {
  const auto json = explain_pixel_json(scene, plan, pool, arguments.pixel[0], arguments.pixel[1], arguments.sample);
  if (!json) return complain(kBadInput, json.error().detail);
  std::printf("%s\n", json->c_str());
  return kOk;
}

RenderProgress wait_for_end(Render& render, ProgressLine& line) {
  constexpr double kLookMs = 100.0;  // how soon Ctrl-C is seen and how often the line changes
  while (!render.wait_ms(kLookMs)) {
    if (is_interrupted()) render.cancel();
    line.show(render.progress());
  }
  return render.progress();
}

// The picture in the format that its path names, and a warning where that changes any of its values.
Result<std::string> encode_result(const Image& image, double exposure_stops, const std::string& path) {
  const ImageFormat format = *image_format_from_extension(path);
  auto bytes = encode_image(image, exposure_stops, format);
  if (const int64_t count = count_clamped(image, exposure_stops, format); bytes && count > 0)
    print_warnings(path, {{"", "clamped", clamped_warning(count, format)}});
  return bytes;
}

Result<std::string> encode_picture(const Render& render, const ViewPlan& plan, const std::string& path) {
  if (image_format_from_extension(path) == ImageFormat::svg) return render.lines_svg();
  return encode_result(*render.image(), plan.view.image.exposure, path);
}

Result<std::string> encode_error_map(const Render& render, const ViewPlan& plan, const std::string& path) {
  const auto& [width, height, exposure] = plan.view.image;
  const auto bounds = render.error_bounds();
  const bool is_numbers = image_format_from_extension(path) == ImageFormat::exr;
  return encode_result(is_numbers ? error_image(width, height, *bounds) : heat_map(width, height, *bounds), 0.0, path);
}

std::string report_of(const Render& render, const ParsedScene& parsed, const CompiledScene& compiled,
                      const ViewPlan& plan, ImageFormat format) {
  const Image& image = *render.image();
  const int64_t clamped = count_clamped(image, plan.view.image.exposure, ImageFormat::exr);
  auto warnings = parsed.warnings;
  if (clamped > 0 && format == ImageFormat::exr)
    warnings.push_back({"/image/exposure", "clamped", clamped_warning(clamped, format)});
  const ReportIdentity identity{TILELIGHT_VERSION, parsed.scene_id,
                                image_hash(image), find_rounding(parsed.scene, compiled, plan),
                                clamped,           std::move(warnings)};
  return report_json(render.report(), plan.plan, identity) + "\n";
}

// What cannot be encoded leaves no file of what can.
ExitCode write_results(const Render& render, const ParsedScene& parsed, const CompiledScene& compiled,
                       const ViewPlan& plan, const RenderArguments& arguments) {
  std::vector<std::pair<std::string, Result<std::string>>> files;
  files.emplace_back(arguments.output, encode_picture(render, plan, arguments.output));
  if (!arguments.error_map.empty())
    files.emplace_back(arguments.error_map, encode_error_map(render, plan, arguments.error_map));
  if (!arguments.report.empty()) {
    const ImageFormat format = *image_format_from_extension(arguments.output);
    files.emplace_back(arguments.report, report_of(render, parsed, compiled, plan, format));
  }
  if (is_interrupted()) return kInterrupted;
  print_warnings(arguments.output, report_warnings(render.report()));
  for (const auto& [path, bytes] : files)
    if (!bytes) return complain(kFailed, path + ": " + bytes.error().detail);
  for (const auto& [path, bytes] : files)
    if (auto written = write_output(path, *bytes); !written) return complain(kFailed, written.error().detail);
  return kOk;
}

void print_summary(const RenderArguments& arguments, const ViewPlan& plan, const Render& render) {
  const RenderProgress progress = render.progress();
  const ErrorSummary error = render.report().points.back().error;
  char rmse[64] = "";
  if (error.is_known) std::snprintf(rmse, sizeof rmse, "rmse %.2g (%.2g to %.2g), ", error.rmse, error.low, error.high);
  std::fprintf(stderr, "%s: %d x %d, %.6g samples a pixel, %s%.2f s (%s on %s)\n", arguments.output.c_str(),
               plan.view.image.width, plan.view.image.height, progress.spp, rmse, progress.elapsed_ms / 1000.0,
               plan.plan.kernel.c_str(), plan.plan.isa.c_str());
}

}  // namespace

ExitCode run_render(const SceneText& source, const RenderArguments& arguments) {
  if (const ExitCode code = check_arguments(arguments); code != kOk) return code;
  auto parsed = parse_with_options(source, arguments.view);
  if (const ExitCode* code = std::get_if<ExitCode>(&parsed)) return *code;
  const auto& [scene, view] = std::tie(std::get<ParsedScene>(parsed).scene, std::get<ParsedScene>(parsed).view);
  if (const ExitCode code = check_output(arguments, view); code != kOk) return code;

  TilePool pool(arguments.threads);
  const auto compiled = compile_scene(scene, pool);
  const ViewPlan plan = plan_view(*compiled, view);
  print_warnings(source.name, plan.plan.warnings);
  if (!arguments.pixel.empty()) return explain(compiled, plan, pool, arguments);
  if (is_interrupted()) return kInterrupted;

  RenderOptions options;
  options.tile_px = arguments.tile_px;
  const auto render = Render::start(pool, Priority::normal, compiled, plan, options);
  ProgressLine line;
  const RenderProgress end = wait_for_end(*render, line);
  line.clear();
  if (end.state == RenderState::cancelled) return complain(kInterrupted, "interrupted; nothing was written");
  if (end.state == RenderState::failed) return complain(kFailed, "the render failed: " + end.error);
  const ExitCode code = write_results(*render, std::get<ParsedScene>(parsed), *compiled, plan, arguments);
  if (code == kOk && line.is_terminal()) print_summary(arguments, plan, *render);
  return code;
}

}  // namespace tilelight::cli
