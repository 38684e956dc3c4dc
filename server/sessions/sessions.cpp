// SPDX-License-Identifier: Apache-2.0
#include "server/sessions/sessions.h"

#include <vector>

#include "server/random_id.h"

namespace tilelight::server {
namespace {

int64_t pixels_of(const ImageSpec& image) { return int64_t{image.width} * image.height; }

}  // namespace

Result<SessionPtr> Sessions::open(CompiledPtr compiled, View view) {
  close_idle();
  auto session = std::make_shared<Session>(random_id(), pool_, std::move(compiled), view);
  {
    const std::lock_guard lock(mutex_);
    if (is_stopping_) return fail("stopping", "the server is stopping");
    if (static_cast<int>(by_id_.size()) >= max_sessions_) {
      return fail("too_many_sessions", std::to_string(by_id_.size()) + " sessions are open, the server's limit");
    }
    if (pixels() + pixels_of(view.image) > kMaxPixels) {
      return fail("too_many_pixels", "the views of all sessions together have as many pixels as they may");
    }
    by_id_[session->id()] = {session, clock_.mono_ms(), pixels_of(view.image)};
  }
  session->set_view(0, std::move(view), false);
  return session;
}

SessionPtr Sessions::find(const std::string& id) {
  close_idle();
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return nullptr;
  known->second.used_ms = clock_.mono_ms();
  return known->second.session;
}

int64_t Sessions::pixels() const {
  int64_t sum = 0;
  for (const auto& [id, entry] : by_id_) sum += entry.pixels;
  return sum;
}

bool Sessions::reserve(const std::string& id, int64_t seq, const ImageSpec& image) {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return true;  // closed meanwhile: the view goes nowhere
  if (seq <= known->second.view_seq) return true;
  if (pixels() - known->second.pixels + pixels_of(image) > kMaxPixels) return false;
  known->second.pixels = pixels_of(image);
  known->second.view_seq = seq;
  return true;
}

bool Sessions::close(const std::string& id) {
  SessionPtr session;
  {
    const std::lock_guard lock(mutex_);
    const auto known = by_id_.find(id);
    if (known == by_id_.end()) return false;
    session = std::move(known->second.session);
    by_id_.erase(known);
  }
  session->close();
  return true;
}

void Sessions::close_idle() {
  const double oldest = clock_.mono_ms() - kIdleMs;
  std::vector<SessionPtr> idle;
  {
    const std::lock_guard lock(mutex_);
    for (auto it = by_id_.begin(); it != by_id_.end();) {
      if (it->second.used_ms >= oldest) {
        ++it;
        continue;
      }
      idle.push_back(std::move(it->second.session));
      it = by_id_.erase(it);
    }
  }
  for (const SessionPtr& session : idle) session->close();
}

void Sessions::close_all() {
  std::map<std::string, Entry> all;
  {
    const std::lock_guard lock(mutex_);
    is_stopping_ = true;
    all.swap(by_id_);
  }
  for (const auto& [id, entry] : all) entry.session->close();
}

int Sessions::count() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int>(by_id_.size());
}

}  // namespace tilelight::server
