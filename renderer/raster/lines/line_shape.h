// SPDX-License-Identifier: Apache-2.0
// LineShape: the faces and edges of a mesh or of a box, as far as they do not depend on where the body stands. Shared
// by all instances. Immutable; any thread may read.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/compile/compiled_scene.h"

namespace tilelight::lines {

inline constexpr uint32_t kNoFace = ~uint32_t{0};

struct LineFace {
  std::array<uint32_t, 4> vertex{};  // counter-clockwise from outside
  uint32_t corners = 3;
};

// What the mesh's own normals say of an edge. Where it has none the angle between the faces decides.
enum class Sharpness : uint8_t { by_angle, smooth, sharp };

struct LineEdge {
  std::array<uint32_t, 2> vertex{};
  std::array<uint32_t, 2> face{kNoFace, kNoFace};  // the second is none at a border, and where more than two faces meet
  bool is_turned = false;  // both faces run along it the same way: one of them shows its other side
  Sharpness sharpness = Sharpness::by_angle;
};

struct LineShape {
  std::vector<LineFace> faces;
  std::vector<LineEdge> edges;
  bool is_outward = false;  // closed, with every part's normals outward: its back faces hide nothing that its front
                            // faces leave visible
  bool is_convex = false;   // implies is_outward
};

LineShape make_mesh_shape(const CompiledMesh& mesh);

// Of a box: bit k of a vertex says on which side along axis k it lies; faces are 2 * axis, + 1 on the positive side.
LineShape make_box_shape();

}  // namespace tilelight::lines
