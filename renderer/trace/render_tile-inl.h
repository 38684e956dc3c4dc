// SPDX-License-Identifier: Apache-2.0
// The tile kernel: a batch of pixel samples goes through the scene breadth first, level of recursion by level: closest
// hits, local light with its shadow rays, then the mirrored and refracted rays of the next level. A sample's sum is
// formed in that order, whatever the batch, so the image does not depend on tiles or threads.
#if defined(TILELIGHT_TRACE_RENDER_TILE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TILELIGHT_TRACE_RENDER_TILE_INL_H_
#undef TILELIGHT_TRACE_RENDER_TILE_INL_H_
#else
#define TILELIGHT_TRACE_RENDER_TILE_INL_H_
#endif

#include <algorithm>
#include <vector>

#include "renderer/film/sampling.h"
#include "renderer/shade/scatter.h"
#include "renderer/trace/tile_job.h"
#include "renderer/trace/traverse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

// What a kernel variant is able to do; the rest is not compiled into it.
struct Abilities {
  bool mirrors = false;   // secondary rays at all
  bool glass = false;     // transmission, media, tinted shadows
  bool shadows = false;
  bool listens = false;   // explanations
};

template <Abilities kCan>
class TileKernel {
 public:
  explicit TileKernel(const TileJob& job)
      : job_(job), scene_(*job.scene), plan_(*job.plan), spec_(job.plan->view.render), counts_(*job.counts) {}

  HWY_INLINE void run() {
    constexpr int kBatchPixels = 256;  // about 60 KiB of rays and hits: inside L2, and long enough to be coherent
    const int rows = std::max(1, kBatchPixels / std::max(1, job_.rect.width()));
    for (uint32_t s = 0; s < job_.sample_count; ++s) {
      for (int y = job_.rect.y0; y < job_.rect.y1; y += rows) {
        if (job_.cancelled && job_.cancelled->load(std::memory_order_relaxed)) return;
        render_rows(y, std::min(y + rows, job_.rect.y1), job_.first_sample + s);
      }
    }
    counts_.is_complete = true;
  }

 private:
  struct PathRay {
    Ray ray;
    Color weight;
    uint32_t sample;  // of the batch
    uint32_t media;   // index into media_; used by glass alone
    int depth;
    const char* kind;
  };
  struct ShadowRay {
    Ray ray;
    double distance;
    Color light;      // what arrives if nothing stands between
    uint32_t sample;
  };

  HWY_INLINE void render_rows(int y0, int y1, uint32_t index) {
    start_batch(y0, y1, index);
    while (!level_.empty()) {
      hits_.resize(level_.size());
      for (size_t i = 0; i < level_.size(); ++i) {
        hits_[i] = trace_closest(scene_, level_[i].ray, std::numeric_limits<double>::infinity());
      }
      next_.clear();
      shadow_rays_.clear();
      for (size_t i = 0; i < level_.size(); ++i) shade(level_[i], hits_[i]);
      if constexpr (kCan.shadows) trace_shadows();
      std::swap(level_, next_);
    }
    finish_batch(y0, y1);
  }

