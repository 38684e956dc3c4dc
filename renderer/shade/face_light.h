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

  // What light number `light` of the scene brings to a hit; the way to the light is that of the hit's own place.
  // REQUIRES: flat or gouraud, and no plane. viewer: as way_to_viewer has him. What is found for the viewer at the eye
  // is kept for some faces, so that neighbouring pixels share it.
  LightSample sample(const Hit& hit, const Surface& surface, const Vec4& viewer, bool is_primary, size_t light);

 private:
  static constexpr int kMostCorners = 4;
  struct Brought {
    Color arriving{0.0}, diffuse{0.0}, specular{0.0};  // by one light, to one corner
    bool is_lit = false;
  };
  using Corners = std::array<Brought, kMostCorners>;
  struct Face {
    uint32_t body = kNone, prim = kNone;
    size_t light = 0;
    Corners brought;  // by that light
  };

  int corners_of(const CompiledBody& body) const;
  LocalPoint corner(const CompiledBody& body, uint32_t prim, int index) const;
  std::array<double, kMostCorners> weights_of(const CompiledBody& body, const Hit& hit, const Vec3& position) const;
  void light_corners(const Hit& hit, const Vec4& viewer, const CompiledLight& light, Corners& brought) const;
  const Corners& kept_corners(const Hit& hit, const Vec4& viewer, size_t light);

  const CompiledScene& scene_;
  const Shading shading_;
  const bool smooth_terminator_;
  std::vector<Face> kept_;  // by a hash of the face and the light; primary rays alone have one viewer
  Corners brought_;         // to what another viewer looks at
};

}  // namespace tilelight
