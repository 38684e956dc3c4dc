// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/render_work.h"

#include "renderer/base/hash.h"

namespace tilelight::server {
namespace {

// Of one moment: a pass that ends between the two calls brings another map, which is that of a finer image.
RenderWork::Picture picture_of(const Render& render) { return {render.image(), render.error_bounds()}; }

}  // namespace

RenderWork::RenderWork(RenderRequest request, std::string key, int64_t created_ms)
    : request_(std::move(request)), key_(std::move(key)), keeps_film_(request_.becomes_job) {
  status_.created_ms = created_ms;
  status_.timings.parse_ms = request_.parse_ms;
}

WorkStatus RenderWork::status() const {
  std::unique_lock lock(mutex_);
  WorkStatus status = status_;
  const auto render = render_;
  lock.unlock();
  if (render) {
    status.progress = render->progress();
    status.report = render->report();
  }
  return status;
}

JobState RenderWork::state() const {
  const std::lock_guard lock(mutex_);
  return status_.state;
}

void RenderWork::wait_change(int64_t seen, std::stop_token gone, Steady::time_point until) const {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, gone, until, [&] { return status_.revision != seen || is_final(status_.state); });
}

bool RenderWork::wait_end(std::stop_token gone, Steady::time_point until) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_until(lock, gone, until, [&] { return is_final(status_.state); });
}

RenderWork::Picture RenderWork::picture() const {
  std::unique_lock lock(mutex_);
  if (picture_.image || !render_) return picture_;
  const auto render = render_;
  lock.unlock();
  return picture_of(*render);
}

std::string RenderWork::lines_svg() const {
  std::unique_lock lock(mutex_);
  if (picture_.image || !render_) return lines_svg_;
  const auto render = render_;
  lock.unlock();
  return render->lines_svg();
}

std::pair<RenderWork::Encoding, std::shared_ptr<RenderWork::EncodingPromise>> RenderWork::claim(ImageFormat format) {
  const std::lock_guard lock(mutex_);
  const auto known = encodings_.find(format);
  if (known != encodings_.end()) return {known->second, nullptr};
  auto promise = std::make_shared<EncodingPromise>();
  Encoding future = promise->get_future().share();
  // Without the linear image there is nothing to claim, and the answer is no promise for later.
  if (picture_.image) encodings_[format] = future;
  return {future, promise};
}

Result<EncodedPtr> RenderWork::encode(ImageFormat format) {
  std::unique_lock lock(mutex_);
  const auto image = picture_.image;
  std::string lines = format == ImageFormat::svg ? lines_svg_ : "";
  lock.unlock();
  if (!image) return fail("expired", "the linear image is no longer kept; only formats encoded before are");
  const auto start = Steady::now();
  // Where there are no lines the encoder says so.
  auto encoded = lines.empty() ? encode_tagged(*image, request_.view.image.exposure, format) : tagged(std::move(lines));
  lock.lock();
  status_.timings.encode_ms += ms_since(start);
  if (encoded) encoded_bytes_ += static_cast<int64_t>((*encoded)->bytes.size());
  if (!encoded) encodings_.erase(format);  // memory that is short now need not be so for who asks next
  return encoded;
}

Result<EncodedPtr> RenderWork::encoded(ImageFormat format, TilePool& pool) {
  auto [future, mine] = claim(format);
  if (mine) {
    // Not at the render's priority: somebody waits for it.
    try {
      pool.post(Priority::interactive, [self = shared_from_this(), format, mine = mine] { self->keep(*mine, format); });
    } catch (...) {
      break_promise(*mine, format);
    }
  }
  return future.get();
}

Result<EncodedPtr> RenderWork::encode_here(ImageFormat format) {
  auto [future, mine] = claim(format);
  if (mine) keep(*mine, format);
  return future.get();
}

void RenderWork::keep(EncodingPromise& promise, ImageFormat format) {
  try {
    promise.set_value(encode(format));
  } catch (...) {
    break_promise(promise, format);
  }
}

void RenderWork::break_promise(EncodingPromise& promise, ImageFormat format) {
  {
    const std::lock_guard lock(mutex_);
    encodings_.erase(format);
  }
  promise.set_exception(std::current_exception());
}

std::string RenderWork::final_image_hash() {
  std::unique_lock lock(mutex_);
  const auto image = picture_.image;
  if (!image_hash_.empty() || !image || status_.state != JobState::done) return image_hash_;
  lock.unlock();
  std::string hash = image_hash(*image);
  lock.lock();
  return image_hash_ = std::move(hash);
}

std::optional<double> RenderWork::final_rounding(const std::function<std::optional<double>()>& find) {
  std::unique_lock lock(mutex_);
  if (rounding_) return *rounding_;
  if (status_.state != JobState::done) return std::nullopt;
  lock.unlock();
  const std::optional<double> found = find();
  lock.lock();
  rounding_ = found;
  return found;
}

