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

IdempotencyKeys::Claim IdempotencyKeys::claim(const std::string& client, const std::string& key,
                                              const std::string& body_hash) {
  const std::lock_guard lock(mutex_);
  drop_old();
  Claim claim{{client, key}, body_hash, false, ""};
  if (const auto known = by_name_.find(claim.name); known != by_name_.end()) {
    claim.is_other_body = known->second->body_hash != body_hash;
    claim.job_id = known->second->job_id;
  } else {
    add(claim, "");
  }
  return claim;
}

std::string IdempotencyKeys::bind(const Claim& claim, const std::string& job_id) {
  const std::lock_guard lock(mutex_);
  const auto known = by_name_.find(claim.name);
  if (known == by_name_.end()) {  // released by a try that failed while this one went on
    add(claim, job_id);
    return job_id;
  }
  Entry& entry = *known->second;
  if (entry.body_hash == claim.body_hash && entry.job_id == claim.job_id) entry.job_id = job_id;
  return entry.body_hash == claim.body_hash ? entry.job_id : job_id;
}

void IdempotencyKeys::release(const Claim& claim) {
  const std::lock_guard lock(mutex_);
  const auto known = by_name_.find(claim.name);
  if (known == by_name_.end()) return;
  const Entry& entry = *known->second;
  if (entry.body_hash != claim.body_hash || entry.job_id != claim.job_id) return;
  entries_.erase(known->second);
  by_name_.erase(known);
}

void IdempotencyKeys::add(const Claim& claim, const std::string& job_id) {
  by_name_[claim.name] = entries_.insert(entries_.end(), {claim.name, claim.body_hash, job_id, clock_.mono_ms()});
}

}  // namespace tilelight::server
