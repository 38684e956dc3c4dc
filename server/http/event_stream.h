// SPDX-License-Identifier: Apache-2.0
// EventStream: a render as Server-Sent Events (HTML, 9.2): `state` with each change, `point` for each of the report,
// `progress` at most four times a second while it runs, and `done` at the end. A point's id is its number and that of
// `done` is `end`, so that a client that comes again (Last-Event-ID) gets what it has missed.
#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "server/http/services.h"

namespace tilelight::server {

// What a client has been told.
struct EventCursor {
  size_t points = 0;
  std::optional<JobState> state = {};
  bool is_done = false;
};

// The events from the cursor on, which moves; all but progress. About kEventBytes at most: the rest comes with the next
// call.
inline constexpr size_t kEventBytes = 64 << 10;
std::string next_events(const WorkStatus& status, EventCursor& cursor);

class EventStream final : public BodyStream {
 public:
  // The slot is held as long as the stream. The clock must outlive it.
  EventStream(WorkPtr work, EventCursor cursor, const Clock& clock, WaitSlots::Slot slot)
      : work_(std::move(work)), clock_(clock), slot_(std::move(slot)), cursor_(cursor), comment_ms_(clock.mono_ms()) {}

  std::optional<std::string> next() override;

 private:
  const WorkPtr work_;
  const Clock& clock_;
  const WaitSlots::Slot slot_;
  EventCursor cursor_;
  double progress_ms_ = -INFINITY, comment_ms_;  // when they were sent last
};

}  // namespace tilelight::server
