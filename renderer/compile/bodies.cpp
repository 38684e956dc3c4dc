// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/bodies.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "renderer/base/double_double.h"
#include "renderer/base/safe_length.h"
#include "renderer/geometry/chess_set.h"
#include "renderer/geometry/self_touch.h"
#include "renderer/geometry/shells.h"

namespace tilelight {
namespace {

Mat4 translation(const Vec3& by) {
  Mat4 m(1.0);
  m[3] = Vec4(by, 1.0);
  return m;
}

Mat4 scaling(const Vec3& by) {
  Mat4 m(1.0);
  for (int i = 0; i < 3; ++i) m[i][i] = by[i];
  return m;
}

// The rotation that turns +Y to `normal`, with axes fixed by the normal alone.
Mat4 frame_of_plane(const PlaneShape& plane) {
  const Vec3 y = safe_normalize(plane.normal);
  const Vec3 helper =
      std::abs(y.x) < 0.9 * std::abs(y.y) || std::abs(y.x) < 0.9 * std::abs(y.z) ? Vec3(1, 0, 0) : Vec3(0, 0, 1);
  const Vec3 z = glm::normalize(glm::cross(helper, y));
  const Vec3 x = glm::cross(y, z);
  Mat4 m(1.0);
  m[0] = Vec4(x, 0.0), m[1] = Vec4(y, 0.0), m[2] = Vec4(z, 0.0), m[3] = Vec4(plane.point, 1.0);
  return m;
}

// Black's men look towards White: half a turn about +Y, exact.
Mat4 facing(Side side) { return side == Side::white ? Mat4(1.0) : scaling(Vec3(-1.0, 1.0, -1.0)); }

// |m * p - place| as exactly as two doubles a number can tell.
Vec3 distance_off(const Mat4& m, const Vec3& p, const Vec3& place) {
  Vec3 off(0.0);
  for (int row = 0; row < 3; ++row) {
    DoubleDouble exact{m[3][row], 0.0};
    for (int column = 0; column < 3; ++column) exact = exact + two_product(m[column][row], p[column]);
    off[row] = std::abs((exact.hi - place[row]) + exact.lo);
  }
  return off;
}

Vec3 rounding_of(const BoxShape& box, const Object& object, const Mat4& world_from_local) {
  Vec3 sides(0.0), out(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    sides[axis] = 0.5 * (std::abs(two_sum(box.min[axis], box.max[axis]).lo) +
                         std::abs(two_sum(box.max[axis], -box.min[axis]).lo));
  }
  for (int column = 0; column < 3; ++column) out += glm::abs(Vec3(object.world_from_shape[column])) * sides[column];
  const Vec3 middle = 0.5 * (box.min + box.max) - object.pivot;
  return out + distance_off(object.world_from_shape, middle, Vec3(world_from_local[3]));
}

struct GlassMesh {
  std::shared_ptr<const TriMesh> mesh;  // wound outwards
  bool has_volume = false, may_touch_itself = false;
};

class BodyMaker {
 public:
  explicit BodyMaker(const Scene& scene) : scene_(scene), meshes_(scene.meshes.size()) {}

  std::vector<Body> make() {
    for (index_ = 0; index_ < scene_.objects.size(); ++index_) {
      std::visit([this](const auto& shape) { place(shape); }, scene_.objects[index_].shape);
    }
    set_ranks(scene_, bodies_);
    return std::move(bodies_);
  }

 private:
  const Object& object() const { return scene_.objects[index_]; }

  Body& add(BodyKind kind, const Mat4& placement, MaterialId material, const std::string& part = {}) {
    Body body;
    body.kind = kind;
    Mat4 pivot_from_local = placement;
    pivot_from_local[3] -= Vec4(object().pivot, 0.0);
    body.world_from_local = object().world_from_shape * pivot_from_local;
    body.material = material;
    body.object = static_cast<uint32_t>(index_);
    body.name = "objects/" + std::to_string(index_) + (part.empty() ? "" : "/" + part);
    return bodies_.emplace_back(std::move(body));
  }

  void place(const SphereShape& sphere) {
    Body& body = add(BodyKind::sphere, translation(sphere.center) * scaling(Vec3(sphere.radius)), object().material);
    body.pattern_from_local = scaling(Vec3(sphere.radius));
  }

  void place(const BoxShape& box) { add_box(box, object().material, {}); }

  void add_box(const BoxShape& box, MaterialId material, const std::string& part) {
    Body& body = add(BodyKind::box, translation(0.5 * (box.min + box.max)), material, part);
    body.half = 0.5 * (box.max - box.min);
    body.rounding = rounding_of(box, object(), body.world_from_local);
    body.has_inside = std::min({body.half.x, body.half.y, body.half.z}) > 0.0;
  }

