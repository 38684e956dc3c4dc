// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_store.h"

namespace tilelight::server {

bool MemoryJobStore::put(JobRecord& record) {
  const std::lock_guard lock(mutex_);
  if (const auto known = by_id_.find(record.id); known != by_id_.end()) {
    record.sequence = known->second;
  } else {
    record.sequence = next_sequence_++;
    by_id_[record.id] = record.sequence;
  }
  by_sequence_[record.sequence] = record;
  for (auto it = by_sequence_.begin(); by_sequence_.size() > max_records_ && it != by_sequence_.end();) {
    if (!is_final(it->second.status.state)) {
      ++it;
      continue;
    }
    by_id_.erase(it->second.id);
    it = by_sequence_.erase(it);
  }
  return true;
}

void MemoryJobStore::update(const JobRecord& record) {
  const std::lock_guard lock(mutex_);
  if (const auto known = by_sequence_.find(record.sequence); known != by_sequence_.end()) known->second = record;
}

std::optional<JobRecord> MemoryJobStore::find(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return std::nullopt;
  return by_sequence_.at(known->second);
}

bool MemoryJobStore::erase(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return false;
  by_sequence_.erase(known->second);
  by_id_.erase(known);
  return true;
}

std::vector<JobRecord> MemoryJobStore::list(const JobFilter& filter) const {
  const std::lock_guard lock(mutex_);
  std::vector<JobRecord> out;
  for (auto it = std::make_reverse_iterator(by_sequence_.lower_bound(filter.before)); it != by_sequence_.rend(); ++it) {
    if (static_cast<int>(out.size()) >= filter.limit) break;
    const JobRecord& record = it->second;
    if (record.client != filter.client || (filter.state && record.status.state != *filter.state)) continue;
    out.push_back(record);
  }
  return out;
}

int64_t MemoryJobStore::count() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int64_t>(by_id_.size());
}

}  // namespace tilelight::server
