// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/hash.h"
#include "server/http/documents.h"
#include "server/http/handlers.h"
#include "server/http/orders.h"
#include "server/http/render_body.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

::tl::unexpected<Problem> no_such_render() {
  return problem(404, "no_such_render",
                 "no render with this id is known; it may have been deleted, or so many came after "
                 "it that its record was dropped");
}

std::string render_etag(const WorkStatus& status) { return "W/\"" + std::to_string(status.revision) + "\""; }

// Whether others may go on from it, or why not.
::tl::expected<void, Problem> check_refinable(Services& services, const JobRecord& record, const WorkPtr& work) {
  const JobState state = record.status.state;
  const std::string name(job_state_name(state));
  if (!is_final(state)) return problem(409, "not_ready", "the render is " + name + "; refine it once it is done");
  if (state != JobState::done)
    return problem(409, name, "the render is " + name + " and can not be refined; submit it again");
  // Who asks at once may come before those who are told of the end.
  if (work) services.jobs.films().add(work);
  if (work && work->is_refinable()) return {};
  return problem(410, "expired",
                 "the film of this render is no longer kept (/v1/limits says how long and how much); submit the scene "
                 "again with the samples or the error that it shall have");
}

}  // namespace

Reply post_render(Services& services, const Request& request) {
  return accept_order(services, request, sha256_hex(request.body), [&]() -> ::tl::expected<Ordered, Problem> {
    auto body = read_render_body(services, request.body, {"format", "priority"});
    if (!body) return ::tl::unexpected(body.error());
    RenderRequest render{body->scene, std::move(body->view)};
    render.format = body->format.value_or(ImageFormat::png);
    render.warnings = std::move(body->warnings);
    render.parse_ms = body->parse_ms;
    return Ordered{std::move(render), body->priority};
  });
}

Reply post_refine(Services& services, const Request& request) {
  const std::string& id = request.args[0];
  return accept_order(services, request, sha256_hex("refine;" + id + ";" + std::string(request.body)),
                      [&]() -> ::tl::expected<Ordered, Problem> {
                        const auto record = services.jobs.find(id);
                        if (!record) return no_such_render();
                        if (auto met = check_conditions(request, {false}); !met) return ::tl::unexpected(met.error());
                        const WorkPtr work = services.jobs.work(id);
                        if (auto can = check_refinable(services, *record, work); !can)
                          return ::tl::unexpected(can.error());
                        auto body = read_refine_body(request.body, work->request().view, record->status.report,
                                                     services.config.limits);
                        if (!body) return ::tl::unexpected(body.error());
                        RenderRequest render{work->request().scene, std::move(body->view)};
                        render.format = body->format.value_or(record->format);
                        render.warnings = work->request().warnings;
                        render.parse_ms = body->parse_ms;
                        render.refines = RefineSource{id, record->status.report, work->film()};
                        return Ordered{std::move(render), body->priority};
                      });
}

Reply list_renders(Services& services, const Request& request) {
  JobFilter filter;
  filter.client = request.client;
  if (const auto state = request.param("state")) {
    filter.state = find_job_state(*state);
    if (!filter.state) return problem(400, "bad_query", "state must be queued, running, done, failed or cancelled");
  }
  if (request.param("limit")) {
    const auto limit = number_param(request, "limit");
    if (!limit || *limit < 1 || *limit > 200) return problem(400, "bad_query", "limit must be from 1 to 200");
    filter.limit = static_cast<int>(*limit);
  }
  if (const auto after = request.param("after")) {
    const auto cursor = whole_number<uint64_t>(*after, 16);
    if (!cursor) return problem(400, "bad_query", "after must be a cursor from a Link header");
    filter.before = *cursor;
  }
  const int limit = filter.limit++;  // one more tells whether there is a next page
  auto records = services.jobs.list(filter);
  const bool has_more = static_cast<int>(records.size()) > limit;
  if (has_more) records.pop_back();
  Response response = json_response(200, jobs_json(records, request.prefix));
  response.with("Cache-Control", "no-store");
  if (has_more) {
    char cursor[32];
    std::snprintf(cursor, sizeof cursor, "%llx", static_cast<unsigned long long>(records.back().sequence));
    std::string next =
        "<" + location_of(request, "/v1/renders?after=") + std::string(cursor) + "&limit=" + std::to_string(limit);
    if (filter.state) next += "&state=" + std::string(job_state_name(*filter.state));
    response.with("Link", next + ">; rel=\"next\"");
  }
  return response;
}

