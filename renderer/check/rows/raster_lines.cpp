// SPDX-License-Identifier: Apache-2.0
// R6: the lines that Roberts' method draws: their lengths by hand, and what they show by the reference's rays.
#include <algorithm>
#include <cmath>

#include "renderer/base/elementary.h"
#include "renderer/check/check.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/rows/raster.h"
#include "renderer/measure/reference.h"
#include "renderer/raster/lines/line_pieces.h"

namespace tilelight::check {
namespace {

// The pinhole camera as a textbook has it, in scene units.
class Pinhole {
 public:
  Pinhole(const Camera& camera, const ImageSpec& image)
      : camera_(camera),
        half_(0.5 * Vec2(image.width, image.height)),
        forward_(glm::normalize(camera.target - camera.position)),
        right_(glm::normalize(glm::cross(forward_, camera.up))),
        up_(glm::cross(right_, forward_)) {}

  double length_of(const Vec3& a, const Vec3& b) const { return glm::length(pixel(b) - pixel(a)); }

 private:
  Vec2 pixel(const Vec3& p) const {
    const Vec3 off = p - camera_.position;
    const double scale =
        camera_.projection == Projection::orthographic
            ? half_.y / (0.5 * camera_.height)
            : half_.y / elementary::tan(elementary::rad_from_deg(0.5 * camera_.fov_y_deg)) / glm::dot(off, forward_);
    return half_ + scale * Vec2(glm::dot(off, right_), -glm::dot(off, up_));
  }

  Camera camera_;
  Vec2 half_;
  Vec3 forward_, right_, up_;
};

struct Drawn {
  ParsedScene parsed;
  std::shared_ptr<const CompiledScene> scene;
  ViewPlan plan;
  LineDrawing lines;
};

Drawn draw(const std::string& json, TilePool& pool) {
  Drawn out{scene_of(json), nullptr, {}, {}};
  out.scene = compile_scene(out.parsed.scene, pool);
  out.plan = plan_view(*out.scene, out.parsed.view);
  out.lines = draw_lines(*out.scene, out.plan, pool, true);
  return out;
}

template <class Keep>
double visible_length(const LineDrawing& drawing, const Keep& keep) {
  double sum = 0.0;
  for (const DrawnLine& line : drawing.lines)
    if (!line.is_hidden && keep(line)) sum += glm::length(line.to - line.from);
  return sum;
}

double off_by(double found, double expected) { return std::abs(found / expected - 1.0); }

// Two cubes of side 2, one moved by (1, 1, 1): they cross in six segments, of which the eye sees two.
std::string cubes_text(const std::string& camera) {
  return R"({"image":{"width":800,"height":600},"camera":{"position":[6,-5,8],"target":[0,0,0],)" + camera +
         R"(},"objects":[{"type":"box","min":[-1,-1,-1],"max":[1,1,1]},{"type":"box","min":[0,0,0],"max":[2,2,2]}]})";
}
double cubes_junction(const Drawn& drawn) {
  const Pinhole eye(drawn.plan.camera, drawn.plan.view.image);
  return eye.length_of({1, 0, 0}, {1, 0, 1}) + eye.length_of({0, 0, 1}, {1, 0, 1});
}

// Three bars in a circle, each under the next: no order of painting draws them. Seen from above in parallel each shows
// the long edges and the ends of its top face and three edges of its raised end; of its long edges the bar over it
// hides what its width takes of a line that it crosses at 60 degrees.
struct Bars {
  double length = 6.0, width = 0.5, height = 0.2, side = 3.0, tilt = elementary::rad_from_deg(10.0);
  double view_height = 8.0;
  int px = 1000;

  // camera: position, target, lens.
  std::string text_of(const std::string& camera) const {
    std::string objects;
    for (int i = 0; i < 3; ++i) {
      const double turn = i * 2.0 * elementary::kPi / 3.0;
      const Vec3 way(elementary::cos(turn), elementary::sin(turn), 0.0), across(-way.y, way.x, 0.0);
      const Vec3 along = elementary::cos(tilt) * way + Vec3(0, 0, elementary::sin(tilt));
      const Vec3 out = glm::cross(along, across), at = -side / (2.0 * std::sqrt(3.0)) * across;
      std::string matrix;
      for (const Vec4& column : {Vec4(along, 0), Vec4(across, 0), Vec4(out, 0), Vec4(at, 1)})
        for (int k = 0; k < 4; ++k) matrix += (matrix.empty() ? "" : ",") + text(column[k]);
      const Vec3 half = 0.5 * Vec3(length, width, height);
      objects += (i > 0 ? "," : "") + std::string(R"({"type":"box","min":)") + text(-half) + R"(,"max":)" + text(half) +
                 R"(,"matrix":[)" + matrix + "]}";
    }
    return R"({"image":{"width":)" + std::to_string(px) + R"(,"height":)" + std::to_string(px) + R"(},"camera":{)" +
           camera + R"(},"objects":[)" + objects + "]}";
  }
  double visible() const {
    const double ends = 2.0 * width + width + 2.0 * height * elementary::sin(tilt);
    const double hidden = 2.0 * width / elementary::sin(elementary::kPi / 3.0);
    return 3.0 * (2.0 * length * elementary::cos(tilt) + ends - hidden) * px / view_height;
  }
};

// What rays of the reference, stopped 1e-6 before sixteen points of every piece, say of them.
struct Told {
  int64_t points = 0, otherwise = 0;
  int64_t undecided = 0;  // hidden ones that lie behind the very outline of something: rays beside them are blocked
};

class Judge {
 public:
  explicit Judge(const Drawn& drawn) : drawn_(drawn), scene_(drawn.parsed.scene), camera_(drawn.plan.camera) {
    forward_ = glm::normalize(camera_.target - camera_.position);
  }

