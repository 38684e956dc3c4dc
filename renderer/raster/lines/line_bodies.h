// SPDX-License-Identifier: Apache-2.0
// LineBodies: a scene's bodies placed before the eye. Immutable after construction; any thread may read.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "renderer/raster/lines/line_shape.h"
#include "renderer/raster/lines/line_view.h"

namespace tilelight::lines {

// A convex polygon; triangles, quads and quads less a corner.
struct Polygon {
  std::array<Vec3, 5> corner;
  int corners = 0;
};

struct FaceId {
  uint32_t body = ~uint32_t{0}, face = kNoFace;
  bool operator==(const FaceId&) const = default;
};

// A finite body in view space.
struct LineBody {
  const LineShape* shape = nullptr;  // none: nothing of it is drawn
  std::vector<Vec3> points;
  std::vector<Vec3> normals;   // of the faces; unit, outward; zero where a face has none
  std::vector<int8_t> facing;  // of the faces: 1 towards the eye, -1 away, 0 seen edge-on
  Vec3 lo{0.0}, hi{0.0};       // its bounds
  bool is_whole = false;       // hides as one convex body, else by its faces
  bool hides_backs = false;    // what faces away is hidden by what faces the eye
  bool is_cut = false;         // by the image plane of an orthographic eye, behind which nothing is seen
  bool is_mirrored = false;    // the corners of its faces run clockwise seen from outside

  // The seen side of a face, counter-clockwise as the eye sees it.
  Polygon polygon(uint32_t face) const;
};

struct LinePlane {
  uint32_t body = 0;
  HalfSpace above;  // unit normal in view space
};

struct LineBodies {
  std::vector<LineBody> finite;  // by index of CompiledScene::bodies
  std::vector<LinePlane> planes;
  std::map<const CompiledMesh*, std::unique_ptr<const LineShape>> shapes;  // null key: the box

  bool is_whole(const FaceId& id) const { return id.body < finite.size() && finite[id.body].is_whole; }
};

LineBodies place_bodies(const CompiledScene& scene, const LineView& view, TilePool& pool);

}  // namespace tilelight::lines
