// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/scene/build.h"
#include "renderer/scene/chess_budget.h"
#include "renderer/scene/readers.h"
#include "renderer/scene/transform.h"

namespace tilelight {
namespace {

constexpr std::string_view kStartingPosition = "rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR";

// Builds one object after the other and adds up what they cost.
class ObjectBuilder {
 public:
  ObjectBuilder(const MeshTable& meshes, MaterialTable& materials, const Limits& limits, Problems& problems)
      : meshes_(meshes), materials_(materials), limits_(limits), problems_(problems) {}

  Object build(Value value) {
    const std::string type = read_text(value, "type");
    Object object;
    object.name = read_text(value, "name");
    Vec3 center(0.0);
    if (type == "sphere") {
      center = build_sphere(value, object);
    } else if (type == "cube") {
      center = build_cube(value, object);
    } else if (type == "box") {
      center = build_box(value, object);
    } else if (type == "plane") {
      center = build_plane(value, object);
    } else if (type == "mesh") {
      build_mesh(value, object);
    } else if (type == "chess_piece") {
      center = build_chess_piece(value, object);
    } else {
      build_chess_position(value, object);
    }
    read_transform(value, center, object, problems_);
    return object;
  }

  bool any_visible() const { return any_visible_; }

 private:
  // These fill in the shape and the material, and answer the center.

  Vec3 build_sphere(Value value, Object& object) {
    SphereShape sphere;
    sphere.center = read_vector(value, "center", sphere.center);
    sphere.radius = read_number(value, "radius", sphere.radius);
    object.shape = sphere;
    object.material = plain_material(value);
    return sphere.center;
  }

  Vec3 build_cube(Value value, Object& object) {
    const Vec3 center = read_vector(value, "center", Vec3(0.0));
    const Vec3 half(0.5 * read_number(value, "size", 1.0));
    object.shape = BoxShape{center - half, center + half};
    object.material = plain_material(value);
    return center;
  }

  Vec3 build_box(Value value, Object& object) {
    BoxShape box;
    box.min = read_vector(value, "min", box.min);
    box.max = read_vector(value, "max", box.max);
    int flat_axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (box.min[axis] > box.max[axis]) report_inverted_box(value, axis, box);
      if (box.min[axis] == box.max[axis]) ++flat_axes;
    }
    if (flat_axes > 1)
      problems_.warn(value, "empty_box", "the box is flat along more than one axis and has no surface");
    object.shape = box;
    object.material = plain_material(value, flat_axes <= 1);
    return 0.5 * box.min + 0.5 * box.max;
  }

  Vec3 build_plane(Value value, Object& object) {
    PlaneShape plane;
    plane.point = read_vector(value, "point", plane.point);
    plane.normal = read_vector(value, "normal", plane.normal);
    object.shape = plane;
    object.material = plain_material(value);
    return plane.point;
  }

  void build_mesh(Value value, Object& object) {
    MeshShape shape;
    bool visible = true;
    if (const Value name = find_accepted(value, "mesh")) {
      const auto mesh = meshes_.by_name.find(name.text());
      if (mesh == meshes_.by_name.end()) {
        if (problems_.full()) return;
        std::string hint = meshes_.names.empty() ? "the scene has no meshes" : did_you_mean(name.text(), meshes_.names);
        problems_.add(
            name,
            {"unknown_name", "found no mesh " + in_quotes(name.text()) + " under \"meshes\"", {}, std::move(hint)});
      } else {
        shape.mesh = mesh->second;
        visible = meshes_.is_visible[mesh->second];
        spend(value, static_cast<int64_t>(meshes_.meshes[mesh->second].indices.size() / 3));
      }
    }
    object.shape = shape;
    object.material = plain_material(value, visible);
  }

