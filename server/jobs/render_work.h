// SPDX-License-Identifier: Apache-2.0
// RenderWork: one render that requests and jobs share. JobQueue moves it from state to state; others look, wait and
// fetch the image. Any thread may call any method; no lock is held while rendering or encoding.
#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/jobs/job.h"
#include "server/scenes/compiled_cache.h"

namespace tilelight::server {

class RenderWork : public std::enable_shared_from_this<RenderWork> {
 public:
  RenderWork(RenderRequest request, std::string key, int64_t created_ms);

  const RenderRequest& request() const { return request_; }
  const std::string& key() const { return key_; }
  WorkStatus status() const;
  JobState state() const;

  // Waits until the revision is not `seen`, the render has ended, the client is gone or the time is over.
  void wait_change(int64_t seen, std::stop_token gone, Steady::time_point until) const;
  // True if the render has ended.
  bool wait_end(std::stop_token gone, Steady::time_point until) const;

  // The linear image of the whole passes so far and the bound of the error by pixel. Null before the first pass and
  // after drop_image().
  struct Picture {
    std::shared_ptr<const Image> image;
    std::shared_ptr<const std::vector<float>> error_bounds;
  };
  Picture picture() const;
  // The lines of that picture as an SVG document. Empty where there is no picture, and by methods that draw none.
  std::string lines_svg() const;

  // The image of an ended render in a format, encoded once on the pool. REQUIRES: not a pool thread.
  // Errors: expired (the linear image was dropped), or the encoder's.
  Result<EncodedPtr> encoded(ImageFormat format, TilePool& pool);
  // The same on this thread, which is one of the pool.
  Result<EncodedPtr> encode_here(ImageFormat format);

  // image_hash() of the final image, worked out once; empty before, and where nobody asked before drop_image().
  std::string final_image_hash();

  // What `find` tells of the final image, asked for once; none before the end. No lock is held while it looks.
  std::optional<double> final_rounding(const std::function<std::optional<double>()>& find);

  // Forgets the linear image and the lines; formats encoded so far stay.
  void drop_image();
  int64_t result_bytes() const;

  // Says that a job was made of it: from its end to drop_film() others may go on from it. The film is kept if this was
  // said before the end, or with the request.
  void keep_film();
  bool is_refinable() const;
  // Null: there is none, and who goes on renders the passes of the report again.
  std::shared_ptr<const ExposedFilm> film() const;
  int64_t film_bytes() const;
  // Hands it over, for its memory to be given back where no lock is held.
  std::shared_ptr<const ExposedFilm> drop_film();

  // Calls fn after every change of state, without a lock. REQUIRES: quick.
  void watch(std::function<void()> fn);

  // What follows is JobQueue's.
  void set_running(int64_t started_ms, double queue_ms);
  void set_planned(const Plan& plan, double compile_ms, double plan_ms);
  void set_render(std::shared_ptr<Render> render);
  std::shared_ptr<Render> render() const;
  void bump();  // a pass is done
  // Takes image, lines and report from the render and lets it go.
  void take_result();
  void set_ended(JobState state, std::string error, int64_t finished_ms);
  void request_cancel();
  bool is_cancel_requested() const { return cancel_requested_.load(std::memory_order_acquire); }
  bool begin_conclusion() { return !concluding_.exchange(true, std::memory_order_acq_rel); }  // true once

 private:
  using Encoding = std::shared_future<Result<EncodedPtr>>;
  using EncodingPromise = std::promise<Result<EncodedPtr>>;
  // The future of the format's encoding, and the promise if it falls to the caller to keep it.
  std::pair<Encoding, std::shared_ptr<EncodingPromise>> claim(ImageFormat format);
  void keep(EncodingPromise& promise, ImageFormat format);
  // Hands on the exception that is being handled, and forgets the encoding first, so that who asks next tries anew.
  // REQUIRES: in a catch block.
  void break_promise(EncodingPromise& promise, ImageFormat format);
  Result<EncodedPtr> encode(ImageFormat format);
  void notify_watchers();

  // Constant after construction.
  const RenderRequest request_;
  const std::string key_;

  std::atomic<bool> cancel_requested_ = false;  // release/acquire: set before the render is looked up to be cancelled
  std::atomic<bool> concluding_ = false;

  mutable std::mutex mutex_;  // guards the rest
  mutable std::condition_variable_any changed_;
  WorkStatus status_;  // progress and report are filled in from render_ while there is one
  std::shared_ptr<Render> render_;
  Picture picture_;
  std::string lines_svg_;                          // beside picture_
  std::string image_hash_;                         // after the end
  std::optional<std::optional<double>> rounding_;  // once it was found, or found that it cannot be
  bool keeps_film_;
  std::shared_ptr<const ExposedFilm> film_;  // after the end
  std::map<ImageFormat, Encoding> encodings_;
  int64_t encoded_bytes_ = 0;
  std::vector<std::function<void()>> watchers_;
};

using WorkPtr = std::shared_ptr<RenderWork>;

// Tags what is encoded already.
EncodedPtr tagged(std::string bytes, int64_t clamped = 0);
// Encodes and tags an image.
Result<EncodedPtr> encode_tagged(const Image& image, double exposure_stops, ImageFormat format);

}  // namespace tilelight::server