  void place(const PlaneShape& plane) {
    add(BodyKind::plane, frame_of_plane(plane), object().material).has_inside = false;
  }

  void place(const MeshShape& shape) {
    auto& mesh = meshes_[shape.mesh];
    if (!mesh) mesh = std::make_shared<const TriMesh>(make_tri_mesh(scene_.meshes[shape.mesh]));
    set_mesh(add(BodyKind::mesh, Mat4(1.0), object().material), mesh);
  }

  void set_mesh(Body& body, const std::shared_ptr<const TriMesh>& mesh) {
    body.mesh = mesh;
    body.has_inside = mesh->closed;
    if (!mesh->closed || scene_.materials[body.material].transmission == Color(0.0)) return;
    const GlassMesh& glass = glass_mesh(mesh);
    body.mesh = glass.mesh;
    body.has_inside = glass.has_volume;
    body.is_turned = glass.mesh != mesh;
    body.may_touch_itself = glass.may_touch_itself;
  }

  // A closed mesh as transparent bodies wear it: light is bent by which side is the inner one.
  const GlassMesh& glass_mesh(const std::shared_ptr<const TriMesh>& mesh) {
    GlassMesh& glass = glass_meshes_[mesh.get()];
    if (glass.mesh) return glass;
    const Shells shells = find_shells(*mesh);
    glass.has_volume = holds_volume(shells);
    glass.may_touch_itself =
        !mesh->is_manifold || shells.volume.size() > 1 || (!mesh->is_known_outward && touches_itself(*mesh));
    const std::vector<bool> is_turned = find_inside_out(*mesh, shells);
    glass.mesh = is_turned.empty() ? mesh : std::make_shared<const TriMesh>(with_turned(*mesh, is_turned));
    return glass;
  }

  void place(const ChessPieceShape& shape) {
    set_mesh(add(BodyKind::mesh, translation(shape.position) * facing(shape.side), object().material),
             piece(shape.piece, shape.detail));
  }

  void place(const ChessPositionShape& position) {
    const auto material = [&](ChessRole role) { return position.materials[static_cast<size_t>(role)]; };
    const auto square_name = [](int rank, int file) {
      return std::string{static_cast<char>('a' + file), static_cast<char>('1' + rank)};
    };
    const auto middle = [](int rank, int file) { return Vec3(file - 3.5, 0.0, 3.5 - rank); };
    for (int rank = 0; rank < 8; ++rank) {
      for (int file = 0; file < 8; ++file) {
        const Vec3 c = middle(rank, file);
        const bool is_light = (rank + file) % 2 == 1;
        add_box({c - Vec3(0.5, kBoardThickness, 0.5), c + Vec3(0.5, 0.0, 0.5)},
                material(is_light ? ChessRole::light : ChessRole::dark), "square/" + square_name(rank, file));
      }
    }
    set_mesh(add(BodyKind::mesh, Mat4(1.0), material(ChessRole::frame), "frame"), frame());
    for (int rank = 0; rank < 8; ++rank) {
      for (int file = 0; file < 8; ++file) {
        const auto& man = position.squares[rank][file];
        if (!man) continue;
        set_mesh(add(BodyKind::mesh, translation(middle(rank, file)) * facing(man->side),
                     material(man->side == Side::white ? ChessRole::white : ChessRole::black), square_name(rank, file)),
                 piece(man->piece, position.detail));
      }
    }
  }

  std::shared_ptr<const TriMesh> piece(Piece piece, int detail) {
    auto& mesh = pieces_[{piece, detail}];
    if (!mesh) mesh = std::make_shared<const TriMesh>(make_chess_piece(piece, detail));
    return mesh;
  }

  std::shared_ptr<const TriMesh> frame() {
    if (!frame_) frame_ = std::make_shared<const TriMesh>(make_board_frame());
    return frame_;
  }

  const Scene& scene_;
  size_t index_ = 0;
  std::vector<Body> bodies_;
  std::vector<std::shared_ptr<const TriMesh>> meshes_;  // by Scene::meshes
  std::map<const TriMesh*, GlassMesh> glass_meshes_;    // of those above and below
  std::map<std::pair<Piece, int>, std::shared_ptr<const TriMesh>> pieces_;
  std::shared_ptr<const TriMesh> frame_;
};

}  // namespace

std::vector<Body> make_bodies(const Scene& scene) { return BodyMaker(scene).make(); }

}  // namespace tilelight
