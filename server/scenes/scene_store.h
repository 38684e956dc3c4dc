// SPDX-License-Identifier: Apache-2.0
// SceneStore: parsed scenes by their id (SHA-256 of the canonical document), so that a client sends a scene once. Keeps
// the most recently used ones within a number of bytes. Any thread.
#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>

#include "renderer/renderer.h"

namespace tilelight::server {

struct StoredScene {
  ParsedScene parsed;
  std::string text;  // as it was sent
};
using ScenePtr = std::shared_ptr<const StoredScene>;

class SceneStore {
 public:
  explicit SceneStore(int64_t max_bytes) : max_bytes_(max_bytes) {}

  // True if the scene was not known.
  bool put(ScenePtr scene);
  // Null if it is not known (any more).
  ScenePtr find(const std::string& id);
  int64_t count() const;

 private:
  const int64_t max_bytes_;
  mutable std::mutex mutex_;    // guards the rest
  std::list<ScenePtr> recent_;  // the front was used last
  std::unordered_map<std::string, std::list<ScenePtr>::iterator> by_id_;
  int64_t bytes_ = 0;
};

}  // namespace tilelight::server
