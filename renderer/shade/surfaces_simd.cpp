// SPDX-License-Identifier: Apache-2.0
// The columns of surfaces.h, a register at a time. Of hits side by side those on one body are made together, body by
// body; then the lights see them all alike.
#include "renderer/base/simd_targets.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/shade/surfaces_simd.cpp"
#include <hwy/foreach_target.h>

#include "renderer/shade/light_equation-inl.h"
#include "renderer/shade/surfaces.h"
#include "renderer/shade/terminator.h"

HWY_BEFORE_NAMESPACE();
namespace tilelight {
namespace HWY_NAMESPACE {

HWY_INLINE Of3<Lanes> load(const Column3& from, size_t i) {
  return {load(&from.x[i]), load(&from.y[i]), load(&from.z[i])};
}
HWY_INLINE void store(const Of3<Lanes>& v, Column3& to, size_t i) {
  store(v.x, &to.x[i]), store(v.y, &to.y[i]), store(v.z, &to.z[i]);
}
HWY_INLINE LaneMask load(const std::vector<uint8_t>& from, size_t i) {
  uint32_t bits = 0;
  for (size_t lane = 0; lane < kLanes; ++lane) bits |= static_cast<uint32_t>(from[i + lane] & 1) << lane;
  return mask_of(bits);
}
HWY_INLINE void store(LaneMask mask, std::vector<uint8_t>& to, size_t i) {
  const uint32_t bits = bits_of(mask);
  for (size_t lane = 0; lane < kLanes; ++lane) to[i + lane] = bits >> lane & 1;
}

// What is known of kLanes hits.
struct LaneSurfaces {
  SurfaceOf<Lanes> surface;
  Of3<Lanes> curve;
  GlossOf<Lanes> gloss;
  LaneMask is_lit_over_curve;
};

HWY_INLINE bool has_gloss(const CompiledScene& scene) {
  return is_built_in(Feature::specular) && scene.plan.features.has(Feature::specular);
}

class SurfaceMaker {
 public:
  SurfaceMaker(const CompiledScene& scene, const SurfaceOptions& options)
      : scene_(scene), options_(options), has_gloss_(has_gloss(scene)) {}

  // The hits of rays[0], rays[1], ... count, at most kLanes, of them.
  HWY_INLINE void make(const BoundedRay* rays, const Hit* hits, size_t count, SurfaceColumns& out, size_t at) {
    rays_ = rays, hits_ = hits;
    Gathered3 ways;
    uint32_t todo = 0;
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const size_t i = lane < count ? lane : 0;
      ways.set(lane, rays[i].ray.direction);
      todo |= static_cast<uint32_t>(lane < count && hits[i].is_hit()) << lane;
    }
    direction_ = ways.lanes();
    store(direction_, out.direction, at);
    if (todo == 0) return;
    LaneSurfaces all = on_first_body(todo);
    while (todo != 0) {
      const uint32_t before = todo;
      const LaneSurfaces more = on_first_body(todo);
      blend(mask_of(before & ~todo), more, all);
    }
    store(all.surface.position, out.position, at);
    store(all.surface.geometric_normal, out.geometric_normal, at);
    store(all.surface.normal, out.normal, at);
    store(all.surface.ambient, out.ambient, at);
    store(all.surface.diffuse, out.diffuse, at);
    store(all.curve, out.curve, at);
    store(all.surface.from_outside, out.from_outside, at);
    store(all.is_lit_over_curve, out.is_lit_over_curve, at);
    if (!has_gloss_) return;
    store(all.gloss.specular, out.specular, at);
    store(all.gloss.shininess, &out.shininess[at]);
    store(all.gloss.is_specular, out.is_specular, at);
  }

 private:
  // Of the body of the first hit to do; takes its hits off the list.
  HWY_INLINE LaneSurfaces on_first_body(uint32_t& todo) const {
    const size_t first = hwy::Num0BitsBelowLS1Bit_Nonzero32(todo);
    const uint32_t index = hits_[first].body;
    size_t source[kLanes];  // hits elsewhere stand aside by repeating the first
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const bool is_here = (todo >> lane & 1) && hits_[lane].body == index;
      source[lane] = is_here ? lane : first;
      todo &= ~(static_cast<uint32_t>(is_here) << lane);
    }
    const CompiledBody& body = scene_.bodies[index];
    const CompiledMaterial& material = scene_.materials[body.material];
    const bool is_mesh = is_built_in(Feature::triangles) && body.kind == BodyKind::mesh;
    LaneSurfaces out = is_mesh ? on_mesh(body, source) : on_solid(body, source);
    if (has_gloss_)
      out.gloss = {of<Lanes>(material.source.specular), Lanes(material.source.shininess),
                   mask_of(material.is_specular ? ~0u : 0u)};
    return out;
  }

