// SPDX-License-Identifier: Apache-2.0
// The tile kernel: a batch of pixel samples goes through the scene breadth first, level of recursion by level: closest
// hits, local light with its shadow rays, then the mirrored and refracted rays of the next level. A level that grows
// too long is cut between samples, and each part goes to its end before the next, so that memory and the answer to a
// cancel stay bounded. A sample's sum is formed in its own order, whatever the batch, so the image does not depend on
// tiles or threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <deque>
#include <span>
#include <vector>

#include "renderer/compile/built_in.h"
#include "renderer/shade/face_light.h"
#include "renderer/shade/media.h"
#include "renderer/shade/scatter.h"
#include "renderer/shade/surfaces.h"
#include "renderer/shade/terminator.h"
#include "renderer/trace/eye_rays.h"
#include "renderer/trace/intersect.h"
#include "renderer/trace/pixel_filter.h"
#include "renderer/trace/place.h"
#include "renderer/trace/tile_job.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight {

// What a kernel variant is able to do; the rest is not compiled into it.
struct Abilities {
  bool mirrors = false;  // secondary rays at all
  bool glass = false;    // transmission, media, tinted shadows
  bool shadows = false;
  bool listens = false;  // explanations
};

template <Abilities kCan>
class TileKernel {
 public:
  explicit TileKernel(const TileJob& job)
      : job_(job),
        scene_(*job.scene),
        plan_(*job.plan),
        spec_(job.plan->view.render),
        counts_(*job.counts),
        face_light_(*job.scene, job.plan->view.render.shading, job.plan->view.render.terminator == Terminator::smooth),
        media_(*job.scene),
        crosser_(*job.scene, media_) {
    const Eye& eye = plan_.eye;
    viewer_ = eye.projection == Projection::orthographic ? Vec4(-eye.forward, 0.0) : Vec4(eye.origin, 1.0);
  }

  void run() {
    constexpr int64_t kBatchPixels = 256;  // about 60 KiB of rays and hits: inside L2, and long enough to be coherent
    uint32_t most = 0;
    for (const CellWork& cell : job_.cells) most = std::max(most, cell.count);
    int64_t pixels = 0;
    for (uint32_t s = 0; s < most; ++s) {
      for (const CellWork& cell : job_.cells) {
        if (s >= cell.count) continue;
        if (pixels > 0 && pixels + cell.rect.pixel_count() > kBatchPixels) {
          if (is_cancelled()) return;
          render_batch();
          pixels = 0;
        }
        batch_.push_back({cell.rect, cell.first + s});
        pixels += cell.rect.pixel_count();
      }
    }
    if (is_cancelled()) return;
    render_batch();
    counts_.is_complete = !is_cancelled();
  }

 private:
  // One sample of every pixel of a cell.
  struct CellSample {
    TileRect rect;
    uint32_t index;
  };
  // What a ray carries beside its geometry.
  struct Path {
    Color weight;
    uint32_t sample;       // of the batch
    MediaSets::Set media;  // used by glass alone
    int depth;
    const char* kind;
  };
  struct Level {
    std::vector<BoundedRay> rays;
    std::vector<Path> paths;
    void clear() { rays.clear(), paths.clear(); }
    // Written where they stay: copies of what was just written would wait for it.
    void push(const Vec3& origin, const Vec3& direction, const Departure& left, Coincident coincident,
              const Color& weight, uint32_t sample, MediaSets::Set media, int depth, const char* kind) {
      Ray& ray = rays.emplace_back().ray;
      ray.origin = origin, ray.direction = direction;
      ray.left = left, ray.coincident = coincident;
      Path& path = paths.emplace_back();
      path.weight = weight, path.sample = sample, path.media = media, path.depth = depth, path.kind = kind;
    }
  };
  // What a light brings to a hit if nothing stands between.
  struct Pending {
    Color light;
    uint32_t hit;
  };
  // Shadow rays to one light, in the order of the hits: neighbours go nearly the same way.
  struct Beam {
    std::vector<BoundedRay> rays;
    std::vector<uint32_t> pending;  // whose each ray is
  };

