// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_stream.h"
#include "server/http/handlers.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

// A place for a stream, which takes no worker: connection and memory are what it costs.
::tl::expected<WaitSlots::Slot, Problem> take_stream(Services& services, const std::string& client) {
  auto slot = services.streams.take(client);
  if (!slot) {
    slot.error().code = "too_many_streams";
    slot.error().detail = "as many event streams are open as may be; ask for the render with Prefer: wait=N instead";
  }
  return slot;
}

}  // namespace

Reply get_render_events(Services& services, const Request& request) {
  const std::string& id = request.args[0];
  const auto record = services.jobs.find(id);
  if (!record) return problem(404, "no_such_render", "no render with this id is known");
  if (!best_offer(request, {"text/event-stream"}))
    return problem(406, "not_acceptable", "events can be had as text/event-stream");
  const std::string_view last = request.header("Last-Event-ID").value_or("");
  const bool has_ended = is_final(record->status.state);
  if (has_ended && last == "end") return empty_response(204).with("Cache-Control", "no-store");
  EventCursor cursor;
  cursor.points = whole_number<uint32_t>(last).value_or(0);
  Response response{200, {}, "text/event-stream", ""};
  // nginx would hold small pieces back to fill its buffer.
  response.with("Cache-Control", "no-store").with("X-Accel-Buffering", "no");
  const WorkPtr work = services.jobs.work(id);
  if (has_ended || !work) {
    while (!cursor.is_done) {
      const std::string piece = next_events(record->status, cursor);
      if (piece.empty()) break;
      response.body += piece;
    }
    return response;
  }
  auto slot = take_stream(services, request.client);
  if (!slot) return ::tl::unexpected(slot.error());
  response.stream = std::make_shared<EventStream>(work, cursor, services.clock, std::move(*slot));
  return response;
}

}  // namespace tilelight::server
