// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/render.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "renderer/base/standard_floats.h"
#include "renderer/render/pass_schedule.h"
#include "renderer/trace/isa.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

using Clock = std::chrono::steady_clock;

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

constexpr int kTilePx = 32;            // 12 KiB of float RGB stays in L1; an item of one sample takes one to five ms
constexpr double kItemTargetMs = 5.0;  // longest wait of a more urgent render for a thread

// The state machine behind Render. The pool calls take() and run(); the last item of a step opens the next step. A pass
// is one or more steps: a step gives every tile as many samples as fit kItemTargetMs, so that items stay short.
class TileRender final : public Render, public WorkSource {
 public:
  TileRender(TilePool& pool, std::shared_ptr<const CompiledScene> scene, ViewPlan plan, RenderOptions options)
      : pool_(pool),
        scene_(std::move(scene)),
        plan_(std::move(plan)),
        options_(std::move(options)),
        tile_px_(options_.tile_px > 0 ? options_.tile_px : kTilePx),
        width_(plan_.view.image.width),
        height_(plan_.view.image.height),
        tiles_(tile_count(width_, height_, tile_px_)),
        kernel_(kernel_of(plan_.variant)),
        eye_media_(*scene_, plan_),
        schedule_(plan_.view.render),
        film_(width_, height_) {
    report_.threads = pool.thread_count();
    const std::lock_guard lock(mutex_);
    open_pass(Clock::now());
  }

  Next take() override {
    const std::lock_guard lock(mutex_);
    if (state_ != RenderState::running) return {Offer::finished, 0};
    if (cancelled_.load(std::memory_order_relaxed) || next_tile_ == tiles_) return {Offer::nothing_now, 0};
    ++in_flight_;
    return {Offer::item, static_cast<uint64_t>(next_tile_++)};
  }

  void run(uint64_t item) override {
    const auto begin = Clock::now();
    TileCounts counts;
    std::string error;
    try {
      render_item(static_cast<int>(item), counts);
    } catch (const std::exception& e) {
      error = e.what();
    }
    finish_item(static_cast<int>(item), counts, ms_between(begin, Clock::now()), error);
  }

  void cancel() override {
    cancelled_.store(true, std::memory_order_relaxed);  // relaxed: a flag on its own; the state changes under the lock
    bool ended = false;
    {
      const std::lock_guard lock(mutex_);
      if (state_ == RenderState::running && in_flight_ == 0) {
        end(RenderState::cancelled, "cancelled");
        ended = true;
      }
    }
    if (!ended) return;
    announce();
    pool_.wake(this);
  }

  RenderProgress progress() const override {
    const std::lock_guard lock(mutex_);
    RenderProgress p;
    p.state = state_;
    p.spp = done_samples_;
    p.error = error_;
    p.elapsed_ms = ms_between(start_, state_ == RenderState::running ? Clock::now() : end_);
    const double total = std::max(1, schedule_.samples());
    const double in_step = static_cast<double>(step_samples_) * tiles_done_ / tiles_;
    p.fraction = state_ == RenderState::running ? std::min(1.0, (step_first_ + in_step) / total) : 1.0;
    if (const auto& time_ms = plan_.view.render.time_ms; time_ms && state_ == RenderState::running) {
      p.fraction = std::min(1.0, std::max(p.fraction, p.elapsed_ms / *time_ms));
    }
    if (state_ == RenderState::running && p.fraction > 0.0) p.eta_ms = p.elapsed_ms * (1.0 - p.fraction) / p.fraction;
    return p;
  }

  RenderReport report() const override {
    const std::lock_guard lock(mutex_);
    return report_;
  }

  std::shared_ptr<const Image> image() const override {
    const std::lock_guard lock(mutex_);
    return image_;
  }

  bool wait_ms(double ms) const override {
    std::unique_lock lock(mutex_);
    const auto over = [this] { return state_ != RenderState::running; };
    constexpr double kForever = 1e12;  // beyond it the clock's arithmetic would overflow
    if (ms >= kForever) {
      ended_.wait(lock, over);
      return true;
    }
    return ended_.wait_for(lock, std::chrono::duration<double, std::milli>(ms), over);
  }