  bool is_cancelled() const { return job_.cancelled && job_.cancelled->load(std::memory_order_relaxed); }

  void render_batch() {
    start_batch();
    follow_levels(0);
    finish_batch();
    batch_.clear();
  }

  // Takes the rays of levels_[depth] and all their descendants to the end. Rays of one sample are neighbours.
  void follow_levels(size_t depth) {
    constexpr size_t kPartRays = 256;  // what is known of their hits stays inside L2
    const size_t count = levels_[depth].rays.size();
    for (size_t first = 0, last = 0; first < count && !is_cancelled(); first = last) {
      last = end_of_part(levels_[depth], first, kPartRays);
      if (levels_.size() == depth + 1) levels_.emplace_back();
      levels_[depth + 1].clear();
      const size_t media_before = media_.size();
      trace_part(levels_[depth], first, last, levels_[depth + 1]);
      if (!levels_[depth + 1].rays.empty()) follow_levels(depth + 1);
      media_.shrink(media_before);
    }
  }

  // Where the part from `first` on ends: after the last whole sample that fits, but after one sample at least.
  static size_t end_of_part(const Level& level, size_t first, size_t size) {
    const size_t count = level.paths.size();
    if (count - first <= size) return count;
    const auto is_cut = [&](size_t i) { return level.paths[i - 1].sample != level.paths[i].sample; };
    size_t end = first + size;
    while (end > first && !is_cut(end)) --end;
    if (end > first) return end;
    for (end = first + size; end < count && !is_cut(end);) ++end;
    return end;
  }

  void trace_part(Level& level, size_t first, size_t last, Level& next) {
    const std::span<BoundedRay> rays = std::span(level.rays).subspan(first, last - first);
    const std::span<Path> paths = std::span(level.paths).subspan(first, last - first);
    find_hits(level, rays, first);
    if constexpr (kCan.glass) {
      crossings_.resize(rays.size());
      for (size_t i = 0; i < rays.size(); ++i) pass_unseen(rays[i], paths[i], hits_[i], crossings_[i]);
    }
    const SurfaceOptions options = {.shading = spec_.shading,
                                    .smooth_terminator = spec_.terminator == Terminator::smooth,
                                    .casts_shadows = kCan.shadows,
                                    .viewer = job_.first_hits ? &viewer_ : nullptr};
    make_surfaces(scene_, rays, hits_, options, surfaces_);
    for (size_t i = 0; i < rays.size(); ++i) radiance_[paths[i].sample] += paths[i].weight * own_light(i);
    if constexpr (kCan.listens) seen_.assign(scene_.lights.size() * rays.size(), Color(1.0));
    for (size_t l = 0; l < scene_.lights.size(); ++l) add_light(l, rays, paths);
    if constexpr (kCan.listens) tell(rays, paths);
    if constexpr (kCan.mirrors) {
      mirror_surfaces(surfaces_, rays.size(), mirrored_);
      next_ = &next;
      for (size_t i = 0; i < rays.size(); ++i) scatter(rays[i].ray, paths[i], i);
    }
  }

  // Fills hits_. Those of primary rays may be known already.
  void find_hits(const Level& level, std::span<const BoundedRay> rays, size_t first) {
    if (job_.first_hits && &level == &levels_[0]) {
      hits_.assign(first_hits_.begin() + static_cast<std::ptrdiff_t>(first),
                   first_hits_.begin() + static_cast<std::ptrdiff_t>(first + rays.size()));
      return;
    }
    hits_.resize(rays.size());
    trace_closest(scene_, rays, hits_);
  }

  // visit(x, y, index) for every pixel sample of the batch. Neighbours are walked as packets.
  template <class Visit>
  void for_each_sample(const Visit& visit) const {
    for (const CellSample& cell : batch_) for_each_pixel(cell.rect, [&](int x, int y) { visit(x, y, cell.index); });
  }

