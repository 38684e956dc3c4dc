// SPDX-License-Identifier: Apache-2.0
// Session: an interactive view of one compiled scene. The newest view wins: it cancels the older render. Every finished
// pass makes a frame, and so does a failure, since who waits for a frame must hear of it; only the newest frame is
// kept. Any thread.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "server/clock.h"
#include "server/scenes/compiled_cache.h"

namespace tilelight::server {

struct Frame {
  int64_t seq = 0;        // 1, 2, ... in the session
  int64_t view_seq = 0;   // the view it shows
  bool is_final = false;  // the view's stop rules hold
  double exposure = 0.0;
  RenderProgress progress;
  RenderReport report;                                     // so far
  std::shared_ptr<const Image> image;                      // null where the view's render failed
  std::shared_ptr<const std::vector<float>> error_bounds;  // by pixel
  std::string error;                                       // of a render that failed: why, for the log
};

class Session : public std::enable_shared_from_this<Session> {
 public:
  Session(std::string id, TilePool& pool, CompiledPtr compiled, View base)
      : id_(std::move(id)), pool_(pool), compiled_(std::move(compiled)), base_(std::move(base)) {}
  virtual ~Session() = default;

  const std::string& id() const { return id_; }
  const View& base_view() const { return base_; }  // over which each view is merged

  // Starts rendering the view unless one of this sequence or a newer one came before. False: ignored. While moving one
  // sample a pixel is rendered, whatever the view says.
  bool set_view(int64_t seq, View view, bool is_moving);

  // Waits for a frame with a number over `after`. Nothing: none came in time, or the session was closed.
  std::optional<Frame> wait_frame(int64_t after, std::stop_token gone, Steady::time_point until) const;

  void close();
  bool is_closed() const;

 protected:
  // Starts the render of a view; tests put another in its place.
  virtual std::shared_ptr<Render> start_render(const View& view, RenderOptions options);

 private:
  void note_pass(int64_t view_seq);
  void note_failure(int64_t view_seq, std::string error);

  // Constant after construction.
  const std::string id_;
  TilePool& pool_;
  const CompiledPtr compiled_;
  const View base_;

  mutable std::mutex mutex_;  // guards the rest; not held while rendering
  mutable std::condition_variable_any changed_;
  int64_t view_seq_ = -1;  // of the newest view
  double exposure_ = 0.0;
  std::shared_ptr<Render> render_;  // of the newest view
  Frame frame_;                     // seq 0: none yet
  bool is_closed_ = false;
};

using SessionPtr = std::shared_ptr<Session>;

}  // namespace tilelight::server
