// SPDX-License-Identifier: Apache-2.0
#include "server/http/event_stream.h"

#include "server/http/documents.h"

namespace tilelight::server {
namespace {

constexpr double kProgressMs = 250.0;
constexpr double kCommentMs = 15'000.0;  // under the half minute after which proxies take a connection for dead

// data: one line, as our documents are.
std::string event(std::string_view name, std::string_view id, std::string_view data) {
  std::string out = "event: " + std::string(name) + "\n";
  if (!id.empty()) out += "id: " + std::string(id) + "\n";
  return out + "data: " + std::string(data) + "\n\n";
}

}  // namespace

std::string next_events(const WorkStatus& status, EventCursor& cursor) {
  std::string out;
  if (cursor.state != status.state) {
    cursor.state = status.state;
    out += event("state", "", state_document(status));
  }
  const auto& points = status.report.points;
  while (cursor.points < points.size() && out.size() < kEventBytes) {
    const ReportPoint& point = points[cursor.points++];
    out += event("point", std::to_string(cursor.points), point_document(point));
  }
  if (is_final(status.state) && !cursor.is_done && cursor.points >= points.size()) {
    cursor.is_done = true;
    out += event("done", "end", state_document(status));
  }
  return out;
}

std::optional<std::string> EventStream::next() {
  if (cursor_.is_done) return std::nullopt;
  const WorkStatus status = work_->status();
  std::string out = next_events(status, cursor_);
  const double now = clock_.mono_ms();
  if (status.state == JobState::running && now - progress_ms_ >= kProgressMs) {
    progress_ms_ = now;
    out += event("progress", "", progress_document(status.progress));
  }
  if (now - comment_ms_ >= kCommentMs) {
    comment_ms_ = now;
    out += ":\n\n";
  }
  return out;
}

}  // namespace tilelight::server
