// SPDX-License-Identifier: Apache-2.0
// T: meshes aimed at where triangles meet, slivers, degenerate and giant ones.
#include "renderer/check/rows/triangles.h"

namespace tilelight::check {
namespace {

constexpr Row kRows[] = {
    {"T1", "edges and vertices of a closed mesh", "1280 triangles, offsets to 1e7 radii, sizes 1e-15 to 1e15",
     "Moeller-Trumbore in float, where the mesh stands", edges_and_vertices},
    {"T2", "coplanar fan of slivers", "1000 triangles, aspect 1e6", "Moeller-Trumbore in float", sliver_fan},
    {"T3", "degenerate triangles", "30 % of the mesh: no area, collinear, an index or a vertex twice",
     "vertex normals as the mean of facet normals, each divided by its length", degenerate_triangles},
    {"T4", "not a manifold", "5 faces an edge, open, faces flipped", "inside or outside by parity", not_a_manifold},
    {"T5", "giant triangle", "vertices at 1e7, the eye 1 above", "Moeller-Trumbore and Baldwin-Weber in float",
     giant_triangle},
    {"T6", "small mesh", "a unit mesh times 1e-3 to 1e-12", "a determinant under 1e-6 is a miss; fixed offset 1e-3",
     small_mesh},
    {"T7", "triangles in one place", "1e5 coincident ones; 1e5 with one centroid", "midpoint split of the centroids",
     coincident_triangles},
    {"T8", "teapot in a stadium", "spheres of radius 2^-k at 2^-k * 3, k = 0..60", "float, fixed offset 1e-4", stadium},
    {"T9", "needle", "a closed tube of triangles with aspect 1e8", "Moeller-Trumbore in float without an epsilon",
     needle_triangles},
    {"T10", "squeezed instance", "a closed mesh scaled by (1e-8, 1, 1e8)",
     "Moeller-Trumbore in float on transformed vertices", squeezed_instance},
    {"T11", "a seam between two meshes", "halves of a ball, instances scaled by 1/2 and 2",
     "Moeller-Trumbore in float without an epsilon", seam_of_meshes},
};

}  // namespace

std::span<const Row> triangle_rows() { return kRows; }

}  // namespace tilelight::check
