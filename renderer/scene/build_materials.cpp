// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/build.h"
#include "renderer/scene/grammar.h"
#include "renderer/scene/readers.h"

namespace tilelight {
namespace {

Paint read_paint(Value material, std::string_view key, const Paint& fallback) {
  const Value paint = find_accepted(material, key);
  if (!paint) return fallback;
  if (!paint.is(JsonKind::object)) return color_of(paint);
  const Value cells = find_accepted(paint, "checker");
  if (!cells) return fallback;
  Checker checker;
  checker.a = read_color(cells, "a", checker.a);
  checker.b = read_color(cells, "b", checker.b);
  checker.size = read_number(cells, "size", checker.size);
  return checker;
}

Material read_material(Value value, std::string_view name) {
  Material material;
  material.name = name;
  material.diffuse = read_paint(value, "diffuse", material.diffuse);
  material.ambient = read_paint(value, "ambient", material.diffuse);
  material.specular = read_color(value, "specular", material.specular);
  material.shininess = read_number(value, "shininess", material.shininess);
  material.reflection = read_color(value, "reflection", material.reflection);
  material.transmission = read_color(value, "transmission", material.transmission);
  material.ior = read_number(value, "ior", material.ior);
  material.priority = read_int(value, "priority", material.priority);
  material.fresnel = read_boolean(value, "fresnel", material.fresnel);
  return material;
}

}  // namespace

MaterialTable::MaterialTable(Value materials, const Limits& limits, Problems& problems)
    : limits_(limits), problems_(problems) {
  materials_.emplace_back();
  if (!materials || materials.is_rejected()) return;
  for (const Value entry : materials.children()) {
    if (is_free_key(entry.key())) continue;
    // A rejected material keeps its name, so that its uses are not reported as well.
    by_name_[std::string(entry.key())] = entry.is_rejected() ? kDefault : add(read_material(entry, entry.key()), entry);
    names_.emplace_back(entry.key());
  }
}

MaterialId MaterialTable::find(Value object, std::string_view key, MaterialId fallback) {
  const Value value = find_accepted(object, key);
  if (!value) return fallback;
  if (value.is(JsonKind::object)) return add(read_material(value, read_text(value, "name")), value);
  const auto named = by_name_.find(value.text());
  if (named != by_name_.end()) return named->second;
  if (problems_.full()) return fallback;
  std::string hint = is_free_key(value.text()) ? "names under \"extras\" or \"x-\" are free keys and no materials"
                     : names_.empty()          ? "the scene has no materials"
                                               : did_you_mean(value.text(), names_);
  problems_.add(
      value,
      {"unknown_name", "found no material " + in_quotes(value.text()) + " under \"materials\"", {}, std::move(hint)});
  return fallback;
}

MaterialId MaterialTable::find_chess(Value object, std::string_view key, ChessRole fallback) {
  if (object && object.find(key)) return find(object, key, kDefault);
  MaterialId& id = chess_[static_cast<size_t>(fallback)];
  if (id == 0) {
    id = static_cast<MaterialId>(materials_.size());
    materials_.push_back(make_chess_material(fallback));
  }
  return id;
}

MaterialId MaterialTable::add(Material material, Value from) {
  const auto id = static_cast<MaterialId>(materials_.size());
  if (user_materials_ == limits_.materials) {
    if (!over_limit_) {
      problems_.add(from, {"limit",
                           "found more than " + std::to_string(limits_.materials) +
                               " materials with those inside objects; allowed: " + std::to_string(limits_.materials) +
                               " (limit materials)",
                           {},
                           "give the material a name under \"materials\" and use that"});
    }
    over_limit_ = true;
    return kDefault;
  }
  ++user_materials_;
  materials_.push_back(std::move(material));
  return id;
}

// Linear RGB: warm ivory against ebony with a hint of brown, squares of maple and walnut in a frame of dark walnut. All
// are polished: a soft highlight and a slight mirror.
Material make_chess_material(ChessRole role) {
  const auto make = [role](const Color& diffuse, double specular, double shininess, double reflection) {
    Material material;
    material.name = "chess " + std::string(get_word(kChessRoleNames, role));
    material.ambient = material.diffuse = diffuse;
    material.specular = Color(specular);
    material.shininess = shininess;
    material.reflection = Color(reflection);
    return material;
  };
  switch (role) {
    case ChessRole::white:
      return make({0.83, 0.73, 0.54}, 0.35, 60.0, 0.05);
    case ChessRole::black:
      return make({0.040, 0.027, 0.021}, 0.45, 80.0, 0.07);
    case ChessRole::light:
      return make({0.68, 0.48, 0.27}, 0.15, 40.0, 0.08);
    case ChessRole::dark:
      return make({0.20, 0.090, 0.042}, 0.15, 40.0, 0.08);
    case ChessRole::frame:
      return make({0.095, 0.040, 0.020}, 0.25, 50.0, 0.06);
  }
  return {};
}

}  // namespace tilelight