Reply get_render(Services& services, const Request& request) {
  const std::string& id = request.args[0];
  auto record = services.jobs.find(id);
  if (!record) return no_such_render();
  const auto etag = [&] { return render_etag(record->status); };
  // Before this waits; of other GETs route() holds it against the answer.
  if (!is_match_met(request, {true, etag()})) return ::tl::unexpected<Problem>(precondition_failed({true, etag()}));
  const double wait_s = wait_seconds(services, request, 0.0);
  const WorkPtr work = services.jobs.work(id);
  // A client that says what it has waits for the next change of that; others for the next change from now.
  const bool is_up_to_date = !request.header("If-None-Match") || has_current(request, etag());
  if (wait_s > 0.0 && work && is_up_to_date) {
    auto slot = services.waits.take(request.client);
    if (!slot) return ::tl::unexpected(slot.error());
    work->wait_change(record->status.revision, request.gone, after_ms(wait_s * 1000.0));
    record = services.jobs.find(id);
    if (!record) return no_such_render();
  }
  Response response =
      has_current(request, etag()) ? empty_response(304) : json_response(200, job_json(*record, request.prefix));
  response.with("ETag", etag()).with("Cache-Control", "no-cache").with("Server-Timing", server_timing(record->status));
  tell_wait(services, request, response);
  return response;
}

Reply delete_render(Services& services, const Request& request) {
  const auto record = services.jobs.find(request.args[0]);
  if (!record) return no_such_render();
  if (auto met = check_conditions(request, {true, render_etag(record->status)}); !met) {
    return ::tl::unexpected(met.error());
  }
  if (!services.jobs.forget(request.args[0])) return no_such_render();
  return empty_response(204);
}

namespace {

// Of a render that is done, on the pool; none where it cannot be told, or not now.
std::optional<double> rounding_of(Services& services, const Request& request, RenderWork& work) {
  const auto slot = services.waits.take(request.client);
  if (!slot) return std::nullopt;
  return work.final_rounding([&]() -> std::optional<double> {
    const RenderRequest& order = work.request();
    const auto compiled = wait_compiled(services, request, order.scene, Priority::normal);
    if (!compiled) return std::nullopt;
    const auto find = [&] {
      return find_rounding(order.scene->parsed.scene, **compiled, plan_view(**compiled, order.view));
    };
    return services.pool.submit(Priority::interactive, find).get();
  });
}

}  // namespace

Reply get_render_report(Services& services, const Request& request) {
  const auto record = services.jobs.find(request.args[0]);
  if (!record) return no_such_render();
  const auto type = best_offer(request, {"application/json", "text/csv", "image/svg+xml"});
  if (!type)
    return problem(406, "not_acceptable", "a report can be had as application/json, text/csv or image/svg+xml");
  const RenderReport& report = record->status.report;
  Response response{200, {}, std::string(*type), ""};
  if (*type == "text/csv") {
    response.body = report_csv(report);
  } else if (*type == "image/svg+xml") {
    response.body = report_svg(report);
  } else {
    const WorkPtr work = services.jobs.work(request.args[0]);
    const auto rounding = work ? rounding_of(services, request, *work) : std::nullopt;
    response.body = report_document(*record, work ? work->final_image_hash() : std::string(), rounding);
  }
  response.with("Vary", "Accept").with("Cache-Control", "no-cache");
  return response;
}

Reply get_render_pixel(Services& services, const Request& request) {
  const auto record = services.jobs.find(request.args[0]);
  if (!record) return no_such_render();
  const WorkPtr work = services.jobs.work(request.args[0]);
  if (!work) return problem(410, "expired", "the render is no longer kept; only its record is");
  const auto x = number_param(request, "x"), y = number_param(request, "y");
  const auto sample = request.param("sample") ? number_param(request, "sample") : std::optional<int64_t>(0);
  if (!x || !y || !sample || *sample < 0 || *sample >= services.config.limits.samples || *x < 0 || *y < 0 ||
      *x >= work->request().view.image.width || *y >= work->request().view.image.height) {
    return problem(422, "out_of_range",
                   "x and y must name a pixel of the image, sample (0 if absent) one of its samples");
  }
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  const auto compiled = wait_compiled(services, request, work->request().scene, Priority::normal);
  if (!compiled) return ::tl::unexpected(compiled.error());
  const ViewPlan plan = plan_view(**compiled, work->request().view);
  auto json = explain_pixel_json(*compiled, plan, services.pool, static_cast<int>(*x), static_cast<int>(*y),
                                 static_cast<int>(*sample));
  if (!json) return problem(422, json.error().code, json.error().detail);
  return json_response(200, std::move(*json)).with("Cache-Control", "no-cache");
}

}  // namespace tilelight::server
