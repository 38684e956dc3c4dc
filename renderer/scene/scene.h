// SPDX-License-Identifier: Apache-2.0
// Scene: what the user asked for, checked and with its names resolved, in double and in the user's units.
// View: how he wants to look at it. A moved camera changes the View alone. Both are plain values.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/base/vec.h"

namespace tilelight {

using MaterialId = uint32_t;  // index into Scene::materials

// A 2-colour pattern: cells of edge `size` in the object's local frame, scene units.
struct Checker {
  Color a{1.0}, b{0.0};
  double size = 1.0;
  bool operator==(const Checker&) const = default;
};
using Paint = std::variant<Color, Checker>;

struct Material {
  std::string name;  // empty for an inline material
  Paint ambient = Color(0.8);
  Paint diffuse = Color(0.8);
  Color specular{0.0};
  double shininess = 32.0;  // exponent n of the lobe, >= 0
  Color reflection{0.0};    // kr
  Color transmission{0.0};  // kt
  double ior = 1.5;         // index of refraction, > 0
  int priority = 0;         // of overlapping media the higher one wins
  bool fresnel = false;     // weigh kr and kt by the dielectric Fresnel term
  bool operator==(const Material&) const = default;
};

enum class LightKind { point, directional };
struct Light {
  std::string name;
  LightKind kind = LightKind::point;
  Vec3 position{0.0};              // point: scene units
  Vec3 direction{0.0, -1.0, 0.0};  // directional: the way the light travels, not normalised
  Color color{1.0};
  double intensity = 1.0;
  bool shadow = true;
  bool operator==(const Light&) const = default;
};

enum class AttenuationMode { linear, inverse_square, none };
struct Attenuation {
  AttenuationMode mode = AttenuationMode::linear;
  double k = 1.0;  // scene units; squared units for inverse_square
  bool operator==(const Attenuation&) const = default;
};

enum class Piece : uint8_t { pawn, rook, knight, bishop, queen, king };
enum class Side : uint8_t { white, black };
inline constexpr int kPieceKinds = 6;

struct SphereShape {
  Vec3 center{0.0};
  double radius = 1.0;
  bool operator==(const SphereShape&) const = default;
};
struct BoxShape {  // also a cube
  Vec3 min{-0.5}, max{0.5};
  bool operator==(const BoxShape&) const = default;
};
struct PlaneShape {  // infinite
  Vec3 point{0.0}, normal{0.0, 1.0, 0.0};
  bool operator==(const PlaneShape&) const = default;
};
struct MeshShape {
  uint32_t mesh = 0;  // index into Scene::meshes
  bool operator==(const MeshShape&) const = default;
};
struct ChessPieceShape {
  Piece piece = Piece::pawn;
  Side side = Side::white;
  Vec3 position{0.0};  // middle of the foot
  int detail = 48;     // segments around the axis
  bool operator==(const ChessPieceShape&) const = default;
};
// Roles of a chess position's materials, in the order of ChessPositionShape::materials.
enum class ChessRole : uint8_t { white, black, light, dark, frame };
inline constexpr int kChessRoles = 5;
struct ChessMan {
  Piece piece;
  Side side;
  bool operator==(const ChessMan&) const = default;
};
// [rank][file], rank 0 = first rank, file 0 = a.
using ChessSquares = std::array<std::array<std::optional<ChessMan>, 8>, 8>;
struct ChessPositionShape {
  ChessSquares squares{};  // of 1 unit; a1 is centred at (-3.5, 0, 3.5)
  int detail = 48;
  std::array<MaterialId, kChessRoles> materials{};
  bool operator==(const ChessPositionShape&) const = default;
};
using Shape = std::variant<SphereShape, BoxShape, PlaneShape, MeshShape, ChessPieceShape, ChessPositionShape>;

struct Object {
  std::string name;
  Shape shape;
  MaterialId material = 0;  // unused by ChessPositionShape
  // The user's transform, after the shape's own placement; never singular. It takes the shape with `pivot` in the
  // origin: about a point far away, p - linear * p would round what is near to it.
  Mat4 world_from_shape{1.0};
  Vec3 pivot{0.0};
  bool operator==(const Object&) const = default;
};

struct MeshData {
  std::string name;
  std::vector<Vec3> positions;
  std::vector<uint32_t> indices;  // 3 a triangle, counter-clockwise from outside
  std::vector<Vec3> normals;      // none, or one a position
  double crease_deg = 30.0;       // edges sharper than this stay sharp; only where normals are absent
  bool operator==(const MeshData&) const = default;
};

struct Background {
  Color bottom{0.9, 0.9, 0.95}, top{0.35, 0.5, 0.8};
  bool operator==(const Background&) const = default;
};

struct Scene {
  std::vector<Material> materials;  // [0] is the default material
  std::vector<MeshData> meshes;
  std::vector<Object> objects;  // at least one
  std::vector<Light> lights;
  Background background;
  Color ambient{0.12};
  Attenuation attenuation;
  bool operator==(const Scene&) const = default;
};

enum class Projection { perspective, orthographic };
struct Camera {
  Projection projection = Projection::perspective;
  Vec3 position{0.0}, target{0.0}, up{0.0, 1.0, 0.0};
  double fov_y_deg = 40.0;  // perspective
  double height = 1.0;      // orthographic: scene units from the bottom to the top edge
  bool operator==(const Camera&) const = default;
};
struct ImageSpec {
  int width = 1280, height = 720;  // pixels
  double exposure = 0.0;           // stops
  bool operator==(const ImageSpec&) const = default;
};

// What decides which surface is seen: rays through the whole light model (Whitted 1980), a depth buffer (Catmull 1974)
// or subdivision of the window (Warnock 1969) with local light, or the visible edges alone (Roberts 1963).
enum class Algorithm { raytrace, zbuffer, warnock, roberts };
// Where the light equation is evaluated: once a face, at its middle; at its corners; at every point.
enum class Shading { flat, gouraud, phong };

// Where the light ends on a mesh with interpolated normals: on the smooth surface that it stands for, or facet by
// facet.
enum class Terminator { smooth, exact };

// How a pixel weighs the picture around its middle.
enum class PixelFilter { box, tent, gaussian };

struct RenderSpec {
  Algorithm algorithm = Algorithm::raytrace;
  Shading shading = Shading::phong;
  bool shadows = true;
  Terminator terminator = Terminator::smooth;
  PixelFilter filter = PixelFilter::box;
  bool tessellate = false;       // spheres become triangles; see is_tessellated
  double chord_error_px = 0.25;  // how far these may lie off the sphere, pixels as seen from the eye
  bool hidden_lines = false;     // roberts: dashed
  int max_depth = 8;             // secondary rays in a row; 0 = local light only
  double weight_cutoff = 0.002;  // a path of less weight is not followed
  int ray_budget = 4096;         // rays a pixel sample
  uint32_t seed = 0;
  // Stop rules; the first that holds ends the render.
  std::optional<int> samples;    // a pixel; parsing always sets it
  bool samples_implied = false;  // nobody asked for `samples`: it follows from the other rules or is the default
  std::optional<double> rmse;    // of displayed - true, over pixels and channels: the upper end of the estimate
  std::optional<double> time_ms;
  std::vector<double> passes;  // an exact replay; empty = not asked for
  bool adaptive = false;       // samples go where the error is; else every pixel takes as many
  bool operator==(const RenderSpec&) const = default;
};

// Whether the view is drawn from triangles, at sample places of 1/256 pixel: every method but ray tracing and every
// shading but phong takes it so.
inline bool is_tessellated(const RenderSpec& spec) {
  return spec.tessellate || spec.algorithm != Algorithm::raytrace || spec.shading != Shading::phong;
}

struct View {
  std::optional<Camera> camera;  // absent: framed from the scene
  ImageSpec image;
  RenderSpec render;
  bool operator==(const View&) const = default;
};

// Something odd but meaningful in a document, and what was made of it. `pointer` is a JSON pointer (RFC 6901) into it.
struct SceneWarning {
  std::string pointer, code, detail;
};

}  // namespace tilelight
