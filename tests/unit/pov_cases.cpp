// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/pov_cases.h"

namespace tilelight {

const char* const kPlainPovScene = R"({
  "image": {"width": 48, "height": 36},
  "render": {"terminator": "exact"},
  "camera": {"position": [2, 2.5, 5], "target": [0, 0.6, 0], "up": [0.1, 1, 0], "fov_y_deg": 33},
  "attenuation": {"mode": "linear", "k": 2},
  "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 5}],
  "objects": [{"type": "plane", "material": {"diffuse": 0.6}},
              {"type": "sphere", "center": [0, 1, 0],
               "material": {"diffuse": [0.7, 0.3, 0.2], "specular": 0.5, "shininess": 40}}]})";

namespace {

// Objects over the plain plane.
std::string on_plane(const std::string& objects, const std::string& rest = "") {
  return R"({"objects": [{"type": "plane", "material": {"diffuse": 0.6}}, )" + objects + "]" +
         (rest.empty() ? "" : ", " + rest) + "}";
}
std::string ball(const std::string& material) {
  return on_plane(R"({"type": "sphere", "center": [0, 1, 0], "material": )" + material + "}");
}
// Two triangles that stand upright and face the camera, with these normals of their four corners.
std::string pane(const std::string& normals, const std::string& rest = "") {
  return on_plane(R"({"type": "mesh", "mesh": "pane", "material": {"diffuse": 0.8, "specular": 0.4, "shininess": 8}})",
                  R"("meshes": {"pane": {"positions": [-1.2,0.2,0, 1.2,0.2,0, 1.2,2,0, -1.2,2,0],
                      "indices": [0,1,2, 0,2,3], "normals": [)" +
                      normals + "]" + rest + "}}");
}
constexpr const char* kCheckered = R"({"diffuse": {"checker": {"a": 0.9, "b": 0.2, "size": 0.5}}})";
constexpr const char* kGlass =
    R"({"diffuse": 0, "ambient": 0, "reflection": 1, "transmission": [0.98, 0.9, 0.6], "fresnel": true})";
constexpr const char* kTurned = R"("rotate_deg": {"axis": [1, 2, 0.5], "angle": 40})";

std::vector<PovCase> of_the_view() {
  return {
      {"document", "a version of the language", R"({"tilelight": 1})"},
      {"size of the picture", "a narrow picture", R"({"image": {"width": 24, "height": 48}})"},
      {"exposure", "a stop more", R"({"image": {"exposure": 1}})"},
      {"exposure", "two stops less, over light far beyond 1",
       R"({"image": {"exposure": -2}, "background": {"bottom": 3, "top": 2},
           "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 40}]})"},
      {"perspective camera", "a wide field, tilted",
       R"({"camera": {"position": [1, 3, 3], "up": [0.4, 1, 0], "fov_y_deg": 90}})"},
      {"perspective camera", "an up vector along the view",
       R"({"camera": {"position": [0, 5, 0], "target": [0, 1, 0]}})"},
      {"orthographic camera", "parallel rays",
       R"({"camera": {"type": "orthographic", "fov_y_deg": null, "height": 4}})"},
      {"eye far from the scene", "a telescope", R"({"camera": {"position": [2e6, 2e6, 5e6], "fov_y_deg": 4e-5}})"},
      {"ray tracing", "by name", R"({"render": {"algorithm": "raytrace"}})"},
      {"other algorithms than raytrace", "a depth buffer",
       R"({"render": {"algorithm": "zbuffer"}, "objects": [{"type": "plane"}, {"type": "cube", "center": [0, 1, 0]}]})"},
      {"other algorithms than raytrace", "subdivision of the window",
       R"({"render": {"algorithm": "warnock"}, "objects": [{"type": "plane"}, {"type": "cube", "center": [0, 1, 0]}]})"},
      {"hidden lines", "dashed",
       R"({"render": {"algorithm": "roberts", "hidden_lines": true},
           "objects": [{"type": "cube", "center": [0, 1, 0]}]})"},
      {"phong shading", "by name", R"({"render": {"shading": "phong"}})"},
      {"flat and gouraud shading", "flat",
       R"({"render": {"shading": "flat"}, "objects": [{"type": "cube", "center": [0, 1, 0]}]})"},
      {"flat and gouraud shading", "gouraud",
       R"({"render": {"shading": "gouraud"}, "objects": [{"type": "cube", "center": [0, 1, 0]}]})"},
      {"tessellation", "of the ball", R"({"render": {"tessellate": true}})"},
      {"shadows", "none", R"({"render": {"shadows": false}})"},
      {"depth of up to 255", "local light alone",
       R"({"render": {"max_depth": 0}, "objects": [{"type": "plane", "material": {"reflection": 0.5}},
           {"type": "sphere", "center": [0, 1, 0], "material": {"reflection": 0.5}}]})"},
      {"depth of up to 255", "two reflections in a row",
       R"({"render": {"max_depth": 2, "weight_cutoff": 0}, "objects": [{"type": "plane", "material": {"reflection": 0.6}},
           {"type": "sphere", "center": [-0.8, 1, 0], "material": {"reflection": 0.9}},
           {"type": "sphere", "center": [1.4, 1, 0], "material": {"reflection": 0.9}}]})"},
      {"depth over 255", "facing mirrors",
       R"({"render": {"max_depth": 300}, "objects": [{"type": "plane", "material": {"reflection": 0.9}}]})"},
      {"depth of up to 255", "three panes at depth two",
       R"({"render": {"max_depth": 2}, "objects": [
           {"type": "box", "min": [-1, 0, 0], "max": [1, 2, 0], "material": {"diffuse": 0, "transmission": 0.8}},
           {"type": "box", "min": [-1, 0, 1], "max": [1, 2, 1], "material": {"diffuse": 0, "transmission": 0.8}},
           {"type": "box", "min": [-1, 0, 2], "max": [1, 2, 2], "material": {"diffuse": 0, "transmission": 0.8}}]})"},
      {"weight of paths", "mirrors that show no mirrors",
       R"({"render": {"weight_cutoff": 0.5}, "objects": [{"type": "plane", "material": {"reflection": 0.6}},
           {"type": "sphere", "center": [0, 1, 0], "material": {"reflection": 0.6}}]})"},
      {"budget of rays", "four rays",
       R"({"render": {"ray_budget": 4}, "objects": [{"type": "plane", "material": {"reflection": 0.6}}]})"},
      {"box filter", "by name", R"({"render": {"filter": "box"}})"},
      {"tent filter", "of two pixels", R"({"render": {"filter": "tent"}})"},
      {"gaussian filter", "of half a pixel's deviation", R"({"render": {"filter": "gaussian"}})"},
      {"rules of sampling", "by error and time", R"({"render": {"seed": 7, "rmse": 0.01, "time_ms": 60000}})"},
  };
}

