// SPDX-License-Identifier: Apache-2.0
// Whether a mesh touches itself: as a slit without width does, though its facets form one closed surface. Pure; any
// thread.
#pragma once

#include "renderer/geometry/tri_mesh.h"

namespace tilelight {

// Whether two facets lie in one plane and over each other, nearer than a millionth of the mesh's size. Facets that
// cross share a line alone, which no ray meets. Time n log n; a mesh of so many facets beside each other that it would
// take longer is said to touch itself.
bool touches_itself(const TriMesh& mesh);

}  // namespace tilelight
