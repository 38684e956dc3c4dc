// SPDX-License-Identifier: Apache-2.0
#include "server/scenes/scene_store.h"

namespace tilelight::server {
namespace {

// The document and about as much again for what was parsed from it.
int64_t cost(const StoredScene& scene) { return 2 * static_cast<int64_t>(scene.text.size()) + 4096; }

}  // namespace

bool SceneStore::put(ScenePtr scene) {
  const std::lock_guard lock(mutex_);
  const std::string& id = scene->parsed.scene_id;
  if (const auto known = by_id_.find(id); known != by_id_.end()) {
    recent_.splice(recent_.begin(), recent_, known->second);
    return false;
  }
  bytes_ += cost(*scene);
  recent_.push_front(scene);
  by_id_[id] = recent_.begin();
  while (bytes_ > max_bytes_ && recent_.size() > 1) {
    bytes_ -= cost(*recent_.back());
    by_id_.erase(recent_.back()->parsed.scene_id);
    recent_.pop_back();
  }
  return true;
}

ScenePtr SceneStore::find(const std::string& id) {
  const std::lock_guard lock(mutex_);
  const auto known = by_id_.find(id);
  if (known == by_id_.end()) return nullptr;
  recent_.splice(recent_.begin(), recent_, known->second);
  return *known->second;
}

int64_t SceneStore::count() const {
  const std::lock_guard lock(mutex_);
  return static_cast<int64_t>(recent_.size());
}

}  // namespace tilelight::server
