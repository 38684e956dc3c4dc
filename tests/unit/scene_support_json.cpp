// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <stdexcept>

#include "renderer/base/characters.h"
#include "scene_support.h"

namespace tilelight::test {

using nlohmann::json;

std::string_view full_document() {
  return R"({
  "tilelight": 1,
  "camera": {"type": "perspective", "position": [4,5,9], "target": [0,0.5,0], "up": [0,1,0], "fov_y_deg": 40},
  "image": {"width": 1280, "height": 720, "exposure": 0},
  "render": {"algorithm": "raytrace", "shading": "phong", "shadows": true, "max_depth": 8, "weight_cutoff": 0.002,
             "ray_budget": 4096, "terminator": "smooth", "filter": "box", "tessellate": false, "samples": 16,
             "time_ms": 5000, "passes": [1, 1, 2], "seed": 0},
  "background": {"bottom": [0.9,0.9,0.95], "top": "#87a9ff"},
  "ambient": 0.12,
  "attenuation": {"mode": "linear", "k": 6},
  "lights": [{"type": "point", "name": "lamp", "position": [5,8,4], "color": [1,0.95,0.9], "intensity": 9},
             {"type": "directional", "direction": [-1,-2,-1], "intensity": 0.3, "shadow": false, "x-mine": 1}],
  "materials": {
    "ivory": {"ambient": [0.9,0.85,0.7], "diffuse": [0.9,0.85,0.7], "specular": 0.4, "shininess": 60, "reflection": 0.08},
    "glass": {"diffuse": 0, "specular": 0.5, "shininess": 400, "reflection": 0.1, "transmission": 0.9, "ior": 1.5,
              "priority": 2, "fresnel": true},
    "tiles": {"diffuse": {"checker": {"a": [0.9,0.9,0.9], "b": "#202020", "size": 1}}}},
  "meshes": {"tetra": {"positions": [0,0,0, 1,0,0, 0,1,0, 0,0,1], "indices": [0,2,1, 0,1,3, 0,3,2, 1,2,3],
                       "crease_deg": 30},
             "leaf": {"positions": [0,0,0, 1,0,0, 0,1,0], "indices": [0,1,2], "normals": [0,0,1, 0,0,1, 0,0,1]}},
  "objects": [
    {"type": "chess_position", "fen": "r1bqkbnr/pppp1ppp/2n5/4p3/2B1P3/5N2/PPPP1PPP/RNBQK2R b KQkq - 3 3", "detail": 48,
     "materials": {"white": "ivory", "frame": {"diffuse": 0.1}}},
    {"type": "chess_piece", "piece": "knight", "position": [6,0,0], "material": "ivory", "detail": 96, "color": "black"},
    {"type": "sphere", "name": "ball", "center": [0,1,0], "radius": 1, "material": "glass", "extras": {"any": [null]}},
    {"type": "cube", "center": [3,0.5,0], "size": 1, "rotate_deg": {"axis": [0,1,0], "angle": 30}},
    {"type": "box", "min": [-9,-1,-9], "max": [9,0,9], "material": "tiles", "rotate_quat": [0,0,0,1]},
    {"type": "plane", "point": [0,-1,0], "normal": [0,1,0], "matrix": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]},
    {"type": "mesh", "mesh": "tetra", "translate": [1,0,2], "scale": [1,2,1]},
    {"type": "mesh", "mesh": "leaf", "material": {"name": "green", "diffuse": [0.1,0.6,0.1]}, "scale": 2}]
})";
}

std::string scene_of(std::string_view object, std::string_view members) {
  return "{" + std::string(members) + "\"objects\": [" + std::string(object) + "]}";
}

ParsedScene parsed(std::string_view text) {
  auto scene = parse_scene(text, Limits{});
  if (scene) return std::move(*scene);
  ADD_FAILURE() << listed(scene.error().errors);
  return {};
}

std::vector<SceneError> errors_of(std::string_view text, const Limits& limits) {
  auto scene = parse_scene(text, limits);
  if (!scene) return std::move(scene.error().errors);
  ADD_FAILURE() << "parsed, though it should not: " << text.substr(0, 300);
  return {};
}

SceneError error_of(std::string_view text, std::string_view code, const Limits& limits) {
  const auto errors = errors_of(text, limits);
  for (const SceneError& error : errors) {
    if (error.code == code) return error;
  }
  ADD_FAILURE() << "no " << code << " among:\n" << listed(errors);
  return {};
}

