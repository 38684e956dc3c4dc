// SPDX-License-Identifier: Apache-2.0
// Building a Scene and a View from a checked document: names resolved, defaults filled in, meanings checked that no
// grammar can express. One file a chapter of the language.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/document.h"
#include "renderer/scene/limits.h"
#include "renderer/scene/problems.h"
#include "renderer/scene/scene.h"

namespace tilelight {

// The materials of a scene under construction.
class MaterialTable {
 public:
  static constexpr MaterialId kDefault = 0;

  // `materials` is the document's member of that name, or nothing.
  MaterialTable(Value materials, const Limits& limits, Problems& problems);

  // The material that `object` names or holds under `key`; `fallback` in its absence.
  MaterialId find(Value object, std::string_view key, MaterialId fallback);
  // As find, with one of the chess set's own materials as the fallback.
  MaterialId find_chess(Value object, std::string_view key, ChessRole fallback);

  std::vector<Material> take() { return std::move(materials_); }

 private:
  MaterialId add(Material material, Value from);

  const Limits& limits_;
  Problems& problems_;
  std::vector<Material> materials_;
  std::map<std::string, MaterialId, std::less<>> by_name_;
  std::vector<std::string> names_;
  std::array<MaterialId, kChessRoles> chess_{};  // 0 = not yet made
  int64_t user_materials_ = 0;
  bool over_limit_ = false;
};

// The meshes of a scene under construction, and what is known of each.
struct MeshTable {
  std::vector<MeshData> meshes;
  std::vector<bool> is_visible;  // has a triangle of positive area
  std::map<std::string, uint32_t, std::less<>> by_name;
  std::vector<std::string> names;
};
MeshTable build_meshes(Value meshes, const Limits& limits, Problems& problems);

std::vector<Object> build_objects(Value objects, const MeshTable& meshes, MaterialTable& materials,
                                  const Limits& limits, Problems& problems);

// `lights` may be absent, which means the two default lights.
std::vector<Light> build_lights(Value lights);

// The parts of the document that say how to look at the scene.
View build_view(Value root, const Limits& limits, Problems& problems);

// The built-in material of a chess set's part.
Material make_chess_material(ChessRole role);

}  // namespace tilelight