 private:
  void render_item(int tile, TileCounts& counts) {
    const TileRect rect = tile_rect(tile, width_, height_, tile_px_);
    TileView view = film_.view(rect);
    TileJob job;
    job.scene = scene_.get();
    job.plan = &plan_;
    job.eye_media = &eye_media_;
    job.film = &view;
    job.rect = rect;
    // Constant while items of the step run.
    job.first_sample = static_cast<uint32_t>(step_first_);
    job.sample_count = static_cast<uint32_t>(step_samples_);
    job.cancelled = &cancelled_;
    job.counts = &counts;
    kernel_(job);
  }

  // What an item leaves to be done once the lock is free.
  enum class Then { nothing, wake, announce_pass, announce_end };

  void finish_item(int tile, const TileCounts& counts, double item_ms, const std::string& error) {
    Then then = Then::nothing;
    bool is_pass_whole = false;
    {
      const std::lock_guard lock(mutex_);
      ++tiles_done_;
      add(counts, item_ms);
      if (!error.empty()) fail_render(tile, error);
      drop_overrun_pass();
      const bool is_stopping = cancelled_.load(std::memory_order_relaxed);
      is_pass_whole = !is_stopping && tiles_done_ == tiles_ && step_end() == pass_first_ + pass_samples_;
      if (!is_pass_whole) then = leave_item();
    }
    if (is_pass_whole) {
      // No other item runs and none is handed out, so the film is at rest; the lock is not held over the whole image.
      auto image = std::make_shared<const Image>(film_.resolve(step_end()));
      const std::lock_guard lock(mutex_);
      image_ = std::move(image);
      then = leave_item();
    }
    if (then == Then::announce_pass || then == Then::announce_end) announce();
    if (then != Then::nothing) pool_.wake(this);  // at the end too: the pool lets go of what says `finished`
  }

  // REQUIRES: mutex_.
  Then leave_item() {
    --in_flight_;
    if (cancelled_.load(std::memory_order_relaxed)) {
      if (in_flight_ > 0) return Then::nothing;
      end_early();
      return Then::announce_end;
    }
    if (tiles_done_ < tiles_) return Then::nothing;
    if (finish_step()) return Then::wake;
    return state_ == RenderState::running ? Then::announce_pass : Then::announce_end;
  }

  // REQUIRES: mutex_.
  void fail_render(int tile, const std::string& error) {
    if (!error_.empty()) return;
    const TileRect rect = tile_rect(tile, width_, height_, tile_px_);
    error_ = error + " (reproduce: tilelight render scene.json --pixel " + std::to_string(rect.x0) + "," +
             std::to_string(rect.y0) + ")";
    cancelled_.store(true, std::memory_order_relaxed);
  }

  int step_end() const { return step_first_ + step_samples_; }

  // REQUIRES: mutex_. A pass that runs past the time limit will not count: stop it now, unless it is the first.
  void drop_overrun_pass() {
    const auto& time_ms = plan_.view.render.time_ms;
    if (!time_ms || done_samples_ == 0 || state_ != RenderState::running) return;
    if (ms_between(start_, Clock::now()) <= *time_ms || tiles_done_ == tiles_) return;
    over_time_ = true;
    cancelled_.store(true, std::memory_order_relaxed);
  }

  void end_early() {
    if (!error_.empty()) {
      end(RenderState::failed, "failed");
    } else if (over_time_) {
      end(RenderState::done, "time");
    } else {
      end(RenderState::cancelled, "cancelled");
    }
  }

  // REQUIRES: mutex_. True if the pass goes on with another step; else a pass is finished.
  bool finish_step() {
    const auto now = Clock::now();
    const double step_ms = ms_between(step_start_, now);
    item_ms_per_sample_ = step_ms * report_.threads / tiles_ / step_samples_;
    if (step_end() < pass_first_ + pass_samples_) {
      open_step(step_end(), now);
      return true;
    }
    done_samples_ = step_end();
    report_.passes.push_back(pass_samples_);
    add_report_point(now);
    open_pass(now);
    return false;
  }

