// SPDX-License-Identifier: Apache-2.0
#include "renderer/scene/parse.h"

#include "renderer/base/standard_floats.h"
#include "renderer/scene/build.h"
#include "renderer/scene/canonical.h"
#include "renderer/scene/check.h"
#include "renderer/scene/read_json.h"
#include "renderer/scene/readers.h"

namespace tilelight {
namespace {

Attenuation build_attenuation(Value value) {
  Attenuation attenuation;
  attenuation.mode = read_word(value, "mode", kAttenuationModes, attenuation.mode);
  attenuation.k = read_number(value, "k", attenuation.k);
  return attenuation;
}

Background build_background(Value value) {
  Background background;
  background.bottom = read_color(value, "bottom", background.bottom);
  background.top = read_color(value, "top", background.top);
  return background;
}

Scene build_scene(Value root, const Limits& limits, Problems& problems) {
  Scene scene;
  MaterialTable materials(root.find("materials"), limits, problems);
  MeshTable meshes = build_meshes(root.find("meshes"), limits, problems);
  scene.objects = build_objects(root.find("objects"), meshes, materials, limits, problems);
  scene.materials = materials.take();
  scene.meshes = std::move(meshes.meshes);
  scene.lights = build_lights(root.find("lights"));
  scene.background = build_background(root.find("background"));
  scene.ambient = read_color(root, "ambient", scene.ambient);
  scene.attenuation = build_attenuation(root.find("attenuation"));
  return scene;
}

// A document of a later version may have any keys: its number is all that is worth telling.
bool report_newer_version(Value root, Problems& problems) {
  constexpr double kVersion = 1.0;
  const Value version = root.find("tilelight");
  if (!version || !version.is(JsonKind::number) || version.number() <= kVersion) return false;
  problems.add(version, {"newer_version",
                         "found version " + number_text(version.number()) +
                             " of the scene language; allowed: up to 1, which is what this release reads",
                         {"1"},
                         "take a newer release, or write the scene in version 1"});
  return true;
}

}  // namespace

::tl::expected<ParsedScene, SceneErrors> parse_scene(std::string_view text, const Limits& limits) {
  const StandardFloats floats;
  auto document = read_document(text, limits);
  if (!document) return ::tl::unexpected(std::move(document.error()));
  Problems problems;
  report_duplicates(*document, problems);
  const Value root = document->root();
  ParsedScene parsed;
  if (!report_newer_version(root, problems)) {
    check_document(root, scene_grammar(limits), problems);
    // A check that gave up has left values unseen, which nobody may read.
    if (root.is(JsonKind::object) && !problems.full()) {
      parsed.scene = build_scene(root, limits, problems);
      parsed.view = build_view(root, limits, problems);
    }
  }
  if (problems.any()) return ::tl::unexpected(problems.take_errors(text));
  parsed.scene_id = scene_id(root);
  parsed.compile_key = compile_key(root);
  parsed.warnings = problems.take_warnings();
  return parsed;
}

}  // namespace tilelight
