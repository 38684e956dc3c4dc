// SPDX-License-Identifier: Apache-2.0
// The terminator: where the light ends on a rounded surface, a facet of a mesh whose normals stand for a curved one.
// Shading ends where the normals turn away from the light; the facets end it too early, and in steps. The rule here,
// which README.md tells with its reasons and its limits: light comes straight to a facet, and whatever it meets casts a
// shadow; only where facets of the same curve hide it that are lit from behind does it come over the curve (Hanika
// 2021, Hacking the Shadow Terminator, Ray Tracing Gems II ch. 4) and down to the facet. What comes from behind a facet
// that no curve lies above comes through it. Pure; any thread.
#pragma once

#include "renderer/compile/compiled_scene.h"
#include "renderer/shade/ray.h"

namespace tilelight {

// A curve that lies less than this above its facet, in normalised units, is rounding.
inline constexpr double kLeastLift = 0x1p-36;

// How far along a shadow ray facets may hide light from a facet that faces it though the curve that they stand for does
// not: those next to it, where they rise towards the light. Normalised units; 0: nowhere. REQUIRES: a rounded facet.
// geometric_normal: its own, towards the viewer.
double reach_of_facets(const CompiledScene& scene, const Departure& facet, const Vec3& geometric_normal,
                       const Vec3& to_light);

// Whether a shadow ray meets such a facet: with a corner in common, on the same side, and by its normals lit from
// behind.
bool is_lit_from_behind(const CompiledScene& scene, const Ray& shadow, const Vec3& geometric_normal, const Hit& met);

}  // namespace tilelight
