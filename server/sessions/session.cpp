// SPDX-License-Identifier: Apache-2.0
#include "server/sessions/session.h"

namespace tilelight::server {

bool Session::set_view(int64_t seq, View view, bool is_moving) {
  if (is_moving) {
    view.render.samples = 1;
    view.render.rmse.reset();
    view.render.time_ms.reset();
    view.render.passes.clear();
  }
  std::shared_ptr<Render> older;
  {
    const std::lock_guard lock(mutex_);
    if (seq <= view_seq_ || is_closed_) return false;
    view_seq_ = seq;
    exposure_ = view.image.exposure;
    older = std::move(render_);
    render_ = nullptr;
  }
  if (older) older->cancel();
  RenderOptions options;
  // Weak: the render must not keep the session, which keeps the render.
  options.on_pass = [weak = weak_from_this(), seq] {
    if (const auto self = weak.lock()) self->note_pass(seq);
  };
  std::shared_ptr<Render> render;
  try {
    render = start_render(view, std::move(options));
  } catch (const std::exception& bug) {
    note_failure(seq, bug.what());
    return true;
  }
  bool is_newest = false;
  {
    const std::lock_guard lock(mutex_);
    is_newest = view_seq_ == seq && !is_closed_;
    if (is_newest) render_ = render;
  }
  if (!is_newest) {
    render->cancel();
    return true;
  }
  note_pass(seq);  // a pass may have ended before the session knew its render
  return true;
}

void Session::note_pass(int64_t view_seq) {
  std::shared_ptr<Render> render;
  {
    const std::lock_guard lock(mutex_);
    if (view_seq != view_seq_ || !render_) return;
    render = render_;
  }
  RenderProgress progress = render->progress();
  if (progress.state == RenderState::failed) return note_failure(view_seq, std::move(progress.error));
  const bool is_final = progress.state == RenderState::done;
  if (progress.spp == 0 || progress.state == RenderState::cancelled) return;
  auto image = render->image();
  auto error_bounds = render->error_bounds();
  auto report = render->report();
  const std::lock_guard lock(mutex_);
  if (view_seq != view_seq_ || !image) return;
  const bool is_known = frame_.seq > 0 && frame_.view_seq == view_seq && frame_.progress.spp >= progress.spp;
  if (is_known && (frame_.is_final || !is_final)) return;
  frame_ = {
      frame_.seq + 1,          view_seq, is_final, exposure_, std::move(progress), std::move(report), std::move(image),
      std::move(error_bounds), ""};
  changed_.notify_all();
}

void Session::note_failure(int64_t view_seq, std::string error) {
  const std::lock_guard lock(mutex_);
  const bool is_known = frame_.seq > 0 && frame_.view_seq == view_seq && !frame_.image;
  if (view_seq != view_seq_ || is_known) return;
  frame_ = {frame_.seq + 1, view_seq, true, exposure_, {}, {}, nullptr, nullptr, std::move(error)};
  changed_.notify_all();
}

std::shared_ptr<Render> Session::start_render(const View& view, RenderOptions options) {
  return Render::start(pool_, Priority::interactive, compiled_, plan_view(*compiled_, view), std::move(options));
}

std::optional<Frame> Session::wait_frame(int64_t after, std::stop_token gone, Steady::time_point until) const {
  std::unique_lock lock(mutex_);
  // That a view failed is told while it is the newest: who has sent another one waits for that one's frames.
  const auto is_new = [&] { return frame_.seq > after && (frame_.image || frame_.view_seq == view_seq_); };
  changed_.wait_until(lock, gone, until, [&] { return is_new() || is_closed_; });
  if (is_closed_ || !is_new()) return std::nullopt;
  return frame_;
}

void Session::close() {
  std::shared_ptr<Render> render;
  {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    render = std::move(render_);
    render_ = nullptr;
    changed_.notify_all();
  }
  if (render) render->cancel();
}

bool Session::is_closed() const {
  const std::lock_guard lock(mutex_);
  return is_closed_;
}

}  // namespace tilelight::server
