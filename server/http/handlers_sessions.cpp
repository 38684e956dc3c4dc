// SPDX-License-Identifier: Apache-2.0
#include "server/http/documents.h"
#include "server/http/handlers.h"
#include "server/http/render_body.h"

namespace tilelight::server {
namespace {

constexpr double kFrameWaitS = 25.0;  // under the half minute after which some proxies give up

::tl::unexpected<Problem> no_such_session() {
  return problem(404, "no_such_session",
                 "no session with this id is open; sessions end after five minutes without use");
}

// None came while this waited.
Response no_frame(const Services& services, const Request& request) {
  Response response = empty_response(204).with("Cache-Control", "no-store");
  tell_wait(services, request, response);
  return response;
}

constexpr std::string_view kFrameFormats = "a frame can be had as image/png or image/jpeg";

// What the client likes best of the formats that can hold a picture of this size.
std::optional<ImageFormat> frame_format(const Request& request, int width, int height) {
  std::vector<std::string_view> offers;
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::jpeg}) {
    if (check_image_size(format, width, height)) offers.push_back(media_type(format));
  }
  const auto type = best_offer(request, offers);
  return type ? image_format_from_media_type(*type) : std::nullopt;
}

}  // namespace

Reply post_session(Services& services, const Request& request) {
  auto body = read_render_body(services, request.body, {});
  if (!body) return ::tl::unexpected(body.error());
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  const auto compiled = wait_compiled(services, request, body->scene, Priority::interactive);
  if (!compiled) return ::tl::unexpected(compiled.error());
  const ViewPlan plan = plan_view(**compiled, body->view);
  // Later views are merged over what the client is told here, also where the scene left the camera to be found.
  body->view.camera = plan.camera;
  const auto session = services.sessions.open(*compiled, body->view);
  if (!session) return busy(session.error().code, session.error().detail, 5);
  const std::string& id = (*session)->id();
  return json_response(201, session_document(id, body->scene->parsed.scene_id, body->warnings, plan))
      .with("Location", location_of(request, "/v1/sessions/" + id))
      .with("Cache-Control", "no-store");
}

Reply put_session_view(Services& services, const Request& request) {
  const SessionPtr session = services.sessions.find(request.args[0]);
  if (!session) return no_such_session();
  if (auto met = check_conditions(request, {false}); !met) return ::tl::unexpected(met.error());
  auto body = read_view_body(request.body, session->base_view(), services.config.limits);
  if (!body) return ::tl::unexpected(body.error());
  if (!services.sessions.reserve(session->id(), body->seq, body->view.image)) {
    return busy("too_many_pixels", "the views of all sessions together have as many pixels as they may", 5);
  }
  session->set_view(body->seq, std::move(body->view), body->is_moving);
  return empty_response(204);
}

Reply get_session_frame(Services& services, const Request& request) {
  const SessionPtr session = services.sessions.find(request.args[0]);
  if (!session) return no_such_session();
  const auto after = request.param("after") ? number_param(request, "after") : std::optional<int64_t>(0);
  if (!after || *after < 0) {
    return problem(400, "bad_query", "after must be the number of the last frame received, or 0");
  }
  if (!frame_format(request, 1, 1)) return problem(406, "not_acceptable", std::string(kFrameFormats));
  const auto layer = read_layer(request);
  if (!layer) return ::tl::unexpected(layer.error());
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  const auto until = after_ms(wait_seconds(services, request, kFrameWaitS) * 1000.0);
  const auto frame = session->wait_frame(*after, request.gone, until);
  if (!frame && session->is_closed()) return problem(410, "session_closed", "the session was closed");
  if (!frame) return no_frame(services, request);
  if (!frame->image) {
    services.log.write(LogLevel::error, "render_failed",
                       {{"id", request.id}, {"session", session->id()}, {"cause", frame->error}});
    return problem(500, "render_failed", "the render of this view failed inside the server; another view may do");
  }
  const auto format = frame_format(request, frame->image->width, frame->image->height);
  if (!format) return not_acceptable(request, std::string(kFrameFormats), frame->image->width, frame->image->height);
  const auto start = Steady::now();
  auto encoded = encode_layer(services, *layer, *frame->image, *frame->error_bounds, frame->exposure, *format);
  if (!encoded) return not_encoded(services, request, encoded.error());
  services.metrics.add("tilelight_session_frames_total", "");
  char timing[96];
  std::snprintf(timing, sizeof timing, "render;dur=%.2f, encode;dur=%.2f", frame->progress.elapsed_ms, ms_since(start));
  Response response = shared_image(*encoded, *format);
  response.with("Frame-Seq", std::to_string(frame->seq))
      .with("View-Seq", std::to_string(frame->view_seq))
      .with("Frame-Final", frame->is_final ? "?1" : "?0")
      .with("Render-Info", render_info(frame->progress.spp, frame->is_final ? frame->report.stop : "", frame->report,
                                       (*encoded)->clamped))
      .with("Server-Timing", timing)
      .with("Cache-Control", "no-store");
  tell_wait(services, request, response);
  return response;
}

Reply delete_session(Services& services, const Request& request) {
  if (!services.sessions.find(request.args[0])) return no_such_session();
  if (auto met = check_conditions(request, {false}); !met) return ::tl::unexpected(met.error());
  if (!services.sessions.close(request.args[0])) return no_such_session();
  return empty_response(204);
}

}  // namespace tilelight::server
