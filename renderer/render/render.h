// SPDX-License-Identifier: Apache-2.0
// Render: one render from pass to pass. Passes of 1, 1, 2, 4, 8, ... samples a pixel over a grid of work items, and
// after each of them its error; only whole passes count. It owns no threads: a TilePool calls it. The image of the
// passes done so far can be read at any time. Any thread may call any method.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/compile/compile.h"
#include "renderer/film/error_map.h"
#include "renderer/film/film.h"
#include "renderer/schedule/tile_pool.h"

namespace tilelight {

// What a render of the view holds at most: samples, error and image.
int64_t render_memory_bytes(const View& view);

// plan_view for the instruction set in use.
ViewPlan plan_view(const CompiledScene& scene, const View& view);

// Whether the picture of the view is a line drawing, so that its render has lines_svg().
inline bool draws_lines(const View& view) { return view.render.algorithm == Algorithm::roberts; }

enum class RenderState { running, done, cancelled, failed };

struct RayCounts {
  int64_t primary = 0, shadow = 0, reflected = 0, refracted = 0;
  int64_t total() const { return primary + shadow + reflected + refracted; }
  RayCounts operator-(const RayCounts& o) const {
    return {primary - o.primary, shadow - o.shadow, reflected - o.reflected, refracted - o.refracted};
  }
};

// One point of the report: after a whole pass. Times in milliseconds since the start, with those of the render that was
// continued before it.
struct ReportPoint {
  int pass = 0;
  double spp = 0.0;  // samples a pixel: the mean over pixels
  double elapsed_ms = 0.0, cpu_ms = 0.0;
  RayCounts rays;
  ErrorSummary error;
  double truncation_bound = -1.0;  // bound of the mean linear value left untraced; < 0: none is finite
  int64_t nonfinite = 0;           // samples that were not finite; each is a bug
  int64_t lights_on_hits = 0;      // lights at the very point of a hit, where they bring nothing
};

struct RenderReport {
  std::vector<ReportPoint> points;
  std::string stop;  // "samples", "rmse", "time", "passes", "cancelled", "failed"; empty while running
  bool adaptive = false;
  std::vector<double> passes;  // what passes: [...] replays, with the same adaptive
  int threads = 0;
  uint32_t seed = 0;
};

struct RenderProgress {
  RenderState state = RenderState::running;
  double spp = 0.0;       // samples a pixel in whole passes so far: the mean over pixels
  double fraction = 0.0;  // [0, 1]
  double elapsed_ms = 0.0;
  double eta_ms = -1.0;  // < 0: unknown
  std::string error;     // state failed only
};

// What a done render leaves for others to go on from. Opaque; immutable.
struct ExposedFilm;
int64_t memory_bytes(const ExposedFilm& film);

// The render that another one goes on from. Its samples count: the same passes in one render give the same bytes.
struct Continued {
  RenderReport report;  // its points and passes come first
  // Null: its passes are rendered once more, before the new render's clock starts.
  std::shared_ptr<const ExposedFilm> film;
};

// The first stop rule of the view that the picture of the report meets already ("samples", "rmse", "time", "passes"),
// so that there is nothing to go on for; else empty.
std::string rule_met(const RenderSpec& spec, const RenderReport& report);

struct RenderOptions {
  int tile_px = 0;                // rounded up to whole cells of the film; 0: chosen by measurement
  std::function<void()> on_pass;  // after each whole pass and at the end, from a pool thread; must be quick
  // REQUIRES: a done render of the same scene and of a view that differs in samples, rmse, time_ms and passes alone.
  // Samples and rmse speak of the whole picture, time_ms of what is added.
  std::optional<Continued> continues;
};

class Render {
 public:
  // Starts at once. The pool must outlive the render's last item.
  static std::shared_ptr<Render> start(TilePool& pool, Priority priority, std::shared_ptr<const CompiledScene> scene,
                                       ViewPlan plan, RenderOptions options = {});
  virtual ~Render() = default;

  virtual void cancel() = 0;  // cooperative; reaches the tiles within milliseconds
  virtual RenderProgress progress() const = 0;
  virtual RenderReport report() const = 0;
  // The image of the whole passes so far; null before the first pass.
  virtual std::shared_ptr<const Image> image() const = 0;
  // By pixel of that image, what its error is below of in 95 % of cases, displayed. Null before the first pass.
  virtual std::shared_ptr<const std::vector<float>> error_bounds() const = 0;
  // The lines of a picture by roberts as an SVG document, from the first pass on. Empty before, and by other methods.
  virtual std::string lines_svg() const = 0;
  // Once it is done. Null before, and where samples of a pass that was dropped are among those that count.
  virtual std::shared_ptr<const ExposedFilm> exposed_film() const = 0;
  // Blocks until the render ends or the time is over. True if it ended.
  virtual bool wait_ms(double ms) const = 0;
};

// What the render cannot know of itself. Empty: not known, null in the report.
struct ReportIdentity {
  std::string version, scene_id, image_hash;
  std::optional<double> rounding = {};  // as find_rounding has it
  std::optional<int64_t> clamped = {};  // values of the image that after exposure no 32-bit float can hold
  std::vector<SceneWarning> warnings =
      {};  // of reading the scene and of the image; the plan and the report have their own
};
// What the report tells that nobody should overlook, as the scene's own warnings are told.
std::vector<SceneWarning> report_warnings(const RenderReport& report);

// SHA-256 of the linear image: floats as they lie in memory, little-endian, RGB, row by row.
std::string image_hash(const Image& image);

// The report as a JSON object, and its curve of error against time as an SVG document.
std::string report_json(const RenderReport& report, const Plan& plan, const ReportIdentity& identity = {});
std::string report_svg(const RenderReport& report);

}  // namespace tilelight
