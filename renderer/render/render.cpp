// SPDX-License-Identifier: Apache-2.0
#include "renderer/render/render.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>

#include "renderer/base/standard_floats.h"
#include "renderer/compile/tessellate.h"
#include "renderer/raster/method.h"
#include "renderer/render/exposed_film.h"
#include "renderer/render/pass_schedule.h"
#include "renderer/render/sketch.h"
#include "renderer/render/spend.h"
#include "renderer/trace/isa.h"
#include "renderer/trace/tile_job.h"

namespace tilelight {
namespace {

using Clock = std::chrono::steady_clock;

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

constexpr int64_t kColorBytes = 3 * sizeof(float);
constexpr int kTilePx = 32;            // 12 KiB of float RGB stays in L1; an item of one sample takes one to five ms
constexpr double kItemTargetMs = 5.0;  // longest wait of a more urgent render for a thread

int in_whole_cells(int tile_px) { return (tile_px + kCellPx - 1) / kCellPx * kCellPx; }

// The state machine behind Render. The pool calls take() and run(); the last item of a step opens the next step. A pass
// is steps of tracing, then one that measures what the blocks of samples say, then one that spreads it over neighbours.
// A step of tracing gives every tile as many samples as fit kItemTargetMs, so that items stay short. A render that goes
// on from another's film first copies it.
class TileRender final : public Render, public WorkSource {
 public:
  TileRender(TilePool& pool, std::shared_ptr<const CompiledScene> scene, ViewPlan plan, RenderOptions options)
      : pool_(pool),
        scene_(std::move(scene)),
        plan_(std::move(plan)),
        on_pass_(std::move(options.on_pass)),
        tile_px_(in_whole_cells(options.tile_px > 0 ? options.tile_px : kTilePx)),
        width_(plan_.view.image.width),
        height_(plan_.view.image.height),
        tiles_(tile_count(width_, height_, tile_px_)),
        eye_media_(*scene_, plan_),
        before_(options.continues ? std::move(options.continues->report) : RenderReport()),
        schedule_(plan_.view.render, before_.passes),
        source_(options.continues ? std::move(options.continues->film) : nullptr),
        exposed_(std::make_shared<ExposedFilm>(width_, height_, plan_.view.image.exposure)) {
    report_.points = before_.points;
    report_.passes = before_.passes;
    report_.threads = pool.thread_count();
    report_.seed = plan_.view.render.seed;
    // Kernels of local light alone do not look at what surfaces would pass on. Lines know no light.
    if (plan_.view.render.max_depth == 0 && plan_.view.render.algorithm != Algorithm::roberts)
      tally_.untraced_weight = scene_->passed_on;
    report_.adaptive = plan_.view.render.adaptive;
    if (source_) take_over();
    const std::lock_guard lock(mutex_);
    open_step(Stage::prepare, 0);
  }

  Next take() override {
    const std::lock_guard lock(mutex_);
    if (state_ != RenderState::running) return {Offer::finished, 0};
    if (cancelled_.load(std::memory_order_relaxed) || next_item_ == items_) return {Offer::nothing_now, 0};
    ++in_flight_;
    return {Offer::item, static_cast<uint64_t>(next_item_++)};
  }

  void run(uint64_t item) override {
    const auto begin = Clock::now();
    const TileRect rect = tile_rect(static_cast<int>(item), width_, height_, tile_px_);
    TileCounts counts;
    std::string error;
    try {
      work_on(rect, counts);
    } catch (const Stopped&) {  // cancelled while it prepared
    } catch (const std::exception& e) {
      error = e.what();
      if (stage_ != Stage::prepare)
        error += " (reproduce: tilelight render scene.json --pixel " + std::to_string(rect.x0) + "," +
                 std::to_string(rect.y0) + ")";
    }
    finish_item(counts, ms_between(begin, Clock::now()), error);
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
    p.spp = standing_.spp;
    p.error = error_;
    const bool is_running = state_ == RenderState::running;
    p.elapsed_ms = ms_between(start_, is_running ? Clock::now() : end_);
    if (!is_running) {
      p.fraction = 1.0;
      return p;
    }
    const double steps = step_first_ + static_cast<double>(step_samples_) * items_done_ / items_;
    const double in_pass = stage_ == Stage::trace ? steps / pass_length_ : 1.0;
    const double expected = std::max(1.0, schedule_.expected_samples(standing_)) - first_spp_;
    p.fraction = (standing_.spp + pass_samples_ * in_pass - first_spp_) / std::max(1e-9, expected);
    const auto& time_ms = plan_.view.render.time_ms;
    if (time_ms && !is_repeating()) p.fraction = std::max(p.fraction, counted_ms() / *time_ms);
    p.fraction = std::min(1.0, p.fraction);
    if (p.fraction > 0.0) p.eta_ms = p.elapsed_ms * (1.0 - p.fraction) / p.fraction;
    return p;
  }

