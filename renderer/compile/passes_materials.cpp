// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include "renderer/base/safe_length.h"
#include "renderer/compile/cost_text.h"
#include "renderer/compile/passes.h"
#include "renderer/compile/reach.h"

namespace tilelight {
namespace {

bool is_zero(const Color& c) { return c == Color(0.0); }

bool is_zero(const Paint& paint) {
  if (const auto* color = std::get_if<Color>(&paint)) return is_zero(*color);
  const auto& checker = std::get<Checker>(paint);
  return is_zero(checker.a) && is_zero(checker.b);
}

double max_channel(const Color& c) { return std::max({c.r, c.g, c.b}); }

Color max_color(const Paint& paint) {
  if (const auto* color = std::get_if<Color>(&paint)) return *color;
  const auto& checker = std::get<Checker>(paint);
  return glm::max(checker.a, checker.b);
}

void add_shape(const CompiledBody& body, FeatureSet& f) {
  switch (body.kind) {
    case BodyKind::sphere:
      f.add(Feature::spheres);
      break;
    case BodyKind::box:
      f.add(Feature::boxes);
      break;
    case BodyKind::plane:
      f.add(Feature::planes);
      break;
    case BodyKind::mesh:
      f.add(Feature::triangles);
      if (!body.mesh->corner_normals.empty()) f.add(Feature::smooth_normals);
      break;
  }
}

void add_material(const CompiledMaterial& m, bool is_lit, FeatureSet& f) {
  if (m.is_specular && is_lit) f.add(Feature::specular);
  if (m.is_reflective) f.add(Feature::reflection);
  if (m.is_transmissive) {
    f.add(Feature::transmission);
    if (m.source.fresnel) f.add(Feature::fresnel);
    if (m.source.priority != 0) f.add(Feature::nested_media);
  }
  if (std::holds_alternative<Checker>(m.source.diffuse) || std::holds_alternative<Checker>(m.source.ambient))
    f.add(Feature::checker);
}

std::string title_of(const Light& light, size_t index) {
  return "light " + (light.name.empty() ? "lights/" + std::to_string(index) : light.name);
}

}  // namespace

std::vector<CompiledMaterial> drop_unused_materials(const Scene& scene, std::vector<Body>& bodies,
                                                    LeftOutList& left_out) {
  constexpr MaterialId kUnused = ~MaterialId{0};
  std::vector<MaterialId> place(scene.materials.size(), kUnused);
  std::vector<CompiledMaterial> kept;
  for (Body& body : bodies) {
    MaterialId& id = place[body.material];
    if (id == kUnused) {
      id = static_cast<MaterialId>(kept.size());
      const Material& m = scene.materials[body.material];
      kept.push_back({m, !is_zero(m.specular), !is_zero(m.reflection), !is_zero(m.transmission)});
    }
    body.material = id;
  }
  for (size_t i = 0; i < place.size(); ++i) {
    if (place[i] == kUnused && !scene.materials[i].name.empty()) {
      left_out.push_back({"material " + scene.materials[i].name, "no object wears it",
                          bytes_text(static_cast<int64_t>(sizeof(CompiledMaterial)))});
    }
  }
  return kept;
}

std::vector<CompiledLight> drop_dead_lights(const Scene& scene, const std::vector<CompiledMaterial>& materials,
                                            LeftOutList& left_out) {
  const bool something_reflects = std::any_of(materials.begin(), materials.end(), [](const CompiledMaterial& m) {
    return m.is_specular || !is_zero(m.source.diffuse);
  });
  // What a light costs is up to the view, which plan_view knows.
  const auto leave_out = [&](size_t i, const char* why) {
    left_out.push_back({.what = title_of(scene.lights[i], i), .why = why, .kind = LeftOut::Kind::light});
  };
  std::vector<CompiledLight> kept;
  for (size_t i = 0; i < scene.lights.size(); ++i) {
    const Light& light = scene.lights[i];
    const Color intensity = light.color * light.intensity;
    if (is_zero(intensity)) {
      leave_out(i, "its colour times its intensity is black");
    } else if (!something_reflects) {
      leave_out(i, "no material has a diffuse or specular part to light");
    } else {
      CompiledLight compiled;
      compiled.kind = light.kind;
      compiled.position = light.position;
      if (light.kind == LightKind::directional) compiled.to_light = -safe_normalize(light.direction);
      compiled.intensity = intensity;
      compiled.shadow = light.shadow;
      compiled.light = static_cast<uint32_t>(i);
      kept.push_back(compiled);
    }
  }
  return kept;
}

std::vector<SceneWarning> find_odd_glass(const std::vector<Body>& bodies) {
  std::vector<SceneWarning> warnings;
  for (const Body& body : bodies) {
    if (body.kind != BodyKind::mesh || body.layer == Layer::opaque) continue;
    const std::string pointer = "/objects/" + std::to_string(body.object);
    if (!body.has_inside) {
      warnings.push_back(
          {pointer, "open_glass",
           std::string(body.mesh->closed ? "the mesh encloses no volume" : "the mesh is open") +
               " and its material transparent: without an inside it bends no light, as if it were thin"});
    } else if (body.is_turned) {
      warnings.push_back(
          {pointer, "inside_out_glass",
           "the mesh is transparent and wound inside out, as a whole or in some of its shells (their "
           "signed volume is negative): it is drawn as if these triangles were wound the other way; name "
           "their corners counter-clockwise as seen from outside"});
    }
  }
  return warnings;
}

double find_passed_on(const CompiledScene& scene) {
  double passed_on = 0.0;
  for (const CompiledMaterial& m : scene.materials) {
    const Color &kr = m.source.reflection, &kt = m.source.transmission;
    // kr F + kt (1 - F) where the body is a medium; a thin one has no F.
    const auto is_thin = [&](const CompiledBody& body) {
      return &scene.materials[body.material] == &m && !body.has_inside;
    };
    const bool is_shared =
        m.source.fresnel && m.is_transmissive && std::none_of(scene.bodies.begin(), scene.bodies.end(), is_thin);
    passed_on = std::max(passed_on, max_channel(is_shared ? glm::max(kr, kt) : kr + kt));
  }
  return passed_on;
}

double find_radiance_bound(const CompiledScene& scene) {
  double light_sum = 0.0;  // the brightest channel of what all lights can bring to one point
  for (const CompiledLight& light : scene.lights) {
    double factor = 1.0;
    if (light.kind == LightKind::point && scene.attenuation.mode != AttenuationMode::none) {
      if (!(scene.attenuation.k > 0.0)) return -1.0;  // unbounded near the light
      factor = 1.0 / scene.attenuation.k;
    }
    light_sum += max_channel(light.intensity) * factor;
  }
  double local = 0.0;
  for (const CompiledMaterial& m : scene.materials) {
    const double ambient = max_channel(scene.ambient * max_color(m.source.ambient));
    const double lit = max_channel(max_color(m.source.diffuse) + m.source.specular);
    local = std::max(local, ambient + light_sum * lit);
  }
  if (scene.passed_on >= 1.0) return -1.0;
  const double sky = std::max(max_channel(scene.background.bottom), max_channel(scene.background.top));
  return std::max(sky, local / (1.0 - scene.passed_on));
}

FeatureSet features_of(const CompiledScene& scene, const Reach& reach) {
  FeatureSet f;
  std::vector<bool> is_worn(scene.materials.size(), false);  // by what is seen
  bool casts_tinted = false, sees_any = false;
  for (size_t i = 0; i < scene.bodies.size(); ++i) {
    if (!reach.casts[i]) continue;
    const CompiledBody& body = scene.bodies[i];
    add_shape(body, f);
    casts_tinted |= scene.materials[body.material].is_transmissive;
    if (!reach.is_seen[i]) continue;
    is_worn[body.material] = sees_any = true;
  }
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    if (is_worn[i]) add_material(scene.materials[i], !scene.lights.empty(), f);
  }
  for (const CompiledLight& light : scene.lights) {
    if (!sees_any) break;
    f.add(light.kind == LightKind::point ? Feature::point_lights : Feature::directional_lights);
    if (light.kind == LightKind::point && scene.attenuation.mode != AttenuationMode::none) f.add(Feature::attenuation);
    if (light.shadow) f.add(Feature::shadows);
  }
  if (f.has(Feature::shadows) && casts_tinted) f.add(Feature::tinted_shadows);
  return f;
}

FeatureSet find_features(const CompiledScene& scene, LeftOutList& left_out) {
  const FeatureSet f = features_of(scene, Reach::everything(scene.bodies.size()));
  const auto say = [&](Feature feature, const char* why) {
    if (!f.has(feature)) left_out.push_back(left_out_feature(feature, why));
  };
  say(Feature::spheres, "the scene has no sphere");
  say(Feature::boxes, "the scene has no cube, box or board");
  say(Feature::planes, "the scene has no infinite plane");
  say(Feature::triangles, "the scene has no mesh and no chess piece");
  say(Feature::checker, "no material has a checker");
  say(Feature::specular, "no lit material has a specular part");
  say(Feature::point_lights, "no point light is alive");
  say(Feature::directional_lights, "no directional light is alive");
  say(Feature::shadows, "no living light casts shadows");
  say(Feature::reflection, "no material reflects");
  say(Feature::transmission, "no material is transparent: shadow rays stop at the first hit");
  return f;
}

}  // namespace tilelight