  HWY_INLINE LaneSurfaces on_mesh(const CompiledBody& body, const size_t (&source)[kLanes]) const {
    const CompiledMesh& mesh = *body.mesh;
    const bool has_normals = is_smooth(mesh);
    Gathered b0, b1, prim;
    for (size_t lane = 0; lane < kLanes; ++lane) {
      const Hit& hit = hits_[source[lane]];
      b0.at[lane] = hit.b0, b1.at[lane] = hit.b1, prim.at[lane] = hit.prim;
    }
    // Triangle by triangle: neighbours mostly share theirs.
    TriangleOf<Lanes> triangle;
    const Lanes prims = prim.lanes();
    constexpr uint32_t kAll = (1u << kLanes) - 1;
    for (uint32_t todo = kAll; todo != 0;) {
      const uint32_t index = hits_[source[hwy::Num0BitsBelowLS1Bit_Nonzero32(todo)]].prim;
      const LaneMask here = prims == Lanes(index);
      const bool is_first = todo == kAll;
      const auto put = [&](const Vec3& vertex, Of3<Lanes>& to)
                           HWY_ATTR { to = is_first ? of<Lanes>(vertex) : select(here, of<Lanes>(vertex), to); };
      for (size_t v = 0; v < 3; ++v) {
        put(mesh.positions[mesh.triangles[index][v]], triangle.corner[v]);
        if (has_normals) put(mesh.normals[mesh.corner_normals[index][v]], triangle.normal[v]);
      }
      todo &= ~bits_of(here);
    }
    const Lanes u = b0.lanes(), v = b1.lanes();
    LaneSurfaces out;
    out.surface = seen(body, point_of_triangle(triangle, has_normals, u, v));
    out.curve = out.surface.position;
    out.is_lit_over_curve = mask_of(is_lit_over_curve(has_normals) ? ~0u : 0u);
    if (is_built_in(Feature::shadows) && options_.casts_shadows && is_lit_over_curve(has_normals))
      out.curve = place_on_curve(body, triangle, u, v, out.surface.position, out.surface.from_outside);
    return out;
  }

  HWY_INLINE LaneSurfaces on_solid(const CompiledBody& body, const size_t (&source)[kLanes]) const {
    Gathered3 origins;
    Gathered t, prim;
    for (size_t lane = 0; lane < kLanes; ++lane) {
      origins.set(lane, rays_[source[lane]].ray.origin);
      t.at[lane] = hits_[source[lane]].t, prim.at[lane] = hits_[source[lane]].prim;
    }
    LaneSurfaces out;
    out.surface = seen(body, point_of_solid(body, origins.lanes(), direction_, t.lanes(), prim.lanes()));
    out.curve = out.surface.position;
    out.is_lit_over_curve = mask_of(0);
    return out;
  }

  bool is_lit_over_curve(bool has_normals) const {
    return has_normals && options_.smooth_terminator && options_.shading != Shading::flat;
  }

  HWY_INLINE void blend(LaneMask mask, const LaneSurfaces& more, LaneSurfaces& all) const {
    const auto take = [&](const auto& a, auto& b) HWY_ATTR { b = select(mask, a, b); };
    take(more.surface.position, all.surface.position);
    take(more.surface.geometric_normal, all.surface.geometric_normal);
    take(more.surface.normal, all.surface.normal);
    take(more.surface.from_outside, all.surface.from_outside);
    take(more.surface.ambient, all.surface.ambient);
    take(more.surface.diffuse, all.surface.diffuse);
    take(more.curve, all.curve);
    take(more.is_lit_over_curve, all.is_lit_over_curve);
    if (!has_gloss_) return;
    take(more.gloss.specular, all.gloss.specular);
    take(more.gloss.shininess, all.gloss.shininess);
    take(more.gloss.is_specular, all.gloss.is_specular);
  }

  HWY_INLINE SurfaceOf<Lanes> seen(const CompiledBody& body, const LocalPointOf<Lanes>& local) const {
    SurfaceOf<Lanes> out = surface_at(scene_, body, local, direction_);
    if (options_.viewer) {
      const Lanes w(options_.viewer->w);
      turn(out, -unit_vector(of<Lanes>(Vec3(*options_.viewer)) - w * out.position));
    }
    if (options_.shading == Shading::flat) out.normal = out.geometric_normal;
    return out;
  }

  const CompiledScene& scene_;
  const SurfaceOptions& options_;
  const bool has_gloss_;
  const BoundedRay* rays_ = nullptr;
  const Hit* hits_ = nullptr;
  Of3<Lanes> direction_;
};

void make_surface_columns(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<const Hit> hits,
                          const SurfaceOptions& options, SurfaceColumns& out) {
  SurfaceMaker maker(scene, options);
  for (size_t i = 0; i < rays.size(); i += kLanes)
    maker.make(&rays[i], &hits[i], std::min(kLanes, rays.size() - i), out, i);
}

// Makes the ways of shadow rays that start on the curved surface ready; returned is whose do.
HWY_INLINE LaneMask leave_from_curve(const CompiledLight& light, LaneMask is_over_curve,
                                     const SurfaceOf<Lanes>& surface, const Of3<Lanes>& curve, LightWayOf<Lanes>& way) {
  const Of3<Lanes> lift = curve - surface.position;
  LaneMask out = is_over_curve & comes_over_curve(surface.geometric_normal, way.to_light) &
                 (dot(lift, lift) > Lanes(kLeastLift * kLeastLift));
  if (is_directional(light) || !any(out)) return out;
  const auto lifted = way_to(light, curve);
  out = out & (lifted.distance > Lanes(0.0));
  way.to_light = select(out, lifted.to_light, way.to_light);
  way.distance = select(out, lifted.distance, way.distance);
  return out;
}

