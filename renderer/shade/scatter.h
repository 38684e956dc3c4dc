// SPDX-License-Identifier: Apache-2.0
// Scatter: the mirror and the refracted ray that leave a surface, and their weights. Pure; any thread.
#pragma once

#include "renderer/shade/surface.h"

namespace tilelight {

// The mirror direction about the shading normal; about the geometric one where that would lead under the surface.
Vec3 mirror_direction(const Surface& surface, const Vec3& incoming);

struct Scatter {
  Vec3 mirrored{0.0}, refracted{0.0};  // unit
  Color mirror_weight{0.0}, refract_weight{0.0};
};

// A transparent surface without an inside: kr, and kt straight on.
Scatter scatter_thin(const Surface& surface, const Vec3& incoming);

// A surface of a medium. ior_before, ior_after: of the media on this and on the other side.
// Snell's law; total internal reflection sends kr + kt into the mirror direction. With Material::fresnel the weights
// are kr F and kt (1 - F), F the reflectance of unpolarised light, 1 in total reflection. is_smooth: the normal is
// interpolated, and the facet stands for a curved surface, which total reflection must not mistake (see scatter.cpp).
Scatter scatter_transparent(const Surface& surface, const Vec3& incoming, double ior_before, double ior_after,
                            bool is_smooth);

}  // namespace tilelight
