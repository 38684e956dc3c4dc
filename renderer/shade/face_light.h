// SPDX-License-Identifier: Apache-2.0
// FaceLight: flat and Gouraud shading. The light equation is evaluated once a face, at its middle, or at its corners,
// with paint of 1; what comes out is interpolated in space (so perspectively right) and multiplied by the paint at the
// point itself, which a checker needs. Every light on its own, so that shadows still fall by the point. Triangles have
// three corners and a box's face four; a plane has no end and so no corners: it is lit by the point. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/shade/light_equation.h"

namespace tilelight {

class FaceLight {
 public:
  // smooth_terminator: the light of faces with interpolated normals ends where these turn away from it.
  FaceLight(const CompiledScene& scene, Shading shading, bool smooth_terminator);

  // REQUIRES: flat or gouraud, and no plane. Lights the face of a hit for a viewer (xyz: his place, w 1; or the way to
  // him, w 0). Keeps what it has found for the viewer at `eye` faces ago, so that neighbouring pixels share it.
  void look_at(const Hit& hit, const Surface& surface, const Vec4& viewer, bool is_primary);

  // What light number i of the scene brings to the point last looked at; the way to the light is that of the point.
  LightSample sample(size_t light) const;

 private:
  static constexpr int kMostCorners = 4;
  struct Brought {
    Color arriving{0.0}, diffuse{0.0}, specular{0.0};  // by one light, to one corner
    bool is_lit = false;
  };
  struct Face {
    uint32_t body = kNone, prim = kNone;
    std::vector<Brought> brought;  // by corner, and by light
  };

  int corners_of(const CompiledBody& body) const;
  LocalPoint corner(const CompiledBody& body, uint32_t prim, int index) const;
  void find_weights(const CompiledBody& body, const Hit& hit, const Surface& surface);
  void light_corners(const Hit& hit, const Vec4& viewer, Face& face) const;

  const CompiledScene& scene_;
  const Shading shading_;
  const bool smooth_terminator_;
  std::vector<Face> kept_;  // by a hash of the face; primary rays alone have one viewer
  Face other_;
  const Face* face_ = nullptr;
  const Surface* surface_ = nullptr;
  int corners_ = 0;
  std::array<double, kMostCorners> weights_{};
};

}  // namespace tilelight