  void start_batch() {
    if (levels_.empty()) levels_.emplace_back();
    enter_eye_media();
    place_samples();
    const size_t count = points_.size();
    start_paths(count);
    aim_eye_rays(plan_.eye, points_, levels_[0].rays);
    if (job_.first_hits) find_first_hits();
    if constexpr (kCan.glass) {
      for (size_t i = 0; i < count; ++i) levels_[0].paths[i].media = media_at(levels_[0].rays[i].ray.origin);
    }
    counts_.primary += static_cast<int64_t>(count);
    radiance_.assign(count, Color(0.0));
    spent_.assign(count, 0);
    untraced_.assign(count, 0.0);
  }

  void place_samples() {
    points_.clear();
    for (const CellSample& cell : batch_) {
      if (!job_.first_hits) {
        place_cell(spec_, cell.rect, cell.index, points_);
        continue;
      }
      for_each_pixel(cell.rect, [&](int x, int y) {
        const SamplePoint p = job_.first_hits->place(x, y, cell.index);
        points_.x.push_back(x + p.x), points_.y.push_back(y + p.y);
      });
    }
  }

  // Primary rays and paths as they start. Only glass ever changes them; without it those of the last batch are good.
  void start_paths(size_t count) {
    Level& primary = levels_[0];
    if constexpr (kCan.glass) primary.clear();
    const size_t known = primary.paths.size();
    primary.rays.resize(count);
    primary.paths.resize(count);
    for (size_t i = known; i < count; ++i) {
      Path& path = primary.paths[i];
      path.weight = Color(1.0), path.sample = static_cast<uint32_t>(i), path.media = MediaSets::kOpenAir;
      path.depth = 0, path.kind = "primary";
    }
  }

  void find_first_hits() {
    first_hits_.clear();
    for_each_sample([&](int x, int y, uint32_t index) {
      first_hits_.push_back(job_.first_hits->at(x, y, index, levels_[0].rays[first_hits_.size()].ray));
    });
  }

  void enter_eye_media() {
    media_.shrink(0);
    if constexpr (kCan.glass) {
      eye_media_ = media_.of(job_.eye_media->around_all());
      TileRect pixels = batch_.empty() ? TileRect{} : batch_[0].rect;
      for (const CellSample& cell : batch_) {
        pixels = {std::min(pixels.x0, cell.rect.x0), std::min(pixels.y0, cell.rect.y0),
                  std::max(pixels.x1, cell.rect.x1), std::max(pixels.y1, cell.rect.y1)};
      }
      constexpr int kReach = kFilterReachPx;
      some_media_ =
          job_.eye_media->some_near({pixels.x0 - kReach, pixels.y0 - kReach, pixels.x1 + kReach, pixels.y1 + kReach});
    }
  }

  // The media in which a primary ray starts.
  MediaSets::Set media_at(const Vec3& start) {
    if constexpr (kCan.glass) {
      if (!some_media_.empty()) return media_.of(job_.eye_media->around(start, some_media_));
    }
    return eye_media_;
  }

  // The sky, or what a surface has of the ambient light.
  Color own_light(size_t i) const {
    if (!hits_[i].is_hit()) return background_color(scene_.background, surfaces_.direction[i]);
    return scene_.ambient * surfaces_.ambient[i];
  }

