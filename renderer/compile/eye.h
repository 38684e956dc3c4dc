// SPDX-License-Identifier: Apache-2.0
// Eye: a camera made ready to shoot primary rays, in the scene's normalised space, double. Plain value; any thread.
#pragma once

#include "renderer/base/vec.h"
#include "renderer/scene/scene.h"

namespace tilelight {

struct Eye {
  Projection projection = Projection::perspective;
  Vec3 origin{0.0};
  Vec3 forward{0.0, 0.0, -1.0};  // unit
  // The image plane: a point (x, y) of the image, in pixels from its top left corner, lies at
  // corner + x * step_x + y * step_y, as a direction (perspective) or as an offset of the origin (orthographic).
  Vec3 corner{0.0}, step_x{0.0}, step_y{0.0};
};

// center, units: of the normalised space. An up vector along the view falls back to the world axis least aligned with it.
Eye make_eye(const Camera& camera, int width, int height, const Vec3& center, double units);

// REQUIRES: camera.position != camera.target.
bool is_up_along_view(const Camera& camera);

}  // namespace tilelight
