// SPDX-License-Identifier: Apache-2.0
// N, J: odd and hostile documents.
#include "renderer/check/rows/inputs.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "renderer/base/hash.h"
#include "renderer/check/kit/naive.h"
#include "renderer/check/kit/pictures.h"
#include "renderer/check/kit/rays.h"
#include "renderer/shade/surface.h"
#include "renderer/trace/trace_rays.h"

namespace tilelight::check {
namespace {

// A square of two triangles, x and y in [-1, 1], with the normals given for its corners.
std::string square_json(const std::string& normals) {
  return R"({"image": {"width": 48, "height": 48}, "render": {"samples": 1},
    "camera": {"position": [0.2, 0.3, 4], "target": [0, 0, 0]},
    "lights": [{"type": "directional", "direction": [-1, -1, -2], "intensity": 0.8}],
    "meshes": {"square": {"positions": [-1,-1,0, 1,-1,0, 1,1,0, -1,1,0], "indices": [0,1,2, 0,2,3],
                          "normals": [)" +
         normals + R"(]}}, "objects": [{"type": "mesh", "mesh": "square",
                   "material": {"diffuse": 0.6, "specular": 0.3, "shininess": 20}}]})";
}

// How many normals a warning of the code speaks of.
double counted(const std::vector<SceneWarning>& warnings, std::string_view code) {
  for (const SceneWarning& w : warnings)
    if (w.code == code) return std::strtod(w.detail.c_str(), nullptr);
  return 0.0;
}

bool is_unit(const Vec3& n) { return std::abs(glm::dot(n, n) - 1.0) <= 1e-12; }

// Shading normals along the line where opposite ones cancel that are not of unit length, and what a float renderer
// makes of them by n / |n|.
std::pair<int64_t, int64_t> lost_on_the_line(TilePool& pool) {
  const RayScene scene(square_json("0,0,1, 0,0,-1, 0,0,-1, 0,0,1"), pool);
  std::vector<BoundedRay> rays;
  constexpr int kRays = 1024;
  for (int i = 0; i < kRays; ++i)
    rays.push_back({{Vec3(0.0, (2.0 * i + 1.0) / kRays - 1.0, 2.0), Vec3(0.0, 0.0, -1.0), {}, {}}});
  std::vector<tilelight::Hit> hits(rays.size());
  trace_closest(scene.compiled(), rays, hits);
  int64_t lost = 0, textbook_lost = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    lost += !hits[i].is_hit() || !is_unit(make_surface(scene.compiled(), rays[i].ray, hits[i]).normal);
    const Vec3f sum = 0.5f * Vec3f(0.0f, 0.0f, 1.0f) + 0.5f * Vec3f(0.0f, 0.0f, -1.0f);
    textbook_lost += !std::isfinite((sum / std::sqrt(glm::dot(sum, sum))).z);
  }
  return {lost, textbook_lost};
}

Outcome of_zero_normals(const Context& context) {
  const auto picture = [&](const char* normals) { return picture_of(scene_of(square_json(normals)), context.pool); };
  const Picture facets = picture("0,0,1, 0,0,1, 0,0,1, 0,0,1"), zeros = picture("0,0,0, 0,0,0, 0,0,0, 0,0,0"),
                behind = picture("0,0,-1, 0,0,-1, 0,0,-1, 0,0,-1"), opposite = picture("0,0,1, 0,0,-1, 0,0,-1, 0,0,1"),
                tiny = picture("0,0,1e-30, 0,0,1e-20, 0,0,1e30, 0,0,1e-300");
  const auto [lost, textbook_lost] = lost_on_the_line(context.pool);
  int64_t nonfinite = 0;
  for (const Picture* p : {&zeros, &behind, &opposite, &tiny}) nonfinite += p->nonfinite();
  return {
      {at_most(0, "samples that are not finite", static_cast<double>(nonfinite)),
       within(0, "zero normals counted, off by", counted(zeros.warnings, "zero_normals"), 4),
       at_most(0, "zero normals against the facet's: pixels that differ, %", differing_pixels(zeros.rgb, facets.rgb)),
       at_most(0, "normals turned over: pixels that differ, %", differing_pixels(behind.rgb, facets.rgb)),
       at_most(0, "normals of length 1e-300 to 1e30: pixels that differ, %", differing_pixels(tiny.rgb, facets.rgb)),
       at_most(0, "normals lost where opposite ones cancel", static_cast<double>(lost))},
      {at_most(0, "normals lost where opposite ones cancel", static_cast<double>(textbook_lost))}};
}