  // Adds what one light brings to the hits, where nothing stands between.
  void add_light(size_t l, std::span<const BoundedRay> rays, std::span<const Path> paths) {
    const CompiledLight& source = scene_.lights[l];
    const bool casts_shadow = kCan.shadows && source.shadow && spec_.shadows;
    light_surfaces(scene_, source, surfaces_, rays.size(), casts_shadow, lit_);
    if (spec_.shading != Shading::phong) light_by_face(l, rays, paths);
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!hits_[i].is_hit()) continue;
      counts_.lights_on_hits += lit_.is_at_light[i];
      const Color light = paths[i].weight * lit_.light[i];
      if (light == Color(0.0)) continue;
      if (casts_shadow) {
        aim(beam_.rays.emplace_back(), i);
        beam_.pending.push_back(static_cast<uint32_t>(pending_.size()));
        Pending& pending = pending_.emplace_back();
        pending.light = light, pending.hit = static_cast<uint32_t>(i);
      } else {
        radiance_[paths[i].sample] += light;
      }
    }
    if constexpr (kCan.shadows) {
      visible_.assign(pending_.size(), Color(1.0));
      follow_beam();
      if (casts_shadow) light_over_curves(source);
      for (size_t p = 0; p < pending_.size(); ++p) {
        radiance_[paths[pending_[p].hit].sample] += pending_[p].light * visible_[p];
        if constexpr (kCan.listens) seen_[l * rays.size() + pending_[p].hit] = visible_[p];
      }
      pending_.clear();
    }
  }

  // Flat and Gouraud shading: a face's own light in place of its points'.
  void light_by_face(size_t l, std::span<const BoundedRay> rays, std::span<const Path> paths) {
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!is_by_face(hits_[i])) continue;
      const LightSample sample = face_light_.sample(hits_[i], surface_of(scene_, surfaces_, hits_[i], i),
                                                    viewer_of(rays[i].ray, paths[i]), paths[i].depth == 0, l);
      lit_.light.set(i, sample.is_lit ? sample.diffuse + sample.specular : Color(0.0));
    }
  }
  bool is_by_face(const Hit& hit) const {
    return spec_.shading != Shading::phong && hit.is_hit() && scene_.bodies[hit.body].kind != BodyKind::plane;
  }

  // Who looks along a ray.
  Vec4 viewer_of(const Ray& ray, const Path& path) const { return path.depth > 0 ? Vec4(ray.origin, 1.0) : viewer_; }

  // A shadow ray to the light in lit_, written where it stays: a copy of what was just written would wait for it. A
  // surface that the light itself lies on does not hide it: the ray ends before, by the rounding of the distance.
  void aim(BoundedRay& shadow, size_t i) const {
    if (lit_.is_from_curve[i]) {  // in free space
      shadow.ray.origin = surfaces_.curve[i], shadow.ray.left = {}, shadow.ray.coincident = Coincident::none;
    } else {
      shadow.ray.origin = surfaces_.position[i];
      shadow.ray.left = {hits_[i].body, hits_[i].prim}, shadow.ray.coincident = Coincident::before;
    }
    shadow.ray.direction = lit_.to_light[i];
    shadow.t_max = lit_.distance[i] * (1.0 - 0x1p-40);
  }

  // What light gains and loses by coming over the curved surface that facets stand for; see terminator.h.
  void light_over_curves(const CompiledLight& light) {
    if (!is_built_in(Feature::smooth_normals) || spec_.terminator != Terminator::smooth) return;
    cross_own_facets();
    pass_facets(light);
    follow_beam();
    go_down_to_facets();
    follow_beam();
  }

  // Light that comes straight from behind a facet has to come through it, and a ray that starts there does not meet it.
  void cross_own_facets() {
    for (size_t p = 0; p < pending_.size(); ++p) {
      const uint32_t i = pending_[p].hit;
      if (!surfaces_.is_lit_over_curve[i] || lit_.is_from_curve[i]) continue;
      if (glm::dot(surfaces_.geometric_normal[i], lit_.to_light[i]) > 0.0) continue;
      const CompiledMaterial& own = scene_.materials[scene_.bodies[hits_[i].body].material];
      visible_[p] *= kCan.glass ? own.source.transmission : Color(0.0);
    }
  }

  // Sends light over the curve that nothing but facets of the curve itself hides.
  void pass_facets(const CompiledLight& light) {
    for (size_t p = 0; p < pending_.size(); ++p) {
      const size_t i = pending_[p].hit;
      if (!surfaces_.is_lit_over_curve[i] || lit_.is_from_curve[i] || visible_[p] == Color(1.0)) continue;
      const double reach =
          reach_of_facets(scene_, {hits_[i].body, hits_[i].prim}, surfaces_.geometric_normal[i], lit_.to_light[i]);
      if (reach == 0.0 || !(lift_at(i) > kLeastLift)) continue;
      BoundedRay& shadow = beam_.rays.emplace_back();
      aim(shadow, i);
      shadow.t_max = std::min(shadow.t_max, reach);
      beam_.pending.push_back(static_cast<uint32_t>(p));
    }
    if (beam_.rays.empty()) return;
    counts_.shadow += static_cast<int64_t>(beam_.rays.size());
    beam_hits_.resize(beam_.rays.size());
    trace_closest(scene_, beam_.rays, beam_hits_);
    size_t kept = 0;
    for (size_t k = 0; k < beam_.rays.size(); ++k) {
      const uint32_t p = beam_.pending[k], i = pending_[p].hit;
      if (!is_lit_from_behind(scene_, beam_.rays[k].ray, surfaces_.geometric_normal[i], beam_hits_[k])) continue;
      const LightWay way = way_to_light(light, surfaces_.curve[i]);
      if (!(way.distance > 0.0)) continue;
      lit_.is_from_curve[i] = 1, lit_.distance[i] = way.distance, lit_.to_light.set(i, way.to_light);
      visible_[p] = Color(1.0);
      aim(beam_.rays[kept], i);
      beam_.pending[kept++] = p;
    }
    beam_.rays.resize(kept);
    beam_.pending.resize(kept);
  }

  double lift_at(size_t i) const { return glm::length(surfaces_.curve[i] - surfaces_.position[i]); }

  // The rest of the way of light that comes over the curve.
  void go_down_to_facets() {
    for (size_t p = 0; p < pending_.size(); ++p) {
      const size_t i = pending_[p].hit;
      if (!lit_.is_from_curve[i] || visible_[p] == Color(0.0)) continue;
      const double height = lift_at(i);
      const Vec3 up = (surfaces_.curve[i] - surfaces_.position[i]) / height;
      beam_.rays.push_back(
          {{surfaces_.position[i], up, {hits_[i].body, hits_[i].prim}, Coincident::before}, height * (1.0 + 0x1p-40)});
      beam_.pending.push_back(static_cast<uint32_t>(p));
    }
  }

  // Sets visible_ of what the beam decides, by channel: 0 behind something opaque, else the product of kt of the
  // transparent surfaces that the ray crosses, unrefracted. Empties the beam.
  void follow_beam() {
    counts_.shadow += static_cast<int64_t>(beam_.rays.size());
    if constexpr (kCan.glass) {
      while (!beam_.rays.empty() && !is_cancelled()) {
        beam_hits_.resize(beam_.rays.size());
        trace_closest(scene_, beam_.rays, beam_hits_);
        size_t kept = 0;
        for (size_t i = 0; i < beam_.rays.size(); ++i) {
          if (!goes_on(beam_.rays[i], beam_hits_[i], visible_[beam_.pending[i]])) continue;
          beam_.rays[kept] = beam_.rays[i];
          beam_.pending[kept++] = beam_.pending[i];
        }
        beam_.rays.resize(kept);
        beam_.pending.resize(kept);
        counts_.shadow += static_cast<int64_t>(kept);
      }
    } else {
      is_blocked_.resize(beam_.rays.size());
      trace_any(scene_, beam_.rays, is_blocked_);
      for (size_t i = 0; i < beam_.rays.size(); ++i) {
        if (is_blocked_[i]) visible_[beam_.pending[i]] = Color(0.0);
      }
    }
    beam_.rays.clear();
    beam_.pending.clear();
  }

  // Takes a shadow ray across the surface that it has met; false: no light is left, or nothing is met.
  bool goes_on(BoundedRay& shadow, const Hit& hit, Color& visible) {
    if (!hit.is_hit()) return false;
    const bool is_at_medium = is_medium(scene_, hit.body);
    visible *= is_at_medium ? crosser_.tint(shadow.ray, hit)  // 0 for what is opaque
                            : scene_.materials[scene_.bodies[hit.body].material].source.transmission;
    if (visible == Color(0.0)) return false;
    const Coincident onward = is_at_medium ? Coincident::none : ways_from_film(shadow.ray, hit).onward;
    shadow.ray.origin += hit.t * shadow.ray.direction;
    shadow.ray.left = {hit.body, hit.prim};
    shadow.ray.coincident = onward;
    shadow.t_max -= hit.t;
    return true;
  }

  // A ray that is on its way back through the films of the place where it starts meets them the other way round.
  struct Ways {
    Coincident onward, back;
  };
  Ways ways_from_film(const Ray& ray, const Hit& hit) const {
    if (ray.coincident == Coincident::before && lies_at_start(scene_, ray, hit))
      return {Coincident::before, Coincident::after};
    return {Coincident::after, Coincident::before};
  }

  // Moves on to the first surface that is there: inside a medium of higher priority a surface is passed unbent, and the
  // ray gets no deeper.
  void pass_unseen(BoundedRay& ray, Path& path, Hit& hit, Crossing& crossing) {
    crossing = {};
    while (hit.is_hit() && is_medium(scene_, hit.body) && !is_cancelled()) {
      crossing = crosser_.cross(ray.ray, path.media, hit);
      if (crossing.is_seen() || !is_medium(scene_, hit.body)) return;
      const Surface surface = make_surface(scene_, ray.ray, hit);
      path.media = crossing.after;
      ray.ray = {surface.position, ray.ray.direction, surface.here, Coincident::none};
      trace_closest(scene_, {&ray, 1}, {&hit, 1});
    }
  }

  void scatter(const Ray& ray, const Path& path, size_t i) {
    if (!hits_[i].is_hit()) return;
    const CompiledMaterial& m = scene_.materials[scene_.bodies[hits_[i].body].material];
    if (!m.is_reflective && !(kCan.glass && m.is_transmissive)) return;
    MediaSets::Set here = path.media, beyond = path.media;
    Ways ways{Coincident::none, Coincident::before};
    Scatter out;
    if (!kCan.glass || !m.is_transmissive) {
      out.mirrored = mirrored_[i], out.mirror_weight = m.source.reflection;
    } else if (const Surface surface = surface_of(scene_, surfaces_, hits_[i], i); is_medium(scene_, hits_[i].body)) {
      here = crossings_[i].before, beyond = crossings_[i].after;
      out = scatter_transparent(surface, ray.direction, media_.ior(here), media_.ior(beyond),
                                spec_.shading != Shading::flat);
    } else {
      out = scatter_thin(surface, ray.direction);
      ways = ways_from_film(ray, hits_[i]);
    }
    if (follow(path, i, out.mirrored, out.mirror_weight, here, ways.back, "reflected")) ++counts_.reflected;
    if constexpr (kCan.glass) {
      if (follow(path, i, out.refracted, out.refract_weight, beyond, ways.onward, "refracted")) ++counts_.refracted;
    }
  }

  static double largest(const Color& c) { return std::max({c.r, c.g, c.b}); }

  // Queues a ray of the next level, if depth, weight and budget allow it.
  bool follow(const Path& path, size_t i, const Vec3& direction, const Color& factor, MediaSets::Set media,
              Coincident coincident, const char* kind) {
    const Color weight = path.weight * factor;
    if (!(largest(weight) > 0.0)) return false;
    if (path.depth >= spec_.max_depth || largest(weight) < spec_.weight_cutoff ||
        spent_[path.sample] >= spec_.ray_budget) {
      untraced_[path.sample] += largest(weight);
      return false;
    }
    ++spent_[path.sample];
    next_->push(surfaces_.position[i], direction, {hits_[i].body, hits_[i].prim}, coincident, weight, path.sample,
                media, path.depth + 1, kind);
    return true;
  }

  // Tells the listener of every ray and of what each light brings to its end.
  void tell(std::span<const BoundedRay> rays, std::span<const Path> paths) {
    for (size_t i = 0; i < rays.size(); ++i) {
      const Ray& ray = rays[i].ray;
      const Path& path = paths[i];
      const bool is_hit = hits_[i].is_hit();
      const Surface surface = is_hit ? surface_of(scene_, surfaces_, hits_[i], i) : Surface{};
      job_.listener->on_ray(
          {path.depth, path.kind, ray, path.weight, hits_[i], is_hit ? &surface : nullptr, own_light(i)});
      if (!is_hit) continue;
      for (size_t l = 0; l < scene_.lights.size(); ++l) {
        const CompiledLight& light = scene_.lights[l];
        const LightSample sample =
            is_by_face(hits_[i]) ? face_light_.sample(hits_[i], surface, viewer_of(ray, path), path.depth == 0, l)
                                 : sample_light(scene_, light, surface, -ray.direction, surfaces_.is_lit_over_curve[i]);
        job_.listener->on_light(light, sample, sample.is_lit ? seen_[l * rays.size() + i] : Color(0.0));
      }
    }
  }

  void finish_batch() {
    const size_t count = radiance_.size();
    finished_.resize(3 * count);
    for (size_t i = 0; i < count; ++i) {
      const Color& c = radiance_[i];
      // More than this no sum of samples in float can hold.
      constexpr double kMost = 1e34;
      const bool is_finite = std::abs(c.r) < kMost && std::abs(c.g) < kMost && std::abs(c.b) < kMost;
      counts_.nonfinite += !is_finite;
      counts_.untraced_weight = std::max(counts_.untraced_weight, untraced_[i]);
      const Color kept = is_finite ? c : Color(0.0);
      for (int channel = 0; channel < 3; ++channel)
        finished_[3 * i + static_cast<size_t>(channel)] = static_cast<float>(kept[channel]);
    }
    if (!job_.film) return;
    const float* from = finished_.data();
    for (const CellSample& cell : batch_) {
      const int width = cell.rect.width();
      for (int y = cell.rect.y0; y < cell.rect.y1; ++y, from += 3 * width)
        job_.film->add(cell.rect.x0, y, width, cell.index, from);
    }
  }

  const TileJob& job_;
  std::vector<CellSample> batch_;
  const CompiledScene& scene_;
  const ViewPlan& plan_;
  const RenderSpec& spec_;
  TileCounts& counts_;
  std::deque<Level> levels_;  // by depth; a deque, so that a level stays where it is while deeper ones come
  Level* next_ = nullptr;     // takes the rays that the part in work sends out
  ImagePoints points_;        // where the batch's samples lie
  std::vector<Hit> hits_;
  std::vector<Hit> first_hits_;  // of the batch's primary rays, where the job knows them
  SurfaceColumns surfaces_;      // of the hits
  LightColumns lit_;             // by the light in work
  Column3 mirrored_;
  Beam beam_;
  std::vector<Pending> pending_;  // what each shadow ray decides
  std::vector<Color> visible_;    // the answers
  std::vector<uint8_t> is_blocked_;
  std::vector<Hit> beam_hits_;
  std::vector<Color> seen_;  // by light and hit, how much of it is seen: for listeners alone
  Vec4 viewer_{0.0};         // whoever looks along primary rays: his place, or for an orthographic eye the way to him
  FaceLight face_light_;     // of flat and Gouraud shading
  MediaSets media_;
  PlaceCrosser crosser_;
  std::vector<Crossing> crossings_;  // where the hits are media's
  MediaSets::Set eye_media_ = MediaSets::kOpenAir;
  MediaList some_media_;         // hold the starts of some rays of the batch
  std::vector<Color> radiance_;  // by sample of the batch
  std::vector<float> finished_;  // the same, as the film takes it
  std::vector<int> spent_;       // rays after the primary one
  std::vector<double> untraced_;
};

}  // namespace tilelight
