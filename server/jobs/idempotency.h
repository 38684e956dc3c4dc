// SPDX-License-Identifier: Apache-2.0
// IdempotencyKeys: what was asked under a client's key, for 24 hours, so that a retry finds its job again. Any thread.
#pragma once

#include <list>
#include <map>
#include <mutex>
#include <string>

#include "server/clock.h"

namespace tilelight::server {

class IdempotencyKeys {
 public:
  explicit IdempotencyKeys(const Clock& clock) : clock_(clock) {}

  // A request under its key, and what the key led to when it came.
  struct Claim {
    std::pair<std::string, std::string> name;  // client, key
    std::string body_hash;
    bool is_other_body = false;  // the key was used for another request
    std::string job_id;          // the job it led to; empty where there is none (yet)
  };
  // Notes the request under the key unless the key is known.
  Claim claim(const std::string& client, const std::string& key, const std::string& body_hash);
  // Ties a job to the key in place of the one that the claim found. Returns the job that holds the key: another one if
  // a retry was faster.
  std::string bind(const Claim& claim, const std::string& job_id);
  // The claim led to no job: forgets the key, unless a retry has tied one to it, so that a corrected body may use it.
  void release(const Claim& claim);

 private:
  static constexpr double kLifeMs = 24.0 * 3600.0 * 1000.0;
  static constexpr size_t kMaxKeys = 100'000;  // some 20 MB; the oldest goes first

  struct Entry {
    std::pair<std::string, std::string> name;  // client, key
    std::string body_hash, job_id;
    double since_ms;
  };
  void drop_old();                                          // REQUIRES: mutex_
  void add(const Claim& claim, const std::string& job_id);  // REQUIRES: mutex_

  const Clock& clock_;
  std::mutex mutex_;          // guards the rest
  std::list<Entry> entries_;  // oldest first
  std::map<std::pair<std::string, std::string>, std::list<Entry>::iterator> by_name_;
};

}  // namespace tilelight::server
