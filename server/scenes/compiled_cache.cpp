// SPDX-License-Identifier: Apache-2.0
#include "server/scenes/compiled_cache.h"

#include <condition_variable>

namespace tilelight::server {

std::shared_ptr<CompiledCache> CompiledCache::make(TilePool& pool, Metrics& metrics, int64_t max_bytes) {
  return std::shared_ptr<CompiledCache>(new CompiledCache(pool, metrics, max_bytes));
}

void CompiledCache::get(ScenePtr scene, Priority priority, Then then) {
  const std::string& key = scene->parsed.compile_key;
  CompiledPtr found;
  bool is_first = false, post = false;
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = by_key_.find(key); known != by_key_.end()) {
      recent_.splice(recent_.begin(), recent_, known->second);
      found = known->second->compiled;
    } else {
      Compilation& compilation = in_flight_[key];
      is_first = compilation.waiting.empty();
      // A thumbnail that joins a batch render's compilation must not wait at the batch's rank: it posts it once more,
      // and whichever comes first does the work.
      post = is_first || (priority < compilation.priority && !compilation.is_running);
      if (post) compilation.priority = priority;
      compilation.waiting.push_back(std::move(then));
    }
  }
  metrics_.add("tilelight_scene_cache_total", found      ? "result=\"hit\""
                                              : is_first ? "result=\"miss\""
                                                         : "result=\"join\"");
  if (found) {
    then(std::move(found));
  } else if (post) {
    pool_.post(priority, [self = shared_from_this(), scene = std::move(scene)] { self->compile(scene); });
  }
}

void CompiledCache::compile(const ScenePtr& scene) {
  const std::string& key = scene->parsed.compile_key;
  {
    const std::lock_guard lock(mutex_);
    const auto compilation = in_flight_.find(key);
    if (compilation == in_flight_.end() || compilation->second.is_running) return;
    compilation->second.is_running = true;
  }
  CompiledPtr compiled;
  try {
    compiled = compile_scene(scene->parsed.scene, pool_);
  } catch (const std::exception&) {
    metrics_.add("tilelight_scene_cache_total", "result=\"failed\"");  // the waiting renders report the failure
  }
  std::vector<Then> waiting;
  {
    const std::lock_guard lock(mutex_);
    if (compiled) keep(key, compiled);
    waiting = std::move(in_flight_[key].waiting);
    in_flight_.erase(key);
  }
  for (Then& then : waiting) then(compiled);
}

void CompiledCache::keep(const std::string& key, CompiledPtr compiled) {
  const int64_t size = scene_plan(*compiled).memory_bytes + 4096;
  recent_.push_front({key, std::move(compiled), size});
  by_key_[key] = recent_.begin();
  bytes_ += size;
  while (bytes_ > max_bytes_ && !recent_.empty()) {
    bytes_ -= recent_.back().bytes;
    by_key_.erase(recent_.back().key);
    recent_.pop_back();
  }
}

std::optional<CompiledPtr> CompiledCache::wait(ScenePtr scene, Priority priority, std::stop_token gone,
                                               Steady::time_point until) {
  struct Slot {
    std::mutex mutex;
    std::condition_variable_any ready;
    bool is_set = false;
    CompiledPtr compiled;
  };
  const auto slot = std::make_shared<Slot>();
  get(std::move(scene), priority, [slot](CompiledPtr compiled) {
    const std::lock_guard lock(slot->mutex);
    slot->is_set = true;
    slot->compiled = std::move(compiled);
    slot->ready.notify_all();
  });
  std::unique_lock lock(slot->mutex);
  if (!slot->ready.wait_until(lock, gone, until, [&] { return slot->is_set; })) return std::nullopt;
  return slot->compiled;
}

int64_t CompiledCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

}  // namespace tilelight::server
