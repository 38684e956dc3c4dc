// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/base/hash.h"
#include "server/http/handlers.h"
#include "server/http/render_body.h"

namespace tilelight::server {
namespace {

// The format in which to serve an image of a view, of those that there are of it; its own where the client has no
// favourite. The error by pixel has no lines.
::tl::expected<ImageFormat, Problem> image_format_for(const Request& request, const View& view, Layer layer,
                                                      ImageFormat own) {
  const auto& [width, height, exposure] = view.image;
  std::vector<ImageFormat> formats = image_formats(layer == Layer::color && draws_lines(view), width, height);
  std::stable_partition(formats.begin(), formats.end(), [own](ImageFormat format) { return format == own; });
  std::vector<std::string_view> offers;
  for (const ImageFormat format : formats) offers.push_back(media_type(format));
  const auto type = best_offer(request, offers);
  if (!type) {
    return not_acceptable(request,
                          "an image can be had as image/png, image/jpeg or image/x-exr, one by the algorithm roberts "
                          "(but not its error) also as image/svg+xml",
                          width, height);
  }
  return *image_format_from_media_type(*type);
}

// The whole passes so far. Errors: not_ready, or the encoder's.
Result<EncodedPtr> encode_so_far(Services& services, const RenderWork& work, Layer layer, ImageFormat format) {
  const Error not_ready{
      "not_ready", "the render is " + std::string(job_state_name(work.state())) + " and has no whole pass to show"};
  if (format == ImageFormat::svg) {
    const auto lines = [&work] { return work.lines_svg(); };
    std::string svg = services.pool.submit(Priority::interactive, lines).get();
    if (svg.empty()) return ::tl::unexpected(not_ready);
    return tagged(std::move(svg));
  }
  const auto [image, error_bounds] = work.picture();
  if (!image) return ::tl::unexpected(not_ready);
  return encode_layer(services, layer, *image, *error_bounds, work.request().view.image.exposure, format);
}

Reply partial_image(Services& services, const Request& request, const RenderWork& work, Layer layer,
                    ImageFormat format) {
  const auto encoded = encode_so_far(services, work, layer, format);
  if (!encoded && encoded.error().code == "not_ready") return problem(409, "not_ready", encoded.error().detail);
  if (!encoded) return not_encoded(services, request, encoded.error());
  return image_response(work, *encoded, format).with("Cache-Control", "no-store");
}

// Of a render that is done. Errors: expired, or the encoder's.
Result<EncodedPtr> error_layer(Services& services, const RenderWork& work, ImageFormat format) {
  const auto [image, error_bounds] = work.picture();
  if (!image) return fail("expired", "the error by pixel is no longer kept; submit the render again");
  return encode_layer(services, Layer::error, *image, *error_bounds, 0.0, format);
}

// Known before rendering: the same scene, view and version give the same bytes.
std::string scene_image_etag(const ScenePtr& scene, const View& view, ImageFormat format) {
  return "\"" +
         sha256_hex(scene->parsed.scene_id + ";" + view_fingerprint(view) + ";" +
                    std::string(image_format_name(format)) + ";" TILELIGHT_VERSION)
             .substr(0, 32) +
         "\"";
}

// What ?format= says; without it, what Accept likes best.
::tl::expected<ImageFormat, Problem> scene_image_format(const Request& request, const View& view) {
  const auto name = request.param("format");
  if (!name) return image_format_for(request, view, Layer::color, ImageFormat::png);
  const std::vector<ImageFormat> formats = image_formats(draws_lines(view));
  const auto named = find_image_format(*name);
  if (named && std::find(formats.begin(), formats.end(), *named) != formats.end()) {
    const auto fits = check_image_size(*named, view.image.width, view.image.height);
    if (fits) return *named;
    return scene_problem({SceneErrors::Kind::invalid, {{"/format", fits.error().code, fits.error().detail, {}, ""}}});
  }
  SceneError error{"/format", "unknown_name", "found '" + std::string(name->substr(0, 40)) + "'; allowed:", {}, ""};
  for (const ImageFormat format : formats) {
    error.allowed.emplace_back(image_format_name(format));
    error.detail += (error.allowed.size() > 1 ? ", " : " ") + error.allowed.back();
  }
  return scene_problem({SceneErrors::Kind::invalid, {std::move(error)}});
}

// The picture of a scene and a view is always the same, whoever asks, so any cache may keep it. An address that names
// the format needs no Vary, which would make a cache keep a copy for every spelling of Accept that browsers have.
// (Nobody needs a key to ask; a picture for holders of one would have to be private.) Preference-Applied is left out: a
// cache would tell it to clients that asked for another wait.
Response for_caches(Response response, const Request& request, const std::string& etag) {
  response.with("ETag", etag).with("Cache-Control", "public, max-age=31536000, immutable");
  if (!request.param("format")) response.with("Vary", "Accept");
  return response;
}

}  // namespace

Reply get_render_image(Services& services, const Request& request) {
  const auto record = services.jobs.find(request.args[0]);
  if (!record) return problem(404, "no_such_render", "no render with this id is known");
  const auto layer = read_layer(request);
  if (!layer) return ::tl::unexpected(layer.error());
  const WorkPtr work = services.jobs.work(request.args[0]);
  if (!work) return problem(410, "expired", "the image is no longer kept; submit the render again");
  const auto format = image_format_for(request, work->request().view, *layer, record->format);
  if (!format) return ::tl::unexpected(format.error());
  const auto partial = request.param("partial");
  if (partial && *partial != "1") return problem(400, "bad_query", "partial must be 1, or be left out");
  const bool wants_partial = partial.has_value();
  const JobState state = record->status.state;
  if (state != JobState::done) {
    if (wants_partial) return partial_image(services, request, *work, *layer, *format);
    const std::string name(job_state_name(state));
    return problem(409, is_final(state) ? name : "not_ready",
                   "the render is " + name + (is_final(state) ? "" : "; ?partial=1 shows what there is"));
  }
  auto image = *layer == Layer::color ? work->encoded(*format, services.pool) : error_layer(services, *work, *format);
  if (!image) return not_encoded(services, request, image.error());
  const char* kCacheControl = "private, max-age=31536000, immutable";
  if (has_current(request, (*image)->etag)) {
    return empty_response(304).with("ETag", (*image)->etag).with("Vary", "Accept").with("Cache-Control", kCacheControl);
  }
  return image_response(*work, *image, *format).with("Cache-Control", kCacheControl);
}

Reply get_scene_image(Services& services, const Request& request) {
  const ScenePtr scene = services.scenes.find(request.args[0]);
  if (!scene) return problem(404, "no_such_scene", "no scene with this id is stored (any more)");
  auto view = read_view_query(request, scene->parsed.view, services.config.limits);
  if (!view) return ::tl::unexpected(view.error());
  if (view->render.time_ms) {
    return problem(422, "time_ms",
                   "this scene stops by time, so its picture has no name to be cached under; ask POST "
                   "/v1/renders for it");
  }
  const auto format = scene_image_format(request, *view);
  if (!format) return ::tl::unexpected(format.error());
  const std::string etag = scene_image_etag(scene, *view, *format);
  // Before anything is rendered; of other GETs route() holds it against the answer.
  if (!is_match_met(request, {true, etag})) return ::tl::unexpected<Problem>(precondition_failed({true, etag}));
  if (has_current(request, etag)) return for_caches(empty_response(304), request, etag);
  if (const auto kept = services.pictures.find(etag)) {
    return for_caches(shared_image(kept->image, *format), request, etag).with("Render-Info", kept->render_info);
  }
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  auto lease = services.queue.submit({scene, std::move(*view), *format, Priority::normal, scene->parsed.warnings, 0.0});
  if (!lease) return refused(services, lease.error());
  RenderWork& work = *lease->work();
  if (!work.wait_end(request.gone, after_ms(wait_seconds(services, request, kImageWaitS) * 1000.0))) {
    if (request.gone.stop_requested()) return client_gone();
    const auto record = services.jobs.keep(std::move(*lease), request.client, *format);
    if (!record) return refused(services, record.error());
    return accepted_response(services, *record, request);
  }
  if (work.state() != JobState::done) return ended_without_image(work.status());
  auto image = work.encoded(*format, services.pool);
  if (!image) return not_encoded(services, request, image.error());
  const WorkStatus status = work.status();
  const std::string info = render_info(status.progress.spp, status.report.stop, status.report, (*image)->clamped);
  services.pictures.put(etag, {*image, info});
  return for_caches(shared_image(*image, *format), request, etag)
      .with("Server-Timing", server_timing(status))
      .with("Render-Info", info);
}

}  // namespace tilelight::server
