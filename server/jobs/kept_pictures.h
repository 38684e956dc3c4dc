// SPDX-License-Identifier: Apache-2.0
// KeptPictures: pictures of stored scenes under their entity tags, the most recently used ones within a number of
// bytes. Caches keep them too, but different caches, and different Accept headers in one cache, ask for the same
// picture. Any thread.
#pragma once

#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "server/jobs/job.h"

namespace tilelight::server {

// A picture and what its render told of it.
struct KeptPicture {
  EncodedPtr image;
  std::string render_info;
};

class KeptPictures {
 public:
  explicit KeptPictures(int64_t max_bytes) : max_bytes_(max_bytes) {}

  std::optional<KeptPicture> find(const std::string& etag);
  // One that is larger than all the room is not kept.
  void put(const std::string& etag, KeptPicture picture);

 private:
  using Entry = std::pair<std::string, KeptPicture>;
  static int64_t bytes_of(const Entry& entry) {
    return static_cast<int64_t>(entry.second.image->bytes.size() + entry.first.size()) + 512;
  }

  const int64_t max_bytes_;
  std::mutex mutex_;         // guards the rest
  std::list<Entry> recent_;  // the front was used last
  std::map<std::string, std::list<Entry>::iterator> by_etag_;
  int64_t bytes_ = 0;
};

}  // namespace tilelight::server