  HWY_INLINE void start_batch(int y0, int y1, uint32_t index) {
    level_.clear();
    media_.clear();
    if constexpr (kCan.glass) media_.push_back(*job_.eye_media);
    const Eye& eye = plan_.eye;
    uint32_t sample = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = job_.rect.x0; x < job_.rect.x1; ++x, ++sample) {
        const SamplePoint p = sample_point(x, y, spec_.seed, index);
        const Vec3 at = eye.corner + (x + p.x) * eye.step_x + (y + p.y) * eye.step_y;
        PathRay path{{}, Color(1.0), sample, 0, 0, "primary"};
        if (eye.projection == Projection::perspective) {
          path.ray.origin = eye.origin;
          path.ray.direction = glm::normalize(at);
        } else {
          path.ray.origin = eye.origin + at;
          path.ray.direction = eye.forward;
        }
        level_.push_back(path);
      }
    }
    counts_.primary += sample;
    radiance_.assign(sample, Color(0.0));
    spent_.assign(sample, 0);
    untraced_.assign(sample, 0.0);
  }

  HWY_INLINE void shade(const PathRay& path, const Hit& hit) {
    if (!hit.is_hit()) {
      const Color sky = background_color(scene_.background, path.ray.direction);
      radiance_[path.sample] += path.weight * sky;
      if constexpr (kCan.listens) listen(path, hit, nullptr, sky);
      return;
    }
    const Surface surface = make_surface(scene_, path.ray, hit);
    if constexpr (kCan.glass) {
      if (surface.material->is_transmissive && surface.body->closed && pass_unseen(path, surface)) return;
    }
    const Color ambient = scene_.ambient * surface.ambient;
    radiance_[path.sample] += path.weight * ambient;
    if constexpr (kCan.listens) listen(path, hit, &surface, ambient);
    light(path, surface);
    if constexpr (kCan.mirrors) scatter(path, surface);
  }

  HWY_INLINE void light(const PathRay& path, const Surface& surface) {
    for (const CompiledLight& source : scene_.lights) {
      const LightSample sample = sample_light(scene_, source, surface, -path.ray.direction);
      if (!sample.is_lit) {
        if constexpr (kCan.listens) job_.listener->on_light(source, sample, Color(0.0));
        continue;
      }
      const Color light = path.weight * (sample.diffuse + sample.specular);
      const bool casts = kCan.shadows && source.shadow && spec_.shadows;
      if (casts && light != Color(0.0)) {
        ShadowRay shadow{{surface.position, sample.to_light, surface.here}, sample.distance, light, path.sample};
        if constexpr (kCan.listens) job_.listener->on_light(source, sample, visibility(shadow));
        shadow_rays_.push_back(shadow);
      } else {
        if constexpr (kCan.listens) job_.listener->on_light(source, sample, Color(1.0));
        radiance_[path.sample] += light;
      }
    }
  }

  // By channel: 0 behind something opaque, else the product of kt of the transparent surfaces between, unrefracted.
  HWY_INLINE Color visibility(const ShadowRay& shadow) {
    // A surface the light lies on does not hide it: the end is left out by the rounding of the distance.
    const double end = shadow.distance * (1.0 - 0x1p-40);
    ++counts_.shadow;
    if constexpr (!kCan.glass) {
      return trace_any(scene_, shadow.ray, end) ? Color(0.0) : Color(1.0);
    } else {
      Color through(1.0);
      Ray ray = shadow.ray;
      double left = end;
      while (true) {
        const Hit hit = trace_closest(scene_, ray, left);
        if (!hit.is_hit()) return through;
        const CompiledMaterial& m = scene_.materials[scene_.bodies[hit.body].material];
        if (!m.is_transmissive) return Color(0.0);
        through *= m.source.transmission;
        if (through == Color(0.0)) return through;
        ray.origin += hit.t * ray.direction;
        ray.left = {hit.body, hit.prim};
        left -= hit.t;
        ++counts_.shadow;
      }
    }
  }

  HWY_INLINE void trace_shadows() {
    for (const ShadowRay& shadow : shadow_rays_) radiance_[shadow.sample] += shadow.light * visibility(shadow);
  }

  // A surface with the same medium on both sides is not there: the ray goes on, no deeper than before.
  HWY_INLINE bool pass_unseen(const PathRay& path, const Surface& surface) {
    MediaSet after = media_[path.media];
    const uint32_t before_top = after.top(scene_);
    if (surface.from_outside) {
      after.enter(surface.here.body);
    } else {
      after.leave(surface.here.body);
    }
    if (after.top(scene_) != before_top) return false;
    if (!spend(path.sample, path.weight)) return true;
    PathRay on = path;
    on.ray.origin = surface.position;
    on.ray.left = surface.here;
    on.media = static_cast<uint32_t>(media_.size());
    media_.push_back(after);
    next_.push_back(on);
    ++counts_.refracted;
    return true;
  }

  HWY_INLINE void scatter(const PathRay& path, const Surface& surface) {
    const CompiledMaterial& m = *surface.material;
    if (!m.is_reflective && !(kCan.glass && m.is_transmissive)) return;
    Scatter out;
    uint32_t media_after = path.media;
    if constexpr (kCan.glass) {
      if (m.is_transmissive && surface.body->closed) {
        MediaSet after = media_[path.media];
        const double ior_before = after.ior(scene_);
        if (surface.from_outside) {
          after.enter(surface.here.body);
        } else {
          after.leave(surface.here.body);
        }
        out = scatter_transparent(surface, path.ray.direction, ior_before, after.ior(scene_));
        if (is_followed(path, out.refract_weight)) {
          media_after = static_cast<uint32_t>(media_.size());
          media_.push_back(after);
        }
      } else if (m.is_transmissive) {
        out = scatter_transparent(surface, path.ray.direction, 1.0, 1.0);  // thin
      } else {
        out = scatter_opaque(surface, path.ray.direction);
      }
    } else {
      out = scatter_opaque(surface, path.ray.direction);
    }
    if (follow(path, surface, out.mirrored, out.mirror_weight, path.media, "reflected")) ++counts_.reflected;
    if constexpr (kCan.glass) {
      if (follow(path, surface, out.refracted, out.refract_weight, media_after, "refracted")) ++counts_.refracted;
    }
  }

  static double largest(const Color& c) { return std::max({c.r, c.g, c.b}); }

  HWY_INLINE bool is_followed(const PathRay& path, const Color& factor) const {
    return path.depth < spec_.max_depth && largest(path.weight * factor) >= spec_.weight_cutoff;
  }

  HWY_INLINE bool spend(uint32_t sample, const Color& weight) {
    if (spent_[sample] < spec_.ray_budget) {
      ++spent_[sample];
      return true;
    }
    untraced_[sample] += largest(weight);
    return false;
  }

  HWY_INLINE bool follow(const PathRay& path, const Surface& surface, const Vec3& direction, const Color& factor,
                         uint32_t media, const char* kind) {
    const Color weight = path.weight * factor;
    if (!(largest(weight) > 0.0)) return false;
    if (!is_followed(path, factor)) {
      untraced_[path.sample] += largest(weight);
      return false;
    }
    if (!spend(path.sample, weight)) return false;
    next_.push_back({{surface.position, direction, surface.here}, weight, path.sample, media, path.depth + 1, kind});
    return true;
  }

  HWY_INLINE void listen(const PathRay& path, const Hit& hit, const Surface* surface, const Color& local) {
    job_.listener->on_ray({path.depth, path.kind, path.ray, path.weight, hit, surface, local});
  }

  HWY_INLINE void finish_batch(int y0, int y1) {
    size_t sample = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = job_.rect.x0; x < job_.rect.x1; ++x, ++sample) {
        const Color& c = radiance_[sample];
        const bool is_finite = std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b);
        counts_.nonfinite += !is_finite;
        counts_.untraced_weight = std::max(counts_.untraced_weight, untraced_[sample]);
        if (!job_.film) continue;
        job_.film->add(x, y, is_finite ? static_cast<float>(c.r) : 0.0f, is_finite ? static_cast<float>(c.g) : 0.0f,
                       is_finite ? static_cast<float>(c.b) : 0.0f);
      }
    }
  }

  const TileJob& job_;
  const CompiledScene& scene_;
  const ViewPlan& plan_;
  const RenderSpec& spec_;
  TileCounts& counts_;
  std::vector<PathRay> level_, next_;
  std::vector<Hit> hits_;
  std::vector<ShadowRay> shadow_rays_;
  std::vector<MediaSet> media_;
  std::vector<Color> radiance_;     // by sample of the batch
  std::vector<int> spent_;          // rays after the primary one
  std::vector<double> untraced_;
};

template <Abilities kCan>
HWY_INLINE void render_tile(const TileJob& job) {
  TileKernel<kCan>(job).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#endif
