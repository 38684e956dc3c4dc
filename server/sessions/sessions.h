// SPDX-License-Identifier: Apache-2.0
// Sessions: the interactive sessions of the server, at most a fixed number; one that nobody used for five minutes is
// closed. Any thread.
#pragma once

#include <map>
#include <mutex>
#include <string>

#include "server/sessions/session.h"

namespace tilelight::server {

class Sessions {
 public:
  static constexpr double kIdleMs = 5.0 * 60.0 * 1000.0;
  // Of the views of all sessions together: 1.6 GB of films and frames.
  static constexpr int64_t kMaxPixels = 64 << 20;

  Sessions(TilePool& pool, const Clock& clock, int max_sessions)
      : pool_(pool), clock_(clock), max_sessions_(max_sessions) {}
  ~Sessions() { close_all(); }

  // Opens a session and starts rendering its first view as number 0.
  // Errors: too_many_sessions, too_many_pixels, stopping.
  Result<SessionPtr> open(CompiledPtr compiled, View view);
  // Null if unknown or expired. Counts as use.
  SessionPtr find(const std::string& id);
  // Notes the size of the session's view of this sequence, unless one as new came before: that view will be ignored and
  // must not change the account. False: all sessions together would show too many pixels.
  bool reserve(const std::string& id, int64_t seq, const ImageSpec& image);
  bool close(const std::string& id);
  void close_idle();
  void close_all();  // and opens no more
  int count() const;

 private:
  struct Entry {
    SessionPtr session;
    double used_ms;
    int64_t pixels;  // of its newest view
    int64_t view_seq = 0;
  };
  int64_t pixels() const;  // REQUIRES: mutex_

  TilePool& pool_;
  const Clock& clock_;
  const int max_sessions_;
  mutable std::mutex mutex_;  // guards the rest; not held while a session is closed
  std::map<std::string, Entry> by_id_;
  bool is_stopping_ = false;
};

}  // namespace tilelight::server
