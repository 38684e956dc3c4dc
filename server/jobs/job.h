// SPDX-License-Identifier: Apache-2.0
// The life of a render in the server.
//
//              submit                 a slot is free                 last pass, encoded
//   (request) --------> queued ------------------------> running -----------------------> done
//                         |                              |     |
//                         | last holder leaves,          |     | a bug, or the image cannot be encoded
//                         | or the server stops          |     +-------------------------> failed
//                         +----------> cancelled <-------+
//
// A RenderWork is the work itself; identical requests in flight share one. Its holders are waiting requests and jobs.
// A job is the record a client can come back to: made only when an answer was 202, forgotten by DELETE. The result of
// a done job is kept until the results' cap on count or bytes drops the oldest; the record then says so (410). Its film
// is kept for a shorter time (kept_films.h), in which a new render may go on from it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/renderer.h"
#include "server/scenes/scene_store.h"

namespace tilelight::server {

enum class JobState { queued = 0, running = 1, done = 2, failed = 3, cancelled = 4 };  // stored: never renumber

std::string_view job_state_name(JobState state);
std::optional<JobState> find_job_state(std::string_view name);
inline bool is_final(JobState state) { return state != JobState::queued && state != JobState::running; }

std::string_view priority_name(Priority priority);
std::string_view image_format_name(ImageFormat format);  // "png", "jpeg", "exr", "svg"
std::optional<ImageFormat> find_image_format(std::string_view name);
// In which pictures can be had, the preferred one first. with_lines: svg too, for line drawings.
std::vector<ImageFormat> image_formats(bool with_lines);
// The same for a picture of this size: those whose limits it keeps.
std::vector<ImageFormat> image_formats(bool with_lines, int width, int height);
inline std::vector<ImageFormat> image_formats(const View& view) {
  return image_formats(draws_lines(view), view.image.width, view.image.height);
}

// The done render that another one goes on from.
struct RefineSource {
  std::string job_id;
  RenderReport report;
  // Weak: what waits in the queue must not keep the film. Once it is gone the passes of the report are rendered again.
  std::weak_ptr<const ExposedFilm> film;
};

// What to render.
struct RenderRequest {
  ScenePtr scene;
  View view;
  ImageFormat format = ImageFormat::png;  // in which the result is encoded before it is called done
  Priority priority = Priority::normal;
  std::vector<SceneWarning> warnings = {};  // of the scene and of the view
  double parse_ms = 0.0;
  std::optional<RefineSource> refines = {};
  bool becomes_job = false;  // for certain: it may end before the job is made, and its film is kept all the same
};

// All values of a view as text, exact to the bit: two views with the same text give the same image.
std::string view_fingerprint(const View& view);

// What identical renders share: SHA-256 of scene, view and what they go on from.
std::string render_key(const RenderRequest& request);

struct Timings {
  double parse_ms = 0.0, queue_ms = 0.0, compile_ms = 0.0, plan_ms = 0.0, render_ms = 0.0, encode_ms = 0.0;
};

// Where a render stands.
struct WorkStatus {
  JobState state = JobState::queued;
  int64_t revision = 1;  // grows with every change of state and every pass
  RenderProgress progress;
  RenderReport report;
  std::optional<Plan> plan;
  Timings timings;
  int64_t created_ms = 0, started_ms = 0, finished_ms = 0;  // wall clock; 0: not yet
  std::string error;                                        // state failed: for the client, no inside information
  std::optional<int64_t> clamped;                           // of the final image: values that no 32-bit float can hold
};

// What a job store keeps of a job.
struct JobRecord {
  std::string id;
  uint64_t sequence = 0;  // order of submission; given by the store
  std::string client;     // whose job it is
  std::string scene_id;
  std::string refines;  // id of the job that it goes on from; empty without one
  double exposure = 0.0;
  Priority priority = Priority::normal;
  ImageFormat format = ImageFormat::png;
  std::vector<SceneWarning> warnings;
  WorkStatus status;
  bool result_expired = false;
};

// An encoded image and its strong entity tag.
struct EncodedImage {
  std::string bytes;
  std::string etag;     // quoted
  int64_t clamped = 0;  // values of the picture that the format cannot hold
};
using EncodedPtr = std::shared_ptr<const EncodedImage>;

}  // namespace tilelight::server
