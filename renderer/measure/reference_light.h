// SPDX-License-Identifier: Apache-2.0
// The light equation of the reference renderer: what a surface sends to the viewer by itself, without mirrors and
// glass. Pure; any thread.
#pragma once

#include "renderer/measure/reference_scene.h"

namespace tilelight::reference {

// A hit turned toward its viewer.
struct ShadingPoint {
  Hit hit;
  Vec3 point;      // world
  Vec3 to_viewer;  // unit
  Vec3 geometric;  // unit; geometric . to_viewer >= 0
  Vec3 shading;    // unit; on the side of `geometric`
  bool is_inside;  // the viewer is on the inner side
};
ShadingPoint shading_point(const ReferenceBody& body, const Hit& hit, const Vec3& direction);

// cos(angle)^n between two unit vectors with a positive cosine, exact for huge n: 1 - R.V = |R - V|^2 / 2 does not
// cancel.
double phong_lobe(const Vec3& r, const Vec3& v, double n);

// The colour of a paint at a hit.
Color paint_at(const ReferenceBody& body, const Hit& hit, const Paint& paint);

// Ia ka + sum of vis Il (kd N.L + ks (R.V)^n) / (d + K), linear RGB.
Color local_light(const ReferenceScene& scene, const ShadingPoint& at, const RenderSpec& render);

Color background_at(const Background& background, const Vec3& direction);

}  // namespace tilelight::reference
