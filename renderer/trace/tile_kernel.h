// SPDX-License-Identifier: Apache-2.0
// The tile kernel: a batch of pixel samples goes through the scene breadth first, level of recursion by level: closest
// hits, local light with its shadow rays, then the mirrored and refracted rays of the next level. A sample's sum is
// formed in that order, whatever the batch, so the image does not depend on tiles or threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/film/sampling.h"
#include "renderer/shade/scatter.h"
#include "renderer/trace/tile_job.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight {

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

  void run() {
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
  // What a ray carries beside its geometry.
  struct Path {
    Color weight;
    uint32_t sample;  // of the batch
    uint32_t media;   // index into media_; used by glass alone
    int depth;
    const char* kind;
  };
  struct Level {
    std::vector<BoundedRay> rays;
    std::vector<Path> paths;
    void clear() { rays.clear(), paths.clear(); }
    void push(const Ray& ray, const Path& path) { rays.push_back({ray}), paths.push_back(path); }
  };
  // What a light brings to a sample if nothing stands between.
  struct Pending {
    Color light;
    uint32_t sample;
  };

  void render_rows(int y0, int y1, uint32_t index) {
    start_batch(y0, y1, index);
    while (!level_.rays.empty()) {
      hits_.resize(level_.rays.size());
      trace_closest(scene_, level_.rays, hits_);
      next_.clear();
      shadow_rays_.clear();
      pending_.clear();
      for (size_t i = 0; i < hits_.size(); ++i) {
        if constexpr (kCan.glass) pass_unseen(level_.rays[i], level_.paths[i], hits_[i]);
        shade(level_.rays[i].ray, level_.paths[i], hits_[i]);
      }
      if constexpr (kCan.shadows) {
        find_visible(shadow_rays_);
        for (size_t i = 0; i < pending_.size(); ++i) radiance_[pending_[i].sample] += pending_[i].light * visible_[i];
      }
      std::swap(level_, next_);
    }
    finish_batch(y0, y1);
  }

  void start_batch(int y0, int y1, uint32_t index) {
    level_.clear();
    media_.clear();
    if constexpr (kCan.glass) media_.push_back(*job_.eye_media);
    const Eye& eye = plan_.eye;
    uint32_t sample = 0;
    for (int y = y0; y < y1; ++y) {
      for (int x = job_.rect.x0; x < job_.rect.x1; ++x, ++sample) {
        const SamplePoint p = sample_point(x, y, spec_.seed, index);
        const Vec3 at = eye.corner + (x + p.x) * eye.step_x + (y + p.y) * eye.step_y;
        const Ray ray = eye.projection == Projection::perspective ? Ray{eye.origin, glm::normalize(at), {}}
                                                                  : Ray{eye.origin + at, eye.forward, {}};
        level_.push(ray, {Color(1.0), sample, 0, 0, "primary"});
      }
    }
    counts_.primary += sample;
    radiance_.assign(sample, Color(0.0));
    spent_.assign(sample, 0);
    untraced_.assign(sample, 0.0);
  }

  void shade(const Ray& ray, const Path& path, const Hit& hit) {
    if (!hit.is_hit()) {
      const Color sky = background_color(scene_.background, ray.direction);
      radiance_[path.sample] += path.weight * sky;
      if constexpr (kCan.listens) listen(ray, path, hit, nullptr, sky);
      return;
    }
    const Surface surface = make_surface(scene_, ray, hit);
    const Color ambient = scene_.ambient * surface.ambient;
    radiance_[path.sample] += path.weight * ambient;
    if constexpr (kCan.listens) listen(ray, path, hit, &surface, ambient);
    light(ray, path, surface);
    if constexpr (kCan.mirrors) scatter(ray, path, surface);
  }

  void light(const Ray& ray, const Path& path, const Surface& surface) {
    for (const CompiledLight& source : scene_.lights) {
      const LightSample sample = sample_light(scene_, source, surface, -ray.direction);
      Color seen(0.0);
      if (sample.is_lit) {
        const Color arriving = path.weight * (sample.diffuse + sample.specular);
        // A surface that the light itself lies on does not hide it: the ray ends before, by the rounding of the distance.
        const BoundedRay shadow{{surface.position, sample.to_light, surface.here}, sample.distance * (1.0 - 0x1p-40)};
        seen = Color(1.0);
        if (!(kCan.shadows && source.shadow && spec_.shadows)) {
          radiance_[path.sample] += arriving;
        } else if (arriving != Color(0.0)) {
          shadow_rays_.push_back(shadow);
          pending_.push_back({arriving, path.sample});
          if constexpr (kCan.listens) seen = visible_now(shadow);
        }
      }
      if constexpr (kCan.listens) job_.listener->on_light(source, sample, seen);
    }
  }

  // visible_[i], by channel: 0 behind something opaque, else the product of kt of the transparent surfaces that
  // rays[i] crosses, unrefracted.
  void find_visible(const std::vector<BoundedRay>& rays) {
    counts_.shadow += static_cast<int64_t>(rays.size());
    visible_.assign(rays.size(), Color(1.0));
    if constexpr (kCan.glass) {
      for (size_t i = 0; i < rays.size(); ++i) follow_shadow(rays[i], visible_[i]);
    } else {
      is_blocked_.resize(rays.size());
      trace_any(scene_, rays, is_blocked_);
      for (size_t i = 0; i < rays.size(); ++i) {
        if (is_blocked_[i]) visible_[i] = Color(0.0);
      }
    }
  }

  void follow_shadow(BoundedRay shadow, Color& visible) {
    Hit hit;
    while (true) {
      trace_closest(scene_, {&shadow, 1}, {&hit, 1});
      if (!hit.is_hit()) return;
      visible *= scene_.materials[scene_.bodies[hit.body].material].source.transmission;  // 0 for what is opaque
      if (visible == Color(0.0)) return;
      shadow.ray.origin += hit.t * shadow.ray.direction;
      shadow.ray.left = {hit.body, hit.prim};
      shadow.t_max -= hit.t;
      ++counts_.shadow;
    }
  }

  Color visible_now(const BoundedRay& shadow) {
    find_visible({shadow});
    return visible_[0];
  }

  bool is_medium(uint32_t body) const {
    return scene_.bodies[body].closed && scene_.materials[scene_.bodies[body].material].is_transmissive;
  }

  // Moves on to the first surface that is there: inside a medium of higher priority a surface is passed unbent, and the ray
  // gets no deeper.
  void pass_unseen(BoundedRay& ray, Path& path, Hit& hit) {
    while (hit.is_hit() && is_medium(hit.body)) {
      const Surface surface = make_surface(scene_, ray.ray, hit);
      const Crossing crossing(scene_, media_[path.media], hit.body, surface.from_outside);
      if (crossing.is_seen) return;
      path.media = keep(crossing.after);
      ray.ray = {surface.position, ray.ray.direction, surface.here};
      trace_closest(scene_, {&ray, 1}, {&hit, 1});
    }
  }

  uint32_t keep(const MediaSet& media) {
    media_.push_back(media);
    return static_cast<uint32_t>(media_.size() - 1);
  }

  void scatter(const Ray& ray, const Path& path, const Surface& surface) {
    const CompiledMaterial& m = *surface.material;
    if (!m.is_reflective && !(kCan.glass && m.is_transmissive)) return;
    uint32_t here = path.media, beyond = path.media;
    Scatter out;
    if (!kCan.glass || !m.is_transmissive) {
      out = scatter_opaque(surface, ray.direction);
    } else if (is_medium(surface.here.body)) {
      const Crossing crossing(scene_, media_[path.media], surface.here.body, surface.from_outside);
      out = scatter_transparent(surface, ray.direction, crossing.before.ior(scene_), crossing.after.ior(scene_));
      here = keep(crossing.before), beyond = keep(crossing.after);
    } else {
      out = scatter_transparent(surface, ray.direction, 1.0, 1.0);  // thin
    }
    if (follow(path, surface, out.mirrored, out.mirror_weight, here, "reflected")) ++counts_.reflected;
    if constexpr (kCan.glass) {
      if (follow(path, surface, out.refracted, out.refract_weight, beyond, "refracted")) ++counts_.refracted;
    }
  }

  static double largest(const Color& c) { return std::max({c.r, c.g, c.b}); }

  // Queues a ray of the next level, if depth, weight and budget allow it.
  bool follow(const Path& path, const Surface& surface, const Vec3& direction, const Color& factor, uint32_t media,
              const char* kind) {
    const Color weight = path.weight * factor;
    if (!(largest(weight) > 0.0)) return false;
    if (path.depth >= spec_.max_depth || largest(weight) < spec_.weight_cutoff ||
        spent_[path.sample] >= spec_.ray_budget) {
      untraced_[path.sample] += largest(weight);
      return false;
    }
    ++spent_[path.sample];
    next_.push({surface.position, direction, surface.here}, {weight, path.sample, media, path.depth + 1, kind});
    return true;
  }

  void listen(const Ray& ray, const Path& path, const Hit& hit, const Surface* surface, const Color& local) {
    job_.listener->on_ray({path.depth, path.kind, ray, path.weight, hit, surface, local});
  }

  void finish_batch(int y0, int y1) {
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
  Level level_, next_;
  std::vector<Hit> hits_;
  std::vector<BoundedRay> shadow_rays_;
  std::vector<Pending> pending_;    // what each shadow ray decides
  std::vector<Color> visible_;      // the answers
  std::vector<uint8_t> is_blocked_;
  std::vector<MediaSet> media_;
  std::vector<Color> radiance_;     // by sample of the batch
  std::vector<int> spent_;          // rays after the primary one
  std::vector<double> untraced_;
};

}  // namespace tilelight