template <bool kGlossy>
HWY_INLINE void light_columns(const CompiledScene& scene, const CompiledLight& light, const SurfaceColumns& surfaces,
                              size_t count, bool casts_shadow, LightColumns& out) {
  for (size_t i = 0; i < count; i += kLanes) {
    SurfaceOf<Lanes> surface;
    surface.position = load(surfaces.position, i);
    surface.geometric_normal = load(surfaces.geometric_normal, i);
    surface.normal = load(surfaces.normal, i);
    surface.diffuse = load(surfaces.diffuse, i);
    GlossOf<Lanes> gloss;
    if (kGlossy) gloss = {load(surfaces.specular, i), load(&surfaces.shininess[i]), load(surfaces.is_specular, i)};
    const LaneMask is_over_curve = load(surfaces.is_lit_over_curve, i);
    const auto sample = light_at<kGlossy>(scene, light, surface, gloss, -load(surfaces.direction, i), is_over_curve);
    store(kGlossy ? sample.diffuse + sample.specular : sample.diffuse, out.light, i);
    store(sample.way.distance == Lanes(0.0), out.is_at_light, i);
    LightWayOf<Lanes> way = sample.way;
    LaneMask is_from_curve = mask_of(0);
    if (is_built_in(Feature::shadows) && casts_shadow && any(is_over_curve))
      is_from_curve = leave_from_curve(light, is_over_curve, surface, load(surfaces.curve, i), way);
    store(is_from_curve, out.is_from_curve, i);
    store(way.to_light, out.to_light, i);
    store(way.distance, &out.distance[i]);
  }
}

void light_surface_columns(const CompiledScene& scene, const CompiledLight& light, const SurfaceColumns& surfaces,
                           size_t count, bool casts_shadow, LightColumns& out) {
  if (has_gloss(scene)) {
    light_columns<true>(scene, light, surfaces, count, casts_shadow, out);
  } else {
    light_columns<false>(scene, light, surfaces, count, casts_shadow, out);
  }
}

void mirror_surface_columns(const SurfaceColumns& surfaces, size_t count, Column3& out) {
  for (size_t i = 0; i < count; i += kLanes) {
    store(
        mirror_direction_at(load(surfaces.normal, i), load(surfaces.geometric_normal, i), load(surfaces.direction, i)),
        out, i);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace tilelight
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace tilelight {

HWY_EXPORT(make_surface_columns);
HWY_EXPORT(light_surface_columns);
HWY_EXPORT(mirror_surface_columns);

namespace {

size_t with_room(size_t count) {
  constexpr size_t kWidest = 8;
  return count + kWidest;
}

void make_room(Column3& columns, size_t count) {
  for (Column* column : {&columns.x, &columns.y, &columns.z}) column->resize(with_room(count));
}

}  // namespace

void make_surfaces(const CompiledScene& scene, std::span<const BoundedRay> rays, std::span<const Hit> hits,
                   const SurfaceOptions& options, SurfaceColumns& out) {
  for (Column3* columns : {&out.direction, &out.position, &out.geometric_normal, &out.normal, &out.ambient,
                           &out.diffuse, &out.curve, &out.specular})
    make_room(*columns, rays.size());
  out.shininess.resize(with_room(rays.size()));
  for (auto* flags : {&out.from_outside, &out.is_specular, &out.is_lit_over_curve})
    flags->resize(with_room(rays.size()));
  HWY_DYNAMIC_DISPATCH(make_surface_columns)(scene, rays, hits, options, out);
}

Surface surface_of(const CompiledScene& scene, const SurfaceColumns& surfaces, const Hit& hit, size_t index) {
  Surface out;
  out.position = surfaces.position[index];
  out.geometric_normal = surfaces.geometric_normal[index];
  out.normal = surfaces.normal[index];
  out.from_outside = surfaces.from_outside[index];
  out.body = &scene.bodies[hit.body];
  out.material = &scene.materials[out.body->material];
  out.ambient = surfaces.ambient[index];
  out.diffuse = surfaces.diffuse[index];
  out.here = {hit.body, hit.prim};
  return out;
}

void light_surfaces(const CompiledScene& scene, const CompiledLight& light, const SurfaceColumns& surfaces,
                    size_t count, bool casts_shadow, LightColumns& out) {
  make_room(out.light, count);
  make_room(out.to_light, count);
  out.distance.resize(with_room(count));
  out.is_at_light.resize(with_room(count));
  out.is_from_curve.resize(with_room(count));
  HWY_DYNAMIC_DISPATCH(light_surface_columns)(scene, light, surfaces, count, casts_shadow, out);
}

void mirror_surfaces(const SurfaceColumns& surfaces, size_t count, Column3& out) {
  make_room(out, count);
  HWY_DYNAMIC_DISPATCH(mirror_surface_columns)(surfaces, count, out);
}

}  // namespace tilelight
#endif
