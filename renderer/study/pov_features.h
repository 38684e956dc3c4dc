// SPDX-License-Identifier: Apache-2.0
// What of the scene language POV-Ray 3.7 can say: one table. Its rows name every property of the language; those that
// POV-Ray draws otherwise have the note that a report then shows.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/compile/bodies.h"
#include "renderer/study/pov_space.h"

namespace tilelight {

enum class PovSupport {
  exact,        // drawn alike, but for rounding
  approximate,  // something near stands for it
  missing       // left out
};

// A scene on its way to POV-Ray.
struct PovSubject {
  const Scene& scene;
  const View& view;  // with its camera
  const std::vector<Body>& bodies;
  const PovSpace& space;
};

struct PovFeature {
  std::string_view name;  // the note begins with it
  std::string_view keys;  // "record.key" as the grammar names them, with spaces between
  PovSupport support = PovSupport::exact;
  std::string_view difference{};                 // empty where there is none
  bool (*is_used)(const PovSubject&) = nullptr;  // of what is not exact
};

std::span<const PovFeature> pov_features();

// What the picture of this scene will have otherwise, as sentences; empty if nothing.
std::vector<std::string> pov_notes(const PovSubject& subject);

}  // namespace tilelight
