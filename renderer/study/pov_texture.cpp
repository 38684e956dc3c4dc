// SPDX-License-Identifier: Apache-2.0
// How POV-Ray 3.7 adds up a layer of a texture: pigment * (ambient + diffuse * N.L) * opacity + phong, beneath it the
// next layer through pigment * filter + transmit. Numbers beyond 1 are taken as they are, so a layer that lets half
// through and shines twice adds light to a transparent one without changing what passes.
#include "renderer/study/pov_texture.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tilelight {
namespace {

constexpr double kNearlyBlack = 1e-9;  // the pigment of a channel that glows without reflecting: ambient is times it

double largest(const Color& c) { return std::max({c.r, c.g, c.b}); }
bool is_grey(const Color& c) { return c.r == c.g && c.g == c.b; }
bool is_black(const Color& c) { return c == Color(0.0); }

const Color& at(const Paint& paint, int cell) {
  if (const auto* color = std::get_if<Color>(&paint)) return *color;
  const Checker& checker = std::get<Checker>(paint);
  return cell ? checker.b : checker.a;
}

// What of light is reflected by a surface as a whole. `gain` of the diffuse part.
void add_finish(PovText& text, const Color& ambient, double gain, const Material& m, bool is_fresnel) {
  text.add(" finish { ambient "), text.color(ambient);
  text.add(" diffuse %.9g", gain);
  if (!is_black(m.specular) && is_grey(m.specular)) text.add(" phong %.9g phong_size %.9g", m.specular.r, m.shininess);
  if (!is_black(m.reflection)) {
    text.add(is_fresnel ? " reflection { rgb 0 " : " reflection { "), text.color(m.reflection);
    text.add(is_fresnel ? " fresnel on } conserve_energy" : " }");
  }
  text.add(" }");
}

// Of cells of edge 1 at a size, told apart along all axes but one.
void add_cell_size(PovText& text, double size, int flat_axis) {
  constexpr double kEndless = 1e15;
  Vec3 scale(size), shift(0.0);
  if (flat_axis < 3) scale[flat_axis] *= kEndless, shift[flat_axis] = -0.5;
  text.add(" translate "), text.vector(shift);
  text.add(" scale "), text.vector(scale);
}

}  // namespace

PovTextures::Cell PovTextures::cell_of(const Color& diffuse, const Color& ambient) const {
  return {diffuse, scene_.ambient * ambient * exposure_};
}

std::string PovTextures::plain(const Cell& cell, const Material& m, const PovSurface& surface) const {
  Color pigment = cell.diffuse, ambient(0.0);
  for (int c = 0; c < 3; ++c) {
    if (!(cell.glow[c] > 0.0)) continue;
    pigment[c] = std::max(pigment[c], kNearlyBlack);
    ambient[c] = cell.glow[c] / pigment[c];
  }
  const bool is_clear = !is_black(m.transmission), is_shaded = !is_black(pigment);
  const bool is_fresnel = m.fresnel && is_clear && surface.is_medium;
  PovText text;  // the lowest layer first
  if (is_clear) {
    text.add("texture { pigment { "), text.color((is_shaded ? 2.0 : 1.0) * m.transmission), text.add(" filter 1 }");
    if (is_shaded)
      text.add(" finish { ambient 0 diffuse 0 }");
    else
      add_finish(text, Color(0.0), 0.0, m, is_fresnel);
    text.add(" }\n");
  }
  if (is_shaded || !is_clear) {
    const double gain = is_clear ? 2.0 : 1.0;
    text.add("texture { pigment { "), text.color(pigment), text.add(is_clear ? " transmit 0.5 }" : " }");
    add_finish(text, gain * ambient, gain, m, is_fresnel);
    text.add(" }\n");
  }
  if (!is_grey(m.specular)) {
    const double most = largest(m.specular);
    text.add("texture { pigment { "), text.color(m.specular / most), text.add(" transmit 1 }");
    text.add(" finish { ambient 0 diffuse 0 phong %.9g phong_size %.9g metallic 1 } }\n", most, m.shininess);
  }
  return text.str();
}

// A checker of whole textures, or of pigments alone where both cells glow alike: POV-Ray then knows that a surface is
// opaque, and its shadow rays end there.
std::string PovTextures::patterned(const std::string& name, const Material& m, const PovSurface& surface) {
  const auto* diffuse = std::get_if<Checker>(&m.diffuse);
  const auto* ambient = std::get_if<Checker>(&m.ambient);
  const double size = diffuse ? diffuse->size : ambient->size;
  const bool is_nested = diffuse && ambient && diffuse->size != ambient->size;
  PovText text;
  if (diffuse && m.ambient == m.diffuse && is_black(m.transmission) && is_grey(m.specular)) {
    text.add("texture { pigment { checker "), text.color(diffuse->a), text.add(" "), text.color(diffuse->b);
    add_cell_size(text, size, surface.flat_axis);
    text.add(" }");
    add_finish(text, scene_.ambient * exposure_, 1.0, m, false);
    text.add(" }\n");
    return text.str();
  }
  // Textures of several layers stand in a pattern by their names alone.
  const auto cell_name = [&](int i, int j) { return name + "Cell" + std::to_string(2 * i + j); };
  text.add("texture { checker");
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < (is_nested ? 2 : 1); ++j) {
      const Cell cell = cell_of(at(m.diffuse, i), at(m.ambient, is_nested ? j : i));
      declarations_.add("#declare " + cell_name(i, j) + " = " + plain(cell, m, surface));
    }
    if (is_nested) {
      text.add(" texture { checker texture { " + cell_name(i, 0) + " } texture { " + cell_name(i, 1) + " }");
      add_cell_size(text, ambient->size / size, 3);
      text.add(" }");
    } else {
      text.add(" texture { " + cell_name(i, 0) + " }");
    }
  }
  add_cell_size(text, size, surface.flat_axis);
  text.add(" }\n");
  return text.str();
}

std::string PovTextures::name_of(MaterialId material, const PovSurface& surface) {
  const Material& m = scene_.materials[material];
  const bool is_checkered = std::holds_alternative<Checker>(m.diffuse) || std::holds_alternative<Checker>(m.ambient);
  const auto key = std::tuple(material, surface.is_medium, is_checkered ? surface.flat_axis : 3);
  auto& name = names_[key];
  if (!name.empty()) return name;
  name = "Texture" + std::to_string(names_.size());
  const std::string layers =
      is_checkered ? patterned(name, m, surface) : plain(cell_of(at(m.diffuse, 0), at(m.ambient, 0)), m, surface);
  declarations_.add("#declare " + name + " = " + layers);
  return name;
}

}  // namespace tilelight
