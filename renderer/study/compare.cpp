// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/compare.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "renderer/compile/tessellate.h"
#include "renderer/film/tone.h"
#include "renderer/scene/words.h"
#include "renderer/study/statistics.h"
#include "renderer/study/studio.h"

namespace tilelight {
namespace {

using study::Cancelled, study::Drawing, study::Studio;

constexpr uint32_t kReferenceSeed = 1'000'000'007;  // far from those of the rounds

template <class Enum, size_t n>
std::vector<Enum> all_of(const std::array<NamedValue<Enum>, n>& table) {
  std::vector<Enum> out;
  for (const auto& entry : table) out.push_back(entry.value);
  return out;
}

class Maker {
 public:
  Maker(const ParsedScene& parsed, const std::string& name, const Studio& studio, const CompareOptions& options)
      : studio_(studio), pool_(studio.pool()), options_(options), view_(parsed.view) {
    view_ = study::with_samples(view_, options.samples, false);
    out_.scene_name = name, out_.scene_id = parsed.scene_id;
    out_.threads = pool_.thread_count();
    out_.width = view_.image.width, out_.height = view_.image.height, out_.exposure = view_.image.exposure;
    out_.samples = options.samples, out_.rounds = options.rounds, out_.reference_samples = options.reference_samples;
    compiled_ = compile_scene(parsed.scene, pool_);
    out_.isa = plan_view(*compiled_, view_).plan.isa;
  }

  Comparison make() {
    ask_rows();
    std::vector<std::vector<Drawing>> rounds(views_.size());
    // All rows once, then once more: what slows the machine down for a while slows one round of each and no median.
    for (int round = 0; round < options_.rounds; ++round) {
      for (size_t i = 0; i < views_.size(); ++i) {
        studio_.tell(out_.rows[i].method + " " + out_.rows[i].shading,
                     0.6 * (round + i / static_cast<double>(views_.size())) / options_.rounds);
        rounds[i].push_back(studio_.draw(compiled_, views_[i]));
      }
    }
    studio_.tell("the reference, " + std::to_string(options_.reference_samples) + " samples a pixel", 0.6);
    View truth = study::with_samples(view_, options_.reference_samples, false);
    truth.render.seed = kReferenceSeed;
    truth.render.algorithm = Algorithm::raytrace, truth.render.shading = Shading::phong;
    out_.reference = studio_.draw(compiled_, truth).image;
    for (size_t i = 0; i < views_.size(); ++i) {
      studio_.tell("comparing", 0.8 + 0.1 * static_cast<double>(i) / static_cast<double>(views_.size()));
      judge(out_.rows[i], views_[i], rounds[i]);
    }
    for (const Algorithm method : methods_) look_at_work(method);
    return std::move(out_);
  }

 private:
  void ask_rows() {
    methods_ = options_.methods.empty() ? all_of(kAlgorithms) : options_.methods;
    const auto shadings = options_.shadings.empty() ? all_of(kShadings) : options_.shadings;
    for (const Algorithm method : methods_) {
      for (const Shading shading : shadings) {
        View view = view_;
        view.render.algorithm = method, view.render.shading = shading;
        views_.push_back(view);
        CompareRow row;
        row.method = get_word(kAlgorithms, method);
        if (method != Algorithm::roberts) row.shading = get_word(kShadings, shading);
        out_.rows.push_back(row);
        if (method == Algorithm::roberts) break;
      }
    }
  }

  void judge(CompareRow& row, const View& view, const std::vector<Drawing>& rounds) {
    std::vector<double> times;
    for (const Drawing& drawn : rounds) times.push_back(drawn.time_ms);
    const auto [least, most] = std::minmax_element(times.begin(), times.end());
    row.time_ms = median(times), row.time_low_ms = *least, row.time_high_ms = *most;
    row.rays = rounds.front().rays;
    row.image = rounds.front().image;
    if (view.render.algorithm == Algorithm::roberts) return;
    row.error = image_error(*row.image, *out_.reference, out_.exposure);
    const DisplayedImage shown = displayed_image(*row.image, out_.exposure);
    row.off = error_by_pixel(shown, displayed_image(*out_.reference, out_.exposure));
    if (view.render.algorithm == Algorithm::raytrace) return;
    const std::shared_ptr<const Image> rays = by_rays(view);
    row.to_rays = difference(*row.image, *rays);
    row.off_rays = error_by_pixel(shown, displayed_image(*rays, out_.exposure));
  }

  // The same view by rays: local light, triangles, the same samples.
  std::shared_ptr<const Image> by_rays(View view) {
    auto& image = by_rays_[view.render.shading];
    if (image) return image;
    view.render.algorithm = Algorithm::raytrace;
    view.render.max_depth = 0;
    view.render.tessellate = true;
    return image = studio_.draw(compiled_, view).image;
  }

  Difference difference(const Image& image, const Image& rays) const {
    const std::vector<uint8_t> a = to_srgb8(image, out_.exposure), b = to_srgb8(rays, out_.exposure);
    Difference out;
    int64_t differing = 0;
    double squares = 0.0;
    for (size_t i = 0; i < a.size(); i += 3) {
      int most = 0;
      for (size_t c = i; c < i + 3; ++c) {
        const int off = std::abs(a[c] - b[c]);
        most = std::max(most, off);
        squares += off * off;
      }
      differing += most > 0;
      out.most = std::max(out.most, most);
    }
    out.part = static_cast<double>(differing) / (static_cast<double>(a.size()) / 3.0);
    out.rms = std::sqrt(squares / static_cast<double>(a.size())) / 255.0;
    return out;
  }

  void look_at_work(Algorithm algorithm) {
    studio_.tell("the work of " + std::string(get_word(kAlgorithms, algorithm)), 0.9);
    View view = view_;
    view.render.algorithm = algorithm;
    const ViewPlan plan = plan_view(*compiled_, view);
    const auto drawn = drawn_scene(compiled_, plan, pool_);
    const auto method = make_method(*drawn, plan, pool_);
    if (const std::string svg = method->lines_svg(); !svg.empty()) out_.lines_svg = svg;
    CompareWork work{std::string(get_word(kAlgorithms, algorithm)), method->work()};
    for (CompareRow& row : out_.rows)
      if (row.method == work.method) row.memory_bytes = method->memory_bytes();
    if (!work.work.counts.empty()) out_.works.push_back(std::move(work));
  }

  const Studio& studio_;
  TilePool& pool_;
  const CompareOptions& options_;
  View view_;
  std::shared_ptr<const CompiledScene> compiled_;
  std::vector<Algorithm> methods_;
  std::vector<View> views_;
  std::map<Shading, std::shared_ptr<const Image>> by_rays_;
  Comparison out_;
};

}  // namespace

std::string file_stem(const CompareRow& row) {
  return row.shading.empty() ? row.method : row.method + "-" + row.shading;
}

std::optional<Comparison> compare_methods(const ParsedScene& parsed, const std::string& name, TilePool& pool,
                                          const CompareOptions& options) {
  try {
    const StudyOptions callbacks{.on_progress = options.on_progress, .is_cancelled = options.is_cancelled};
    const Studio studio(pool, callbacks);
    return Maker(parsed, name, studio, options).make();
  } catch (const Cancelled&) {
    return std::nullopt;
  }
}

}  // namespace tilelight