  Vec3 build_chess_piece(Value value, Object& object) {
    ChessPieceShape shape;
    shape.piece = read_word(value, "piece", kPieces, shape.piece);
    shape.side = read_word(value, "color", kSides, shape.side);
    shape.position = read_vector(value, "position", shape.position);
    shape.detail = read_int(value, "detail", shape.detail);
    spend(value, chess_piece_triangle_bound(shape.detail));
    object.material =
        materials_.find_chess(value, "material", shape.side == Side::white ? ChessRole::white : ChessRole::black);
    object.shape = shape;
    any_visible_ = true;
    return shape.position;
  }

  void build_chess_position(Value value, Object& object) {
    const Value fen = find_accepted(value, "fen");
    auto parsed = parse_fen(fen ? fen.text() : kStartingPosition);
    ChessPositionShape shape;
    if (parsed) {
      shape.squares = parsed->squares;
      for (std::string& sentence : parsed->left_out) problems_.warn(fen, "fen_left_out", std::move(sentence));
    } else {
      problems_.add(fen, {"bad_fen", parsed.error(), {}, "as in \"" + std::string(kStartingPosition) + "\""});
    }
    shape.detail = read_int(value, "detail", shape.detail);
    int64_t men = 0;
    for (const auto& rank : shape.squares) {
      men += std::count_if(rank.begin(), rank.end(), [](const auto& square) { return square.has_value(); });
    }
    spend(value, men * chess_piece_triangle_bound(shape.detail) + kBoardTriangleBound);
    const Value overrides = find_accepted(value, "materials");
    for (const auto& role : kChessRoleNames) {
      shape.materials[static_cast<size_t>(role.value)] = materials_.find_chess(overrides, role.name, role.value);
    }
    object.shape = shape;
    any_visible_ = true;
  }

  MaterialId plain_material(Value value, bool visible = true) {
    any_visible_ |= visible;
    return materials_.find(value, "material", MaterialTable::kDefault);
  }

  void report_inverted_box(Value value, int axis, const BoxShape& box) {
    const Value culprit = value.find("max") ? value.find("max") : value.find("min");
    problems_.add(culprit, {"out_of_range",
                            "found min " + number_text(box.min[axis]) + " above max " + number_text(box.max[axis]) +
                                " along " + std::string(1, static_cast<char>('x' + axis)) + "; allowed: min <= max",
                            {},
                            "swap the two"});
  }

  // Counts triangles as they will be after instancing; the object that crosses the limit is reported, once.
  void spend(Value value, int64_t triangles) {
    const bool was_over = spent_ > limits_.instanced_triangles;
    spent_ += triangles;
    if (was_over || spent_ <= limits_.instanced_triangles) return;
    problems_.add(value,
                  {"limit",
                   "found up to " + std::to_string(spent_) + " triangles in the objects up to this one; allowed: " +
                       std::to_string(limits_.instanced_triangles) + " (limit instanced_triangles)",
                   {},
                   "use less `detail` or fewer copies"});
  }

  const MeshTable& meshes_;
  MaterialTable& materials_;
  const Limits& limits_;
  Problems& problems_;
  int64_t spent_ = 0;
  bool any_visible_ = false;
};

}  // namespace

std::vector<Object> build_objects(Value objects, const MeshTable& meshes, MaterialTable& materials,
                                  const Limits& limits, Problems& problems) {
  std::vector<Object> built;
  if (!objects || objects.is_rejected()) return built;
  ObjectBuilder builder(meshes, materials, limits, problems);
  bool all_usable = true;
  built.reserve(objects.size());
  for (const Value value : objects.children()) {
    // Without its type nothing can be said of an object; missing members leave the rest readable.
    const Value type = value.is(JsonKind::object) ? find_accepted(value, "type") : Value();
    if (type) {
      built.push_back(builder.build(value));
    } else {
      all_usable = false;
    }
  }
  if (all_usable && !builder.any_visible()) {
    problems.add(objects, {"no_visible_object", "found no object with a surface; allowed: at least one", {}, ""});
  }
  return built;
}

}  // namespace tilelight
