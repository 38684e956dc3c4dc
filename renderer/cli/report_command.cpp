// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "renderer/cli/commands.h"
#include "renderer/cli/complain.h"
#include "renderer/cli/folder.h"
#include "renderer/cli/interrupt.h"
#include "renderer/cli/progress_line.h"
#include "renderer/renderer.h"
#include "renderer/study/study.h"
#include "renderer/trace/isa.h"

namespace tilelight::cli {
namespace {

std::vector<File> files_of(const Study& study) {
  const DisplayedImage shown = displayed_image(*study.picture, study.exposure);
  const std::vector<float> off = error_by_pixel(shown, displayed_image(*study.reference, study.exposure));
  const auto png = [&](const Image& image, double exposure) { return encode_image(image, exposure, ImageFormat::png); };
  return {{"study.json", study_json(study)},
          {"runs.csv", study_csv(study)},
          {"error_time.svg", study_svg(study)},
          {"reference.png", png(*study.reference, study.exposure)},
          {"picture.png", png(*study.picture, study.exposure)},
          {"error.png", png(heat_map(study.width, study.height, off), 0.0)},
          {"told.png", png(heat_map(study.width, study.height, study.told_bounds), 0.0)},
          {"report.html", study_html(study)}};
}

void print_summary(const Study& study, const std::string& folder) {
  std::printf("%-34s %-28s %9s %9s %9s %9s %7s\n", "series", "setting", "spp", "ms", "rmse", "told", "FLIP");
  for (const StudySeries& series : study.series) {
    for (const StudyRun& run : series.runs) {
      char told[16] = "";
      if (run.told_rmse >= 0.0) std::snprintf(told, sizeof told, "%.5f", run.told_rmse);
      std::printf("%-34s %-28s %9.4g %9.1f %9.5f %9s %7.4f%s\n", series.name.c_str(), run.setting.c_str(), run.spp,
                  run.time_ms, run.error.rmse, told, run.error.flip, run.is_on_front ? "  *" : "");
    }
  }
  std::printf("* on the front: no run has less error in less time\n%s/report.html\n", folder.c_str());
}

}  // namespace

ExitCode run_report(const SceneText& source, const ReportArguments& arguments) {
  if (auto isa = select_isa(arguments.isa); !isa) return complain(kBadInput, isa.error().detail);
  auto parsed = parse_with_options(source, arguments.view);
  if (const ExitCode* code = std::get_if<ExitCode>(&parsed)) return *code;
  ParsedScene& document = std::get<ParsedScene>(parsed);
  if (!arguments.view.width && !arguments.view.height) document.view.image = study_size(document.view.image);

  if (const ExitCode code = make_folder(arguments.output, "report.html"); code != kOk) return code;

  TilePool pool(arguments.threads);
  ProgressLine line;
  StudyOptions options{
      .most_samples = arguments.most_samples, .rounds = arguments.rounds, .with_povray = arguments.with_povray};
  options.is_cancelled = is_interrupted;
  options.on_progress = [&](const std::string& what, double done) {
    line.show(std::to_string(static_cast<int>(100.0 * done)) + " %   " + what);
  };
  std::optional<Study> study;
  try {
    study = make_study(document, source.name, pool, options);
  } catch (const std::runtime_error& error) {
    line.clear();
    return complain(kFailed, error.what());
  }
  line.clear();
  if (!study) return complain(kInterrupted, "interrupted; nothing was written");
  const ExitCode code = write_files(files_of(*study), arguments.output);
  if (code == kOk) print_summary(*study, arguments.output);
  return code;
}

}  // namespace tilelight::cli
