// SPDX-License-Identifier: Apache-2.0
// T3, T4, T6: meshes with degenerate triangles, meshes that bound nothing, small meshes.
#include <algorithm>
#include <cmath>

#include "renderer/check/kit/meshes.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/textbook.h"
#include "renderer/check/rows/triangles.h"
#include "renderer/compile/bodies.h"
#include "renderer/trace/tile_job.h"

namespace tilelight::check {
namespace {

// The mesh with every fourth corner on a copy of its vertex, and after every triangle of each ten the first three
// followed by one without area: an index twice, two copies of a vertex, three points of a line.
struct Littered {
  MeshData mesh;
  int64_t degenerate = 0;
};
Littered littered(const MeshData& clean) {
  Littered out{clean, 0};
  MeshData& mesh = out.mesh;
  const auto vertices = static_cast<uint32_t>(clean.positions.size());
  mesh.positions.insert(mesh.positions.end(), clean.positions.begin(), clean.positions.end());
  mesh.indices.clear();
  for (size_t i = 0; i < clean.indices.size(); i += 3) {
    uint32_t corner[3];
    for (size_t k = 0; k < 3; ++k) corner[k] = clean.indices[i + k] + ((i + k) % 4 == 0 ? vertices : 0);
    mesh.indices.insert(mesh.indices.end(), corner, corner + 3);
    const auto litter = [&](uint32_t a, uint32_t b, uint32_t c) {
      mesh.indices.insert(mesh.indices.end(), {a, b, c});
      ++out.degenerate;
    };
    const uint32_t a = clean.indices[i], b = clean.indices[i + 1];
    if (i / 3 % 10 == 0) litter(a, a, b);
    if (i / 3 % 10 == 3) litter(a, b, a + vertices);
    if (i / 3 % 10 == 6) {
      mesh.positions.push_back(0.5 * (clean.positions[a] + clean.positions[b]));
      litter(a, b, static_cast<uint32_t>(mesh.positions.size() - 1));
    }
  }
  return out;
}

// Vertices whose normal, as the mean of unit facet normals, is no number.
double textbook_normals_lost(const MeshData& mesh) {
  std::vector<Vec3f> normals(mesh.positions.size(), Vec3f(0.0f));
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const uint32_t* v = &mesh.indices[i];
    const Vec3f a(mesh.positions[v[0]]), b(mesh.positions[v[1]]), c(mesh.positions[v[2]]);
    for (int k = 0; k < 3; ++k) normals[v[k]] += glm::normalize(glm::cross(b - a, c - a));
  }
  const auto lost =
      std::count_if(normals.begin(), normals.end(), [](const Vec3f& n) { return !(glm::length(n) >= 0); });
  return percent(lost, static_cast<int64_t>(normals.size()));
}

// Five pages about one spine, and a bowl: the lower half of a ball, open at its rim.
MeshData pages() {
  MeshData mesh;
  mesh.positions = {{0, -1, 0}, {0, 1, 0}};
  const Vec3 outer[] = {{1, 0, 0.3}, {0.2, 0, 1}, {-0.8, 0, 0.7}, {-0.9, 0, -0.4}, {0.5, 0, -0.9}};
  for (const Vec3& p : outer) {
    mesh.positions.push_back(p);
    mesh.indices.insert(mesh.indices.end(), {0, 1, static_cast<uint32_t>(mesh.positions.size() - 1)});
  }
  return mesh;
}
MeshData bowl() {
  MeshData ball = icosphere(2), mesh = ball;
  mesh.indices.clear();
  for (size_t i = 0; i < ball.indices.size(); i += 3) {
    const Vec3 sum =
        ball.positions[ball.indices[i]] + ball.positions[ball.indices[i + 1]] + ball.positions[ball.indices[i + 2]];
    if (sum.y < 0.0) mesh.indices.insert(mesh.indices.end(), &ball.indices[i], &ball.indices[i] + 3);
  }
  return mesh;
}
MeshData some_flipped(MeshData mesh) {
  for (size_t i = 0; i < mesh.indices.size(); i += 6) std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
  return mesh;
}
std::string pages_and_bowl(bool flip, int side) {
  const auto mesh = [&](const MeshData& m) { return mesh_text(flip ? some_flipped(m) : m, R"(,"crease_deg":0)"); };
  return R"({"meshes":{"pages":)" + mesh(pages()) + R"(,"bowl":)" + mesh(bowl()) + R"(},"objects":[
      {"type":"mesh","mesh":"pages","material":{"diffuse":[0.8,0.3,0.2],"specular":0.4}},
      {"type":"mesh","mesh":"bowl","translate":[1.7,0,0.4],
       "material":{"diffuse":0.3,"transmission":[0.5,0.6,0.7],"reflection":0.2,"ior":1.5}}],
      "camera":{"position":[1.2,2.5,4.5],"target":[0.8,-0.2,0]},)" +
         image_text(side, side) + "}";
}

