// SPDX-License-Identifier: Apache-2.0
// The chapters of the language on objects and meshes.
#include "renderer/scene/fen.h"
#include "renderer/scene/grammar_rules.h"

namespace tilelight {
namespace {

constexpr double kMinDetail = 8, kMaxDetail = 512;  // as renderer/geometry makes pieces

Field name_field() { return {"name", text_rule(), "Name", "For people; the image does not depend on it."}; }

Rule material_rule(const std::shared_ptr<const Record>& material) {
  Rule rule = any_of({text_rule(), record_rule(material)});
  rule.shared_name = "material_or_name";
  return rule;
}

Field material_field(const std::shared_ptr<const Record>& material) {
  return {"material", material_rule(material), "Material",
          "A name under `materials`, or a material. Absent: plain grey."};
}

Field detail_field() {
  return {"detail", whole_rule(kMinDetail, kMaxDetail), "Detail", "Segments around a piece's axis.", "48"};
}

std::vector<Field> transform_fields() {
  Range factor = kAnyNumber;
  factor.nonzero = true;
  Rule scale = any_of({number_rule(factor), numbers_rule(factor, {3, 3})});
  scale.shared_name = "scale";
  Rule quaternion = numbers_rule(kAnyNumber, {4, 4});
  quaternion.nonzero_vector = true;
  Rule rotation = record_rule({"rotation",
                               "A rotation about an axis",
                               {{"axis", direction_rule(), "Axis", "Need not be of unit length.", "", Need::required},
                                {"angle", number_rule({.min = -1e9, .max = 1e9}), "Angle",
                                 "Degrees, counter-clockwise seen against the axis.", "", Need::required}}});
  return {{"scale", scale, "Scale about the object's pivot", "Done first; one factor or three."},
          {"rotate_deg", rotation, "Rotation about the object's pivot", "Done after the scale."},
          {"rotate_quat", quaternion, "Rotation about the object's pivot as a quaternion",
           "x, y, z, w; need not be of unit length."},
          {"translate", vector_rule(), "Translation", "Scene units; done last.", "[0, 0, 0]"},
          {"matrix", numbers_rule(kAnyNumber, {16, 16}), "Transform as a 4x4 matrix",
           "Column-major and affine, about the world's origin; excludes the other transforms."}};
}

std::shared_ptr<const Record> object_record(std::string_view name, std::string_view title, std::vector<Field> fields) {
  std::vector<Field> transforms = transform_fields();
  fields.insert(fields.begin(), name_field());
  fields.insert(fields.end(), transforms.begin(), transforms.end());
  return std::make_shared<const Record>(
      Record{name,
             title,
             std::move(fields),
             {{"matrix", "scale", "rotate_deg", "rotate_quat", "translate"}, {"rotate_deg", "rotate_quat"}}});
}

std::shared_ptr<const Record> chess_position_record(const std::shared_ptr<const Record>& material) {
  Record set{"chess_materials", "Materials of a chess position", {}};
  for (const auto& role : kChessRoleNames) {
    set.fields.push_back({role.name, material_rule(material), "Material of this part",
                          "A name under `materials`, or a material. Absent: the set's own."});
  }
  const Rule fen{.form = Form::text, .length = {.max = kMostFenCharacters}, .pattern = fen_pattern()};
  return object_record("chess_position", "A board with men",
                       {{"fen", fen, "Position",
                         "A FEN as programs write it, or its placement field alone. What stands on no square (pockets, "
                         "EPD operations, a variant's name, ...) is left out with a warning.",
                         "\"rnbqkbnr/pppppppp/8/8/8/8/PPPPPPPP/RNBQKBNR\""},
                        detail_field(),
                        {"materials", record_rule(std::move(set)), "Materials of the set"}});
}

std::shared_ptr<const Record> chess_piece_record(const std::shared_ptr<const Record>& material) {
  return object_record(
      "chess_piece", "One chess piece",
      {{"piece", words_rule(kPieces), "Piece", "", "", Need::required},
       {"position", vector_rule(), "Middle of the foot", "Scene units; the king is 1.9 high. The pivot.", "[0, 0, 0]"},
       {"color", words_rule(kSides), "Side", "Its material, unless one is given, and where a knight looks.",
        "\"white\""},
       detail_field(),
       {"material", material_rule(material), "Material", "Absent: the set's own of its side."}});
}

}  // namespace

Rule objects_grammar(const Limits& limits, const std::shared_ptr<const Record>& material) {
  const Field material_choice = material_field(material);
  Rule object{.form = Form::tagged};
  object.records = {
      object_record("sphere", "A sphere",
                    {{"center", vector_rule(), "Centre", "Scene units. The pivot.", "[0, 0, 0]"},
                     {"radius", number_rule(kPositive), "Radius", "Scene units.", "1"},
                     material_choice}),
      object_record("cube", "A cube",
                    {{"center", vector_rule(), "Centre", "Scene units. The pivot.", "[0, 0, 0]"},
                     {"size", number_rule(kPositive), "Edge", "Scene units.", "1"},
                     material_choice}),
      object_record(
          "box", "A box along the axes; flat where min = max",
          {{"min", vector_rule(), "Least corner", "Scene units. The pivot is the middle.", "[-0.5, -0.5, -0.5]"},
           {"max", vector_rule(), "Greatest corner", "Scene units.", "[0.5, 0.5, 0.5]"},
           material_choice}),
      object_record("plane", "An infinite plane",
                    {{"point", vector_rule(), "A point of it", "Scene units. The pivot.", "[0, 0, 0]"},
                     {"normal", direction_rule(), "Normal", "Need not be of unit length.", "[0, 1, 0]"},
                     material_choice}),
      object_record(
          "mesh", "A triangle mesh",
          {{"mesh", text_rule(), "Mesh", "A name under `meshes`. The pivot is its origin.", "", Need::required},
           material_choice}),
      chess_piece_record(material),
      chess_position_record(material)};
  return list_of(std::move(object), {.min = 1, .max = limits.objects, .is_limit = true});
}

Rule meshes_grammar(const Limits& limits) {
  constexpr double kLargestIndex = 4294967294.0;
  const int64_t corners = 3 * limits.mesh_triangles;
  const Record mesh{
      "mesh_data",
      "Triangles with shared vertices",
      {{"positions", threes_rule(kAnyNumber, {3, 3 * corners, 3, true}), "Positions",
        "x, y, z of every vertex, scene units: numbers in a row, or a list of three for each.", "", Need::required},
       {"indices", threes_rule({.min = 0.0, .max = kLargestIndex, .whole = true}, {3, corners, 3, true}), "Indices",
        "Three vertices of every triangle, counter-clockwise from outside; written as positions are.", "",
        Need::required},
       {"normals", threes_rule(kAnyNumber, {0, 3 * corners, 3, true}), "Normals",
        "x, y, z for every vertex, written as positions are. Absent: averaged from the faces."},
       {"crease_deg", number_rule({.min = 0.0, .max = 180.0}), "Crease angle",
        "Degrees; edges sharper than this stay sharp. Only where normals are absent.", "30"},
       {"name", text_rule(), "Name", "For people; the image does not depend on it."},
       {"asset", text_rule(), "An uploaded mesh by its hash", "", "", Need::later}},
      {}};
  return map_of(record_rule(mesh), {.max = limits.objects, .is_limit = true});
}

}  // namespace tilelight
