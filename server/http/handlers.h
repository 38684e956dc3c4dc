// SPDX-License-Identifier: Apache-2.0
// The handlers of all routes, by file: renders, images of renders, scenes, sessions, discovery and page, admin.
#pragma once

#include "server/http/negotiate.h"
#include "server/http/services.h"

namespace tilelight::server {

// handlers_renders.cpp
Reply post_render(Services&, const Request&);
Reply post_refine(Services&, const Request&);
Reply list_renders(Services&, const Request&);
Reply get_render(Services&, const Request&);
Reply delete_render(Services&, const Request&);
Reply get_render_report(Services&, const Request&);
Reply get_render_pixel(Services&, const Request&);

// handlers_events.cpp
Reply get_render_events(Services&, const Request&);

// handlers_images.cpp
Reply get_render_image(Services&, const Request&);
Reply get_scene_image(Services&, const Request&);

// handlers_scenes.cpp
Reply post_scene(Services&, const Request&);
Reply get_scene(Services&, const Request&);
Reply get_scene_plan(Services&, const Request&);
Reply post_plan(Services&, const Request&);

// handlers_sessions.cpp
Reply post_session(Services&, const Request&);
Reply put_session_view(Services&, const Request&);
Reply get_session_frame(Services&, const Request&);
Reply delete_session(Services&, const Request&);

// handlers_page.cpp
Reply get_limits(Services&, const Request&);
Reply get_scene_schema(Services&, const Request&);
Reply get_openapi(Services&, const Request&);
Reply get_page_file(Services&, const Request&);
bool is_page_file(const std::vector<std::string>& segments);

// handlers_admin.cpp
Reply get_livez(Services&, const Request&);
Reply get_readyz(Services&, const Request&);
Reply get_metrics(Services&, const Request&);
Reply get_version(Services&, const Request&);

// Shared by handlers; answers.cpp.

// How long a request for an image waits for it where the client does not say.
constexpr double kImageWaitS = 30.0;

// What a request is told whose client has closed its connection: for the log, since nobody reads it.
::tl::unexpected<Problem> client_gone();

// The compiled scene, waited for. REQUIRES: a slot to wait in. Problems: client_gone, compiling (it takes longer than a
// request may wait; it goes on, so that a retry finds it), internal.
::tl::expected<CompiledPtr, Problem> wait_compiled(Services& services, const Request& request, const ScenePtr& scene,
                                                   Priority priority);

// The location of one of our resources ("/v1/renders/...") as the client has to ask for it.
inline std::string location_of(const Request& request, const std::string& path) { return request.prefix + path; }

// A whole number from a query. Nothing: it is absent, or anything else.
std::optional<int64_t> number_param(const Request& request, const std::string& name);

// How long this request waits: Prefer: wait=N, else the default, and at most --max-wait-s.
double wait_seconds(const Services& services, const Request& request, double default_s);
// Says in Preference-Applied which wait was granted, where the client asked for one. Not for answers that caches keep.
void tell_wait(const Services& services, const Request& request, Response& response);

// What a refused submission becomes.
::tl::unexpected<Problem> refused(Services& services, const Error& error);

// An encoded image of the render with its entity tag, timings and figures.
Response image_response(const RenderWork& work, const EncodedPtr& image, ImageFormat format);
// The same without them.
Response shared_image(const EncodedPtr& image, ImageFormat format);

// 202 and the job that now holds the work.
Response accepted_response(const Services& services, const JobRecord& record, const Request& request);

// A render that ended without an image as a problem: 503 where it was cancelled, 500 where it failed.
::tl::unexpected<Problem> ended_without_image(const WorkStatus& status);

std::string server_timing(const WorkStatus& status);
// What of a picture is asked for by ?layer=.
enum class Layer { color, error };
::tl::expected<Layer, Problem> read_layer(const Request& request);
// On the pool. error_bounds: by pixel of the image.
Result<EncodedPtr> encode_layer(Services& services, Layer layer, const Image& image,
                                const std::vector<float>& error_bounds, double exposure_stops, ImageFormat format);
// clamped: values of the picture that its format cannot hold; told where there are any.
std::string render_info(double spp, std::string_view stop, const RenderReport& report, int64_t clamped);

// 406: what there is, and, for a format that the client accepts but that cannot hold a picture of this size, its limit.
::tl::unexpected<Problem> not_acceptable(const Request& request, std::string what_there_is, int width, int height);
// What becomes of a picture that was rendered and cannot be encoded.
::tl::unexpected<Problem> not_encoded(Services& services, const Request& request, const Error& error);

}  // namespace tilelight::server