std::string listed(const std::vector<SceneError>& errors) {
  std::string text;
  for (const SceneError& e : errors) {
    text += std::to_string(e.line) + ":" + std::to_string(e.column) + " " + e.pointer + " " + e.code + ": " + e.detail +
            (e.hint.empty() ? "" : " (" + e.hint + ")") + "\n";
  }
  return text;
}

bool pointer_resolves(std::string_view document, const std::string& pointer) {
  const json root = json::parse(document);
  return pointer.empty() || root.contains(json::json_pointer(pointer));
}

namespace {

// Calls `visit` with the pointer of every value of `value`, itself included.
template <class Visit>
void walk(const json& value, const json::json_pointer& at, const Visit& visit) {
  visit(at, value);
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) walk(member, at / key, visit);
  } else if (value.is_array()) {
    for (size_t i = 0; i < value.size(); ++i) walk(value[i], at / i, visit);
  }
}

}  // namespace

std::vector<std::string> single_mutations(std::string_view document) {
  const json root = json::parse(document);
  const std::vector<json> replacements = {nullptr,
                                          true,
                                          false,
                                          -1,
                                          -0.0,
                                          0.5,
                                          1,
                                          2,
                                          7,
                                          64,
                                          1e9,
                                          1e31,
                                          "",
                                          "ivory",
                                          "#a0B1c2",
                                          "#12345",
                                          "perspective",
                                          "box",
                                          json::array(),
                                          json{0, 0, 0},
                                          json{1, 2, 3},
                                          json{-1, 1, 1},
                                          json{1, "2"},
                                          json{{}, 1},
                                          json::object(),
                                          {{"diffuse", 1}},
                                          {{"checker", json::object()}}};
  std::vector<std::string> mutations;
  walk(root, json::json_pointer(), [&](const json::json_pointer& at, const json& value) {
    const auto mutate = [&](auto change) {
      json copy = root;
      change(copy);
      mutations.push_back(copy.dump());
    };
    for (const json& other : replacements) mutate([&](json& copy) { copy[at] = other; });
    if (value.is_object()) {
      for (const char* key : {"type", "name", "extras", "x-free", "raduis", "matrix", "rotate_deg", "rmse", "asset"}) {
        mutate([&](json& copy) { copy[at][key] = 1; });
      }
    }
    if (at.empty()) return;
    mutate([&](json& copy) {
      json& parent = copy[at.parent_pointer()];
      if (parent.is_object()) {
        parent.erase(at.back());
      } else {
        parent.erase(parent.begin() + std::stoi(at.back()));
      }
    });
  });
  return mutations;
}

struct SchemaJudge::State {
  json schema;
  mutable std::map<std::pair<std::string, std::string>, bool> verdicts;

  static size_t length_of(const json& text) { return count_characters(text.get<std::string>()); }

  bool accepts(const json& rules, const json& value) const {
    for (const auto& [keyword, operand] : rules.items()) {
      if (!holds(keyword, operand, rules, value)) return false;
    }
    return true;
  }

  bool holds(const std::string& keyword, const json& operand, const json& rules, const json& value) const {
    const auto passes = [&](const json& option) { return accepts(option, value); };
    if (keyword == "$ref") return accepts(schema.at(json::json_pointer(operand.get<std::string>().substr(1))), value);
    if (keyword == "type") return is_type(operand, value);
    if (keyword == "const") return value == operand;
    if (keyword == "enum") return std::find(operand.begin(), operand.end(), value) != operand.end();
    if (keyword == "not") return !accepts(operand, value);
    if (keyword == "anyOf") return std::any_of(operand.begin(), operand.end(), passes);
    if (keyword == "oneOf") return std::count_if(operand.begin(), operand.end(), passes) == 1;
    if (keyword == "allOf") return std::all_of(operand.begin(), operand.end(), passes);
    if (keyword == "minimum") return !value.is_number() || value >= operand;
    if (keyword == "maximum") return !value.is_number() || value <= operand;
    if (keyword == "exclusiveMinimum") return !value.is_number() || value > operand;
    if (keyword == "exclusiveMaximum") return !value.is_number() || value < operand;
    if (keyword == "minItems") return !value.is_array() || value.size() >= operand.get<size_t>();
    if (keyword == "maxItems") return !value.is_array() || value.size() <= operand.get<size_t>();
    if (keyword == "minLength") return !value.is_string() || length_of(value) >= operand.get<size_t>();
    if (keyword == "maxLength") return !value.is_string() || length_of(value) <= operand.get<size_t>();
    if (keyword == "minProperties") return !value.is_object() || value.size() >= operand.get<size_t>();
    if (keyword == "maxProperties") return !value.is_object() || value.size() <= operand.get<size_t>();
    if (keyword == "pattern") return !value.is_string() || matches(operand, value);
    if (keyword == "items") {
      return !value.is_array() ||
             std::all_of(value.begin(), value.end(), [&](const json& item) { return accepts(operand, item); });
    }
    if (keyword == "required") {
      return !value.is_object() || std::all_of(operand.begin(), operand.end(),
                                               [&](const json& key) { return value.contains(key.get<std::string>()); });
    }
    if (keyword == "properties") return !value.is_object() || members_hold(rules, value);
    static const std::set<std::string> kSeenToElsewhere = {
        "patternProperties", "additionalProperties", "title", "description", "default", "$schema", "$defs"};
    if (!kSeenToElsewhere.contains(keyword)) throw std::logic_error("no rule for the schema keyword " + keyword);
    return true;
  }

