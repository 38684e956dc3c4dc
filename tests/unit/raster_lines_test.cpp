// SPDX-License-Identifier: Apache-2.0
// Line drawings against lengths worked out by hand, and against the reference's rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "renderer/raster/lines/line_ink.h"
#include "tests/unit/raster_lines_support.h"

namespace tilelight {
namespace {

using namespace lines_test;
using Segment = std::pair<Vec3, Vec3>;

constexpr double kRelative = 1e-11;  // only rounding

// The pinhole camera as a textbook has it.
Vec2 projected(const View& view, const Vec3& p) {
  const Camera& camera = *view.camera;
  const Vec3 forward = glm::normalize(camera.target - camera.position);
  const Vec3 right = glm::normalize(glm::cross(forward, camera.up)), up = glm::cross(right, forward);
  const Vec3 off = p - camera.position;
  const double half = 0.5 * view.image.height;
  const double scale = camera.projection == Projection::orthographic
                           ? half / (0.5 * camera.height)
                           : half / std::tan(camera.fov_y_deg * std::numbers::pi / 360.0) / glm::dot(off, forward);
  return {0.5 * view.image.width + scale * glm::dot(off, right), half - scale * glm::dot(off, up)};
}

double length_of(const View& view, const Segment& s) {
  return glm::length(projected(view, s.second) - projected(view, s.first));
}

double length_of(const View& view, const std::vector<Segment>& segments) {
  double sum = 0.0;
  for (const Segment& s : segments) sum += length_of(view, s);
  return sum;
}

template <class Keep>
double length_of(const LineDrawing& drawing, Keep keep) {
  double sum = 0.0;
  for (const DrawnLine& line : drawing.lines)
    if (keep(line)) sum += glm::length(line.to - line.from);
  return sum;
}

constexpr auto kVisible = [](const DrawnLine& line) { return !line.is_hidden; };
constexpr auto kHidden = [](const DrawnLine& line) { return line.is_hidden; };
constexpr auto kVisibleJunction = [](const DrawnLine& line) {
  return !line.is_hidden && line.kind == LineKind::junction;
};

// Exactly these segments are drawn among the lines that `keep` lets through.
template <class Keep>
void expect_lines(const LineDrawing& drawing, const View& view, const std::vector<Segment>& expected, Keep keep) {
  EXPECT_EQ(std::count_if(drawing.lines.begin(), drawing.lines.end(), keep),
            static_cast<std::ptrdiff_t>(expected.size()));
  for (const Segment& s : expected) {
    const Vec2 a = projected(view, s.first), b = projected(view, s.second);
    const double tolerance = kRelative * glm::length(b - a);
    const auto is_it = [&](const DrawnLine& line) {
      const double one_way = std::max(glm::length(line.from - a), glm::length(line.to - b));
      const double other_way = std::max(glm::length(line.from - b), glm::length(line.to - a));
      return keep(line) && std::min(one_way, other_way) <= tolerance;
    };
    EXPECT_EQ(std::count_if(drawing.lines.begin(), drawing.lines.end(), is_it), 1)
        << "(" << s.first.x << " " << s.first.y << " " << s.first.z << ") to (" << s.second.x << " " << s.second.y
        << " " << s.second.z << ")";
  }
}

void expect_length(double found, double expected) { EXPECT_NEAR(found, expected, kRelative * expected); }

// The edges of a box by the corners: bit k says on which side along axis k.
Vec3 corner(const Vec3& lo, const Vec3& hi, int bits) {
  return {bits & 1 ? hi.x : lo.x, bits & 2 ? hi.y : lo.y, bits & 4 ? hi.z : lo.z};
}
std::vector<Segment> edges_at(const Vec3& lo, const Vec3& hi, int corner_bits, bool wants_those_at_corner) {
  std::vector<Segment> edges;
  for (int a = 0; a < 8; ++a) {
    for (int axis = 0; axis < 3; ++axis) {
      const int b = a | 1 << axis;
      if (b != a && (a == corner_bits || b == corner_bits) == wants_those_at_corner)
        edges.emplace_back(corner(lo, hi, a), corner(lo, hi, b));
    }
  }
  return edges;
}

TEST(LineDrawing, OfACubeShowsTheNineEdgesThatDoNotMeetAtItsFarthestCorner) {
  const Vec3 lo(-1.0), hi(1.0);
  for (const Camera& camera : {perspective({3, 4, 5}), orthographic({3, 4, 5}, 5.0)}) {
    const View view = view_of(camera);
    const LineDrawing seen = draw(boxes({{lo, hi}}), view), all = draw(boxes({{lo, hi}}), view, true);
    expect_lines(seen, view, edges_at(lo, hi, 0, false), kVisible);
    expect_lines(all, view, edges_at(lo, hi, 0, false), kVisible);
    expect_lines(all, view, edges_at(lo, hi, 0, true), kHidden);
    EXPECT_EQ(std::count_if(seen.lines.begin(), seen.lines.end(), kHidden), 0);
    // The outline is a hexagon; the three edges at the nearest corner are creases.
    const auto is_crease = [](const DrawnLine& line) { return line.kind == LineKind::crease && !line.is_hidden; };
    expect_lines(all, view, edges_at(lo, hi, 7, true), is_crease);
    EXPECT_EQ(all.work.convex_bodies, 1);
    EXPECT_EQ(all.work.faces, 6);
    EXPECT_EQ(all.work.edges, 12);
    EXPECT_EQ(all.work.drawn_lines, 12);
  }
}

TEST(LineDrawing, OfACubeSeenFaceOnIsItsSquareDrawnOnce) {
  const View view = view_of(orthographic({0, 0, 5}, 5.0));
  expect_lines(draw(boxes({{Vec3(-1), Vec3(1)}}), view), view,
               {{Vec3(-1, -1, 1), Vec3(1, -1, 1)},
                {Vec3(1, -1, 1), Vec3(1, 1, 1)},
                {Vec3(1, 1, 1), Vec3(-1, 1, 1)},
                {Vec3(-1, 1, 1), Vec3(-1, -1, 1)}},
               kVisible);
}

// The eye looks along -z; the farther box shows one face. Under perspective what the near face at z = 2 hides is 11/8
// of its size where the far face lies at z = -1.
TEST(LineDrawing, OfACubePartlyBehindAnotherEndsAtTheOutlineOfThatOne) {
  const Scene scene = boxes({{Vec3(-1, -1, 1), Vec3(1, 1, 2)}, {Vec3(-0.5, -0.5, -2), Vec3(3, 2, -1)}});
  for (const bool is_perspective : {false, true}) {
    const View view = view_of(is_perspective ? perspective({0, 0, 10}) : orthographic({0, 0, 10}, 8.0));
    const double reach = is_perspective ? 11.0 / 8.0 : 1.0;
    const auto of_second = [](const DrawnLine& line) { return line.body == 1 && !line.is_hidden; };
    const LineDrawing drawing = draw(scene, view);
    expect_lines(drawing, view,
                 {{Vec3(reach, -0.5, -1), Vec3(3, -0.5, -1)},
                  {Vec3(3, -0.5, -1), Vec3(3, 2, -1)},
                  {Vec3(3, 2, -1), Vec3(-0.5, 2, -1)},
                  {Vec3(-0.5, 2, -1), Vec3(-0.5, reach, -1)}},
                 of_second);
    EXPECT_EQ(drawing.lines.size(), 8u);
  }
}

// [-1,1]^3 and [0,2]^3: their surfaces cross in a ring of six segments of length 1.
TEST(LineDrawing, OfCubesThatInterpenetrateShowsTheirJunction) {
  const Scene scene = boxes({{Vec3(-1), Vec3(1)}, {Vec3(0), Vec3(2)}});
  const std::vector<Segment> seen = {{Vec3(1, 0, 0), Vec3(1, 0, 1)}, {Vec3(0, 0, 1), Vec3(1, 0, 1)}};
  const std::vector<Segment> unseen = {{Vec3(1, 0, 0), Vec3(1, 1, 0)},
                                       {Vec3(0, 1, 0), Vec3(1, 1, 0)},
                                       {Vec3(0, 1, 0), Vec3(0, 1, 1)},
                                       {Vec3(0, 0, 1), Vec3(0, 1, 1)}};
  const auto is_hidden_junction = [](const DrawnLine& line) {
    return line.is_hidden && line.kind == LineKind::junction;
  };
  // From here the second one's face y = 0 is seen and its faces x = 0 and z = 0 are not.
  for (const Camera& camera : {perspective({6, -5, 8}), orthographic({6, -5, 8}, 6.0)}) {
    const View view = view_of(camera);
    const LineDrawing drawing = draw(scene, view, true);
    expect_lines(drawing, view, seen, kVisibleJunction);
    expect_lines(drawing, view, unseen, is_hidden_junction);
    EXPECT_EQ(draw(scene, view).work.junction_segments, 2);
    for (const DrawnLine& line : drawing.lines) EXPECT_EQ(line.other, line.kind == LineKind::junction ? 1 : line.body);
  }
}

// Three bars, each under the next: no order of painting draws them. Seen from above, in the plan: each shows the long
// edges and the ends of its top face and three edges of its raised end; of its long edges the bar over it hides what
// its width takes of a line that it crosses at 60 degrees.
TEST(LineDrawing, OfThreeBarsThatOverlapInACircleHidesEachUnderTheNext) {
  const double length = 6.0, width = 0.5, height = 0.2, tilt = 10.0 * std::numbers::pi / 180.0, side = 3.0;
  Scene scene = dark_scene();
  for (int i = 0; i < 3; ++i) {
    const double turn = i * 2.0 * std::numbers::pi / 3.0;
    const Vec3 way(std::cos(turn), std::sin(turn), 0.0), across(-way.y, way.x, 0.0);
    const Vec3 along = std::cos(tilt) * way + Vec3(0, 0, std::sin(tilt));
    Object& bar = add_object(scene, BoxShape{-0.5 * Vec3(length, width, height), 0.5 * Vec3(length, width, height)});
    bar.world_from_shape[0] = Vec4(along, 0.0);
    bar.world_from_shape[1] = Vec4(across, 0.0);
    bar.world_from_shape[2] = Vec4(glm::cross(along, across), 0.0);
    bar.world_from_shape[3] = Vec4(-side / (2.0 * std::sqrt(3.0)) * across, 1.0);
  }
  Camera camera = orthographic({0, 0, 10}, 8.0);
  const View view = view_of(camera, 1000, 1000);
  const LineDrawing drawing = draw(scene, view);
  const double ends = 2.0 * width + width + 2.0 * height * std::sin(tilt);
  const double hidden = 2.0 * width / std::sin(std::numbers::pi / 3.0);
  expect_length(length_of(drawing, kVisible), 3.0 * (2.0 * length * std::cos(tilt) + ends - hidden) * 1000.0 / 8.0);
  // Cut in two where they are hidden: one part more for each of the six long edges.
  EXPECT_EQ(drawing.lines.size(), 3u * (7u + 2u));
}

TEST(LineDrawing, DrawsTheLineOfContactOnceAndABoxSunkInAPlaneToItsJunction) {
  const View view = view_of(perspective({3, 4, 5}));
  Scene standing = boxes({{Vec3(-1, 0, -1), Vec3(1, 1, 1)}});
  add_object(standing, PlaneShape{});
  expect_lines(draw(standing, view), view, edges_at({-1, 0, -1}, {1, 1, 1}, 0, false), kVisible);

  Scene sunk = boxes({{Vec3(-1, -1, -1), Vec3(1, 1, 1)}});
  add_object(sunk, PlaneShape{});
  const LineDrawing drawing = draw(sunk, view);
  expect_lines(drawing, view, edges_at({-1, 0, -1}, {1, 1, 1}, 0, false), kVisible);
  expect_lines(drawing, view, {{Vec3(-1, 0, 1), Vec3(1, 0, 1)}, {Vec3(1, 0, 1), Vec3(1, 0, -1)}}, kVisibleJunction);
}

TEST(LineDrawing, OfABoxThatStandsOnAnotherDoublesAndLosesNothing) {
  const View view = view_of(perspective({3, 4, 5}));
  // Flush on all sides: the seam is the upper edges of the lower box, of which the far two are out of sight.
  const LineDrawing flush = draw(boxes({{Vec3(-1), Vec3(1, 0, 1)}, {Vec3(-1, 0, -1), Vec3(1)}}), view);
  std::vector<Segment> expected = edges_at(Vec3(-1), Vec3(1), 0, false);
  expected.emplace_back(Vec3(-1, 0, 1), Vec3(1, 0, 1));
  expected.emplace_back(Vec3(1, 0, 1), Vec3(1, 0, -1));
  expect_length(length_of(flush, kVisible), length_of(view, expected));
  // Smaller: its foot lies in the lower one's top face, where it is seen.
  const Vec3 lo(-0.4, 0, -0.4), hi(0.4, 0.3, 0.4);
  const LineDrawing small = draw(boxes({{Vec3(-1), Vec3(1, 0, 1)}, {lo, hi}}), view);
  const auto of_small = [](const DrawnLine& line) { return line.body == 1; };
  expect_lines(small, view, edges_at(lo, hi, 0, false), of_small);
}

TEST(LineDrawing, OfABodyAroundTheEyeShowsItFromTheInside) {
  const View view = view_of({.position = Vec3(0.0), .target = Vec3(0, 0, -1), .fov_y_deg = 100.0});
  const Vec3 lo(-1, -1, -2), hi(1, 1, 1);
  const LineDrawing drawing = draw(boxes({{lo, hi}}), view);
  std::vector<Segment> far_square;
  for (int i = 0; i < 4; ++i) {
    const auto at = [&](int k) { return Vec3(k == 1 || k == 2 ? 1 : -1, k >= 2 ? 1 : -1, -2); };
    far_square.emplace_back(at(i), at((i + 1) % 4));
  }
  // The four edges towards the eye are cut at the image's border.
  EXPECT_EQ(drawing.lines.size(), 8u);
  double inside = 0.0;
  for (const DrawnLine& line : drawing.lines) inside += glm::length(line.to - line.from);
  const double top = projected(view, far_square[0].first).y;  // of the lower corners, in pixels
  const double to_border = std::sqrt(2.0) * (600.0 - top);
  expect_length(inside, length_of(view, far_square) + 4.0 * to_border);
}

TEST(LineDrawing, OfPlanesAloneIsEmptyAndOfAnyImageShapeStaysInIt) {
  Scene planes = dark_scene();
  add_object(planes, PlaneShape{});
  add_object(planes, PlaneShape{.point = Vec3(0), .normal = Vec3(1, 0, 0)});
  EXPECT_TRUE(draw(planes, view_of(perspective({3, 4, 5})), true).lines.empty());
  const Scene cube = boxes({{Vec3(-1), Vec3(1)}});
  for (const auto& [width, height] : {std::pair(1, 1), std::pair(30000, 1), std::pair(1, 30000)}) {
    const LineDrawing drawing = draw(cube, view_of(perspective({3, 4, 5}), width, height), true);
    EXPECT_FALSE(drawing.lines.empty());
    for (const DrawnLine& line : drawing.lines) {
      EXPECT_TRUE(line.from.x >= 0.0 && line.from.x <= width && line.from.y >= 0.0 && line.from.y <= height);
      EXPECT_TRUE(line.to.x >= 0.0 && line.to.x <= width && line.to.y >= 0.0 && line.to.y <= height);
    }
    EXPECT_FALSE(LineInk(drawing).is_inked(0.01, 0.01) && width > 1);
  }
}

MeshData octahedron(bool is_cut) {
  MeshData mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const auto middle = [&](uint32_t a, uint32_t b) {
    mesh.positions.push_back(0.5 * (mesh.positions[a] + mesh.positions[b]));
    return static_cast<uint32_t>(mesh.positions.size() - 1);
  };
  for (uint32_t octant = 0; octant < 8; ++octant) {
    uint32_t a = octant & 1, b = 2 + (octant >> 1 & 1), c = 4 + (octant >> 2);
    if (std::popcount(octant) % 2 == 1) std::swap(a, b);
    if (!is_cut) {
      mesh.indices.insert(mesh.indices.end(), {a, b, c});
      continue;
    }
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    mesh.indices.insert(mesh.indices.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
  }
  return mesh;
}

TEST(LineDrawing, OfAConvexMeshShowsTheEdgesOfItsFlatFacesHoweverTheyAreCut) {
  const Vec3 eye(3, 2, 1.5);
  const View view = view_of(perspective(eye));
  std::vector<Segment> expected;  // an edge from axis to axis lies between the two octants that share its signs
  for (int axis = 0; axis < 3; ++axis) {
    for (int signs = 0; signs < 4; ++signs) {
      Vec3 a(0.0), b(0.0), other(0.0);
      a[axis] = signs & 1 ? 1.0 : -1.0, b[(axis + 1) % 3] = signs & 2 ? 1.0 : -1.0, other[(axis + 2) % 3] = 1.0;
      const double in_plane = glm::dot(a + b, eye) - 1.0;
      if (in_plane + glm::dot(other, eye) > 0.0 || in_plane - glm::dot(other, eye) > 0.0) expected.emplace_back(a, b);
    }
  }
  for (const bool is_cut : {false, true}) {
    Scene scene = dark_scene();
    scene.meshes = {octahedron(is_cut)};
    add_object(scene, MeshShape{0});
    const LineDrawing drawing = draw(scene, view);
    EXPECT_EQ(drawing.work.convex_bodies, 1);
    EXPECT_EQ(drawing.lines.size(), expected.size() * (is_cut ? 2 : 1));
    expect_length(length_of(drawing, kVisible), length_of(view, expected));
  }
}

TEST(LineDrawing, IsTheSameOnAnyNumberOfThreads) {
  View view;
  const Scene scene = parsed(file_text("web/scenes/opening.json"), &view);
  TilePool one(1), three(3);
  const auto compiled = compile_scene(scene, one);
  const ViewPlan plan = plan_view(*compiled, view, "");
  const LineDrawing a = draw_lines(*compiled, plan, one, true), b = draw_lines(*compiled, plan, three, true);
  EXPECT_GT(a.lines.size(), 10000u);
  EXPECT_EQ(line_drawing_svg(a), line_drawing_svg(b));
  EXPECT_EQ(a.work.occlusion_tests, b.work.occlusion_tests);
  ASSERT_EQ(a.lines.size(), b.lines.size());
  for (size_t i = 0; i < a.lines.size(); ++i) {
    ASSERT_EQ(a.lines[i].from, b.lines[i].from);
    ASSERT_EQ(a.lines[i].to, b.lines[i].to);
  }
}

TEST(LineDrawing, AsSvgDashesWhatIsHidden) {
  const View view = view_of(perspective({3, 4, 5}));
  const std::string svg = line_drawing_svg(draw(boxes({{Vec3(-1), Vec3(1)}}), view, true));
  EXPECT_EQ(svg.find("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"600\" viewBox=\"0 0 800 600\">"),
            0u);
  EXPECT_EQ(svg.substr(svg.size() - 7), "</svg>\n");
  EXPECT_NE(svg.find("class=\"crease hidden\" stroke-width=\"1\" stroke-dasharray=\"6 4\""), std::string::npos);
  // One subpath for the outline's hexagon.
  const size_t outline = svg.find("class=\"silhouette\" stroke-width=\"1.5\"");
  ASSERT_NE(outline, std::string::npos);
  const std::string data = svg.substr(outline, svg.find("/>", outline) - outline);
  EXPECT_EQ(std::count(data.begin(), data.end(), 'M'), 1);
  EXPECT_EQ(std::count(data.begin(), data.end(), 'L'), 6);
}

TEST(LineInk, LiesOnStrokesOfTheirWidthAndBetweenDashesNot) {
  LineDrawing drawing{200, 100, {}, {}};
  drawing.lines.push_back({.from = {10, 20.5}, .to = {150, 20.5}});
  drawing.lines.push_back({.from = {10, 60}, .to = {13, 60}, .is_hidden = true});
  drawing.lines.push_back({.from = {13, 60}, .to = {110, 60}, .is_hidden = true, .along = 3.0});
  const LineInk ink(drawing);
  for (const double x : {10.0, 63.9, 64.0, 149.9}) {
    EXPECT_TRUE(ink.is_inked(x, 20.5 + 0.74));
    EXPECT_TRUE(ink.is_inked(x, 20.5 - 0.74));
    EXPECT_FALSE(ink.is_inked(x, 20.5 + 0.76));
  }
  EXPECT_TRUE(ink.is_inked(150.7, 20.5));
  EXPECT_FALSE(ink.is_inked(150.7, 21.1));
  EXPECT_FALSE(ink.is_inked(150.8, 20.5));
  for (double x = 10.05; x < 110.0; x += 0.1) {
    EXPECT_EQ(ink.is_inked(x, 60.4), std::fmod(x - 10.0, 10.0) < 6.0) << x;
    EXPECT_FALSE(ink.is_inked(x, 60.6));
  }
  EXPECT_FALSE(ink.is_inked(-1.0, 20.5));
  EXPECT_FALSE(ink.is_inked(100.0, 100.5));
}

TEST(LineInk, TakesTheAreaOfItsStrokes) {
  const double width = 90.0, height = 70.0;
  LineDrawing drawing{100, 80, {}, {}};
  drawing.lines.push_back({.from = {5, 5}, .to = {5 + width, 5 + height}});
  const LineInk ink(drawing);
  int inked = 0;
  for (int y = 0; y < 800; ++y)
    for (int x = 0; x < 1000; ++x) inked += ink.is_inked((x + 0.5) / 10.0, (y + 0.5) / 10.0);
  const double r = 0.5 * kVisibleLinePx;
  EXPECT_NEAR(inked / 100.0, std::hypot(width, height) * 2.0 * r + std::numbers::pi * r * r, 0.2);
}

}  // namespace
}  // namespace tilelight
