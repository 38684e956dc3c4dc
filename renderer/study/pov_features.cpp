// SPDX-License-Identifier: Apache-2.0
#include "renderer/study/pov_features.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/base/safe_length.h"
#include "renderer/study/pov_media.h"
#include "renderer/study/pov_mesh.h"

namespace tilelight {
namespace {

using Subject = PovSubject;

const Material& material_of(const Subject& s, const Body& body) { return s.scene.materials[body.material]; }
bool is_clear(const Material& m) { return m.transmission != Color(0.0); }

template <class Holds>
bool any_body(const Subject& s, Holds holds) {
  return std::any_of(s.bodies.begin(), s.bodies.end(), holds);
}
template <class Holds>
bool any_material(const Subject& s, Holds holds) {
  return any_body(s, [&](const Body& body) { return holds(material_of(s, body)); });
}
// Of a body that encloses its medium.
template <class Holds>
bool any_medium(const Subject& s, Holds holds) {
  return any_body(s, [&](const Body& body) {
    return body.has_inside && is_clear(material_of(s, body)) && holds(material_of(s, body));
  });
}

bool has_coloured_highlights(const Subject& s) {
  return !s.scene.lights.empty() && any_material(s, [](const Material& m) {
    return m.specular.r != m.specular.g || m.specular.b != m.specular.g;
  });
}

bool has_partial_total_reflection(const Subject& s) {
  return any_medium(s, [](const Material& m) {
    const Color sum = m.reflection + m.transmission;
    return !m.fresnel && m.ior != 1.0 && glm::length(sum - Color(1.0)) > 1e-9;
  });
}

bool has_partial_fresnel(const Subject& s) {
  return any_medium(s, [](const Material& m) { return m.fresnel && m.ior != 1.0 && m.reflection != Color(1.0); });
}

bool bends_at_curves(const Subject& s) {
  return any_body(s, [&](const Body& body) {
    const Material& m = material_of(s, body);
    return body.has_inside && is_clear(m) && m.ior != 1.0 && body.mesh && !body.mesh->corner_normals.empty();
  });
}

bool casts_shadow(const Subject& s, const Light& light) { return light.shadow && s.view.render.shadows; }

bool is_rounded_by_shadows(const Subject& s) {
  if (s.view.render.terminator != Terminator::smooth) return false;
  const auto& lights = s.scene.lights;
  return std::any_of(lights.begin(), lights.end(), [&](const Light& light) { return casts_shadow(s, light); }) &&
         any_body(s, [](const Body& body) { return body.mesh && !body.mesh->corner_normals.empty(); });
}

// A facet that faces away from a light lies in its own shadow; in POV-Ray only if the light casts shadows and the mesh
// is closed.
bool is_lit_behind_facets(const Subject& s) {
  if (s.view.render.terminator != Terminator::exact) return false;
  bool found = false;
  for (const Body& body : s.bodies) {
    for_each_smooth_corner(body, [&](const Vec3& place, const Vec3& facet, const Vec3& normal) {
      for (const Light& light : s.scene.lights) {
        if (casts_shadow(s, light) && body.mesh->closed) continue;
        const Vec3 way = light.kind == LightKind::point ? light.position - place : -light.direction;
        found = found || glm::dot(facet, way) * glm::dot(normal, way) < 0.0;
      }
    });
  }
  return found;
}

// More rays than the budget can come from one sample.
bool may_spend_budget(const Subject& s) {
  const RenderSpec& render = s.view.render;
  const bool branches = any_material(s, [](const Material& m) { return is_clear(m) && m.reflection != Color(0.0); });
  const double most = branches ? elementary::exp2(render.max_depth + 1.0) : render.max_depth + 1.0;
  const bool follows = any_material(s, [](const Material& m) { return is_clear(m) || m.reflection != Color(0.0); });
  return follows && most > render.ray_budget;
}

bool follows_rays(const Subject& s) {
  return any_material(s, [](const Material& m) { return is_clear(m) || m.reflection != Color(0.0); });
}

// POV-Ray turns a normal to the eye, we to the side of the facet that is seen: where an interpolated normal looks away
// from the eye and the facet does not, these are two. Counts corners whose normal is far from their facet's, by how
// large the eye sees them: where the two are near, that is a rim of no width.
bool has_turned_normals(const Subject& s) {
  constexpr double kNear = 0.8;    // cosine
  constexpr double kShows = 5e-3;  // of a body's picture
  const Camera& camera = *s.view.camera;
  if (s.scene.lights.empty()) return false;
  return any_body(s, [&](const Body& body) {
    double all = 0.0, turned = 0.0;
    for_each_smooth_corner(body, [&](const Vec3& place, const Vec3& facet, const Vec3& normal) {
      const bool is_parallel = camera.projection == Projection::orthographic;
      const Vec3 to_eye = safe_normalize(camera.position - (is_parallel ? camera.target : place));
      const double seen = glm::dot(facet, to_eye);
      all += std::abs(seen);
      const bool is_far = glm::dot(facet, normal) < kNear * glm::length(facet) * glm::length(normal);
      if (is_far && seen * glm::dot(normal, to_eye) < 0.0) turned += std::abs(seen);
    });
    return turned > kShows * all;
  });
}

bool has_details(const Subject& s) {
  return any_body(s, [&](const Body& body) {
    const Box box = world_bounds(body);
    return !box.is_empty() && safe_length(box.hi - box.lo) * s.space.scale < kPovLeastDetail;
  });
}

bool is_far(const Subject& s) {
  return safe_length(s.view.camera->position - s.space.center) * s.space.scale > kPovFarthest;
}

const std::array kFeatures = {
    // The document and its view.
    PovFeature{"document",
               "scene.tilelight scene.camera scene.image scene.render scene.lights scene.materials "
               "scene.meshes scene.objects"},
    PovFeature{"size of the picture", "image.width image.height"},
    PovFeature{"exposure", "image.exposure"},
    PovFeature{"perspective camera", "perspective.position perspective.target perspective.up perspective.fov_y_deg"},
    PovFeature{"orthographic camera", "orthographic.position orthographic.target orthographic.up orthographic.height"},
    PovFeature{"eye far from the scene", "perspective.position orthographic.position", PovSupport::missing,
               "POV-Ray sees no farther than 10^7 of its units, in which this scene measures hundreds.", is_far},
    // How it is drawn.
    PovFeature{"ray tracing", "render.algorithm"},
    PovFeature{"other algorithms than raytrace", "render.algorithm", PovSupport::missing,
               "POV-Ray draws by rays, with mirrors and glass.",
               [](const Subject& s) { return s.view.render.algorithm != Algorithm::raytrace; }},
    PovFeature{
        "hidden lines", "render.hidden_lines", PovSupport::missing, "POV-Ray draws no lines.",
        [](const Subject& s) { return s.view.render.algorithm == Algorithm::roberts && s.view.render.hidden_lines; }},
    PovFeature{"phong shading", "render.shading"},
    PovFeature{"flat and gouraud shading", "render.shading", PovSupport::missing,
               "POV-Ray evaluates light at every point, with the normal there.",
               [](const Subject& s) { return s.view.render.shading != Shading::phong; }},
    PovFeature{"tessellation", "render.tessellate render.chord_error_px", PovSupport::missing,
               "spheres are round in POV-Ray.",
               [](const Subject& s) {
                 return is_tessellated(s.view.render) &&
                        any_body(s, [](const Body& body) { return body.kind == BodyKind::sphere; });
               }},
    PovFeature{"shadows", "render.shadows"},
    PovFeature{"depth of up to 255", "render.max_depth"},
    PovFeature{"depth over 255", "render.max_depth", PovSupport::approximate,
               "POV-Ray follows at most 255 secondary rays in a row.",
               [](const Subject& s) { return follows_rays(s) && s.view.render.max_depth > 255; }},
    PovFeature{"weight of paths", "render.weight_cutoff"},
    PovFeature{"budget of rays", "render.ray_budget", PovSupport::missing,
               "POV-Ray has none and traces all rays that depth and weight allow.", may_spend_budget},
    PovFeature{"exact terminator", "render.terminator"},
    PovFeature{"smooth terminator", "render.terminator", PovSupport::approximate,
               "on meshes with interpolated normals light ends facet by facet in POV-Ray.", is_rounded_by_shadows},
    PovFeature{
        "exact terminator where nothing shades", "render.terminator", PovSupport::approximate,
        "facets that face away from a light have its light in POV-Ray by their normals, if it casts no shadow or "
        "their mesh is open.",
        is_lit_behind_facets},
    PovFeature{"box filter", "render.filter"},
    PovFeature{"tent filter", "render.filter", PovSupport::missing, "POV-Ray weighs the square of a pixel alike.",
               [](const Subject& s) { return s.view.render.filter == PixelFilter::tent; }},
    PovFeature{"gaussian filter", "render.filter", PovSupport::missing, "POV-Ray weighs the square of a pixel alike.",
               [](const Subject& s) { return s.view.render.filter == PixelFilter::gaussian; }},
    // What decides how often the picture is sampled, and no more: each program has its own rules.
    PovFeature{"rules of sampling",
               "render.samples render.rmse render.time_ms render.passes render.adaptive "
               "render.seed"},
    // Light.
    PovFeature{"background", "scene.background background.bottom background.top"},
    PovFeature{"ambient light", "scene.ambient material.ambient"},
    PovFeature{"attenuation", "scene.attenuation attenuation.mode attenuation.k"},
    PovFeature{"point lights", "point.name point.position point.color point.intensity"},
    PovFeature{"directional lights",
               "directional.name directional.direction directional.color "
               "directional.intensity"},
    PovFeature{"lights without shadow", "point.shadow directional.shadow"},
    // Materials.
    PovFeature{"diffuse reflection", "material.name material.diffuse"},
    PovFeature{"checkers", "pattern.checker checker.a checker.b checker.size"},
    PovFeature{"grey highlights", "material.specular material.shininess"},
    PovFeature{"coloured highlights", "material.specular", PovSupport::approximate,
               "in POV-Ray a highlight's colour fades to the light's where that grazes the surface.",
               has_coloured_highlights},
    PovFeature{"mirrors", "material.reflection"},
    PovFeature{"transmission", "material.transmission"},
    PovFeature{"refraction", "material.ior"},
    PovFeature{"refraction by facets that stand for a curve", "mesh_data.normals mesh_data.crease_deg",
               PovSupport::approximate,
               "where the curve would trap light that its facets let out, POV-Ray reflects it on and on; the fewer the "
               "facets, the more.",
               bends_at_curves},
    PovFeature{"total reflection of weight 1", "material.reflection material.transmission"},
    PovFeature{"total reflection of other weight", "material.reflection material.transmission", PovSupport::approximate,
               "POV-Ray reflects all light there, in place of reflection + transmission.",
               has_partial_total_reflection},
    PovFeature{"fresnel with reflection 1", "material.fresnel"},
    PovFeature{"fresnel with other reflection", "material.fresnel", PovSupport::approximate,
               "what POV-Ray does not reflect passes: transmission * (1 - reflection * F), and all light in total "
               "reflection.",
               has_partial_fresnel},
    PovFeature{"media apart", "material.priority"},
    PovFeature{"media that meet", "material.priority", PovSupport::approximate,
               "where transparent bodies touch or overlap, or one with fresnel lies in another, POV-Ray has its own "
               "rules: no priorities, the weights of every surface, no fresnel on the way out.",
               [](const Subject& s) { return do_media_meet(s.scene, s.bodies); }},
    // Objects.
    PovFeature{"spheres", "sphere.center sphere.radius sphere.material sphere.name"},
    PovFeature{"cubes", "cube.center cube.size cube.material cube.name"},
    PovFeature{"boxes", "box.min box.max box.material box.name"},
    PovFeature{"planes", "plane.point plane.normal plane.material plane.name"},
    PovFeature{"meshes",
               "mesh.mesh mesh.material mesh.name mesh_data.positions mesh_data.indices mesh_data.name "
               "mesh_data.asset"},
    PovFeature{"normals of meshes", "mesh_data.normals mesh_data.crease_deg"},
    PovFeature{"normals that look away", "mesh_data.normals mesh_data.crease_deg", PovSupport::approximate,
               "where an interpolated normal looks away from the eye and its facet does not, POV-Ray turns it round.",
               has_turned_normals},
    PovFeature{"chess pieces",
               "chess_piece.piece chess_piece.position chess_piece.color chess_piece.detail "
               "chess_piece.material chess_piece.name"},
    PovFeature{"chess positions",
               "chess_position.fen chess_position.detail chess_position.materials "
               "chess_position.name chess_materials.white chess_materials.black "
               "chess_materials.light chess_materials.dark chess_materials.frame"},
    PovFeature{"scale",
               "sphere.scale cube.scale box.scale plane.scale mesh.scale chess_piece.scale chess_position.scale"},
    PovFeature{"rotation",
               "sphere.rotate_deg sphere.rotate_quat cube.rotate_deg cube.rotate_quat box.rotate_deg "
               "box.rotate_quat plane.rotate_deg plane.rotate_quat mesh.rotate_deg mesh.rotate_quat "
               "chess_piece.rotate_deg chess_piece.rotate_quat chess_position.rotate_deg "
               "chess_position.rotate_quat rotation.axis rotation.angle"},
    PovFeature{"translation",
               "sphere.translate cube.translate box.translate plane.translate mesh.translate "
               "chess_piece.translate chess_position.translate"},
    PovFeature{"matrices",
               "sphere.matrix cube.matrix box.matrix plane.matrix mesh.matrix chess_piece.matrix "
               "chess_position.matrix"},
    PovFeature{"details", "sphere.radius cube.size box.min box.max", PovSupport::approximate,
               "bodies ten million times smaller than the scene are lost in POV-Ray's tolerances.", has_details},
};

}  // namespace

std::span<const PovFeature> pov_features() { return kFeatures; }

std::vector<std::string> pov_notes(const PovSubject& subject) {
  std::vector<std::string> notes;
  for (const PovFeature& feature : kFeatures) {
    if (feature.is_used && feature.is_used(subject))
      notes.push_back(std::string(feature.name) + ": " + std::string(feature.difference));
  }
  return notes;
}

}  // namespace tilelight