  // REQUIRES: mutex_.
  void open_pass(Clock::time_point now) {
    const double elapsed = ms_between(start_, now);
    const int passes_done = static_cast<int>(report_.passes.size());
    const PassSchedule::Next next =
        schedule_.next(passes_done, done_samples_, elapsed, done_samples_ > 0 ? elapsed / done_samples_ : 0.0);
    pass_first_ = done_samples_;
    pass_samples_ = next.samples;
    if (next.samples == 0) {
      end(RenderState::done, next.stop);
    } else {
      open_step(pass_first_, now);
    }
  }

  // REQUIRES: mutex_.
  void open_step(int first, Clock::time_point now) {
    const int left = pass_first_ + pass_samples_ - first;
    const int fitting =
        item_ms_per_sample_ > 0.0 ? static_cast<int>(std::min(1e6, kItemTargetMs / item_ms_per_sample_)) : 1;
    step_first_ = first;
    step_samples_ = std::clamp(fitting, 1, left);
    step_start_ = now;
    next_tile_ = 0;
    tiles_done_ = 0;
  }

  // REQUIRES: mutex_.
  void end(RenderState state, std::string stop) {
    state_ = state;
    end_ = Clock::now();
    report_.stop = std::move(stop);
    pass_samples_ = 0;
    ended_.notify_all();
  }

  void add(const TileCounts& counts, double item_ms) {
    rays_.primary += counts.primary;
    rays_.shadow += counts.shadow;
    rays_.reflected += counts.reflected;
    rays_.refracted += counts.refracted;
    nonfinite_ += counts.nonfinite;
    lights_on_hits_ += counts.lights_on_hits;
    untraced_weight_ = std::max(untraced_weight_, counts.untraced_weight);
    cpu_ms_ += item_ms;
  }

  void add_report_point(Clock::time_point now) {
    ReportPoint point;
    point.pass = static_cast<int>(report_.passes.size());
    point.spp = done_samples_;
    point.elapsed_ms = ms_between(start_, now);
    point.cpu_ms = cpu_ms_;
    point.rays = rays_;
    point.nonfinite = nonfinite_;
    point.lights_on_hits = lights_on_hits_;
    if (untraced_weight_ == 0.0) {
      point.truncation_bound = 0.0;
    } else if (scene_->radiance_bound >= 0.0) {
      constexpr double kRounding = 1.0 + 0x1p-36;  // more than the products and sums behind both have lost
      point.truncation_bound = untraced_weight_ * scene_->radiance_bound * kRounding;
    }
    report_.points.push_back(point);
  }

  void announce() const {
    if (options_.on_pass) options_.on_pass();
  }

  // Constant after construction.
  TilePool& pool_;
  const std::shared_ptr<const CompiledScene> scene_;
  const ViewPlan plan_;
  const RenderOptions options_;
  const int tile_px_, width_, height_, tiles_;
  const Kernel kernel_;
  const EyeMedia eye_media_;
  const PassSchedule schedule_;
  const Clock::time_point start_ = Clock::now();

  std::atomic<bool> cancelled_{false};
  Film film_;  // items write disjoint tiles; read only between steps

  mutable std::mutex mutex_;
  mutable std::condition_variable ended_;
  // Guarded by mutex_.
  RenderState state_ = RenderState::running;
  std::string error_;
  bool over_time_ = false;
  Clock::time_point end_, step_start_;
  int done_samples_ = 0;
  int pass_first_ = 0, pass_samples_ = 0;
  int step_first_ = 0, step_samples_ = 1;
  int next_tile_ = 0, tiles_done_ = 0, in_flight_ = 0;
  double item_ms_per_sample_ = 0.0;
  double cpu_ms_ = 0.0, untraced_weight_ = 0.0;
  RayCounts rays_;
  int64_t nonfinite_ = 0, lights_on_hits_ = 0;
  RenderReport report_;
  std::shared_ptr<const Image> image_;
};

}  // namespace

ViewPlan plan_view(const CompiledScene& scene, const View& view) { return plan_view(scene, view, current_isa()); }

std::shared_ptr<Render> Render::start(TilePool& pool, Priority priority, std::shared_ptr<const CompiledScene> scene,
                                      ViewPlan plan, RenderOptions options) {
  const StandardFloats floats;
  auto render = std::make_shared<TileRender>(pool, std::move(scene), std::move(plan), std::move(options));
  pool.add(render, priority);
  return render;
}

}  // namespace tilelight
