// SPDX-License-Identifier: Apache-2.0
// The frame of the board: a moulding run around the 64 squares and mitred at the corners.
#include "renderer/geometry/chess_set.h"
#include "renderer/geometry/mesh_builder.h"
#include "renderer/geometry/profile.h"

namespace tilelight {
namespace {

constexpr int kDetail = 96;  // of the moulding's curves; the frame is seen close by
constexpr double kInner = 4.0;

// The moulding in the plane (distance from the middle, y), around from its inner foot and back to it.
Profile moulding() {
  const double foot = -kBoardThickness - kFrameFoot;
  Profile profile({kInner, foot}, kDetail);
  profile.line_to({4.50, foot}).line_to({4.50, -kBoardThickness});  // a recessed foot
  profile.line_to({4.585, -kBoardThickness});
  profile.arc_to({4.585, -0.072}, 180.0);  // a bead
  profile.line_to({4.572, -0.072});
  profile.curve_to({4.572, -0.030}, {4.525, -0.034}, {4.515, 0.004});  // a cyma up to the edge
  profile.line_to({4.500, 0.004});
  profile.arc_to({4.476, 0.022}, 90.0);  // the rounded edge of the flat
  profile.line_to({4.085, 0.022});
  profile.arc_to({4.070, 0.014}, -60.0);  // a quirk beside the inner bead
  profile.line_to({4.062, 0.014});
  profile.arc_to({4.010, 0.004}, 130.0);
  profile.line_to({kInner, 0.004}).line_to({kInner, foot});
  return profile;
}

}  // namespace

TriMesh make_board_frame() {
  MeshBuilder mesh;
  const Profile profile = moulding();
  // The side towards `out`, between the mitres with the sides to its left and right as seen from outside.
  const auto add_side = [&](const ProfileRun& run, const Vec3& out) {
    const Vec3 right = glm::cross(Vec3(0.0, 1.0, 0.0), out);
    std::vector<SurfacePoint> points;
    for (const ProfilePoint& p : run) {
      const Vec3 normal = p.normal.x * out + Vec3(0.0, p.normal.y, 0.0);
      for (const double side : {-1.0, 1.0})
        points.push_back({p.position.x * (out + side * right) + Vec3(0.0, p.position.y, 0.0), normal});
    }
    mesh.add_grid(points, 2);
  };
  for (const ProfileRun& run : profile.runs())
    for (const Vec3& out : {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(-1, 0, 0), Vec3(0, 0, -1)}) add_side(run, out);
  return mesh.finish();
}

}  // namespace tilelight
