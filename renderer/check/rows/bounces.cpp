// SPDX-License-Identifier: Apache-2.0
// M: mirrors and media in long rows.
#include "renderer/check/rows/bounces.h"

#include <atomic>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/film/sampling.h"

namespace tilelight::check {
namespace {

bool is_same(const Path& path, const std::vector<ReferenceRay>& rays) {
  if (path.rays.size() != rays.size()) return false;
  for (size_t i = 0; i < rays.size(); ++i) {
    const char kind = rays[i].kind == ReferenceRayKind::primary     ? 'p'
                      : rays[i].kind == ReferenceRayKind::reflected ? 'm'
                                                                    : 't';
    const PathRay& ours = path.rays[i];
    if (ours.kind != kind || ours.depth != rays[i].depth || ours.id != rays[i].hit_id) return false;
  }
  return true;
}

constexpr Row kRows[] = {
    {"M1", "facing mirrors", "kr = 0.5, 0.9, 0.99; depth 5, 50, 1000", "recursion cut at 5", facing_mirrors},
    {"M2", "tree of rays", "kr = kt = 0.5, depth 50, 20 spheres", "no budget (followed up to 65536 rays)", glass_tree},
    {"M3", "furnace", "kr + kt = 1 under a white sky; ior 1", "total reflection drops kt", furnace},
    {"M4", "total reflection", "1.5 to 1, 1e-6 rad about the critical angle", "sqrt of a negative number",
     total_reflection},
    {"M5", "bubble", "ior 2/3 against air in glass; ior 0, -1", "eta the wrong way round", bubble},
    {"M6", "parallel plates", "100 plates of 1e-2, gaps of 1e-5", "float, rays lifted by 1e-4", plates},
    {"M7", "overlapping media", "12 balls of four priorities", "a stack that is pushed and popped", overlapping_media},
    {"M8", "corner cube", "three mirrors, turned", "normals and directions in float", corner_cube},
    {"M9", "image plane through glass", "orthographic; a ball at the eye, another before it",
     "media of the eye's place for all rays", plane_through_glass},
    {"M10", "ball lens", "heights up to the limb", "b^2 - 4ac and Snell's law in float", ball_lens},
    {"M11", "grazing Fresnel", "cosines of 0.1 to 1e-12", "Schlick's approximation", grazing_fresnel},
    {"M12", "energy after 1000 mirrors", "kr = 0.999", "a product in float", thousand_mirrors},
    {"M13", "nested media", "20 balls inside each other", "a list of 16 media", nested_media},
    {"M14", "touching media", "glass on water, faces at 0.1 + 0.2 and 0.3", "out of the one, into the other",
     touching_media},
    {"M15", "curved facets", "glass balls of 20 to 5120 facets, ior 1.05 to 2.4",
     "Snell's law by the interpolated normal", curved_facets},
};

}  // namespace

std::string long_paths(int size, double height, const Vec3& from, const Vec3& direction, int max_depth) {
  const std::string edge = text(size);
  return R"("lights": [], "ambient": 0, "background": {"bottom": 1, "top": 1}, "image": {"width": )" + edge +
         R"(, "height": )" + edge + R"(}, "render": {"weight_cutoff": 0, "max_depth": )" + text(max_depth) +
         R"(}, "camera": {"type": "orthographic", "height": )" + text(height) + R"(, "position": )" + text(from) +
         R"(, "target": )" + text(from + direction) + "}, ";
}

double differing_paths(std::string_view json, TilePool& pool) {
  const PathScene ours(json, pool);
  const ReferenceScene scene(scene_of(json).scene);
  const View& view = ours.plan().view;
  const ReferenceEye eye = make_reference_eye(scene, view, ours.plan().camera);
  std::atomic<int> differing = 0;
  pool.parallel_for(view.image.height, Priority::batch, [&](int64_t row) {
    const int y = static_cast<int>(row);
    for (int x = 0; x < view.image.width; ++x) {
      const SamplePoint p = sample_point(x, y, view.render.seed, 0);
      std::vector<ReferenceRay> rays;
      reference_sample(scene, eye, Vec2(x + p.x, y + p.y), &rays);
      if (!is_same(ours.path(x, y), rays)) differing.fetch_add(1, std::memory_order_relaxed);  // a count alone
    }
  });
  return differing;
}

double arcsine(double x) { return elementary::atan2(x, std::sqrt((1.0 - x) * (1.0 + x))); }

Vec3f naive_refract(const Vec3f& direction, const Vec3f& normal, float eta) {
  const float cosine = -glm::dot(direction, normal);
  const float k = 1.0f - eta * eta * (1.0f - cosine * cosine);
  return k < 0.0f ? Vec3f(0.0f) : eta * direction + (eta * cosine - std::sqrt(k)) * normal;
}

std::span<const Row> bounce_rows() { return kRows; }

}  // namespace tilelight::check
