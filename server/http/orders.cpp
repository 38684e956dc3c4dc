// SPDX-License-Identifier: Apache-2.0
#include "server/http/orders.h"

namespace tilelight::server {
namespace {

// What the client wants for an answer.
struct AnswerKind {
  std::optional<ImageFormat> image;  // wait and answer with it; nothing: answer with the job
};

// What to answer with when none of the image types named in Accept can hold the picture.
std::optional<std::string_view> acceptable_fallback(const Request& request, const std::vector<ImageFormat>& formats) {
  std::vector<std::string_view> offers;
  if (asked_image_format(request, image_formats(true))) {
    for (const ImageFormat format : formats) offers.push_back(media_type(format));
  }
  offers.emplace_back("application/json");
  return best_offer(request, offers);
}

// formats: those that there are of the picture. size: of the picture, where it is known.
::tl::expected<AnswerKind, Problem> read_answer_kind(const Request& request, const std::vector<ImageFormat>& formats,
                                                     const ImageSpec& size) {
  // With both, it is a job where it takes longer than the wait (RFC 7240, 4.3).
  const Preferences preferences = read_preferences(request);
  if (preferences.respond_async && !preferences.wait_s) return AnswerKind{};
  if (const auto image = asked_image_format(request, formats)) return AnswerKind{image};
  if (const auto type = acceptable_fallback(request, formats)) return AnswerKind{image_format_from_media_type(*type)};
  return not_acceptable(request,
                        "a render can be answered as image/png, image/jpeg or image/x-exr, one by the algorithm "
                        "roberts also as image/svg+xml or, as a job, as application/json",
                        size.width, size.height);
}

::tl::expected<AnswerKind, Problem> read_answer_kind(const Request& request, const View& view) {
  return read_answer_kind(request, image_formats(view), view.image);
}

// Waits for the work; the image, or nothing if it takes longer than the client waits.
::tl::expected<std::optional<Response>, Problem> wait_for_image(Services& services, const Request& request,
                                                                RenderWork& work, ImageFormat format) {
  auto slot = services.waits.take(request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  const bool has_ended = work.wait_end(request.gone, after_ms(wait_seconds(services, request, kImageWaitS) * 1000.0));
  if (request.gone.stop_requested()) return client_gone();
  if (!has_ended) return std::optional<Response>();
  if (work.state() != JobState::done) return ended_without_image(work.status());
  auto image = work.encoded(format, services.pool);
  if (!image) return not_encoded(services, request, image.error());
  Response response = image_response(work, *image, format);
  response.with("Cache-Control", "no-store");
  tell_wait(services, request, response);
  return std::optional<Response>(std::move(response));
}

// The client's key of a request that may be sent twice. Empty: none.
::tl::expected<std::string, Problem> read_idempotency_key(const Request& request) {
  const std::string key(request.header("Idempotency-Key").value_or(""));
  if (key.size() > 255) return problem(400, "bad_request", "an Idempotency-Key may have 255 characters");
  return key;
}

// Of the request's idempotency key, if it has one.
using Claim = std::optional<IdempotencyKeys::Claim>;

// Answers a retry with the job that its first try led to, if it is still there.
::tl::expected<std::optional<Response>, Problem> answer_retry(Services& services, const Request& request,
                                                              const IdempotencyKeys::Claim& claim) {
  if (claim.is_other_body) {
    return problem(422, "idempotency_key_reused", "this Idempotency-Key came with another body before");
  }
  const auto record = claim.job_id.empty() ? std::nullopt : services.jobs.find(claim.job_id);
  if (!record) return std::optional<Response>();
  if (const WorkPtr work = services.jobs.work(record->id)) {
    const auto kind = read_answer_kind(request, work->request().view);
    if (!kind) return ::tl::unexpected(kind.error());
    if (kind->image) {
      auto image = wait_for_image(services, request, *work, *kind->image);
      if (!image || *image) return image;
    }
  }
  const auto now = services.jobs.find(record->id);
  if (!now) return std::optional<Response>();  // deleted while this waited
  return std::optional<Response>(accepted_response(services, *now, request));
}

// The record of the job that answers the request: a new one, or that of a retry that came meanwhile and was faster.
Result<JobRecord> keep_job(Services& services, WorkLease lease, const Request& request, const Claim& claim,
                           ImageFormat format) {
  auto record = services.jobs.keep(std::move(lease), request.client, format);
  if (!record || !claim) return record;
  const std::string winner = services.keys.bind(*claim, record->id);
  if (winner == record->id) return record;
  auto first = services.jobs.find(winner);
  if (!first) return record;  // deleted since
  services.jobs.forget(record->id);
  return std::move(*first);
}

Reply submit_order(Services& services, const Request& request, const Claim& claim, Ordered&& ordered) {
  RenderRequest& render = ordered.render;
  const auto kind = read_answer_kind(request, render.view);
  if (!kind) return ::tl::unexpected(kind.error());
  render.format = kind->image.value_or(render.format);
  render.priority = ordered.priority.value_or(kind->image ? Priority::normal : Priority::batch);
  render.becomes_job = !kind->image;
  const ImageFormat format = render.format;
  auto lease = services.queue.submit(std::move(render));
  if (!lease) return refused(services, lease.error());
  if (kind->image) {
    auto image = wait_for_image(services, request, *lease->work(), format);
    if (!image) return ::tl::unexpected(image.error());
    if (*image) return std::move(**image);
  }
  const auto record = keep_job(services, std::move(*lease), request, claim, format);
  if (!record) return refused(services, record.error());
  return accepted_response(services, *record, request);
}

}  // namespace

Reply accept_order(Services& services, const Request& request, const std::string& content_hash,
                   const std::function<::tl::expected<Ordered, Problem>()>& prepare) {
  // What nobody could answer is refused before the body is read.
  if (const auto kind = read_answer_kind(request, image_formats(true), ImageSpec{}); !kind)
    return ::tl::unexpected(kind.error());
  const auto key = read_idempotency_key(request);
  if (!key) return ::tl::unexpected(key.error());
  Claim claim;
  if (!key->empty()) {
    claim = services.keys.claim(request.client, *key, content_hash);
    auto retried = answer_retry(services, request, *claim);
    if (!retried) return ::tl::unexpected(retried.error());
    if (*retried) return std::move(**retried);
  }
  auto ordered = prepare();
  Reply reply = ordered ? submit_order(services, request, claim, std::move(*ordered))
                        : Reply(::tl::unexpected(std::move(ordered.error())));
  if (!reply && claim) services.keys.release(*claim);
  return reply;
}

}  // namespace tilelight::server
