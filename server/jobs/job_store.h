// SPDX-License-Identifier: Apache-2.0
// JobStore: where the records of jobs are kept. This release has one in memory; a durable one takes the same calls and
// returns from put() when the record is committed. Any thread.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/job.h"

namespace tilelight::server {

struct JobFilter {
  std::string client;  // only this client's
  std::optional<JobState> state;
  uint64_t before = UINT64_MAX;  // only of a smaller sequence
  int limit = 50;
};

class JobStore {
 public:
  virtual ~JobStore() = default;
  // Adds the record and gives it its sequence, or replaces the one with its id. False if the store had to refuse.
  virtual bool put(JobRecord& record) = 0;
  // Replaces the record if it is still there: a late change must not bring back what was forgotten.
  virtual void update(const JobRecord& record) = 0;
  virtual std::optional<JobRecord> find(const std::string& id) const = 0;
  virtual bool erase(const std::string& id) = 0;
  // Newest first, at most filter.limit.
  virtual std::vector<JobRecord> list(const JobFilter& filter) const = 0;
  virtual int64_t count() const = 0;
};

class MemoryJobStore final : public JobStore {
 public:
  // Over max_records the oldest record of an ended job is dropped.
  explicit MemoryJobStore(size_t max_records) : max_records_(max_records) {}
  bool put(JobRecord& record) override;
  void update(const JobRecord& record) override;
  std::optional<JobRecord> find(const std::string& id) const override;
  bool erase(const std::string& id) override;
  std::vector<JobRecord> list(const JobFilter& filter) const override;
  int64_t count() const override;

 private:
  const size_t max_records_;
  mutable std::mutex mutex_;  // guards the rest
  std::map<uint64_t, JobRecord> by_sequence_;
  std::map<std::string, uint64_t> by_id_;
  uint64_t next_sequence_ = 1;
};

}  // namespace tilelight::server
