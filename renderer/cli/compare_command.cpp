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
#include "renderer/scene/words.h"
#include "renderer/study/compare.h"
#include "renderer/trace/isa.h"

namespace tilelight::cli {
namespace {

std::vector<File> files_of(const Comparison& c) {
  std::vector<File> files;
  const auto add_png = [&](const std::string& name, const Image& image, double exposure) {
    files.emplace_back(name + ".png", encode_image(image, exposure, ImageFormat::png));
  };
  add_png("reference", *c.reference, c.exposure);
  for (const CompareRow& row : c.rows) {
    add_png(file_stem(row), *row.image, c.exposure);
    if (!row.off.empty()) add_png(file_stem(row) + "-off", heat_map(c.width, c.height, row.off), 0.0);
    if (!row.off_rays.empty()) add_png(file_stem(row) + "-rays", heat_map(c.width, c.height, row.off_rays), 0.0);
  }
  for (const CompareWork& w : c.works)
    if (w.work.picture) add_png(w.method + "-work", *w.work.picture, 0.0);
  if (!c.lines_svg.empty()) files.emplace_back("roberts.svg", c.lines_svg);
  files.emplace_back("compare.json", comparison_json(c));
  files.emplace_back("compare.html", comparison_html(c));  // last: it shows the others
  return files;
}

void print_summary(const Comparison& c, const std::string& folder) {
  std::printf("%-10s %-8s %9s %9s %9s %10s %12s %12s\n", "method", "shading", "ms", "of first", "Mrays", "memory MiB",
              "rmse, whole", "unlike rays");
  for (const CompareRow& row : c.rows) {
    std::printf("%-10s %-8s %9.1f %9.2f", row.method.c_str(), row.shading.c_str(), row.time_ms,
                row.time_ms / c.rows.front().time_ms);
    if (!row.shading.empty())
      std::printf(" %9.2f %10.1f %12.5f", 1e-6 * static_cast<double>(row.rays.total()),
                  static_cast<double>(row.memory_bytes) / 0x1p20, row.error.rmse);
    if (row.to_rays) std::printf(" %10.4f %%", 100.0 * row.to_rays->part);
    std::printf("\n");
  }
  for (const CompareWork& w : c.works) {
    std::printf("\n%s, for one sample of every pixel\n", w.method.c_str());
    for (const MethodWork::Count& count : w.work.counts)
      std::printf("  %-62s %14.10g\n", count.name.c_str(), count.value);
  }
  std::printf("%s/compare.html\n", folder.c_str());
}

}  // namespace

ExitCode run_compare(const SceneText& source, const CompareArguments& arguments) {
  if (auto isa = select_isa(arguments.isa); !isa) return complain(kBadInput, isa.error().detail);
  auto parsed = parse_with_options(source, arguments.view);
  if (const ExitCode* code = std::get_if<ExitCode>(&parsed)) return *code;
  const ParsedScene& document = std::get<ParsedScene>(parsed);

  if (const ExitCode code = make_folder(arguments.output, "compare.html"); code != kOk) return code;

  TilePool pool(arguments.threads);
  ProgressLine line;
  CompareOptions options{.samples = arguments.samples, .rounds = arguments.rounds};
  for (const std::string& name : arguments.methods) options.methods.push_back(*find_word(kAlgorithms, name));
  for (const std::string& name : arguments.shadings) options.shadings.push_back(*find_word(kShadings, name));
  options.is_cancelled = is_interrupted;
  options.on_progress = [&](const std::string& what, double done) {
    line.show(std::to_string(static_cast<int>(100.0 * done)) + " %   " + what);
  };
  std::optional<Comparison> comparison;
  try {
    comparison = compare_methods(document, source.name, pool, options);
  } catch (const std::runtime_error& error) {
    line.clear();
    return complain(kFailed, error.what());
  }
  line.clear();
  if (!comparison) return complain(kInterrupted, "interrupted; nothing was written");
  const ExitCode code = write_files(files_of(*comparison), arguments.output);
  if (code == kOk) print_summary(*comparison, arguments.output);
  return code;
}

}  // namespace tilelight::cli
