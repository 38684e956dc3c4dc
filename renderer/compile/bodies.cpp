// SPDX-License-Identifier: Apache-2.0
#include "renderer/compile/bodies.h"

#include <map>
#include <utility>

#include "renderer/base/facet.h"
#include "renderer/geometry/chess_set.h"

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
  const Vec3 y = unit_or_zero(plane.normal);
  const Vec3 helper = std::abs(y.x) < 0.9 * std::abs(y.y) || std::abs(y.x) < 0.9 * std::abs(y.z) ? Vec3(1, 0, 0)
                                                                                                  : Vec3(0, 0, 1);
  const Vec3 z = glm::normalize(glm::cross(helper, y));
  const Vec3 x = glm::cross(y, z);
  Mat4 m(1.0);
  m[0] = Vec4(x, 0.0), m[1] = Vec4(y, 0.0), m[2] = Vec4(z, 0.0), m[3] = Vec4(plane.point, 1.0);
  return m;
}

// Black's men look towards White: half a turn about +Y, exact.
Mat4 facing(Side side) { return side == Side::white ? Mat4(1.0) : scaling(Vec3(-1.0, 1.0, -1.0)); }

class BodyMaker {
 public:
  explicit BodyMaker(const Scene& scene) : scene_(scene), meshes_(scene.meshes.size()) {}

  std::vector<Body> make() {
    for (index_ = 0; index_ < scene_.objects.size(); ++index_) {
      std::visit([this](const auto& shape) { place(shape); }, scene_.objects[index_].shape);
    }
    return std::move(bodies_);
  }

 private:
  const Object& object() const { return scene_.objects[index_]; }

  Body& add(BodyKind kind, const Mat4& placement, MaterialId material, const std::string& part = {}) {
    Body body;
    body.kind = kind;
    body.world_from_local = object().world_from_shape * placement;
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
    add(BodyKind::box, translation(0.5 * (box.min + box.max)), material, part).half = 0.5 * (box.max - box.min);
  }

  void place(const PlaneShape& plane) { add(BodyKind::plane, frame_of_plane(plane), object().material); }

  void place(const MeshShape& shape) {
    auto& mesh = meshes_[shape.mesh];
    if (!mesh) mesh = std::make_shared<const TriMesh>(make_tri_mesh(scene_.meshes[shape.mesh]));
    add(BodyKind::mesh, Mat4(1.0), object().material).mesh = mesh;
  }

  void place(const ChessPieceShape& shape) {
    add(BodyKind::mesh, translation(shape.position) * facing(shape.side), object().material).mesh =
        piece(shape.piece, shape.detail);
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
    add(BodyKind::mesh, Mat4(1.0), material(ChessRole::frame), "frame").mesh = frame();
    for (int rank = 0; rank < 8; ++rank) {
      for (int file = 0; file < 8; ++file) {
        const auto& man = position.squares[rank][file];
        if (!man) continue;
        add(BodyKind::mesh, translation(middle(rank, file)) * facing(man->side),
            material(man->side == Side::white ? ChessRole::white : ChessRole::black), square_name(rank, file))
            .mesh = piece(man->piece, position.detail);
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
  std::map<std::pair<Piece, int>, std::shared_ptr<const TriMesh>> pieces_;
  std::shared_ptr<const TriMesh> frame_;
};

}  // namespace

std::vector<Body> make_bodies(const Scene& scene) { return BodyMaker(scene).make(); }

}  // namespace tilelight