// A document of one sphere; `members` of the document and `object`'s own begin with ", " or are empty.
std::string document(const std::string& members, const std::string& object) {
  return R"({"image": {"width": 8, "height": 8}, "objects": [{"type": "sphere")" + object + "}]" + members + "}";
}

std::string with_image(const char* image) {
  return R"({"objects": [{"type": "sphere"}], "image": )" + std::string(image) + "}";
}

using Refused = std::pair<std::string, std::string>;

// Documents, and where they have to be refused.
std::vector<Refused> refused_documents() {
  const auto radius = [](const char* n) {
    return Refused(document("", R"(, "radius": )" + std::string(n)), "/objects/0/radius");
  };
  const auto material = [](const char* m, const char* pointer) {
    return Refused(document("", R"(, "material": {)" + std::string(m) + "}"), pointer);
  };
  const auto with = [](const char* members, const char* pointer) { return Refused(document(members, ""), pointer); };
  std::string deepest = "/extras";  // the first that is too deep
  for (int level = 1; level < Limits{}.json_depth; ++level) deepest += "/0";
  return {
      radius("1e400"),
      radius("-1e400"),
      radius("1e999999999999999999999"),
      radius("1e-400"),  // is 0
      radius("-1e-320"),
      radius("-0"),
      radius("0"),
      radius("1e31"),
      radius("\"NaN\""),
      radius("\"Infinity\""),
      radius("null"),
      radius("[1]"),
      {document("", R"(, "center": [0, 1e400, 0])"), "/objects/0/center/1"},
      {document("", R"(, "center": [0, "NaN", 0])"), "/objects/0/center/1"},
      {document("", R"(, "scale": [1, 0, 1])"), "/objects/0/scale/1"},
      {document("", R"(, "matrix": [1,0,0,0, 0,-0,0,0, 0,0,1,0, 0,0,0,1])"), "/objects/0/matrix"},
      material(R"("shininess": -1)", "/objects/0/material/shininess"),
      material(R"("shininess": -1e-320)", "/objects/0/material/shininess"),
      material(R"("ior": 0)", "/objects/0/material/ior"),
      material(R"("shininess": 1e30)", "/objects/0/material/shininess"),
      material(R"("ior": 1e30)", "/objects/0/material/ior"),
      material(R"("ior": -1)", "/objects/0/material/ior"),
      material(R"("diffuse": [0.5, 1.0000001, 0.5])", "/objects/0/material/diffuse/1"),
      with(R"(, "camera": {"position": [1, 2, 3], "target": [1, 2, 3]})", "/camera/position"),
      with(R"(, "camera": {"position": [1, 2, 3], "fov_y_deg": 180})", "/camera/fov_y_deg"),
      with(R"(, "camera": {"position": [1, 2, 3], "fov_y_deg": -0})", "/camera/fov_y_deg"),
      with(R"(, "camera": {"position": [1, 2, 3], "up": [0, -0, 0]})", "/camera/up"),
      with(R"(, "render": {"max_depth": 1e9})", "/render/max_depth"),
      with(R"(, "render": {"max_depth": -1})", "/render/max_depth"),
      with(R"(, "render": {"samples": 18446744073709551616})", "/render/samples"),
      with(R"(, "render": {"samples": 0.5})", "/render/samples"),
      with(R"(, "render": {"passes": [1, 0]})", "/render/passes/1"),
      with(R"(, "attenuation": {"k": -1e-9})", "/attenuation/k"),
      with(R"(, "lights": [{"type": "point", "position": [0, 0, 0], "intensity": -1}])", "/lights/0/intensity"),
      with(R"(, "lights": [{"type": "directional", "direction": [0, 0, 0]}])", "/lights/0/direction"),
      with(R"(, "meshes": {"m": {"positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0, 1, 4294967296]}})",
           "/meshes/m/indices/2"),
      with(R"(, "meshes": {"m": {"positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0, 1, 3]}})", "/meshes/m/indices/2"),
      {with_image(R"({"width": 0})"), "/image/width"},
      {with_image(R"({"width": 2147483648})"), "/image/width"},
      {with_image(R"({"width": 65537, "height": 65537})"), "/image"},
      {with_image(R"({"exposure": 1e5})"), "/image/exposure"},
      {document(R"(, "extras": )" + std::string(100'000, '['), ""), deepest}};
}

// Odd, but they mean something: each of them has to be drawn.
std::vector<std::string> odd_documents() {
  std::vector<std::string> all;
  for (const char* object :
       {R"(, "center": [-0, -0, -0])", R"(, "center": [1e-320, -1e-320, 0])", R"(, "radius": 1e-320)",
        R"(, "radius": 1e-30)", R"(, "radius": 1e30)", R"(, "center": [1e30, 1e30, 1e30], "radius": 1e-30)",
        R"(, "scale": [1, 1e-30, 1e30])", R"(, "scale": -1)", R"(, "rotate_quat": [1e-320, 0, 0, 1e-320])",
        R"(, "material": {"shininess": -0})", R"(, "material": {"shininess": 1e12, "specular": 1})",
        R"(, "material": {"ior": 1e-30, "transmission": 1})", R"(, "material": {"ior": 1e6, "transmission": 1})",
        R"(, "material": {"diffuse": {"checker": {"a": 1, "b": 0, "size": 1e-320}}})"})
    all.push_back(document("", object));
  for (
      const char* members :
      {R"(, "camera": {"position": [1e-320, 0, 0]})", R"(, "camera": {"position": [1e30, 1e30, 1e30]})",
       R"(, "camera": {"position": [0, 5, 0], "up": [0, 1, 0]})",
       R"(, "camera": {"position": [3, 5, 0], "fov_y_deg": 1e-320})",
       R"(, "camera": {"position": [3, 5, 0], "fov_y_deg": 179.999999999})",
       R"(, "camera": {"type": "orthographic", "position": [3, 5, 0], "height": 1e-320})",
       R"(, "lights": [{"type": "point", "position": [0, 1, 0]}], "attenuation": {"k": -0})",
       R"(, "lights": [{"type": "point", "position": [0, 1, 0]}], "attenuation": {"mode": "inverse_square", "k": 1e-320})",
       R"(, "lights": [{"type": "directional", "direction": [1e-320, 0, 0], "intensity": 1e-320}])",
       R"(, "lights": [{"type": "directional", "direction": [1e30, -1e30, 1e30], "intensity": 1e30}])",
       R"(, "ambient": 1e30, "background": {"top": 1e30})",
       R"(, "render": {"max_depth": -0, "weight_cutoff": 1e-320})"})
    all.push_back(document(members, ""));
  return all;
}

// The textbook reads numbers by strtod and looks no further.
int64_t accepted_by_strtod() {
  int64_t count = 0;
  for (const char* text : {"1e400", "-1e400", "NaN", "nan(0x1)", "Infinity", "-inf"}) {
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    count += *end == '\0' && !std::isfinite(number);
  }
  return count;
}

Outcome of_hostile_numbers(const Context& context) {
  int64_t accepted = 0, elsewhere = 0, refused = 0, nonfinite = 0;
  for (const auto& [text, pointer] : refused_documents()) {
    const auto parsed = parse_scene(text, Limits{});
    accepted += parsed.has_value();
    elsewhere += !parsed && parsed.error().errors[0].pointer != pointer;
  }
  for (const std::string& text : odd_documents()) {
    const auto parsed = parse_scene(text, Limits{});
    refused += !parsed;
    if (!parsed) continue;
    const Picture picture = picture_of(*parsed, context.pool);
    nonfinite += picture.nonfinite() > 0 ||
                 !std::all_of(picture.linear.begin(), picture.linear.end(), [](float v) { return std::isfinite(v); });
  }
  return {{at_most(0, "hostile documents accepted", static_cast<double>(accepted)),
           at_most(0, "hostile documents refused at another place", static_cast<double>(elsewhere)),
           at_most(0, "odd documents refused", static_cast<double>(refused)),
           at_most(0, "odd documents with samples that are not finite", static_cast<double>(nonfinite))},
          {at_most(0, "numbers accepted that are none", static_cast<double>(accepted_by_strtod()))}};
}

// One scene, spelled by four hands.
constexpr const char* kSpellings[] = {
    R"({"objects":[{"type":"sphere","center":[0,0.5,0],"radius":2,"material":"red"}],"materials":{"red":{"diffuse":[1,0,0],"shininess":100}},"image":{"width":32,"height":24},"render":{"samples":1}})",
    R"({ "render": {"samples": 1.0}, "image": {"height": 2.4e1, "width": 32},
         "materials": {"red": {"shininess": 1e2, "diffuse": [1.0, -0.0, 0e5]}},
         "objects": [{"material": "red", "radius": 2.000, "center": [0, 5e-1, 0], "type": "sphere"}] })",
    R"({"tilelight": 1, "objects": [{"name": "ball", "type": "sphere", "center": [-0, 0.50000000000000000001, 0],
         "radius": 20e-1, "material": "r\u0065d", "x-note": 7}], "extras": {"by": "hand"},
        "materials": {"\u0072ed": {"diffuse": [1, 0, 0], "shininess": 100}}, "image": {"width": 32, "height": 24},
        "render": {"samples": 1}})",
    "\n\t{\"objects\"\r\n:[{\"type\":\"\\u0073phere\",\"center\":[0,0.5,0],\"radius\":0.0002E4,\"material\":\"red\"}],"
    "\"render\":{\"samples\":1},\"image\":{\"width\":32,\"height\":24},"
    "\"materials\":{\"red\":{\"diffuse\":[1,0,0],\"shininess\":0.1e+3}}}\n"};

