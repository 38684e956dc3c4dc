// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/idempotency.h"

namespace tilelight::server {

void IdempotencyKeys::drop_old() {
  const double oldest = clock_.mono_ms() - kLifeMs;
  while (!entries_.empty() && (entries_.front().since_ms < oldest || entries_.size() > kMaxKeys)) {
    by_name_.erase(entries_.front().name);
    entries_.pop_front();
  }
}

IdempotencyKeys::Seen IdempotencyKeys::claim(const std::string& client, const std::string& key,
                                             const std::string& body_hash) {
  const std::lock_guard lock(mutex_);
  drop_old();
  const std::pair name(client, key);
  if (const auto known = by_name_.find(name); known != by_name_.end()) {
    return {known->second->body_hash != body_hash, known->second->job_id};
  }
  by_name_[name] = entries_.insert(entries_.end(), {name, body_hash, "", clock_.mono_ms()});
  return {};
}

std::string IdempotencyKeys::bind(const std::string& client, const std::string& key, const std::string& job_id) {
  const std::lock_guard lock(mutex_);
  const auto known = by_name_.find({client, key});
  if (known == by_name_.end()) return job_id;
  if (known->second->job_id.empty()) known->second->job_id = job_id;
  return known->second->job_id;
}

}  // namespace tilelight::server