std::vector<PovCase> of_light() {
  return {
      {"background", "red below, blue above", R"({"background": {"bottom": [0.8, 0.1, 0.1], "top": [0, 0.1, 0.9]},
          "objects": [{"type": "sphere", "center": [0, 1, 0], "material": {"diffuse": 0.1, "reflection": 0.8}}]})"},
      {"ambient light", "of a colour", R"({"ambient": [0.3, 0.2, 0.1]})"},
      {"ambient light", "without diffuse reflection", ball(R"({"diffuse": 0, "ambient": [0.9, 0.4, 0]})")},
      {"ambient light", "in one channel that reflects nothing",
       ball(R"({"diffuse": [0.5, 0, 0], "ambient": [0.9, 0.8, 0]})")},
      {"ambient light", "of another checker than the diffuse one",
       R"({"camera": {"position": [2, 5, 3]}, "ambient": 0.4, "objects": [{"type": "plane", "material": {
           "diffuse": {"checker": {"a": 0.8, "b": 0.1, "size": 2}}, "ambient": {"checker": {"a": 0, "b": 1, "size": 1.3}}}}]})"},
      {"ambient light", "of a checker over plain diffuse",
       R"({"camera": {"position": [2, 5, 3]}, "ambient": 0.4, "objects": [{"type": "plane", "material": {
           "diffuse": 0.3, "ambient": {"checker": {"a": 0, "b": 1, "size": 1.3}}}}]})"},
      {"attenuation", "linear without a constant", R"({"attenuation": {"mode": "linear", "k": 0}})"},
      {"attenuation", "by the inverse square",
       R"({"attenuation": {"mode": "inverse_square", "k": 3},
           "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 30}]})"},
      {"attenuation", "by the inverse square without a constant",
       R"({"attenuation": {"mode": "inverse_square", "k": 0},
           "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 30}]})"},
      {"attenuation", "none", R"({"attenuation": {"mode": "none"},
          "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 0.7}]})"},
      {"point lights", "two of other colours",
       R"({"lights": [{"type": "point", "position": [3, 5, 4], "color": [1, 0.5, 0.2], "intensity": 4},
                      {"type": "point", "position": [-3, 2, 1], "color": [0.1, 0.5, 1], "intensity": 3}]})"},
      {"directional lights", "from a side",
       R"({"lights": [{"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.7}]})"},
      {"directional lights", "of a tiny direction",
       R"({"lights": [{"type": "directional", "direction": [-1e-170, -2e-170, -1.5e-170], "intensity": 0.7}]})"},
      {"lights without shadow", "one alone",
       R"({"lights": [{"type": "point", "position": [3, 5, 4], "intensity": 5, "shadow": false}]})"},
      {"lights without shadow", "a directional one beside a lamp",
       R"({"lights": [{"type": "point", "position": [3, 5, 4], "intensity": 4},
                      {"type": "directional", "direction": [1, -2, -1], "intensity": 0.4, "shadow": false}]})"},
      {"lights without shadow", "a lamp beside a lamp",
       R"({"lights": [{"type": "point", "position": [3, 5, 4], "intensity": 3},
                      {"type": "point", "position": [-3, 4, 4], "intensity": 3, "shadow": false}]})"},
      {"lights without shadow", "beside a lamp, on what is dull",
       R"({"objects": [{"type": "plane"}, {"type": "sphere", "center": [0, 1, 0]}],
           "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 3},
                      {"type": "point", "position": [-3, 4, 4], "intensity": 3, "shadow": false}]})"},
  };
}

