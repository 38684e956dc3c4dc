// SPDX-License-Identifier: Apache-2.0
#include "renderer/base/hash.h"
#include "server/http/documents.h"
#include "server/http/handlers.h"
#include "server/http/render_body.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

::tl::unexpected<Problem> no_such_render() {
  return problem(404, "no_such_render",
                 "no render with this id is known; it may have been deleted, or so many came after "
                 "it that its record was dropped");
}

// What the client wants for an answer.
struct Wish {
  std::optional<ImageFormat> image;  // wait and answer with it; nothing: answer with the job
};

::tl::expected<Wish, Problem> read_wish(const Request& request) {
  if (read_preferences(request).respond_async) return Wish{};
  const auto image = asked_image_format(request);
  if (!image && !best_offer(request, {"application/json"})) {
    return problem(406, "not_acceptable",
                   "a render can be answered as image/png, image/jpeg, image/x-exr or, as a job, application/json");
  }
  return Wish{image};
}

// Waits for the work; the image, or nothing if it takes longer than the client waits.
::tl::expected<std::optional<Response>, Problem> wait_for_image(Services& services, const Request& request,
                                                                RenderWork& work, ImageFormat format) {
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  const bool has_ended = work.wait_end(request.gone, after_ms(wait_seconds(request, kImageWaitS) * 1000.0));
  if (request.gone.stop_requested()) return client_gone();
  if (!has_ended) return std::optional<Response>();
  if (work.state() != JobState::done) return ended_without_image(work.status());
  auto image = work.encoded(format, services.pool);
  if (!image) return problem(410, image.error().code, image.error().detail);
  Response response = image_response(work, *image, format);
  response.with("Cache-Control", "no-store");
  return std::optional<Response>(std::move(response));
}

// The client's key of a request that may be sent twice. Empty: none.
::tl::expected<std::string, Problem> read_idempotency_key(const Request& request) {
  const std::string key(request.header("Idempotency-Key").value_or(""));
  if (key.size() > 255) return problem(400, "bad_request", "an Idempotency-Key may have 255 characters");
  return key;
}

// Answers a retry with the job that its first try led to, if it is still there.
::tl::expected<std::optional<Response>, Problem> answer_retry(Services& services, const Request& request,
                                                              const IdempotencyKeys::Claim& claim, const Wish& wish) {
  if (claim.is_other_body) {
    return problem(422, "idempotency_key_reused", "this Idempotency-Key came with another body before");
  }
  const auto record = claim.job_id.empty() ? std::nullopt : services.jobs.find(claim.job_id);
  if (!record) return std::optional<Response>();
  const WorkPtr work = services.jobs.work(record->id);
  if (wish.image && work) {
    auto image = wait_for_image(services, request, *work, *wish.image);
    if (!image || *image) return image;
  }
  return std::optional<Response>(accepted_response(*services.jobs.find(record->id), request));
}

// What a POST of a render wants, read from its headers. The claim: of the request's idempotency key, if it has one.
struct Order {
  Wish wish;
  std::optional<IdempotencyKeys::Claim> claim;
};

// The record of the job that answers the request: a new one, or that of a retry that came meanwhile and was faster.
Result<JobRecord> keep_job(Services& services, WorkLease lease, const Request& request, const Order& order,
                           ImageFormat format) {
  auto record = services.jobs.keep(std::move(lease), request.client, format);
  if (!record || !order.claim) return record;
  const std::string winner = services.keys.bind(*order.claim, record->id);
  if (winner == record->id) return record;
  auto first = services.jobs.find(winner);
  if (!first) return record;  // deleted since
  services.jobs.forget(record->id);
  return std::move(*first);
}

Reply submit_render(Services& services, const Request& request, const Order& order) {
  auto body = read_render_body(services, request.body, {"format", "priority"});
  if (!body) return ::tl::unexpected(body.error());
  const std::optional<ImageFormat>& image_format = order.wish.image;
  // "format" says how a job keeps its image; an image that is waited for is what Accept says.
  const ImageFormat format = image_format.value_or(body->format.value_or(ImageFormat::png));
  const Priority priority = body->priority.value_or(image_format ? Priority::normal : Priority::batch);
  auto lease = services.queue.submit(
      {body->scene, std::move(body->view), format, priority, std::move(body->warnings), body->parse_ms});
  if (!lease) return refused(services, lease.error());
  if (image_format) {
    auto image = wait_for_image(services, request, *lease->work(), format);
    if (!image) return ::tl::unexpected(image.error());
    if (*image) return std::move(**image);
  }
  const auto record = keep_job(services, std::move(*lease), request, order, format);
  if (!record) return refused(services, record.error());
  return accepted_response(*record, request);
}

}  // namespace

Reply post_render(Services& services, const Request& request) {
  const auto wish = read_wish(request);
  if (!wish) return ::tl::unexpected(wish.error());
  const auto key = read_idempotency_key(request);
  if (!key) return ::tl::unexpected(key.error());
  Order order{*wish, std::nullopt};
  if (!key->empty()) {
    order.claim = services.keys.claim(request.client, *key, sha256_hex(request.body));
    auto retried = answer_retry(services, request, *order.claim, *wish);
    if (!retried) return ::tl::unexpected(retried.error());
    if (*retried) return std::move(**retried);
  }
  Reply reply = submit_render(services, request, order);
  if (!reply && order.claim) services.keys.release(*order.claim);
  return reply;
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
  Response response = json_response(200, jobs_json(records));
  response.with("Cache-Control", "no-store");
  if (has_more) {
    char cursor[32];
    std::snprintf(cursor, sizeof cursor, "%llx", static_cast<unsigned long long>(records.back().sequence));
    std::string next = "</v1/renders?after=" + std::string(cursor) + "&limit=" + std::to_string(limit);
    if (filter.state) next += "&state=" + std::string(job_state_name(*filter.state));
    response.with("Link", next + ">; rel=\"next\"");
  }
  return response;
}

Reply get_render(Services& services, const Request& request) {
  const std::string& id = request.args[0];
  auto record = services.jobs.find(id);
  if (!record) return no_such_render();
  const auto etag = [&] { return "W/\"" + std::to_string(record->status.revision) + "\""; };
  const double wait_s = wait_seconds(request, 0.0);
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
  Response response = has_current(request, etag()) ? empty_response(304) : json_response(200, job_json(*record));
  response.with("ETag", etag()).with("Cache-Control", "no-cache").with("Server-Timing", server_timing(record->status));
  return response;
}

Reply delete_render(Services& services, const Request& request) {
  if (!services.jobs.forget(request.args[0])) return no_such_render();
  return empty_response(204);
}

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
    response.body = report_json(report, record->status.plan.value_or(Plan{}));
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
  const CompiledScene& scene = **compiled;
  auto json = explain_pixel_json(scene, plan_view(scene, work->request().view), static_cast<int>(*x),
                                 static_cast<int>(*y), static_cast<int>(*sample));
  if (!json) return problem(422, json.error().code, json.error().detail);
  return json_response(200, std::move(*json)).with("Cache-Control", "no-cache");
}

}  // namespace tilelight::server
