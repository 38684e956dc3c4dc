// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/job_queue.h"

#include <algorithm>

namespace tilelight::server {
namespace {

int64_t film_bytes(const RenderRequest& request) { return render_memory_bytes(request.view); }

// A scene's document and what was parsed from it, about.
int64_t scene_bytes(const RenderRequest& request) { return 3 * static_cast<int64_t>(request.scene->text.size()); }

}  // namespace

WorkLease& WorkLease::operator=(WorkLease&& other) noexcept {
  if (this != &other) {
    release();
    queue_ = std::move(other.queue_);
    work_ = std::move(other.work_);
  }
  return *this;
}

void WorkLease::release() {
  if (!queue_) return;
  queue_->release(work_);
  queue_ = nullptr;
  work_ = nullptr;
}

std::shared_ptr<JobQueue> JobQueue::make(TilePool& pool, std::shared_ptr<CompiledCache> compiled, Metrics& metrics,
                                         const Log& log, const Clock& clock, Options options) {
  return std::shared_ptr<JobQueue>(new JobQueue(pool, std::move(compiled), metrics, log, clock, options));
}

JobQueue::JobQueue(TilePool& pool, std::shared_ptr<CompiledCache> compiled, Metrics& metrics, const Log& log,
                   const Clock& clock, Options options)
    : pool_(pool), compiled_(std::move(compiled)), metrics_(metrics), log_(log), clock_(clock), options_(options) {
  lanes_[0].max_running = options.max_running_normal;
  lanes_[1].max_running = options.max_running_batch;
}

Result<WorkLease> JobQueue::submit(RenderRequest request) {
  std::string key = render_key(request);
  WorkPtr work;
  bool is_shared = false;
  {
    const std::lock_guard lock(mutex_);
    if (is_stopping_) return fail("stopping", "the server is stopping");
    if (const auto known = in_flight_.find(key); known != in_flight_.end()) {
      work = known->second;
      is_shared = true;
    } else {
      Lane& own = lane(request.priority);
      const bool must_wait = own.running >= own.max_running || !own.queued.empty();
      if (must_wait && queued_count() >= options_.max_queue) {
        return fail("queue_full", "the render queue holds " + std::to_string(queued_count()) + " renders, its limit");
      }
      if (scene_bytes_ + scene_bytes(request) > options_.max_scene_bytes) {
        return fail("queue_full", "the scenes of the renders in the queue take the memory that they may take");
      }
      scene_bytes_ += scene_bytes(request);
      work = std::make_shared<RenderWork>(std::move(request), key, clock_.wall_ms());
      step_start_[work.get()] = Steady::now();
      in_flight_[key] = work;
      own.queued.push_back(work);
    }
    ++holders_[work.get()];
  }
  WorkLease lease(shared_from_this(), work);
  if (is_shared) metrics_.add("tilelight_renders_shared_total", "");
  start_next();
  return lease;
}

int JobQueue::queued_count() const { return static_cast<int>(lanes_[0].queued.size() + lanes_[1].queued.size()); }

// A render whose film would not fit waits until it does, or until it has the lane for itself.
bool JobQueue::has_slot(const Lane& lane) const {
  if (lane.queued.empty() || lane.running >= lane.max_running) return false;
  return lane.running == 0 || film_bytes_ + film_bytes(lane.queued.front()->request()) <= options_.max_film_bytes;
}

JobQueue::Counts JobQueue::counts() const {
  const std::lock_guard lock(mutex_);
  return {queued_count(), static_cast<int>(running_.size())};
}

void JobQueue::start_next() {
  std::vector<WorkPtr> ready;
  {
    const std::lock_guard lock(mutex_);
    for (Lane& lane : lanes_) {
      while (has_slot(lane)) {
        ++lane.running;
        film_bytes_ += film_bytes(lane.queued.front()->request());
        running_.insert(lane.queued.front());
        ready.push_back(std::move(lane.queued.front()));
        lane.queued.pop_front();
      }
    }
  }
  for (const WorkPtr& work : ready) start(work);
}

void JobQueue::start(const WorkPtr& work) {
  const auto now = Steady::now();
  double queue_ms = 0.0;
  {
    const std::lock_guard lock(mutex_);
    queue_ms = ms_between(step_start_[work.get()], now);
    step_start_[work.get()] = now;
  }
  work->set_running(clock_.wall_ms(), queue_ms);
  compiled_->get(work->request().scene, work->request().priority,
                 [self = shared_from_this(), work](CompiledPtr compiled) {
                   try {
                     self->begin_render(work, compiled);
                   } catch (const std::exception& bug) {
                     self->fail_work(work, bug.what());
                   }
                 });
}

void JobQueue::begin_render(const WorkPtr& work, const CompiledPtr& compiled) {
  if (work->is_cancel_requested()) return end(work, JobState::cancelled, "");
  if (!compiled) return fail_work(work, "compile_scene threw");
  double compile_ms = 0.0;
  {
    const std::lock_guard lock(mutex_);
    compile_ms = ms_since(step_start_[work.get()]);
  }
  const auto plan_start = Steady::now();
  ViewPlan plan = plan_view(*compiled, work->request().view);
  work->set_planned(plan.plan, compile_ms, ms_since(plan_start));
  RenderOptions options;
  // Weak: the render must not keep the work, which keeps the render.
  options.on_pass = [self = shared_from_this(), weak = std::weak_ptr(work)] {
    if (const WorkPtr alive = weak.lock()) self->note_pass(alive);
  };
  if (const auto& source = work->request().refines) options.continues = Continued{source->report, source->film.lock()};
  work->set_render(Render::start(pool_, work->request().priority, compiled, std::move(plan), std::move(options)));
  if (work->is_cancel_requested()) work->request_cancel();  // asked for while there was no render to tell
  note_pass(work);  // the first passes may have ended before the work knew its render
}

void JobQueue::note_pass(const WorkPtr& work) {
  const auto render = work->render();
  if (!render) return;
  if (render->progress().state == RenderState::running) return work->bump();
  if (!work->begin_conclusion()) return;
  pool_.post(work->request().priority, [self = shared_from_this(), work] {
    try {
      self->conclude(work);
    } catch (const std::exception& bug) {
      self->fail_work(work, bug.what());
    }
  });
}

void JobQueue::conclude(const WorkPtr& work) {
  work->take_result();
  const WorkStatus status = work->status();
  if (status.progress.state == RenderState::cancelled) return end(work, JobState::cancelled, "");
  if (status.progress.state == RenderState::failed) return fail_work(work, status.progress.error);
  if (auto encoded = work->encode_here(work->request().format); !encoded)
    return fail_work(work, encoded.error().detail);
  end(work, JobState::done, "");
}

void JobQueue::fail_work(const WorkPtr& work, std::string_view cause) {
  log_.write(LogLevel::error, "render_failed",
             {{"scene", work->request().scene->parsed.scene_id}, {"key", work->key()}, {"cause", std::string(cause)}});
  end(work, JobState::failed,
      "the render failed inside the server; its log line has the key " + work->key().substr(0, 16));
}

void JobQueue::end(const WorkPtr& work, JobState state, std::string error) {
  bool was_running = false;
  {
    const std::lock_guard lock(mutex_);
    if (const auto known = in_flight_.find(work->key()); known != in_flight_.end() && known->second == work) {
      in_flight_.erase(known);
    }
    was_running = running_.count(work) != 0;
    if (was_running) {
      --lane(work->request().priority).running;
      film_bytes_ -= film_bytes(work->request());
    }
    scene_bytes_ -= scene_bytes(work->request());
    step_start_.erase(work.get());
  }
  const WorkStatus status = work->status();
  metrics_.add("tilelight_renders_total", "state=\"" + std::string(job_state_name(state)) + "\"");
  if (!status.report.points.empty()) {
    // The report goes on from the source's, whose rays were counted when it ended.
    RayCounts rays = status.report.points.back().rays;
    if (const auto& source = work->request().refines) rays = rays - source->report.points.back().rays;
    metrics_.add("tilelight_rays_total", "kind=\"primary\"", static_cast<double>(rays.primary));
    metrics_.add("tilelight_rays_total", "kind=\"shadow\"", static_cast<double>(rays.shadow));
    metrics_.add("tilelight_rays_total", "kind=\"reflected\"", static_cast<double>(rays.reflected));
    metrics_.add("tilelight_rays_total", "kind=\"refracted\"", static_cast<double>(rays.refracted));
  }
  const ImageSpec& image = work->request().view.image;
  log_.write(LogLevel::info, "render",
             {{"state", std::string(job_state_name(state))},
              {"key", work->key().substr(0, 16)},
              {"scene", work->request().scene->parsed.scene_id.substr(0, 16)},
              {"priority", std::string(priority_name(work->request().priority))},
              {"width", int64_t{image.width}},
              {"height", int64_t{image.height}},
              {"spp", status.progress.spp},
              {"stop", status.report.stop},
              {"queue_ms", status.timings.queue_ms},
              {"compile_ms", status.timings.compile_ms},
              {"render_ms", status.timings.render_ms},
              {"encode_ms", status.timings.encode_ms}});
  work->set_ended(state, std::move(error), clock_.wall_ms());
  if (was_running) {
    const std::lock_guard lock(mutex_);
    running_.erase(work);
    idle_.notify_all();
  }
  start_next();
}

void JobQueue::release(const WorkPtr& work) {
  bool was_queued = false;
  {
    const std::lock_guard lock(mutex_);
    const auto held = holders_.find(work.get());
    if (--held->second > 0) return;
    holders_.erase(held);
    const auto known = in_flight_.find(work->key());
    if (known == in_flight_.end() || known->second != work) return;  // it has ended
    in_flight_.erase(known);                                         // nobody joins what is about to stop
    auto& queued = lane(work->request().priority).queued;
    const auto place = std::find(queued.begin(), queued.end(), work);
    was_queued = place != queued.end();
    if (was_queued) queued.erase(place);
  }
  if (was_queued) {
    end(work, JobState::cancelled, "");
  } else {
    work->request_cancel();
  }
}

void JobQueue::drain(double grace_ms) {
  std::vector<WorkPtr> dropped;
  std::unique_lock lock(mutex_);
  is_stopping_ = true;
  for (Lane& lane : lanes_) {
    dropped.insert(dropped.end(), lane.queued.begin(), lane.queued.end());
    lane.queued.clear();
  }
  lock.unlock();
  for (const WorkPtr& work : dropped) end(work, JobState::cancelled, "the server is stopping");
  lock.lock();
  idle_.wait_until(lock, after_ms(grace_ms), [&] { return running_.empty(); });
  const std::vector<WorkPtr> late(running_.begin(), running_.end());
  lock.unlock();
  for (const WorkPtr& work : late) work->request_cancel();
  lock.lock();
  idle_.wait(lock, [&] { return running_.empty(); });
}

}  // namespace tilelight::server