std::vector<PovCase> of_materials() {
  return {
      {"diffuse reflection", "black and colours", ball(R"({"diffuse": [0.9, 0, 0.3]})")},
      {"checkers", "on a plane",
       R"({"camera": {"position": [2, 5, 3]}, "objects": [{"type": "plane", "material": )" + std::string(kCheckered) +
           "}]}"},
      {"checkers", "on a tilted plane through the origin of cells",
       R"({"camera": {"position": [2, 5, 3]}, "objects": [{"type": "plane", "normal": [0.2, 1, 0.1], "material": )" +
           std::string(kCheckered) + "}]}"},
      {"checkers", "on a ball", ball(kCheckered)},
      {"checkers", "on a box whose faces end at cells",
       on_plane(R"({"type": "box", "min": [-1, 0, -1], "max": [1, 2, 1], "material": )" + std::string(kCheckered) +
                "}")},
      {"checkers", "on a turned box of uneven sides",
       on_plane(R"({"type": "box", "min": [-1, 0.3, -0.7], "max": [0.9, 2, 1], "material": )" +
                std::string(kCheckered) + ", " + kTurned + "}")},
      {"checkers", "on a mesh",
       on_plane(
           R"({"type": "mesh", "mesh": "tetra", "scale": 2.5, "translate": [-1, 0, -1], "material": )" +
               std::string(kCheckered) + "}",
           R"("meshes": {"tetra": {"positions": [0,0,0, 1,0,0, 0,1,0, 0,0,1], "indices": [0,2,1, 0,1,3, 0,3,2, 1,2,3]}})")},
      {"checkers", "that glow beside what they reflect",
       ball(R"({"diffuse": {"checker": {"a": [0.9, 0, 0], "b": 0.2, "size": 0.5}}, "ambient": 0.7})")},
      {"grey highlights", "sharp", ball(R"({"diffuse": 0.2, "specular": 0.8, "shininess": 300})")},
      {"grey highlights", "of shininess 0", ball(R"({"diffuse": 0.2, "specular": 0.5, "shininess": 0})")},
      {"coloured highlights", "of gold",
       ball(R"({"diffuse": [0.3, 0.2, 0.1], "specular": [0.9, 0.6, 0.2], "shininess": 9})")},
      {"mirrors", "coloured", ball(R"({"diffuse": 0.1, "reflection": [0.9, 0.6, 0.2]})")},
      {"transmission", "a tinted pane, and its shadow",
       on_plane(R"({"type": "box", "min": [-1, 0.2, 0.5], "max": [1, 2, 0.5], "material":
                    {"diffuse": 0, "transmission": [0.9, 0.5, 0.2]}})")},
      {"transmission", "a pane that also reflects and shines",
       on_plane(R"({"type": "box", "min": [-1, 0.2, 0.5], "max": [1, 2, 0.5], "material":
                    {"diffuse": [0.1, 0.3, 0.2], "specular": 0.4, "shininess": 20, "reflection": 0.2,
                     "transmission": [0.5, 0.4, 0.6]}})")},
      {"transmission", "a sheet with a back, which holds nothing",
       on_plane(
           R"({"type": "mesh", "mesh": "sheet", "material": {"diffuse": 0, "transmission": [0.9, 0.5, 0.2], "ior": 1.5}})",
           R"("meshes": {"sheet": {"positions": [-1,0.2,0.5, 1,0.2,0.5, 0,2,0.3], "indices": [0,1,2, 0,2,1]}})")},
      {"transmission", "a clear checker",
       on_plane(R"({"type": "box", "min": [-1, 0.2, 0.5], "max": [1, 2, 0.5], "material":
                    {"diffuse": {"checker": {"a": 0.5, "b": 0.1, "size": 0.5}}, "transmission": 0.5}})")},
      {"refraction", "a ball of glass",
       ball(R"({"diffuse": 0, "reflection": [0.1, 0.2, 0.4], "transmission": [0.9, 0.8, 0.6], "ior": 1.5})")},
      {"refraction", "a block of water, turned",
       on_plane(R"({"type": "box", "min": [-0.8, 0.6, -0.8], "max": [0.8, 2, 0.8], "material":
                    {"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "ior": 1.33}, )" +
                std::string(kTurned) + "}")},
      {"refraction", "glass that also reflects and shines",
       ball(
           R"({"diffuse": [0.2, 0.1, 0], "specular": 0.5, "shininess": 100, "reflection": 0.3, "transmission": 0.7})")},
      {"refraction", "seen from inside",
       R"({"camera": {"position": [0.5, 1.1, 0.6], "target": [0, 0.8, 0], "fov_y_deg": 70},
           "objects": [{"type": "plane"}, {"type": "cube", "center": [-2, 0, -1], "size": 1.5},
           {"type": "sphere", "center": [0, 1.2, 0], "material": {"diffuse": 0, "reflection": 0.2, "transmission": 0.8}}]})"},
      {"refraction by facets that stand for a curve", "a pawn of few",
       on_plane(R"({"type": "chess_piece", "piece": "pawn", "detail": 8, "material":
                    {"diffuse": 0, "reflection": 0, "transmission": 1, "ior": 1.5}})")},
      {"total reflection of weight 1", "a prism",
       on_plane(R"({"type": "cube", "center": [0, 1.2, 0], "size": 1.4, "material":
                    {"diffuse": 0, "reflection": 0, "transmission": 1, "ior": 1.6}, )" +
                std::string(kTurned) + "}")},
      {"total reflection of other weight", "dark glass",
       on_plane(R"({"type": "cube", "center": [0, 1.2, 0], "size": 1.4, "material":
                    {"diffuse": 0, "reflection": 0, "transmission": 0.6}, )" +
                std::string(kTurned) + "}")},
      {"fresnel with reflection 1", "amber", ball(kGlass)},
      {"fresnel with reflection 1", "a block",
       on_plane(R"({"type": "cube", "center": [0, 1.2, 0], "size": 1.4, "material": )" + std::string(kGlass) + ", " +
                kTurned + "}")},
      {"fresnel with other reflection", "half a mirror",
       ball(R"({"diffuse": 0, "reflection": 0.5, "transmission": 0.5, "fresnel": true})")},
      {"media apart", "two balls of other priorities",
       on_plane(R"({"type": "sphere", "center": [-1.1, 1, 0], "material":
                    {"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "priority": 3}},
                   {"type": "sphere", "center": [1.1, 1, 0], "material":
                    {"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "priority": 1}})")},
      {"media apart", "water within glass",
       ball(R"({"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "ior": 1.5}}, {"type": "sphere",
                "center": [0.1, 1, 0], "radius": 0.8, "material": {"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "ior": 1.33})")},
      {"media that meet", "balls that overlap", on_plane(R"({"type": "sphere", "center": [-0.5, 1, 0], "material":
                    {"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "priority": 3}},
                   {"type": "sphere", "center": [0.5, 1, 0], "material":
                    {"diffuse": 0, "reflection": 0.1, "transmission": 0.9, "priority": 1}})")},
      {"media that meet", "a cube of glass on the floor",
       on_plane(R"({"type": "cube", "center": [0, 0.5, 0], "material":
                    {"diffuse": 0, "reflection": 0.1, "transmission": 0.9}})")},
      {"media that meet", "a bubble with fresnel",
       ball(std::string(kGlass) + R"(}, {"type": "sphere", "center": [0, 1, 0],
           "radius": 0.5, "material": {"diffuse": 0, "reflection": 1, "transmission": 1, "ior": 1, "priority": 1, "fresnel": true})")},
  };
}

std::vector<PovCase> of_objects() {
  return {
      {"spheres", "two that overlap", R"({"objects": [{"type": "plane"}, {"type": "sphere", "center": [-0.4, 1, 0]},
          {"type": "sphere", "center": [0.7, 0.8, 0.3], "radius": 0.8}]})"},
      {"spheres", "an ellipsoid, turned",
       on_plane(R"({"type": "sphere", "center": [0, 1.2, 0], "scale": [1.5, 0.7, 1],
          "material": {"diffuse": 0.5, "specular": 0.5, "reflection": 0.3}, )" +
                std::string(kTurned) + "}")},
      {"cubes", "upright", on_plane(R"({"type": "cube", "center": [0, 1, 0], "size": 1.5})")},
      {"boxes", "upright and mirroring",
       on_plane(R"({"type": "box", "min": [-1, 0.2, -0.5], "max": [0.8, 1.5, 1], "material": {"reflection": 0.4}})")},
      {"boxes", "flat", on_plane(R"({"type": "box", "min": [-1, 0.7, -0.5], "max": [0.8, 0.7, 1]})")},
      {"boxes", "uneven and turned",
       on_plane(R"({"type": "box", "min": [-1, 0.2, -0.5], "max": [0.8, 1.5, 1], )" + std::string(kTurned) + "}")},
      {"planes", "a tilted one through another",
       on_plane(R"({"type": "plane", "point": [0, 0, -2], "normal": [0.3, 0.5, 1]})")},
      {"planes", "of a tiny normal",
       R"({"objects": [{"type": "plane", "normal": [0, 1e-170, 0]}, {"type": "cube", "center": [0, 0.5, 0]}]})"},
      {"meshes", "faceted",
       on_plane(
           R"({"type": "mesh", "mesh": "tetra", "scale": 2, "translate": [-0.5, 0, 0], "material": {"specular": 0.4}})",
           R"("meshes": {"tetra": {"positions": [0,0,0, 1,0,0, 0,1,0, 0,0,1], "indices": [0,2,1, 0,1,3, 0,3,2, 1,2,3], "crease_deg": 10}})")},
      {"meshes", "of tiny coordinates, placed by a matrix",
       on_plane(
           R"({"type": "mesh", "mesh": "tetra", "matrix": [2e6,0,0,0, 0,2e6,0,0, 0,0,2e6,0, -0.5,0,0,1]})",
           R"("meshes": {"tetra": {"positions": [0,0,0, 1e-6,0,0, 0,1e-6,0, 0,0,1e-6], "indices": [0,2,1, 0,1,3, 0,3,2, 1,2,3]}})")},
      {"normals of meshes", "all three alike", pane("0.5,0.3,0.8, 0.5,0.3,0.8, 0.5,0.3,0.8, 0.5,0.3,0.8")},
      {"normals of meshes", "two of three alike", pane("0,0,1, 0,0,1, 0.7,0,0.7, 0.7,0,0.7")},
      {"normals of meshes", "all different", pane("-0.5,-0.3,1, 0.5,-0.3,1, 0.5,0.4,1, -0.5,0.4,1")},
      {"normals that look away", "averaged across a ridge",
       on_plane(R"({"type": "mesh", "mesh": "roof", "material": {"diffuse": 0.8, "specular": 0.3}})",
                R"("meshes": {"roof": {"positions": [-1,0.3,0.6, 1,0.3,0.6, -1,1.4,0, 1,1.4,0, -1,0.3,-0.6, 1,0.3,-0.6],
                   "indices": [0,1,3, 0,3,2, 2,3,5, 2,5,4, 0,4,5, 0,5,1, 0,2,4, 1,5,3], "crease_deg": 180}})")},
      {"smooth terminator", "on a mesh with interpolated normals",
       R"({"render": {"terminator": "smooth"}, "camera": {"position": [1, 2, 4]}, "objects": [{"type": "chess_piece", "piece": "pawn", "detail": 8}]})"},
      {"exact terminator", "on a mesh with interpolated normals",
       R"({"camera": {"position": [1, 2, 4]}, "objects": [{"type": "plane"}, {"type": "chess_piece", "piece": "pawn", "detail": 32}]})"},
      {"exact terminator where nothing shades", "a pawn of few facets under a light without shadow",
       R"({"camera": {"position": [1, 2, 4]},
           "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 5, "shadow": false}],
           "objects": [{"type": "plane"}, {"type": "chess_piece", "piece": "pawn", "detail": 16}]})"},
      {"exact terminator where nothing shades", "a pane in slanting light, with normals that lean to it",
       R"({"lights": [{"type": "point", "position": [5, 1, -1], "intensity": 5}], "objects": [
           {"type": "mesh", "mesh": "pane", "material": {"diffuse": 0.8}}], "meshes": {"pane": {
           "positions": [-1.2,0.2,0, 1.2,0.2,0, 1.2,2,0, -1.2,2,0], "indices": [0,1,2, 0,2,3],
           "normals": [0.6,0,0.8, 0.7,0,0.7, 0.7,0,0.7, 0.6,0,0.8]}}})"},
      {"lights without shadow", "on a smooth mesh with the smooth terminator",
       R"({"render": {"terminator": "smooth"}, "camera": {"position": [1, 2, 4]},
           "lights": [{"type": "point", "position": [3, 5, 4], "intensity": 5, "shadow": false}],
           "objects": [{"type": "plane"}, {"type": "chess_piece", "piece": "pawn", "detail": 32}]})"},
      {"chess pieces", "a black knight",
       R"({"camera": {"position": [2, 2, 3]}, "objects": [{"type": "plane"},
           {"type": "chess_piece", "piece": "knight", "color": "black", "detail": 32}]})"},
      {"chess positions", "an endgame with a checkered frame",
       R"({"camera": {"position": [3, 5, 8], "target": [1, 0, 2], "fov_y_deg": 25},
           "lights": [{"type": "directional", "direction": [-1, -2, -1.5], "intensity": 0.7}],
           "objects": [{"type": "chess_position", "fen": "8/8/4k3/8/2Q5/8/3K4/8", "detail": 24,
                        "materials": {"white": {"diffuse": 0.8, "specular": 0.3}, "frame": )" +
           std::string(kCheckered) + "}}]}"},
      {"matrices", "a reflection with shear",
       on_plane(
           R"({"type": "cube", "center": [0, 0, 0], "matrix": [-1.2,0,0,0, 0.4,1,0,0, 0,0.2,0.9,0, 0,1,0,1], "material": {"specular": 0.3}})")},
      {"rotation", "of a mirrored mesh of uneven scale",
       R"({"camera": {"position": [2, 2, 3]}, "objects": [{"type": "plane"},
           {"type": "chess_piece", "piece": "knight", "detail": 32, "scale": [-1.5, 1, 0.7], "rotate_quat": [0, 0.4, 0, 1]}]})"},
      {"scale", "a scene of a millionth of the size",
       R"({"camera": {"position": [2e-6, 2.5e-6, 5e-6], "target": [0, 0.8e-6, 0]}, "attenuation": {"k": 2e-6},
           "lights": [{"type": "point", "position": [3e-6, 5e-6, 4e-6], "intensity": 5e-6}],
           "objects": [{"type": "plane"}, {"type": "sphere", "center": [0, 1e-6, 0], "radius": 1e-6,
                        "material": {"reflection": 0.3}}, {"type": "cube", "center": [1.4e-6, 0.3e-6, 0], "size": 0.6e-6}]})"},
      {"scale", "a scene of a million times the size",
       R"({"camera": {"position": [2e6, 2.5e6, 5e6], "target": [0, 0.8e6, 0]}, "attenuation": {"k": 2e6},
           "lights": [{"type": "point", "position": [3e6, 5e6, 4e6], "intensity": 5e6}],
           "objects": [{"type": "plane"}, {"type": "sphere", "center": [0, 1e6, 0], "radius": 1e6,
                        "material": {"reflection": 0.3}}, {"type": "cube", "center": [1.4e6, 0.3e6, 0], "size": 0.6e6}]})"},
      {"translation", "of a scene far from the origin",
       R"({"camera": {"position": [10000002, -6999997.5, 3000005], "target": [10000000, -6999999.2, 3000000]},
           "lights": [{"type": "point", "position": [10000003, -6999995, 3000004], "intensity": 5}],
           "objects": [{"type": "plane", "point": [10000000, -7000000, 3000000]},
                       {"type": "sphere", "center": [10000000, -6999999, 3000000], "material": {"specular": 0.5}}]})"},
      {"scale", "a cup on a field of a kilometre",
       on_plane(R"({"type": "box", "min": [-500, -1, -500], "max": [500, 0.01, 500]},
                   {"type": "sphere", "center": [0, 0.06, 0], "radius": 0.05, "material": {"specular": 0.5}})",
                R"("camera": {"position": [0.1, 0.2, 0.3], "target": [0, 0.05, 0]})")},
      {"details", "dust on a planet",
       R"({"objects": [{"type": "sphere", "center": [0, -1e7, 0], "radius": 1e7}, {"type": "sphere", "center": [0, 0.001, 0], "radius": 0.001}]})"},
  };
}

}  // namespace

std::vector<PovCase> pov_cases() {
  std::vector<PovCase> all;
  for (const auto& part : {of_the_view(), of_light(), of_materials(), of_objects()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace tilelight
