// SPDX-License-Identifier: Apache-2.0
// Jobs: the renders that clients can come back to. Keeps their records, holds their work and lets the oldest results
// go when there are too many. Any thread.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "server/jobs/job_queue.h"
#include "server/jobs/job_store.h"
#include "server/jobs/kept_films.h"

namespace tilelight::server {

class Jobs : public std::enable_shared_from_this<Jobs> {
 public:
  struct Options {
    int max_results = 1000;
    int64_t max_result_bytes = int64_t{512} << 20;
    KeptFilms::Options films;
  };
  // The clock must outlive it.
  static std::shared_ptr<Jobs> make(std::unique_ptr<JobStore> store, const Clock& clock, Options options);

  // Makes a job of the work, whose image is served in this format unless a client accepts another one only; the record
  // is committed when this returns. Errors: store_refused; the work then lost this holder.
  Result<JobRecord> keep(WorkLease lease, const std::string& client, ImageFormat format);

  // The record with its progress of this moment.
  std::optional<JobRecord> find(const std::string& id) const;
  // Null for an unknown job and for one whose result has expired.
  WorkPtr work(const std::string& id) const;
  std::vector<JobRecord> list(const JobFilter& filter) const;
  // Cancels if nobody else holds the work, then forgets. False if it was not known.
  bool forget(const std::string& id);
  int64_t count() const { return store_->count(); }
  KeptFilms& films() { return films_; }

 private:
  Jobs(std::unique_ptr<JobStore> store, const Clock& clock, Options options)
      : store_(std::move(store)), options_(options), films_(clock, options.films) {}
  void note_change(const std::string& id);
  void refresh(JobRecord& record) const;
  void drop_oldest_results();

  const std::unique_ptr<JobStore> store_;
  const Options options_;
  KeptFilms films_;
  mutable std::mutex mutex_;               // guards the rest; never held while the store or a work is asked
  std::map<std::string, WorkLease> held_;  // by id: live work and kept results
  std::deque<std::string> ended_;          // ids with a result, oldest first
};

}  // namespace tilelight::server
