// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "renderer/base/facet.h"
#include "renderer/scene/build.h"
#include "renderer/scene/grammar.h"
#include "renderer/scene/readers.h"

namespace tilelight {
namespace {

constexpr int kMaxErrorsInList = 5;

std::vector<Vec3> read_vectors(Value list) {
  std::vector<Vec3> vectors;
  if (!list) return vectors;
  const auto numbers = list.numbers();
  vectors.reserve(numbers.size() / 3);
  for (size_t i = 0; i + 2 < numbers.size(); i += 3) vectors.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  return vectors;
}

// Returns false, after complaints, if an index points past the positions.
bool check_indices(Value indices, size_t position_count, Problems& problems) {
  const auto numbers = indices.numbers();
  int errors = 0;
  for (size_t i = 0; i < numbers.size() && errors < kMaxErrorsInList; ++i) {
    if (numbers[i] < static_cast<double>(position_count)) continue;
    ++errors;
    problems.add_element(
        indices, i,
        {"out_of_range",
         "found index " + number_text(numbers[i]) + "; allowed: 0 to " + std::to_string(position_count - 1) +
             ", for there are " + std::to_string(position_count) + " positions (of 3 numbers each)",
         {},
         ""});
  }
  return errors == 0;
}

bool has_area(const MeshData& mesh, size_t corner) {
  const auto at = [&](size_t k) { return mesh.positions[mesh.indices[corner + k]]; };
  return geometric_normal(at(0), at(1), at(2)) != Vec3(0.0);
}

// Odd but meaningful: geometry repairs these, the author should know.
int64_t warn_of_oddities(Value entry, const MeshData& mesh, Problems& problems) {
  const auto triangles = static_cast<int64_t>(mesh.indices.size() / 3);
  int64_t flat = 0;
  for (size_t corner = 0; corner < mesh.indices.size(); corner += 3) flat += has_area(mesh, corner) ? 0 : 1;
  if (flat > 0) {
    problems.warn(
        entry, "degenerate_triangles",
        std::to_string(flat) + " of " + std::to_string(triangles) + " triangles have no area and are left out");
  }
  const auto zero_normals = std::count(mesh.normals.begin(), mesh.normals.end(), Vec3(0.0));
  if (zero_normals > 0) {
    problems.warn(entry, "zero_normals",
                  std::to_string(zero_normals) + " normals are zero; the faces' own normals take their place");
  }
  return triangles - flat;
}

// Reads one entry into the table; an unusable one leaves only its name, so that its uses are not reported as well.
void build_mesh(Value entry, bool usable, MeshTable& table, Problems& problems) {
  MeshData mesh;
  mesh.name = entry.key();
  const Value positions = find_accepted(entry, "positions"), indices = find_accepted(entry, "indices");
  const Value normals = find_accepted(entry, "normals");
  bool visible = true;
  if (usable && !entry.is_rejected() && positions && indices &&
      check_indices(indices, positions.numbers().size() / 3, problems)) {
    mesh.positions = read_vectors(positions);
    mesh.indices.assign(indices.numbers().begin(), indices.numbers().end());
    mesh.normals = read_vectors(normals);
    mesh.crease_deg = read_number(entry, "crease_deg", mesh.crease_deg);
    if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size()) {
      problems.add(normals, {"wrong_length",
                             "found " + std::to_string(normals.numbers().size()) + " numbers; allowed: " +
                                 std::to_string(positions.numbers().size()) + ", as many as positions, or none",
                             {},
                             ""});
    }
    visible = warn_of_oddities(entry, mesh, problems) > 0;
  }
  table.by_name[mesh.name] = static_cast<uint32_t>(table.meshes.size());
  table.names.push_back(mesh.name);
  table.is_visible.push_back(visible);
  table.meshes.push_back(std::move(mesh));
}

}  // namespace

MeshTable build_meshes(Value meshes, const Limits& limits, Problems& problems) {
  MeshTable table;
  if (!meshes || meshes.is_rejected()) return table;
  int64_t triangles = 0;
  bool reported = false;
  for (const Value entry : meshes.children()) {
    if (is_free_key(entry.key())) continue;
    const Value indices = find_accepted(entry, "indices");
    triangles += indices ? static_cast<int64_t>(indices.numbers().size() / 3) : 0;
    const bool fits = triangles <= limits.mesh_triangles;
    if (!fits && !reported) {
      problems.add(entry, {"limit",
                           "found " + std::to_string(triangles) +
                               " triangles up to this mesh; allowed: " + std::to_string(limits.mesh_triangles) +
                               " in the meshes of one scene (limit mesh_triangles)",
                           {},
                           ""});
      reported = true;
    }
    build_mesh(entry, fits, table, problems);
  }
  return table;
}

}  // namespace tilelight
