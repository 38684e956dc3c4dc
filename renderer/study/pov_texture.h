// SPDX-License-Identifier: Apache-2.0
// PovTextures: materials as POV-Ray's textures. Every texture is declared once, where it is first asked for.
#pragma once

#include <map>
#include <string>
#include <tuple>

#include "renderer/scene/scene.h"
#include "renderer/study/pov_text.h"

namespace tilelight {

// How a body shows its material.
struct PovSurface {
  bool is_medium = true;  // encloses the medium; else light passes straight on
  // The axis that a checker does not count: 0, 1, 2; 3: none, its cells are cubes.
  int flat_axis = 3;
};

class PovTextures {
 public:
  // exposure: what all light is multiplied by.
  PovTextures(const Scene& scene, double exposure) : scene_(scene), exposure_(exposure) {}

  // The name of the declared texture. A checker's pattern is in units of Body::pattern_from_local.
  std::string name_of(MaterialId material, const PovSurface& surface);
  // All declarations so far.
  const std::string& declarations() const { return declarations_.str(); }

 private:
  // A place of a surface: what it reflects of light that falls on it, and what it sends out by itself.
  struct Cell {
    Color diffuse, glow;
  };
  Cell cell_of(const Color& diffuse, const Color& ambient) const;
  // Declares what it is put together from.
  std::string patterned(const std::string& name, const Material& material, const PovSurface& surface);
  std::string plain(const Cell& cell, const Material& material, const PovSurface& surface) const;

  const Scene& scene_;
  const double exposure_;
  std::map<std::tuple<MaterialId, bool, int>, std::string> names_;
  PovText declarations_;
};

}  // namespace tilelight
