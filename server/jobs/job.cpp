// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job.h"

#include <array>
#include <cstdio>

#include "renderer/base/hash.h"

namespace tilelight::server {
namespace {

constexpr std::string_view kStateNames[] = {"queued", "running", "done", "failed", "cancelled"};
constexpr std::string_view kPriorityNames[] = {"interactive", "normal", "batch"};
constexpr std::pair<ImageFormat, std::string_view> kFormatNames[] = {
    {ImageFormat::png, "png"}, {ImageFormat::jpeg, "jpeg"}, {ImageFormat::exr, "exr"}, {ImageFormat::svg, "svg"}};

// Hexadecimal floating point: exact, whatever the locale's rounding.
void put(std::string& out, double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%a,", value);
  out += text;
}
void put(std::string& out, const Vec3& v) { put(out, v.x), put(out, v.y), put(out, v.z); }
void put_whole(std::string& out, int64_t value) { out += std::to_string(value) + ","; }

}  // namespace

std::string_view job_state_name(JobState state) { return kStateNames[static_cast<size_t>(state)]; }

std::optional<JobState> find_job_state(std::string_view name) {
  for (size_t i = 0; i < std::size(kStateNames); ++i) {
    if (kStateNames[i] == name) return static_cast<JobState>(i);
  }
  return std::nullopt;
}

std::string_view priority_name(Priority priority) { return kPriorityNames[static_cast<size_t>(priority)]; }

std::string_view image_format_name(ImageFormat format) {
  for (const auto& [known, name] : kFormatNames) {
    if (known == format) return name;
  }
  return "";
}

std::optional<ImageFormat> find_image_format(std::string_view name) {
  for (const auto& [format, known] : kFormatNames) {
    if (known == name) return format;
  }
  return std::nullopt;
}

std::vector<ImageFormat> image_formats(bool with_lines) {
  std::vector<ImageFormat> formats = {ImageFormat::png, ImageFormat::jpeg, ImageFormat::exr};
  if (with_lines) formats.push_back(ImageFormat::svg);
  return formats;
}

std::vector<ImageFormat> image_formats(bool with_lines, int width, int height) {
  std::vector<ImageFormat> formats = image_formats(with_lines);
  std::erase_if(formats, [&](ImageFormat format) { return !check_image_size(format, width, height); });
  return formats;
}

std::string view_fingerprint(const View& view) {
  std::string out = "view1:";
  if (view.camera) {
    const Camera& c = *view.camera;
    put_whole(out, static_cast<int>(c.projection));
    put(out, c.position), put(out, c.target), put(out, c.up), put(out, c.fov_y_deg), put(out, c.height);
  }
  const RenderSpec& r = view.render;
  out += ";";
  put_whole(out, view.image.width), put_whole(out, view.image.height), put(out, view.image.exposure);
  put_whole(out, static_cast<int>(r.algorithm)), put_whole(out, static_cast<int>(r.shading));
  put_whole(out, r.shadows), put_whole(out, r.max_depth), put(out, r.weight_cutoff);
  put_whole(out, r.ray_budget), put_whole(out, r.seed), put_whole(out, static_cast<int>(r.terminator));
  put_whole(out, static_cast<int>(r.filter)), put_whole(out, r.tessellate), put(out, r.chord_error_px);
  put_whole(out, r.hidden_lines);
  out += ";";
  put_whole(out, r.samples.value_or(-1)), put(out, r.rmse.value_or(-1.0)), put(out, r.time_ms.value_or(-1.0));
  put_whole(out, r.adaptive);
  for (const double pass : r.passes) put(out, pass);
  return out;
}

std::string render_key(const RenderRequest& request) {
  return sha256_hex(request.scene->parsed.scene_id + ";" + view_fingerprint(request.view) + ";" +
                    std::string(priority_name(request.priority)) +
                    (request.refines ? ";" + request.refines->job_id : ""));
}

}  // namespace tilelight::server
