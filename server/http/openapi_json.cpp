// SPDX-License-Identifier: Apache-2.0
// openapi.json as it is served: the file beside this one, and in its place #/components/schemas/Scene the scene
// language, written from the parser's own grammar.
#include <cctype>
#include <nlohmann/json.hpp>
#include <utility>

#include "renderer/base/hash.h"
#include "server/http/documents.h"
#include "server/http/page_files.h"

namespace tilelight::server {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kDefs = "#/$defs/", kSchemas = "#/components/schemas/";

// "checker_map" -> "SceneCheckerMap": a name of its own among the schemas of the API.
std::string schema_name(std::string_view def) {
  std::string out = "Scene";
  bool begins_word = true;
  for (const char c : def) {
    const bool is_plain = std::isalnum(static_cast<unsigned char>(c)) != 0;
    if (is_plain) out += static_cast<char>(begins_word ? std::toupper(static_cast<unsigned char>(c)) : c);
    begins_word = !is_plain;
  }
  return out;
}

void adapt(Json& schema);

void adapt_all(Json& schemas) {
  for (auto& child : schemas) adapt(child);
}

// Definitions become schemas of the API, so references to them change. Defaults become words: makers of clients take a
// member that has one for a member that is always there, in what is sent too.
void adapt(Json& schema) {
  if (!schema.is_object()) return;
  if (schema.contains("$ref")) {
    const std::string target = schema["$ref"];
    schema["$ref"] = std::string(kSchemas) + schema_name(std::string_view(target).substr(kDefs.size()));
  }
  if (schema.contains("default")) {
    const std::string said = schema.value("description", "");
    schema["description"] = said + (said.empty() ? "" : ". ") + "Default: " + schema["default"].dump();
    schema.erase("default");
  }
  for (const char* key : {"items", "not", "additionalProperties"}) {
    if (schema.contains(key)) adapt(schema[key]);
  }
  for (const char* key : {"properties", "patternProperties", "$defs", "anyOf", "oneOf", "allOf"}) {
    if (schema.contains(key)) adapt_all(schema[key]);
  }
}

}  // namespace

Descriptions make_descriptions(const Config& config) {
  Descriptions out;
  out.scene_schema = scene_schema_json(config.limits);
  constexpr std::string_view kUrlHere = "<url>";  // nothing else in the document says so
  Json document = Json::parse(kOpenApiFile.bytes);
  document["servers"][0]["url"] = kUrlHere;
  Json scene = Json::parse(out.scene_schema);
  adapt(scene);
  Json& schemas = document["components"]["schemas"];
  const Json defs = std::exchange(scene["$defs"], Json());
  scene.erase("$defs");
  scene.erase("$schema");  // OpenAPI 3.1 has the same dialect
  schemas["Scene"] = std::move(scene);
  for (const auto& [name, def] : defs.items()) schemas[schema_name(name)] = def;
  const std::string text = document.dump(-1, ' ', false, Json::error_handler_t::replace);
  const size_t at = text.find(kUrlHere);
  out.openapi_before_url = text.substr(0, at);
  out.openapi_after_url = text.substr(at + kUrlHere.size());
  out.openapi_hash = sha256_hex(text);
  return out;
}

}  // namespace tilelight::server
