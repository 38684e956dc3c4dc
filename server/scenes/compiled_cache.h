// SPDX-License-Identifier: Apache-2.0
// CompiledCache: compiled scenes by compile key (geometry, materials and lights, not the camera). A scene that several
// requests want at once is compiled once; the most recently used ones stay within a number of bytes. Any thread.
#pragma once

#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <unordered_map>
#include <vector>

#include "server/clock.h"
#include "server/metrics.h"
#include "server/scenes/scene_store.h"

namespace tilelight::server {

using CompiledPtr = std::shared_ptr<const CompiledScene>;

class CompiledCache : public std::enable_shared_from_this<CompiledCache> {
 public:
  // Owned by shared_ptr: tasks on the pool hold it. pool and metrics must outlive it.
  static std::shared_ptr<CompiledCache> make(TilePool& pool, Metrics& metrics, int64_t max_bytes);

  // Calls then(compiled) at once if it is there, else from a pool thread when it has been compiled; with null if
  // compiling threw, which is a bug: counted, and reported by the renders that wait.
  using Then = std::function<void(CompiledPtr)>;
  void get(ScenePtr scene, Priority priority, Then then);

  // The same for a thread that may wait. Nothing: `gone` was requested first or the time is over, and compiling goes
  // on.
  std::optional<CompiledPtr> wait(ScenePtr scene, Priority priority, std::stop_token gone, Steady::time_point until);

  int64_t bytes() const;

 private:
  CompiledCache(TilePool& pool, Metrics& metrics, int64_t max_bytes)
      : pool_(pool), metrics_(metrics), max_bytes_(max_bytes) {}
  void compile(const ScenePtr& scene);
  void keep(const std::string& key, CompiledPtr compiled);  // REQUIRES: mutex_

  struct Entry {
    std::string key;
    CompiledPtr compiled;
    int64_t bytes;
  };

  struct Compilation {
    std::vector<Then> waiting;
    Priority priority = Priority::batch;  // the highest at which it was posted
    bool is_running = false;
  };

  TilePool& pool_;
  Metrics& metrics_;
  const int64_t max_bytes_;
  mutable std::mutex mutex_;  // guards the rest; not held while compiling or calling `then`
  std::list<Entry> recent_;   // the front was used last
  std::unordered_map<std::string, std::list<Entry>::iterator> by_key_;
  std::unordered_map<std::string, Compilation> in_flight_;
  int64_t bytes_ = 0;
};

}  // namespace tilelight::server
