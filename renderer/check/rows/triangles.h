// SPDX-License-Identifier: Apache-2.0
// The rows of T by file; triangles.cpp lists them.
#pragma once

#include "renderer/check/check.h"

namespace tilelight::check {

// triangles_edges.cpp: rays against meshes
Outcome edges_and_vertices(const Context& context);
Outcome sliver_fan(const Context& context);
Outcome giant_triangle(const Context& context);
Outcome needle_triangles(const Context& context);
Outcome squeezed_instance(const Context& context);
Outcome seam_of_meshes(const Context& context);

// triangles_shapes.cpp: pictures of odd and small meshes
Outcome degenerate_triangles(const Context& context);
Outcome not_a_manifold(const Context& context);
Outcome small_mesh(const Context& context);

// triangles_many.cpp: trees over what no plane can part
Outcome coincident_triangles(const Context& context);
Outcome stadium(const Context& context);

}  // namespace tilelight::check
