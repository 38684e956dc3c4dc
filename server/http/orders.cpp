// SPDX-License-Identifier: Apache-2.0
#include "server/http/orders.h"

namespace tilelight::server {
namespace {

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
  const auto now = services.jobs.find(record->id);
  if (!now) return std::optional<Response>();  // deleted while this waited
  return std::optional<Response>(accepted_response(*now, request));
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

Reply submit_order(Services& services, const Request& request, const Order& order, RenderRequest&& render) {
  const ImageFormat format = render.format;
  auto lease = services.queue.submit(std::move(render));
  if (!lease) return refused(services, lease.error());
  if (order.wish.image) {
    auto image = wait_for_image(services, request, *lease->work(), format);
    if (!image) return ::tl::unexpected(image.error());
    if (*image) return std::move(**image);
  }
  const auto record = keep_job(services, std::move(*lease), request, order, format);
  if (!record) return refused(services, record.error());
  return accepted_response(*record, request);
}

}  // namespace

Reply accept_order(Services& services, const Request& request, const std::string& content_hash,
                   const std::function<::tl::expected<RenderRequest, Problem>(const Wish&)>& prepare) {
  const auto wish = read_wish(request);
  if (!wish) return ::tl::unexpected(wish.error());
  const auto key = read_idempotency_key(request);
  if (!key) return ::tl::unexpected(key.error());
  Order order{*wish, std::nullopt};
  if (!key->empty()) {
    order.claim = services.keys.claim(request.client, *key, content_hash);
    auto retried = answer_retry(services, request, *order.claim, *wish);
    if (!retried) return ::tl::unexpected(retried.error());
    if (*retried) return std::move(**retried);
  }
  auto render = prepare(*wish);
  Reply reply = render ? submit_order(services, request, order, std::move(*render))
                       : Reply(::tl::unexpected(std::move(render.error())));
  if (!reply && order.claim) services.keys.release(*order.claim);
  return reply;
}

}  // namespace tilelight::server