  void fill_in(const json& rules, json& value, int& count) const {
    if (rules.contains("$ref"))
      return fill_in(schema.at(json::json_pointer(rules["$ref"].get<std::string>().substr(1))), value, count);
    for (const char* choice : {"oneOf", "anyOf"}) {
      if (!rules.contains(choice)) continue;
      for (const json& option : rules[choice]) {
        if (accepts(option, value)) return fill_in(option, value, count);
      }
    }
    if (value.is_array() && rules.contains("items")) {
      for (json& item : value) fill_in(rules["items"], item, count);
    }
    if (!value.is_object() || !rules.contains("properties")) return;
    for (const auto& [key, property] : rules["properties"].items()) {
      if (value.contains(key) || !property.contains("default")) continue;
      value[key] = property["default"];
      ++count;
    }
    for (auto& [key, member] : value.items()) {
      const bool known = rules["properties"].contains(key);
      if (known || rules["additionalProperties"].is_object()) {
        fill_in(known ? rules["properties"][key] : rules["additionalProperties"], member, count);
      }
    }
  }

  bool members_hold(const json& rules, const json& value) const {
    const json& properties = rules.at("properties");
    for (const auto& [key, member] : value.items()) {
      if (properties.contains(key)) {
        if (!accepts(properties[key], member)) return false;
      } else if (!key.starts_with("x-")) {  // the only pattern there is
        const auto additional = rules.find("additionalProperties");  // absent: anything
        if (additional != rules.end() && (*additional == false || !accepts(*additional, member))) return false;
      }
    }
    return true;
  }

  // In wide characters, for patterns name code points. Mutations of a document ask the same again and again.
  bool matches(const std::string& pattern, const std::string& text) const {
    const auto [found, is_new] = verdicts.try_emplace({pattern, text});
    if (is_new) found->second = std::regex_search(wide(text), std::wregex(wide(pattern)));
    return found->second;
  }

  static std::wstring wide(const std::string& text) {
    std::wstring out;
    for (size_t at = 0; at < text.size();) {
      const auto [code, bytes] = character_at(text, at);
      out += static_cast<wchar_t>(code);
      at += bytes;
    }
    return out;
  }

  static bool is_type(const std::string& type, const json& value) {
    if (type == "object") return value.is_object();
    if (type == "array") return value.is_array();
    if (type == "string") return value.is_string();
    if (type == "boolean") return value.is_boolean();
    if (type == "number") return value.is_number();
    if (type == "integer") return value.is_number() && std::floor(value.get<double>()) == value.get<double>();
    throw std::logic_error("no rule for the schema type " + type);
  }
};

SchemaJudge::SchemaJudge(std::string_view schema) : state_(new State{json::parse(schema), {}}) {}
SchemaJudge::~SchemaJudge() { delete state_; }
bool SchemaJudge::accepts(std::string_view document) const {
  return state_->accepts(state_->schema, json::parse(document));
}
std::string SchemaJudge::with_defaults(std::string_view document, int& count) const {
  json value = json::parse(document);
  state_->fill_in(state_->schema, value, count);
  return value.dump();
}

}  // namespace tilelight::test
