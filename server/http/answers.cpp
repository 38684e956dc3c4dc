// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "server/http/documents.h"
#include "server/http/handlers.h"
#include "server/http/text.h"

namespace tilelight::server {

::tl::expected<WaitSlots::Slot, Problem> WaitSlots::take(const std::string& client) {
  constexpr const char* kInstead = "; ask again, or ask for a job (Prefer: respond-async) and come back for it";
  const std::lock_guard lock(mutex_);
  if (free_ == 0) {
    return busy("too_many_waiting", std::string("as many requests wait for results as the server allows") + kInstead,
                1);
  }
  int& held = by_client_[client];
  if (held >= most_by_client_) {
    return ::tl::unexpected<Problem>(
        Problem{429,
                "too_many_waiting",
                "as many requests of this client wait for results as one may" + std::string(kInstead),
                {},
                {{"Retry-After", "1"}}});
  }
  ++held;
  --free_;
  return Slot(this, client);
}

void WaitSlots::give_back(const std::string& client) {
  const std::lock_guard lock(mutex_);
  ++free_;
  if (const auto held = by_client_.find(client); --held->second == 0) by_client_.erase(held);
}

int WaitSlots::free() const {
  const std::lock_guard lock(mutex_);
  return free_;
}

::tl::unexpected<Problem> client_gone() { return problem(408, "client_gone", "the client closed its connection"); }

::tl::expected<CompiledPtr, Problem> wait_compiled(Services& services, const Request& request, const ScenePtr& scene,
                                                   Priority priority) {
  const auto until = after_ms(services.config.max_wait_s * 1000.0);
  const auto compiled = services.compiled.wait(scene, priority, request.gone, until);
  if (compiled && *compiled) return *compiled;
  if (request.gone.stop_requested()) return client_gone();
  if (!compiled) return busy("compiling", "the scene is still being compiled; ask again for what has come of it", 5);
  return problem(500, "internal", "the scene could not be compiled");
}

std::optional<int64_t> number_param(const Request& request, const std::string& name) {
  const auto text = request.param(name);
  return text ? whole_number<int64_t>(*text) : std::nullopt;
}

double wait_seconds(const Services& services, const Request& request, double default_s) {
  return std::min<double>(read_preferences(request).wait_s.value_or(default_s), services.config.max_wait_s);
}

namespace {

// "wait=40", "wait=0.4", or nothing where the client asked for no wait.
std::string granted_wait(const Services& services, const Request& request) {
  if (!read_preferences(request).wait_s) return {};
  char text[32];
  std::snprintf(text, sizeof text, "wait=%.3f", wait_seconds(services, request, 0.0));
  std::string wait = text;
  wait.erase(wait.find_last_not_of('0') + 1);
  if (wait.back() == '.') wait.pop_back();
  return wait;
}

// Of a 202, where respond-async counts too.
void tell_preferences(const Services& services, const Request& request, Response& response) {
  std::string applied = granted_wait(services, request);
  if (read_preferences(request).respond_async) applied = "respond-async" + (applied.empty() ? "" : ", " + applied);
  if (!applied.empty()) response.with("Preference-Applied", applied);
}

}  // namespace

void tell_wait(const Services& services, const Request& request, Response& response) {
  if (const std::string wait = granted_wait(services, request); !wait.empty())
    response.with("Preference-Applied", wait);
}

::tl::unexpected<Problem> refused(Services& services, const Error& error) {
  if (error.code == "stopping") return busy("stopping", error.detail, 5);
  // About a second for every two renders that wait, which is right within a factor for pictures of a megapixel.
  const int retry_s = std::clamp(services.queue.counts().queued / 2, 1, 60);
  return busy(error.code, error.detail, retry_s);
}

std::string server_timing(const WorkStatus& status) {
  const Timings& t = status.timings;
  char text[256];
  std::snprintf(text, sizeof text,
                "parse;dur=%.2f, queue;dur=%.2f, compile;dur=%.2f, plan;dur=%.2f, render;dur=%.2f, encode;dur=%.2f",
                t.parse_ms, t.queue_ms, t.compile_ms, t.plan_ms, t.render_ms, t.encode_ms);
  return text;
}

::tl::expected<Layer, Problem> read_layer(const Request& request) {
  const auto layer = request.param("layer").value_or("color");
  if (layer == "color") return Layer::color;
  if (layer == "error") return Layer::error;
  return problem(400, "bad_query", "layer must be color or error");
}

Result<EncodedPtr> encode_layer(Services& services, Layer layer, const Image& image,
                                const std::vector<float>& error_bounds, double exposure_stops, ImageFormat format) {
  const auto encode = [&] {
    if (layer == Layer::color) return encode_tagged(image, exposure_stops, format);
    const bool is_numbers = format == ImageFormat::exr;
    return encode_tagged(is_numbers ? error_image(image.width, image.height, error_bounds)
                                    : heat_map(image.width, image.height, error_bounds),
                         0.0, format);
  };
  return services.pool.submit(Priority::interactive, encode).get();
}

::tl::unexpected<Problem> not_acceptable(const Request& request, std::string what_there_is, int width, int height) {
  for (const ImageFormat format : image_formats(false)) {
    const auto fits = check_image_size(format, width, height);
    if (!fits && best_offer(request, {media_type(format)})) what_there_is += "; " + fits.error().detail;
  }
  return problem(406, "not_acceptable", std::move(what_there_is));
}

::tl::unexpected<Problem> not_encoded(Services& services, const Request& request, const Error& error) {
  if (error.code == "expired") return problem(410, "expired", error.detail);
  if (error.code == "format_limit") return problem(406, "not_acceptable", error.detail);
  services.log.write(LogLevel::error, "encode_failed", {{"id", request.id}, {"cause", error.detail}});
  if (error.code == "out_of_memory") return busy("out_of_memory", error.detail, 5);
  return problem(500, "internal", "the image could not be encoded; the server's log has a line with this request_id");
}

std::string render_info(double spp, std::string_view stop, const RenderReport& report, int64_t clamped) {
  // Structured fields (RFC 8941) know decimals of three places and no exponents.
  const auto decimal = [](double value, int places) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", places, value);
    return std::string(text);
  };
  std::string out = "spp=" + decimal(spp, spp == std::floor(spp) ? 0 : 3);
  if (!stop.empty()) out += ", stop=\"" + std::string(stop) + "\"";
  if (clamped > 0) out += ", clamped=" + std::to_string(clamped);
  if (report.points.empty()) return out;
  const ReportPoint& last = report.points.back();
  if (last.error.is_known) out += ", rmse=" + decimal(last.error.rmse, 6);
  return out + ", nonfinite=" + std::to_string(last.nonfinite);
}