  RenderReport report() const override {
    const std::lock_guard lock(mutex_);
    return report_;
  }

  std::shared_ptr<const Image> image() const override {
    const std::lock_guard lock(mutex_);
    return exposed_->image;
  }

  std::shared_ptr<const std::vector<float>> error_bounds() const override {
    const std::lock_guard lock(mutex_);
    return exposed_->error_bounds;
  }

  std::string lines_svg() const override {
    {
      const std::lock_guard lock(mutex_);
      if (stage_ == Stage::prepare) return {};
    }
    return method_->lines_svg();  // set once, by that stage
  }

  std::shared_ptr<const ExposedFilm> exposed_film() const override {
    const std::lock_guard lock(mutex_);
    return state_ == RenderState::done && !over_time_ ? exposed_ : nullptr;
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
  enum class Stage { prepare, copy, sketch, fill, trace, measure, spread };

  // What is read here is constant while items of the step run.
  void work_on(const TileRect& tile, TileCounts& counts) {
    switch (stage_) {
      case Stage::prepare:
        method_ = make_method(*scene_, plan_, pool_, &cancelled_);
        break;
      case Stage::copy:
        film_.copy(tile, source_->film);
        break;
      case Stage::sketch:
        trace_sketch(tile, counts);
        break;
      case Stage::fill:
        sketch_->fill(tile, *next_image_);
        break;
      case Stage::trace:
        trace_tile(tile, counts);
        break;
      case Stage::measure:
        film_.resolve(tile, *next_image_);
        error_map_.measure(film_, *next_image_, tile);
        break;
      case Stage::spread:
        error_map_.spread(film_, tile);
        break;
    }
  }

  void trace_sketch(const TileRect& tile, TileCounts& counts) {
    std::vector<CellWork> pixels;
    for_each_cell(tile, [&](const TileRect& cell) { pixels.push_back({Sketch::pixel_of(cell)}); });
    trace(pixels, sketch_->view(), counts);
  }

  void trace_tile(const TileRect& tile, TileCounts& counts) {
    std::vector<CellWork> cells;
    for_each_cell(tile, [&](const TileRect& cell) {
      const size_t i = film_.cell_at(cell.x0, cell.y0);
      const uint32_t first = film_.samples()[i] + step_first_;
      const uint32_t last = std::min(targets_[i], first + step_samples_);
      if (first < last) cells.push_back({cell, first, last - first});
    });
    trace(cells, film_.view(), counts);
  }

  void trace(const std::vector<CellWork>& cells, TileView view, TileCounts& counts) {
    method_->draw({.scene = scene_.get(),
                   .plan = &plan_,
                   .eye_media = &eye_media_,
                   .film = &view,
                   .cells = cells,
                   .cancelled = &cancelled_,
                   .counts = &counts});
  }

  // What an item leaves to be done once the lock is free.
  enum class Then { nothing, wake, announce_pass, announce_end };

  void finish_item(const TileCounts& counts, double item_ms, const std::string& error) {
    Then then = Then::nothing;
    bool is_step_whole = false;
    {
      const std::lock_guard lock(mutex_);
      ++items_done_;
      add(counts, item_ms);
      if (!error.empty() && error_.empty()) {
        error_ = error;
        cancelled_.store(true, std::memory_order_relaxed);
      }
      drop_overrun_pass();
      const bool is_stopping = cancelled_.load(std::memory_order_relaxed);
      is_step_whole = !is_stopping && items_done_ == items_;
      if (is_stopping && --in_flight_ == 0) {
        end_early();
        then = Then::announce_end;
      } else if (!is_stopping && !is_step_whole) {
        --in_flight_;
      }
    }
    if (is_step_whole) {
      try {
        then = finish_step();
      } catch (const std::exception& e) {
        then = fail(e.what());
      }
    }
    if (then == Then::announce_pass || then == Then::announce_end) announce();
    if (then != Then::nothing) pool_.wake(this);  // at the end too: the pool lets go of what says `finished`
  }

  // REQUIRES: mutex_. A pass that runs past the time limit will not count: stop it now, unless it is the first.
  void drop_overrun_pass() {
    const auto& time_ms = plan_.view.render.time_ms;
    if (!time_ms || standing_.passes == 0 || stage_ != Stage::trace || state_ != RenderState::running) return;
    if (is_repeating() || counted_ms() <= *time_ms || items_done_ == items_) return;
    over_time_ = true;
    cancelled_.store(true, std::memory_order_relaxed);
  }

  // REQUIRES: mutex_.
  void end_early() {
    if (!error_.empty()) {
      end(RenderState::failed, "failed");
    } else if (over_time_) {
      end(RenderState::done, "time");
    } else {
      end(RenderState::cancelled, "cancelled");
    }
  }

  // The caller holds the render's only item in flight and none is handed out: film, map and targets are at rest, and
  // work over the whole image needs no lock.
  Then finish_step() {
    switch (stage_) {
      case Stage::prepare:
        return begin();
      case Stage::copy:
        film_.samples() = source_->film.samples();
        source_ = nullptr;
        return go_on();
      case Stage::sketch:
        next_image_ = new_image();
        break;
      case Stage::fill:
        sketch_ = nullptr;
        return finish_pass(kSketchSamples, {}, std::vector<float>(static_cast<size_t>(width_) * height_, 1.0f));
      case Stage::trace:
        if (step_first_ + step_samples_ < pass_length_) break;
        film_.samples() = targets_;
        next_image_ = new_image();
        break;
      case Stage::measure:
        error_map_.pool(film_);
        break;
      case Stage::spread:
        return finish_pass(film_.mean_samples(), error_map_.summary(), error_map_.bounds());
    }
    const std::lock_guard lock(mutex_);
    if (stage_ == Stage::trace && step_first_ + step_samples_ < pass_length_) {
      const double step_ms = ms_between(step_start_, Clock::now());
      item_ms_per_sample_ = step_ms * report_.threads / tiles_ / step_samples_;
      open_step(Stage::trace, step_first_ + step_samples_);
    } else {
      open_step(after(stage_), 0);
    }
    return leave(Then::wake);
  }

  // The step that comes after a whole one, in a pass.
  static Stage after(Stage stage) {
    if (stage == Stage::sketch) return Stage::fill;
    return stage == Stage::trace ? Stage::measure : Stage::spread;
  }

  // REQUIRES: the render's only item in flight is the caller's.
  Then fail(const char* what) {
    const std::lock_guard lock(mutex_);
    --in_flight_;
    error_ = what;
    end(RenderState::failed, "failed");
    return Then::announce_end;
  }

  std::shared_ptr<Image> new_image() const {
    return std::make_shared<Image>(
        Image{width_, height_, std::vector<float>(static_cast<size_t>(width_) * height_ * 3)});
  }

  Then finish_pass(double spp, const ErrorSummary& error, std::vector<float> bounds) {
    auto error_bounds = std::make_shared<const std::vector<float>>(std::move(bounds));
    {
      const std::lock_guard lock(mutex_);
      const double elapsed = counted_ms();
      standing_ = {.passes = standing_.passes + 1,
                   .spp = spp,
                   .elapsed_ms = elapsed,
                   .ms_per_sample = (elapsed - standing_.elapsed_ms) / std::max(1e-9, spp - standing_.spp),
                   .was_for_all = is_for_all_};
      if (error.is_known) standing_.rmse = error.high;
      exposed_->image = std::move(next_image_);
      exposed_->error_bounds = std::move(error_bounds);
      if (standing_.passes > static_cast<int>(before_.passes.size())) {
        report_.passes.push_back(pass_samples_);
        add_report_point(error);
      } else if (!is_repeating()) {  // from here on it adds
        counted_from_ = Clock::now();
        standing_.elapsed_ms = 0.0;
        tally_.cpu_ms = before_.points.back().cpu_ms;
      }
    }
    return go_on();
  }

  // The next pass, or the end.
  Then go_on() {
    PassSchedule::Next next;
    {
      const std::lock_guard lock(mutex_);
      next = schedule_.next(standing_);
      if (next.samples == 0.0) end(RenderState::done, next.stop);
    }
    if (next.samples > 0.0) open_pass(next);
    const std::lock_guard lock(mutex_);
    return leave(state_ == RenderState::running ? Then::announce_pass : Then::announce_end);
  }

  // REQUIRES: mutex_. A cancel that came while the item in flight closed a step was left to it.
  Then leave(Then then) {
    --in_flight_;
    if (state_ != RenderState::running || !cancelled_.load(std::memory_order_relaxed)) return then;
    end_early();
    return Then::announce_end;
  }

  Then begin() {
    if (source_) {
      open_copy();
    } else {
      open_pass(schedule_.next(standing_));
    }
    const std::lock_guard lock(mutex_);
    return leave(Then::wake);
  }

  // What the render that is gone on from has shown and learnt; its samples are copied later.
  void take_over() {
    error_map_ = source_->error_map;
    exposed_->image = source_->image;
    exposed_->error_bounds = source_->error_bounds;
    tally_ = source_->tally;
    standing_ = source_->standing;
    standing_.elapsed_ms = 0.0;
    first_spp_ = standing_.spp;
  }

  void open_copy() {
    for (size_t block = 0; block < kSampleBlocks && source_->film.planes()[block]; ++block)
      film_.grow(static_cast<uint32_t>(block) + 1);
    const std::lock_guard lock(mutex_);
    open_step(Stage::copy, 0);
  }

  // REQUIRES: mutex_. True while it renders the passes of the one before once more.
  bool is_repeating() const { return standing_.passes < static_cast<int>(before_.passes.size()); }

  // REQUIRES: mutex_. Since it began to add to what was there.
  double counted_ms() const { return ms_between(counted_from_, Clock::now()); }

  void open_sketch() {
    sketch_ = std::make_unique<Sketch>(width_, height_);
    const std::lock_guard lock(mutex_);
    pass_samples_ = kSketchSamples;
    is_for_all_ = true;
    pass_length_ = 1;
    open_step(Stage::sketch, 0);
  }

  void open_pass(const PassSchedule::Next& next) {
    if (next.is_sketch) return open_sketch();
    if (next.for_all) {
      targets_ = film_.samples();
      for (uint32_t& samples : targets_) samples += static_cast<uint32_t>(next.samples);
    } else {
      targets_ = spend(film_, error_map_.cell_variances(), next.samples);
    }
    uint32_t most = 0, longest = 0;
    for (size_t i = 0; i < targets_.size(); ++i) {
      most = std::max(most, targets_[i]);
      longest = std::max(longest, targets_[i] - film_.samples()[i]);
    }
    film_.grow(most);
    const std::lock_guard lock(mutex_);
    pass_samples_ = next.samples;
    is_for_all_ = next.for_all;
    pass_length_ = std::max(1u, longest);
    open_step(Stage::trace, 0);
  }

  // REQUIRES: mutex_.
  void open_step(Stage stage, uint32_t first) {
    const double fitting = item_ms_per_sample_ > 0.0 ? std::min(1e6, kItemTargetMs / item_ms_per_sample_) : 1.0;
    stage_ = stage;
    step_first_ = first;
    step_samples_ = std::clamp(static_cast<uint32_t>(fitting), 1u, pass_length_ - (stage == Stage::trace ? first : 0));
    step_start_ = Clock::now();
    items_ = stage == Stage::prepare ? 1 : tiles_;
    next_item_ = items_done_ = 0;
  }

  // REQUIRES: mutex_.
  void end(RenderState state, std::string stop) {
    state_ = state;
    end_ = Clock::now();
    report_.stop = std::move(stop);
    ended_.notify_all();
  }

  void add(const TileCounts& counts, double item_ms) {
    tally_.rays.primary += counts.primary;
    tally_.rays.shadow += counts.shadow;
    tally_.rays.reflected += counts.reflected;
    tally_.rays.refracted += counts.refracted;
    tally_.nonfinite += counts.nonfinite;
    tally_.lights_on_hits += counts.lights_on_hits;
    tally_.untraced_weight = std::max(tally_.untraced_weight, counts.untraced_weight);
    tally_.cpu_ms += item_ms;
  }

  // REQUIRES: mutex_.
  void add_report_point(const ErrorSummary& error) {
    ReportPoint point;
    point.pass = standing_.passes;
    point.spp = standing_.spp;
    point.elapsed_ms = standing_.elapsed_ms + (before_.points.empty() ? 0.0 : before_.points.back().elapsed_ms);
    point.cpu_ms = tally_.cpu_ms;
    point.rays = tally_.rays;
    point.error = error;
    point.nonfinite = tally_.nonfinite;
    point.lights_on_hits = tally_.lights_on_hits;
    if (tally_.untraced_weight == 0.0) {
      point.truncation_bound = 0.0;
    } else if (scene_->radiance_bound >= 0.0) {
      constexpr double kRounding = 1.0 + 0x1p-36;  // more than the products and sums behind both have lost
      point.truncation_bound = tally_.untraced_weight * scene_->radiance_bound * kRounding;
    }
    report_.points.push_back(point);
  }

  void announce() const {
    if (on_pass_) on_pass_();
  }

  // Constant after construction.
  TilePool& pool_;
  const std::shared_ptr<const CompiledScene> scene_;
  const ViewPlan plan_;
  const std::function<void()> on_pass_;
  const int tile_px_, width_, height_, tiles_;
  const EyeMedia eye_media_;
  const RenderReport before_;  // of the render that is continued; empty without one
  const PassSchedule schedule_;
  const Clock::time_point start_ = Clock::now();

  std::atomic<bool> cancelled_{false};
  // Items write disjoint tiles; between steps the last item's thread has them for itself.
  std::unique_ptr<const Method> method_;
  std::shared_ptr<const ExposedFilm> source_;  // until it is copied
  const std::shared_ptr<ExposedFilm> exposed_;
  Film& film_ = exposed_->film;
  ErrorMap& error_map_ = exposed_->error_map;
  std::unique_ptr<Sketch> sketch_;     // while that is the pass in work
  std::shared_ptr<Image> next_image_;  // of the pass in work
  std::vector<uint32_t> targets_;      // by cell: its samples after the pass in work

  mutable std::mutex mutex_;
  mutable std::condition_variable ended_;
  // Guarded by mutex_; items read the stage and the step without it, for they change only between steps.
  RenderState state_ = RenderState::running;
  std::string error_;
  bool over_time_ = false;
  Clock::time_point end_, step_start_;
  Clock::time_point counted_from_ = start_;
  Standing& standing_ = exposed_->standing;
  Tally& tally_ = exposed_->tally;
  double first_spp_ = 0.0;  // what its film had at the start
  double pass_samples_ = 0.0;
  bool is_for_all_ = true;
  uint32_t pass_length_ = 1;  // samples of the cell that takes most
  Stage stage_ = Stage::trace;
  uint32_t step_first_ = 0, step_samples_ = 1;                      // of each cell's samples in the pass
  int items_ = 1, next_item_ = 0, items_done_ = 0, in_flight_ = 0;  // the first three of the step
  double item_ms_per_sample_ = 0.0;
  RenderReport report_;
};

}  // namespace

int64_t render_memory_bytes(const View& view) {
  const auto& [width, height, exposure] = view.image;
  const int64_t pixel_bytes =
      std::min<int64_t>(kSampleBlocks, view.render.samples.value_or(kSampleBlocks)) * kColorBytes + 2 * kColorBytes +
      ErrorMap::kPixelBytes;
  return int64_t{width} * height * pixel_bytes;
}

int64_t memory_bytes(const ExposedFilm& exposed) {
  const Film& film = exposed.film;
  return film.bytes() + int64_t{film.width()} * film.height() * (ErrorMap::kPixelBytes + kColorBytes);
}

std::string rule_met(const RenderSpec& spec, const RenderReport& report) {
  if (report.points.empty()) return {};
  const ReportPoint& last = report.points.back();
  Standing standing{.passes = last.pass, .spp = last.spp};
  if (last.error.is_known) standing.rmse = last.error.high;
  const PassSchedule::Next next = PassSchedule(spec).next(standing);
  return next.samples > 0.0 ? std::string() : next.stop;
}

ViewPlan plan_view(const CompiledScene& scene, const View& view) { return plan_view(scene, view, current_isa()); }

std::shared_ptr<Render> Render::start(TilePool& pool, Priority priority, std::shared_ptr<const CompiledScene> scene,
                                      ViewPlan plan, RenderOptions options) {
  const StandardFloats floats;
  auto drawn = drawn_scene(scene, plan, pool);
  auto render = std::make_shared<TileRender>(pool, std::move(drawn), std::move(plan), std::move(options));
  pool.add(render, priority);
  return render;
}

}  // namespace tilelight
