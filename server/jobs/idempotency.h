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

  struct Seen {
    bool is_other_body = false;  // the key was used for another request
    std::string job_id;          // the job it led to; empty where there is none (yet)
  };
  // Notes the request under the key unless the key is known.
  Seen claim(const std::string& client, const std::string& key, const std::string& body_hash);
  // Ties a job to the key. Returns the job that holds the key: another one if a retry was faster.
  std::string bind(const std::string& client, const std::string& key, const std::string& job_id);

 private:
  static constexpr double kLifeMs = 24.0 * 3600.0 * 1000.0;
  static constexpr size_t kMaxKeys = 100'000;  // some 20 MB; the oldest goes first

  struct Entry {
    std::pair<std::string, std::string> name;  // client, key
    std::string body_hash, job_id;
    double since_ms;
  };
  void drop_old();  // REQUIRES: mutex_

  const Clock& clock_;
  std::mutex mutex_;          // guards the rest
  std::list<Entry> entries_;  // oldest first
  std::map<std::pair<std::string, std::string>, std::list<Entry>::iterator> by_name_;
};

}  // namespace tilelight::server