Response shared_image(const EncodedPtr& image, ImageFormat format) {
  Response response{200, {}, std::string(media_type(format)), "", SharedBytes(image, &image->bytes)};
  // Browsers open an SVG as a document: ours needs nothing beside itself and may run nothing.
  if (format == ImageFormat::svg) response.with("Content-Security-Policy", "default-src 'none'; sandbox");
  return response;
}

Response image_response(const RenderWork& work, const EncodedPtr& image, ImageFormat format) {
  const WorkStatus status = work.status();
  Response response = shared_image(image, format);
  response.with("ETag", image->etag)
      .with("Vary", "Accept")
      .with("Server-Timing", server_timing(status))
      .with("Render-Info", render_info(status.progress.spp, status.report.stop, status.report, image->clamped));
  return response;
}

Response accepted_response(const Services& services, const JobRecord& record, const Request& request) {
  Response response = json_response(202, job_json(record, request.prefix));
  const double eta_s = record.status.progress.eta_ms / 1000.0;
  const int retry_s = std::clamp(static_cast<int>(std::ceil(eta_s)), 1, 30);
  response.with("Location", location_of(request, "/v1/renders/" + record.id))
      .with("Retry-After", std::to_string(retry_s))
      .with("Vary", "Accept, Prefer")
      .with("Cache-Control", "no-store");
  tell_preferences(services, request, response);
  return response;
}

::tl::unexpected<Problem> ended_without_image(const WorkStatus& status) {
  if (status.state == JobState::failed) return problem(500, "render_failed", status.error);
  return busy("cancelled", status.error.empty() ? "the render was cancelled" : status.error, 1);
}

}  // namespace tilelight::server
