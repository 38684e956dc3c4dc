// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/povray_run.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <system_error>

#include "renderer/base/elementary.h"
#include "renderer/film/image_io.h"

namespace tilelight::study {
namespace {

constexpr const char* kProgram = "povray";

// The number that the pattern's first group catches in the log.
double number_after(const std::string& log, const char* pattern) {
  std::smatch match;
  if (!std::regex_search(log, match, std::regex(pattern)))
    throw std::runtime_error("POV-Ray did not say \"" + std::string(pattern) + "\": " + log);
  return std::atof(match[1].str().c_str());
}

Image read_linear(const std::string& path, double exposure) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  auto image = decode_linear(bytes, ImageFormat::png, int64_t{1} << 26);
  if (!image) throw std::runtime_error("POV-Ray's image: " + image.error().detail);
  const double dimmed = elementary::exp2(-exposure);
  for (float& v : image->rgb) v = static_cast<float>(v * dimmed);
  return std::move(*image);
}

}  // namespace

std::string PovSetting::words() const {
  std::string out = "-A";
  if (method > 0) {
    char threshold_text[32];
    std::snprintf(threshold_text, sizeof threshold_text, "%.3f", threshold);  // it does not know "+A0"
    out = "+AM" + std::to_string(method) + " +A" + threshold_text + " +R" + std::to_string(depth) +
          (has_jitter ? " +J" : " -J");
  }
  return out + " +BM" + std::to_string(bounding);
}

PovRay::PovRay(const PovScene& scene, const ImageSpec& image, int threads) : image_(image), threads_(threads) {
  std::ofstream(folder_.file("scene.pov")) << scene.text;
}

Drawing PovRay::draw(const PovSetting& setting) const {
  std::vector<std::string> words{"+I" + folder_.file("scene.pov"),
                                 "+O" + folder_.file("out.png"),
                                 "+W" + std::to_string(image_.width),
                                 "+H" + std::to_string(image_.height),
                                 "+WT" + std::to_string(threads_),
                                 "+FN16",
                                 "-D",
                                 "File_Gamma=srgb"};
  std::istringstream setting_words(setting.words());
  words.insert(words.end(), std::istream_iterator<std::string>(setting_words), {});
  const ChildResult result = run_child(kProgram, words, "", {}, ChildErrors::in_output);
  if (result.status != 0) throw std::runtime_error("POV-Ray failed: " + result.output);
  Drawing drawing;
  drawing.image = std::make_shared<const Image>(read_linear(folder_.file("out.png"), image_.exposure));
  drawing.time_ms = 1e3 * number_after(result.output, R"(Trace Time:[^(]*\(([0-9.]+) seconds\))");
  drawing.cpu_ms = 1e3 * number_after(result.output, R"(Trace Time:[^\n]*\n[^\n]*with ([0-9.]+) CPU-seconds)");
  const double first = number_after(result.output, R"(Pixels: *([0-9]+))");
  const double more = number_after(result.output, R"(Samples: *([0-9]+))");
  drawing.spp = (first + more) / (static_cast<double>(image_.width) * image_.height);
  return drawing;
}

bool is_povray_installed() {
  try {
    return run_child(kProgram, {"--version"}, "", {}, ChildErrors::in_output).status == 0;
  } catch (const std::system_error&) {
    return false;
  }
}

}  // namespace tilelight::study