void RenderWork::drop_image() {
  const std::lock_guard lock(mutex_);
  picture_ = {};
  std::string().swap(lines_svg_);  // an assignment would keep the memory
}

int64_t RenderWork::result_bytes() const {
  const std::lock_guard lock(mutex_);
  const auto picture_bytes =
      picture_.image ? static_cast<int64_t>(picture_.image->rgb.size() + picture_.error_bounds->size()) * 4 : 0;
  return picture_bytes + static_cast<int64_t>(lines_svg_.size()) + encoded_bytes_ +
         2 * static_cast<int64_t>(request_.scene->text.size()) + 4096;
}

void RenderWork::keep_film() {
  const std::lock_guard lock(mutex_);
  keeps_film_ = true;
}

bool RenderWork::is_refinable() const {
  const std::lock_guard lock(mutex_);
  return keeps_film_ && status_.state == JobState::done;
}

std::shared_ptr<const ExposedFilm> RenderWork::film() const {
  const std::lock_guard lock(mutex_);
  return film_;
}

int64_t RenderWork::film_bytes() const {
  const auto film = this->film();
  return film ? memory_bytes(*film) : 0;
}

std::shared_ptr<const ExposedFilm> RenderWork::drop_film() {
  const std::lock_guard lock(mutex_);
  keeps_film_ = false;
  return std::move(film_);
}

void RenderWork::watch(std::function<void()> fn) {
  const std::lock_guard lock(mutex_);
  watchers_.push_back(std::move(fn));
}

void RenderWork::notify_watchers() {
  std::unique_lock lock(mutex_);
  const auto watchers = watchers_;
  lock.unlock();
  for (const auto& watcher : watchers) watcher();
}

void RenderWork::bump() {
  const std::lock_guard lock(mutex_);
  ++status_.revision;
  changed_.notify_all();
}

void RenderWork::set_running(int64_t started_ms, double queue_ms) {
  {
    const std::lock_guard lock(mutex_);
    status_.state = JobState::running;
    status_.started_ms = started_ms;
    status_.timings.queue_ms = queue_ms;
  }
  bump();
  notify_watchers();
}

void RenderWork::set_planned(const Plan& plan, double compile_ms, double plan_ms) {
  {
    const std::lock_guard lock(mutex_);
    status_.plan = plan;
    status_.timings.compile_ms = compile_ms;
    status_.timings.plan_ms = plan_ms;
  }
  bump();
}

void RenderWork::set_render(std::shared_ptr<Render> render) {
  const std::lock_guard lock(mutex_);
  render_ = std::move(render);
}

std::shared_ptr<Render> RenderWork::render() const {
  const std::lock_guard lock(mutex_);
  return render_;
}

void RenderWork::take_result() {
  const auto render = this->render();
  if (!render) return;
  auto picture = picture_of(*render);
  auto lines = render->lines_svg();
  auto progress = render->progress();
  auto report = render->report();
  auto film = render->exposed_film();
  std::optional<int64_t> clamped;
  if (picture.image) clamped = count_clamped(*picture.image, request_.view.image.exposure, ImageFormat::exr);
  const std::lock_guard lock(mutex_);
  if (keeps_film_) film_ = std::move(film);
  picture_ = std::move(picture);
  lines_svg_ = std::move(lines);
  status_.timings.render_ms = progress.elapsed_ms;
  status_.progress = std::move(progress);
  status_.report = std::move(report);
  status_.clamped = clamped;
  render_ = nullptr;
}

void RenderWork::set_ended(JobState state, std::string error, int64_t finished_ms) {
  Picture dropped;  // before the lock: memory is given back after it
  std::string dropped_lines;
  std::shared_ptr<const ExposedFilm> dropped_film;
  {
    const std::lock_guard lock(mutex_);
    status_.state = state;
    status_.error = std::move(error);
    status_.finished_ms = finished_ms;
    status_.progress.eta_ms = state == JobState::done ? 0.0 : -1.0;
    if (state != JobState::done)
      std::swap(dropped, picture_), std::swap(dropped_lines, lines_svg_), std::swap(dropped_film, film_);
  }
  bump();
  notify_watchers();
}

void RenderWork::request_cancel() {
  cancel_requested_.store(true, std::memory_order_release);
  if (const auto render = this->render()) render->cancel();
}

EncodedPtr tagged(std::string bytes, int64_t clamped) {
  auto encoded = std::make_shared<EncodedImage>();
  encoded->clamped = clamped;
  encoded->etag = "\"" + sha256_hex(bytes).substr(0, 32) + "\"";
  encoded->bytes = std::move(bytes);
  return encoded;
}

Result<EncodedPtr> encode_tagged(const Image& image, double exposure_stops, ImageFormat format) {
  auto bytes = encode_image(image, exposure_stops, format);
  if (!bytes) return ::tl::unexpected(bytes.error());
  return tagged(std::move(*bytes), count_clamped(image, exposure_stops, format));
}

}  // namespace tilelight::server
