// SPDX-License-Identifier: Apache-2.0
#include "server/http/documents.h"
#include "server/http/handlers.h"
#include "server/http/render_body.h"

namespace tilelight::server {
namespace {

::tl::unexpected<Problem> no_such_scene() {
  return problem(404, "no_such_scene", "no scene with this id is stored (any more); store it with POST /v1/scenes");
}

// What the view of the scene needs, as a plan document.
Reply plan_response(Services& services, const Request& request, const ScenePtr& scene, const View& view,
                    const std::vector<SceneWarning>& warnings) {
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  const auto compiled = wait_compiled(services, request, scene, Priority::normal);
  if (!compiled) return ::tl::unexpected(compiled.error());
  const ViewPlan plan = plan_view(**compiled, view);
  // On the pool, as all tracing is; what it throws comes back here.
  const auto predict = [&] { return predict_cost(*compiled, plan, services.pool); };
  const CostPrediction cost = services.pool.submit(Priority::normal, predict).get();
  return json_response(200, plan_document(scene->parsed.scene_id, warnings, plan, cost))
      .with("Cache-Control", "no-cache");
}

}  // namespace

Reply post_scene(Services& services, const Request& request) {
  const auto scene = read_scene(services, request.body);
  if (!scene) return ::tl::unexpected(scene.error());
  const ParsedScene& parsed = (*scene)->parsed;
  const bool is_new = services.scenes.put(*scene);
  const std::string id = parsed.scene_id;
  return json_response(is_new ? 201 : 200, scene_document(id, parsed.warnings))
      .with("Location", location_of(request, "/v1/scenes/" + id));
}

Reply get_scene(Services& services, const Request& request) {
  const ScenePtr scene = services.scenes.find(request.args[0]);
  if (!scene) return no_such_scene();
  // The id is the hash of what the document means, so two spellings share it: a weak tag.
  const std::string etag = "W/\"" + scene->parsed.scene_id.substr(0, 32) + "\"";
  Response response = has_current(request, etag) ? empty_response(304) : json_response(200, "");
  if (response.status == 200) response.shared = SharedBytes(scene, &scene->text);
  return response.with("ETag", etag).with("Cache-Control", "private, max-age=31536000");
}

Reply get_scene_plan(Services& services, const Request& request) {
  const ScenePtr scene = services.scenes.find(request.args[0]);
  if (!scene) return no_such_scene();
  const auto view = read_view_query(request, scene->parsed.view, services.config.limits);
  if (!view) return ::tl::unexpected(view.error());
  return plan_response(services, request, scene, *view, scene->parsed.warnings);
}

Reply post_plan(Services& services, const Request& request) {
  const auto body = read_render_body(services, request.body, {"format", "priority"});
  if (!body) return ::tl::unexpected(body.error());
  return plan_response(services, request, body->scene, body->view, body->warnings);
}

}  // namespace tilelight::server
