// SPDX-License-Identifier: Apache-2.0
// The peer: POV-Ray, a program of its own. Its time is what it says that tracing took.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "renderer/base/child_process.h"
#include "renderer/film/image_io.h"
#include "renderer/study/pov_scene.h"
#include "renderer/study/studio.h"

namespace tilelight::study {
namespace {

constexpr const char* kProgram = "povray";

// The number that the pattern's first group catches in the log.
double number_after(const std::string& log, const char* pattern) {
  std::smatch match;
  if (!std::regex_search(log, match, std::regex(pattern))) throw std::runtime_error("POV-Ray says no more: " + log);
  return std::atof(match[1].str().c_str());
}

// side * side samples in every pixel that differs at all from a neighbour, beside the one that every pixel has; side 1:
// that one alone.
Drawing draw(const TemporaryFolder& folder, const ImageSpec& image, int threads, int side) {
  std::vector<std::string> words{"+I" + folder.file("scene.pov"),
                                 "+O" + folder.file("out.png"),
                                 "+W" + std::to_string(image.width),
                                 "+H" + std::to_string(image.height),
                                 "+WT" + std::to_string(threads),
                                 "+FN16",
                                 "-D",
                                 "File_Gamma=srgb"};
  if (side > 1) {
    words.insert(words.end(), {"+AM1", "+A0.0", "+R" + std::to_string(side)});
  } else {
    words.emplace_back("-A");
  }
  const ChildResult result = run_child(kProgram, words, "", {}, ChildErrors::in_output);
  if (result.status != 0) throw std::runtime_error("POV-Ray failed: " + result.output);
  std::ifstream file(folder.file("out.png"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  auto linear = decode_linear(bytes, ImageFormat::png, int64_t{1} << 26);
  if (!linear) throw std::runtime_error("POV-Ray's image: " + linear.error().detail);
  Drawing drawing;
  drawing.image = std::make_shared<const Image>(std::move(*linear));
  drawing.time_ms = 1e3 * number_after(result.output, R"(Trace Time:[^(]*\(([0-9.]+) seconds\))");
  drawing.spp = side > 1 ? number_after(result.output, R"(Smpls/Pxl: *([0-9.]+))") : 1.0;
  return drawing;
}

// Throws std::exception where POV-Ray is not there, fails, or says something else than it used to.
void draw_beside(const Studio& studio, const Scene& scene, const View& view, const Image& truth, Study& study) {
  const TemporaryFolder folder;
  const PovScene pov = pov_scene(scene, view);
  std::ofstream(folder.file("scene.pov")) << pov.text;
  StudySeries series{
      .name = "POV-Ray", .method = "POV-Ray", .shading = "phong", .sampling = "grid", .precision = "double"};
  const std::vector<int> sides{1, 2, 3, 4, 6, 8};
  std::vector<std::vector<Drawing>> drawings(sides.size());
  for (int round = 0; round < studio.options().rounds; ++round) {
    for (size_t i = 0; i < sides.size(); ++i) {
      studio.stop_if_cancelled();
      drawings[i].push_back(draw(folder, view.image, studio.pool().thread_count(), sides[i]));
    }
  }
  for (size_t i = 0; i < sides.size(); ++i) {
    const std::string side = std::to_string(sides[i]);
    StudyRun run;
    run.setting = sides[i] == 1 ? "1 sample" : side + " x " + side + " where pixels differ";
    time_run(run, drawings[i]);
    judge(run, drawings[i], truth, view.image.exposure, studio.pool());
    series.runs.push_back(std::move(run));
  }
  study.series.push_back(std::move(series));
  constexpr int kFinest = 12;
  const Image finest = *draw(folder, view.image, studio.pool().thread_count(), kFinest).image;
  std::ostringstream note;
  note << "POV-Ray's finest picture (" << kFinest << " x " << kFinest << " samples) is "
       << rms_difference(displayed_image(finest, view.image.exposure), displayed_image(truth, view.image.exposure))
       << " off ours, rmse: no sampling brings its first curve below that.";
  study.notes.push_back(note.str());
  for (const std::string& difference : pov.differences) study.notes.push_back("In POV-Ray " + difference + ".");
}

}  // namespace

void add_povray(const Studio& studio, const Scene& scene, const View& view, const Image& truth, Study& study) {
  try {
    draw_beside(studio, scene, view, truth, study);
  } catch (const std::exception& error) {
    studio.stop_if_cancelled();  // Ctrl-C reaches POV-Ray too
    study.notes.push_back(std::string("POV-Ray is not beside ours (Debian: apt install povray): ") + error.what());
  }
}

}  // namespace tilelight::study
