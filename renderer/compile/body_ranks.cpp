// SPDX-License-Identifier: Apache-2.0
// The order in which surfaces in one place are met.
#include <algorithm>
#include <numeric>

#include "renderer/compile/bodies.h"

namespace tilelight {
namespace {

void append(const Color& c, std::vector<double>& key) { key.insert(key.end(), {c.r, c.g, c.b}); }
void append(const Paint& paint, std::vector<double>& key) {
  const auto* color = std::get_if<Color>(&paint);
  const auto* checker = std::get_if<Checker>(&paint);
  append(color ? *color : checker->a, key);
  append(color ? *color : checker->b, key);
  key.push_back(color ? 0.0 : checker->size);
}

// The lexicographically smaller comes first.
std::vector<double> key_of(const Material& m) {
  std::vector<double> key = {-static_cast<double>(m.priority), -m.ior, m.fresnel ? 0.0 : 1.0, m.shininess};
  for (const Color& c : {m.transmission, m.reflection, m.specular}) append(c, key);
  for (const Paint& paint : {m.diffuse, m.ambient}) append(paint, key);
  return key;
}

// Below 0, 0 or above.
int compare(double a, double b) { return a < b ? -1 : a > b ? 1 : 0; }
int compare(const Vec3& a, const Vec3& b) {
  for (int axis = 0; axis < 3; ++axis) {
    if (const int order = compare(a[axis], b[axis])) return order;
  }
  return 0;
}
int compare_normals(const TriMesh& a, const TriMesh& b) {
  if (a.corner_normals.size() != b.corner_normals.size())
    return a.corner_normals.size() < b.corner_normals.size() ? -1 : 1;
  for (size_t i = 0; i < a.corner_normals.size(); ++i) {
    for (size_t corner = 0; corner < 3; ++corner) {
      if (const int order = compare(a.corner_normals[i][corner], b.corner_normals[i][corner])) return order;
    }
  }
  return 0;
}
int compare(const TriMesh* a, const TriMesh* b) {
  if (a == b) return 0;
  if (a->positions.size() != b->positions.size()) return a->positions.size() < b->positions.size() ? -1 : 1;
  for (size_t i = 0; i < a->positions.size(); ++i) {
    if (const int order = compare(a->positions[i], b->positions[i])) return order;
  }
  if (a->triangles != b->triangles) return a->triangles < b->triangles ? -1 : 1;
  return compare_normals(*a, *b);
}
int compare_places(const Body& a, const Body& b) {
  if (a.kind != b.kind) return a.kind < b.kind ? -1 : 1;
  if (const int order = compare(a.half, b.half)) return order;
  for (const auto member : {&Body::world_from_local, &Body::pattern_from_local}) {
    for (int column = 0; column < 4; ++column) {
      if (const int order = compare(Vec3((a.*member)[column]), Vec3((b.*member)[column]))) return order;
    }
  }
  return compare(a.mesh.get(), b.mesh.get());
}

}  // namespace

void set_ranks(const Scene& scene, std::vector<Body>& bodies) {
  std::vector<std::vector<double>> keys;
  for (const Material& m : scene.materials) keys.push_back(key_of(m));
  for (Body& body : bodies) {
    const bool is_transparent = scene.materials[body.material].transmission != Color(0.0);
    body.layer = !is_transparent ? Layer::opaque : body.has_inside ? Layer::medium : Layer::film;
  }
  std::vector<uint32_t> order(bodies.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t i, uint32_t k) {
    const Body &a = bodies[i], &b = bodies[k];
    if (a.layer != b.layer) return a.layer < b.layer;
    if (a.layer == Layer::opaque) return i < k;
    if (a.material != b.material && keys[a.material] != keys[b.material]) return keys[a.material] < keys[b.material];
    const int places = compare_places(a, b);
    return places != 0 ? places < 0 : i < k;
  });
  for (uint32_t rank = 0; rank < order.size(); ++rank) bodies[order[rank]].rank = rank;
}

}  // namespace tilelight
