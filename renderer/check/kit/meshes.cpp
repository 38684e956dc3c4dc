// SPDX-License-Identifier: Apache-2.0
#include "renderer/check/kit/meshes.h"

#include <map>

#include "renderer/check/kit/pictures.h"

namespace tilelight::check {

MeshData icosphere(int levels) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  MeshData mesh;
  mesh.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                    {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : mesh.positions) p = glm::normalize(p);
  mesh.indices = {0, 11, 5, 0, 5, 1, 0, 1, 7, 0, 7, 10, 0, 10, 11, 1, 5, 9, 5, 11, 4,  11, 10, 2,  10, 7, 6, 7, 1, 8,
                  3, 9,  4, 3, 4, 2, 3, 2, 6, 3, 6, 8,  3, 8,  9,  4, 9, 5, 2, 4,  11, 6,  2,  10, 8,  6, 7, 9, 8, 1};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [it, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(mesh.positions.size()));
      if (is_new) mesh.positions.push_back(glm::normalize(mesh.positions[a] + mesh.positions[b]));
      return it->second;
    };
    std::vector<uint32_t> finer;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
      const uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    mesh.indices = std::move(finer);
  }
  return mesh;
}

MeshData sheet(double half, int steps, bool other_diagonal) {
  MeshData mesh;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; j <= steps; ++j)
      mesh.positions.push_back(half * ((2.0 * i / steps - 1.0) * kAcross + (2.0 * j / steps - 1.0) * kAlong));
  const auto row = static_cast<uint32_t>(steps + 1);
  for (uint32_t i = 0; i + 1 < row; ++i) {
    for (uint32_t j = 0; j + 1 < row; ++j) {
      const uint32_t a = i * row + j, b = a + row, c = b + 1, d = a + 1;
      if (other_diagonal)
        mesh.indices.insert(mesh.indices.end(), {a, b, d, b, c, d});
      else
        mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
    }
  }
  return mesh;
}

std::string turn_text() {
  const glm::dquat q = glm::quat_cast(Mat3(kAlong, kNormal, glm::cross(kAlong, kNormal)));
  return R"("rotate_quat":[)" + text(q.x) + "," + text(q.y) + "," + text(q.z) + "," + text(q.w) + "]";
}

MeshData placed(MeshData mesh, double size, const Vec3& offset) {
  for (Vec3& p : mesh.positions) p = size * (p + offset);
  return mesh;
}

std::string mesh_text(const MeshData& mesh, const std::string& more) {
  std::string out = R"({"positions":[)";
  for (const Vec3& p : mesh.positions) {
    const std::string triple = text(p);
    out.append(triple, 1, triple.size() - 2).push_back(',');
  }
  out.back() = ']';
  out += R"(,"indices":[)";
  for (const uint32_t i : mesh.indices) out.append(std::to_string(i)).push_back(',');
  out.back() = ']';
  return out + more + "}";
}

std::string mesh_document(const MeshData& mesh, const std::string& object) {
  return R"({"lights":[],"meshes":{"m":)" + mesh_text(mesh) + R"(},"objects":[{"type":"mesh","mesh":"m")" + object +
         "}]}";
}

Rimmed::Rimmed(MeshData mesh) : mesh_(std::move(mesh)), around_(mesh_.positions.size()) {
  for (size_t i = 0; i < mesh_.indices.size(); ++i) around_[mesh_.indices[i]].push_back(static_cast<uint32_t>(i / 3));
}

Target Rimmed::on_edge(Random& random) const {
  const size_t i = random.next() % mesh_.indices.size();
  const uint32_t a = mesh_.indices[i], b = mesh_.indices[i % 3 == 2 ? i - 2 : i + 1];
  return {glm::mix(mesh_.positions[a], mesh_.positions[b], random.unit()), a, b};
}

Target Rimmed::on_vertex(Random& random) const {
  const auto v = static_cast<uint32_t>(random.next() % mesh_.positions.size());
  return {mesh_.positions[v], v, v};
}

bool textbook_hits(const Rimmed& mesh, const Target& target, const Vec3& origin, const Vec3& direction, float epsilon) {
  const naive::RayF ray{Vec3f(origin), Vec3f(glm::normalize(direction))};
  return mesh.any(target, [&](size_t t) {
    return naive::triangle(ray, Vec3f(mesh.corner(t, 0)), Vec3f(mesh.corner(t, 1)), Vec3f(mesh.corner(t, 2)), 0.0f,
                           epsilon)
        .has_value();
  });
}

}  // namespace tilelight::check