// Eyes around the bowl that are taken to be in its glass. An open mesh holds nothing.
struct Insiders {
  int64_t ours = 0, parity = 0;
  int count = 4'000;
};
Insiders taken_for_insiders(const ParsedScene& parsed, TilePool& pool) {
  Insiders out;
  const auto compiled = compile_scene(parsed.scene, pool);
  ViewPlan plan = plan_view(*compiled, parsed.view);
  const MeshData mesh = some_flipped(bowl());
  const Vec3 towards = glm::normalize(Vec3(0.31415, 0.59265, 0.35897));
  Random random(4);
  for (int i = 0; i < out.count; ++i) {
    const Vec3 eye = Vec3(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
    plan.eye.origin = (eye + Vec3(1.7, 0.0, 0.4) - compiled->center) / compiled->units;
    out.ours += !EyeMedia(*compiled, plan).around_all().empty();
    int crossings = 0;
    const naive::RayF ray{Vec3f(eye), Vec3f(towards)};
    for (size_t k = 0; k < mesh.indices.size(); k += 3) {
      const auto corner = [&](size_t c) { return Vec3f(mesh.positions[mesh.indices[k + c]]); };
      crossings += naive::triangle(ray, corner(0), corner(1), corner(2), 0.0f).has_value();
    }
    out.parity += crossings % 2;
  }
  return out;
}

// Lengths, the attenuation's constant and the light's intensity go with the size: the picture stays.
std::string ball_of_size(double size, int side) {
  return R"({"meshes":{"m":)" + mesh_text(placed(icosphere(2), size, Vec3(0.0)), R"(,"crease_deg":10)") +
         R"(},"objects":[{"type":"mesh","mesh":"m","material":{"diffuse":[0.7,0.5,0.3],"specular":0.5}},
            {"type":"box","min":)" +
         text(size * Vec3(-2.0, -1.2, -2.0)) + R"(,"max":)" + text(size * Vec3(2.0, -1.0, 2.0)) +
         R"(}],"lights":[{"type":"point","position":)" + text(size * Vec3(3.0, 4.0, 2.0)) + R"(,"intensity":)" +
         text(6.0 * size) + R"(}],"attenuation":{"mode":"linear","k":)" + text(2.0 * size) +
         R"(},"camera":{"position":)" + text(size * Vec3(1.5, 1.2, 4.0)) + R"(,"target":[0,0,0]},)" +
         image_text(side, side) + "}";
}

}  // namespace

Outcome degenerate_triangles(const Context& context) {
  const auto document = [&](const MeshData& mesh) {
    return R"({"meshes":{"m":)" + mesh_text(mesh, R"(,"crease_deg":40)") +
           R"(},"objects":[{"type":"mesh","mesh":"m","material":{"specular":0.5,"reflection":0.2}}],)" +
           image_text(side_of(context), side_of(context)) + "}";
  };
  const MeshData clean = icosphere(2);
  const Littered dirty = littered(clean);
  const ParsedScene with = scene_of(document(dirty.mesh)), without = scene_of(document(clean));
  const Picture a = picture_of(with, context.pool), b = picture_of(without, context.pool);
  const auto dropped = static_cast<double>(make_bodies(with.scene)[0].mesh->degenerate_dropped);
  const auto warnings = std::count_if(a.warnings.begin(), a.warnings.end(), [&](const SceneWarning& w) {
    return w.code == "degenerate_triangles" && w.detail.starts_with(std::to_string(dirty.degenerate) + " of ");
  });
  return {{within(0, "triangles dropped, off by", dropped, static_cast<double>(dirty.degenerate)),
           at_least(1, "warnings that tell their number", static_cast<double>(warnings)),
           at_most(0, "samples that are not finite", static_cast<double>(a.nonfinite())),
           at_most(0, "first surfaces unlike the clean mesh's, %", differing_ids(a.ids, b.ids)),
           at_most(0, "linear values unlike the clean mesh's", a.linear == b.linear ? 0.0 : 1.0)},
          {at_most(0, "vertex normals that are no number, %", textbook_normals_lost(dirty.mesh))}};
}

Outcome not_a_manifold(const Context& context) {
  const ParsedScene flipped = scene_of(pages_and_bowl(true, side_of(context)));
  const Picture a = picture_of(flipped, context.pool);
  const Picture b = picture_of(scene_of(pages_and_bowl(false, side_of(context))), context.pool);
  const Insiders insiders = taken_for_insiders(flipped, context.pool);
  return {{at_most(0, "samples that are not finite", static_cast<double>(a.nonfinite())),
           at_most(0, "first surfaces unlike the reference's, %",
                   differing_ids(a.ids, reference_ids(flipped, context.pool))),
           at_most(0, "pixels that flipping every other face changes, %", differing_pixels(a.rgb, b.rgb)),
           at_most(0, "eyes taken to be inside of the open bowl, %", percent(insiders.ours, insiders.count))},
          {at_most(0, "eyes taken to be inside of the open bowl, %", percent(insiders.parity, insiders.count))}};
}

Outcome small_mesh(const Context& context) {
  const int textbook_side = 96;  // it tries every triangle
  const auto ours = [&](double size) {
    return picture_of(scene_of(ball_of_size(size, side_of(context))), context.pool);
  };
  const auto textbook = [&](double size) {
    const ParsedScene parsed = scene_of(ball_of_size(size, textbook_side));
    return TextbookTracer(parsed.scene).picture(parsed.view, *parsed.view.camera, context.pool);
  };
  const Picture unit = ours(1.0);
  const auto textbook_unit = textbook(1.0);
  Outcome out;
  for (const double size : {1e-3, 1e-6, 1e-9, 1e-12}) {
    const std::string what = "pixels that change at " + text(size) + ", %";
    out.ours.push_back(at_most(0.02, what, differing_pixels(ours(size).rgb, unit.rgb)));
    out.naive.push_back(at_most(0.02, what, differing_pixels(textbook(size).rgb, textbook_unit.rgb)));
  }
  return out;
}

}  // namespace tilelight::check
