// SPDX-License-Identifier: Apache-2.0
// The first and the last chapter of the language: the document as a whole, its materials and its lights.
#include "renderer/scene/grammar.h"

#include "renderer/scene/grammar_rules.h"

namespace tilelight {
namespace {

constexpr double kMaxLightColor = 1e3;  // times the greatest intensity it still fits a float

Rule paint_rule() {
  Rule checker = record_rule(
      {"checker",
       "Two colours in a pattern of cells",
       {{"a", color_rule(kUnitInterval, "reflectance"), "Colour of the even cells", "", "1"},
        {"b", color_rule(kUnitInterval, "reflectance"), "Colour of the odd cells", "", "0"},
        {"size", number_rule(kPositive), "Edge of a cell", "Scene units, in the object's own frame.", "1"}}});
  Rule holder = record_rule(
      {"pattern", "A pattern in place of a colour", {{"checker", checker, "A checker", "", "", Need::required}}});
  Rule paint =
      any_of({number_rule(kUnitInterval), numbers_rule(kUnitInterval, {3, 3}), {.form = Form::hex_color}, holder});
  paint.shared_name = "paint";
  return paint;
}

std::shared_ptr<const Record> light_grammar(LightKind kind) {
  std::vector<Field> fields;
  if (kind == LightKind::point) {
    fields = {{"position", vector_rule(), "Where it stands", "Scene units.", "", Need::required}};
  } else {
    fields = {{"direction", direction_rule(), "The way its light travels", "Need not be of unit length.", "",
               Need::required}};
  }
  const std::vector<Field> common = {
      {"name", text_rule(), "Name", "For people; the image does not depend on it."},
      {"color", color_rule({.min = 0.0, .max = kMaxLightColor}, "light_color"), "Colour", "Linear RGB.", "1"},
      {"intensity", number_rule(kNotNegative), "Intensity", "Multiplies the colour.", "1"},
      {"shadow", boolean_rule(), "Whether it casts shadows", "", "true"}};
  fields.insert(fields.end(), common.begin(), common.end());
  const bool is_point = kind == LightKind::point;
  return std::make_shared<const Record>(
      Record{is_point ? "point" : "directional",
             is_point ? "A light at a point" : "A light at infinity, never attenuated", std::move(fields)});
}

Record background_grammar() {
  return {"background",
          "What rays see that hit nothing",
          {{"bottom", color_rule(kNotNegative, "radiance"), "Straight below", "Linear RGB.", "[0.9, 0.9, 0.95]"},
           {"top", color_rule(kNotNegative, "radiance"), "Straight above", "Linear RGB.", "[0.35, 0.5, 0.8]"}}};
}

Record attenuation_grammar() {
  constexpr double kMaxSquare = kMaxMagnitude * kMaxMagnitude;
  return {"attenuation",
          "How the light of a point falls off with the distance d",
          {{"mode", words_rule(kAttenuationModes), "Law",
            "linear: 1 / (d + k); inverse_square: 1 / (d^2 + k); none: 1.", "\"linear\""},
           {"k", number_rule({.min = 0.0, .max = kMaxSquare}), "Constant",
            "Scene units; squared scene units for inverse_square.", "1"}}};
}

}  // namespace

std::shared_ptr<const Record> material_grammar() {
  const Rule reflectance = color_rule(kUnitInterval, "reflectance");
  return std::make_shared<const Record>(Record{
      "material",
      "How a surface answers light",
      {{"name", text_rule(), "Name", "For people; the image does not depend on it."},
       {"ambient", paint_rule(), "Coefficient of ambient light", "Absent: as `diffuse`, its checker too."},
       {"diffuse", paint_rule(), "Coefficient of diffuse reflection", "", "0.8"},
       {"specular", reflectance, "Coefficient of specular reflection", "", "0"},
       {"shininess", number_rule({.min = 0.0, .max = 1e12}), "Exponent of the specular lobe", "", "32"},
       {"reflection", reflectance, "Weight of the mirrored ray", "", "0"},
       {"transmission", reflectance, "Weight of the refracted ray", "", "0"},
       {"ior", number_rule({.min = 0.0, .max = 1e6, .above_min = true}), "Index of refraction", "", "1.5"},
       {"priority", whole_rule(-1e6, 1e6), "Rank among overlapping media", "The higher one wins.", "0"},
       {"fresnel", boolean_rule(), "Whether reflection and transmission follow the Fresnel equations", "", "false"}}});
}

Rule lights_grammar(const Limits& limits) {
  const Rule light = {.form = Form::tagged,
                      .records = {light_grammar(LightKind::point), light_grammar(LightKind::directional)}};
  return list_of(light, {.max = limits.lights, .is_limit = true});
}

Record scene_grammar(const Limits& limits) {
  const std::shared_ptr<const Record> material = material_grammar();
  return {
      "scene",
      "A scene of Tilelight, version 1",
      {{"tilelight", whole_rule(1, 1), "Version of the language", "", "1"},
       {"camera", camera_grammar(), "Camera", "Absent: the finite objects are framed from three-quarters above."},
       {"image", image_grammar(limits), "Image"},
       {"render", render_grammar(limits), "How to render and when to stop"},
       {"background", record_rule(background_grammar()), "Background"},
       {"ambient", color_rule(kNotNegative, "radiance"), "Ambient light", "Linear RGB.", "0.12"},
       {"attenuation", record_rule(attenuation_grammar()), "Attenuation"},
       {"lights", lights_grammar(limits), "Lights", "Absent: a key and a fill light; an empty list: none."},
       {"materials", map_of(record_rule(material), {.max = limits.materials, .is_limit = true}), "Materials by name"},
       {"meshes", meshes_grammar(limits), "Triangle meshes by name"},
       {"objects", objects_grammar(limits, material), "Objects", "At least one visible.", "", Need::required}}};
}

Record view_grammar(const Limits& limits) {
  return {"view",
          "A view of a scene",
          {{"camera", camera_grammar(), "Camera"},
           {"image", image_grammar(limits), "Image"},
           {"render", render_grammar(limits), "How to render and when to stop"}}};
}

}  // namespace tilelight
