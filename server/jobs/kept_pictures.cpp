// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/kept_pictures.h"

namespace tilelight::server {

std::optional<KeptPicture> KeptPictures::find(const std::string& etag) {
  const std::lock_guard lock(mutex_);
  const auto known = by_etag_.find(etag);
  if (known == by_etag_.end()) return std::nullopt;
  recent_.splice(recent_.begin(), recent_, known->second);
  return known->second->second;
}

void KeptPictures::put(const std::string& etag, KeptPicture picture) {
  std::list<Entry> dropped;  // freed where no lock is held
  Entry entry(etag, std::move(picture));
  const int64_t bytes = bytes_of(entry);
  if (bytes > max_bytes_) return;  // it would drive out all others, and then itself
  const std::lock_guard lock(mutex_);
  if (by_etag_.contains(etag)) return;
  recent_.push_front(std::move(entry));
  by_etag_[etag] = recent_.begin();
  bytes_ += bytes;
  while (bytes_ > max_bytes_) {
    bytes_ -= bytes_of(recent_.back());
    by_etag_.erase(recent_.back().first);
    dropped.splice(dropped.begin(), recent_, std::prev(recent_.end()));
  }
}

}  // namespace tilelight::server