  Told ask(TilePool& pool, size_t stride) const {
    const lines::LineView view(drawn_.plan);
    const lines::LinePieces found = lines::find_line_pieces(*drawn_.scene, view, pool, true);
    Told told;
    for (size_t i = 0; i < found.pieces.size(); i += stride) {
      const lines::LinePiece& piece = found.pieces[i];
      for (int k = 0; k < 16; ++k) {
        const Vec3 place = view.to_world(glm::mix(piece.from, piece.to, (k + 0.5) / 16.0));
        const Vec3 p = drawn_.scene->center + drawn_.scene->units * place;
        ++told.points;
        if (is_blocked(p) == piece.is_hidden) continue;
        const bool is_on_outline = piece.is_hidden && is_blocked_beside(p);
        ++(is_on_outline ? told.undecided : told.otherwise);
      }
    }
    return told;
  }

 private:
  double reach() const { return 1e-6 * drawn_.scene->units; }

  bool is_blocked(const Vec3& p) const {
    reference::Ray ray;
    ray.origin = camera_.position, ray.direction = glm::normalize(p - camera_.position);
    double distance = glm::length(p - camera_.position);
    if (camera_.projection == Projection::orthographic) {
      distance = glm::dot(p - camera_.position, forward_);
      ray.origin = p - distance * forward_, ray.direction = forward_;
    }
    const auto hit = scene_.nearest(ray);
    return hit && hit->t < distance - reach();
  }

  bool is_blocked_beside(const Vec3& p) const {
    const Vec3 right = glm::normalize(glm::cross(forward_, camera_.up)), up = glm::cross(right, forward_);
    for (const Vec3& off : {right, -right, up, -up})
      if (is_blocked(p + reach() * off)) return true;
    return false;
  }

  const Drawn& drawn_;
  const ReferenceScene scene_;
  const Camera& camera_;
  Vec3 forward_{0.0};
};

std::string pieces_text() {
  return R"({"image":{"width":640,"height":480},"camera":{"position":[3.1,2.3,3.9],"target":[0,0.7,0]},"objects":[
    {"type":"chess_piece","piece":"king","detail":48},
    {"type":"chess_piece","piece":"knight","position":[1,0,0.4],"detail":32},
    {"type":"chess_piece","piece":"rook","position":[-0.9,0,-0.6],"detail":36},
    {"type":"box","min":[-2,-0.2,-2],"max":[2,0,2]}]})";
}

}  // namespace

Outcome hidden_lines(const Context& context) {
  const auto is_junction = [](const DrawnLine& line) { return line.kind == LineKind::junction; };
  const auto is_any = [](const DrawnLine&) { return true; };
  double junction = 0.0, without_junctions = 0.0;
  Told told;
  const auto ask = [&](const Drawn& drawn, size_t stride) {
    const Told some = Judge(drawn).ask(context.pool, stride);
    told.points += some.points, told.otherwise += some.otherwise, told.undecided += some.undecided;
  };
  for (const char* lens : {R"("fov_y_deg":40)", R"("type":"orthographic","height":6)"}) {
    const Drawn cubes = draw(cubes_text(lens), context.pool);
    note(junction, off_by(visible_length(cubes.lines, is_junction), cubes_junction(cubes)));
    const double all = visible_length(cubes.lines, is_any);
    note(without_junctions, off_by(all - visible_length(cubes.lines, is_junction), all));
    ask(cubes, 1);
  }
  const Bars bars;
  const std::string above = R"("type":"orthographic","position":[0,0,10],"target":[0,0,0],"height":)";
  const Drawn circle = draw(bars.text_of(above + text(bars.view_height)), context.pool);
  const double painted = visible_length(circle.lines, is_any) +  // what is hidden drawn as well
                         3.0 * 2.0 * bars.width / elementary::sin(elementary::kPi / 3.0) * bars.px / bars.view_height;
  ask(draw(bars.text_of(R"("position":[1,2,9],"target":[0,0,0])"), context.pool), 1);
  ask(draw(pieces_text(), context.pool), context.is_quick ? 16 : 1);
  return {{at_most(1e-6, "length of the junction of two cubes, relative error", junction),
           at_most(1e-6, "visible length of three bars in a circle, relative error",
                   off_by(visible_length(circle.lines, is_any), bars.visible())),
           at_most(0, "points of lines that rays tell otherwise", static_cast<double>(told.otherwise)),
           at_most(context.is_quick ? 0.1 : 0.01, "points behind the very outline of something, %",
                   percent(told.undecided, told.points))},
          {at_most(1e-6, "without junctions: length of what the cubes show, relative error", without_junctions),
           at_most(1e-6, "bars painted whole: visible length, relative error", off_by(painted, bars.visible()))}};
}

}  // namespace tilelight::check