Outcome of_spellings(const Context& context) {
  const ParsedScene first = scene_of(kSpellings[0]);
  const Picture picture = picture_of(first, context.pool);
  int64_t other_ids = 0, other_hashes = 0;
  double off = 0.0;
  for (const char* text : kSpellings) {
    const ParsedScene parsed = scene_of(text);
    other_ids += parsed.scene_id != first.scene_id || parsed.compile_key != first.compile_key;
    other_hashes += sha256_hex(text) != sha256_hex(kSpellings[0]);
    note(off, differing_pixels(picture_of(parsed, context.pool).rgb, picture.rgb));
  }
  return {{at_most(0, "spellings with another identity", static_cast<double>(other_ids)),
           at_most(0, "pixels that differ, %", off)},
          {at_most(0, "spellings with another identity", static_cast<double>(other_hashes))}};
}

constexpr Row kRows[] = {
    {"N1", "zero and opposite normals", "|n| = 0, 1e-300 to 1e30; n and -n on one edge", "n / |n| in float",
     of_zero_normals},
    {"J1", "hostile numbers", "1e400, -0, 1e-320, \"NaN\", depths of 1e5 and 1e9, n < 0", "strtod and nothing more",
     of_hostile_numbers},
    {"J2", "documents as large as may be", "16 MiB of brackets, digits, names, duplicates, errors",
     "a recursive reader's stack", of_large_documents},
    {"J3", "one scene in four spellings", "order of keys, 20e-1 and 2.000, escapes, names", "a hash of the text",
     of_spellings},
};

}  // namespace

std::span<const Row> input_rows() { return kRows; }

}  // namespace tilelight::check
