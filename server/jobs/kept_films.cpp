// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/kept_films.h"

#include <algorithm>

namespace tilelight::server {

void KeptFilms::add(const WorkPtr& work) {
  if (!work->is_refinable()) return;
  {
    const std::lock_guard lock(mutex_);
    // Without a share in it, which could be the last one.
    const auto is_same = [&](const Entry& entry) {
      return !entry.work.owner_before(work) && !work.owner_before(entry.work);
    };
    if (std::none_of(entries_.begin(), entries_.end(), is_same)) entries_.push_back({work, clock_.mono_ms()});
  }
  drop_old();
}

void KeptFilms::drop_old() {
  // Declared before the lock: memory is given back after it.
  std::vector<WorkPtr> alive;
  std::vector<std::shared_ptr<const ExposedFilm>> dropped;
  const std::lock_guard lock(mutex_);
  std::deque<Entry> kept;
  int64_t bytes = 0;
  // The newest first: those that do not fit any more are the oldest, or larger than the whole budget.
  for (auto entry = entries_.rbegin(); entry != entries_.rend(); ++entry) {
    const WorkPtr work = alive.emplace_back(entry->work.lock());
    if (!work || !work->is_refinable()) continue;
    const int64_t own = work->film_bytes();
    if (bytes + own >= options_.max_bytes || clock_.mono_ms() - entry->since_ms >= options_.keep_ms) {
      dropped.push_back(work->drop_film());
    } else {
      bytes += own;
      kept.push_front(*entry);
    }
  }
  entries_ = std::move(kept);
}

int64_t KeptFilms::bytes() const {
  std::vector<WorkPtr> alive;  // as above
  const std::lock_guard lock(mutex_);
  int64_t bytes = 0;
  for (const Entry& entry : entries_) {
    if (const WorkPtr work = alive.emplace_back(entry.work.lock())) bytes += work->film_bytes();
  }
  return bytes;
}

}  // namespace tilelight::server
