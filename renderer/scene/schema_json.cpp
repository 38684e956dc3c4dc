// SPDX-License-Identifier: Apache-2.0
// The JSON Schema (2020-12) of the language, written from the grammar.
#include <cmath>
#include <nlohmann/json.hpp>

#include "renderer/scene/document.h"
#include "renderer/scene/grammar.h"
#include "renderer/scene/parse.h"

namespace tilelight {
namespace {

using json = nlohmann::ordered_json;

json number_json(double number) {
  constexpr double kExact = 9007199254740992.0;  // 2^53
  if (std::floor(number) == number && std::fabs(number) < kExact) return static_cast<int64_t>(number);
  return number;
}

class SchemaWriter {
 public:
  json write(const Record& root) {
    json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
    schema.update(record_schema(root, nullptr));
    schema["$defs"] = std::move(defs_);
    return schema;
  }

 private:
  // What is used in several places is defined once.
  json rule_schema(const Rule& rule) {
    if (rule.shared_name.empty()) return plain_schema(rule);
    return define(rule.shared_name, [&] { return plain_schema(rule); });
  }

  template <class Make>
  json define(std::string_view name, Make make) {
    const std::string key(name);
    if (!defs_.contains(key)) {
      json schema = make();  // which may define others
      defs_[key] = std::move(schema);
    }
    return {{"$ref", "#/$defs/" + key}};
  }

  json plain_schema(const Rule& rule) {
    switch (rule.form) {
      case Form::boolean:
        return {{"type", "boolean"}};
      case Form::number:
        return number_schema(rule.range);
      case Form::numbers:
        return numbers_schema(rule);
      case Form::text:
        return text_schema(rule);
      case Form::hex_color:
        return {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}, {"description", "sRGB, made linear"}};
      case Form::word:
        return word_schema(rule);
      case Form::list:
        return list_schema(rule);
      case Form::map:
        return map_schema(rule);
      case Form::record:
        return record_reference(*rule.records[0], nullptr);
      case Form::tagged: {
        json records = json::array();
        for (const auto& record : rule.records) records.push_back(record_reference(*record, &rule));
        return {{"oneOf", std::move(records)}};
      }
      case Form::any_of: {
        json options = json::array();
        for (const Rule& option : rule.options) options.push_back(rule_schema(option));
        return {{"anyOf", std::move(options)}};
      }
    }
    return {};
  }

  static json number_schema(const Range& range) {
    json schema = {{"type", range.whole ? "integer" : "number"}};
    schema[range.above_min ? "exclusiveMinimum" : "minimum"] = number_json(range.min);
    schema[range.below_max ? "exclusiveMaximum" : "maximum"] = number_json(range.max);
    if (range.nonzero) schema["not"] = {{"const", 0}};
    return schema;
  }

  static json text_schema(const Rule& rule) {
    json schema = {{"type", "string"}};
    add_length(rule.length, "minLength", "maxLength", schema);
    if (!rule.pattern.empty()) schema["pattern"] = rule.pattern;
    return schema;
  }

  static json numbers_schema(const Rule& rule) {
    json flat = list_of_numbers(rule.range, rule.length);
    if (rule.nonzero_vector) flat["not"] = {{"const", std::vector<int>(static_cast<size_t>(rule.length.max), 0)}};
    if (!rule.or_rows) return flat;
    constexpr int64_t kEach = Document::kRowNumbers;
    json rows = {{"type", "array"}, {"items", list_of_numbers(rule.range, {kEach, kEach})}};
    add_length({rule.length.min / kEach, rule.length.max / kEach}, "minItems", "maxItems", rows);
    return {{"anyOf", {std::move(flat), std::move(rows)}}};
  }

  static json list_of_numbers(const Range& range, const Length& length) {
    json schema = {{"type", "array"}, {"items", number_schema(range)}};
    add_length(length, "minItems", "maxItems", schema);
    return schema;
  }

  static json word_schema(const Rule& rule) { return {{"enum", rule.words}}; }

  json list_schema(const Rule& rule) {
    json schema = {{"type", "array"}, {"items", rule_schema(rule.options[0])}};
    add_length(rule.length, "minItems", "maxItems", schema);
    return schema;
  }

  json map_schema(const Rule& rule) {
    json schema = {{"type", "object"}};
    add_length(rule.length, "minProperties", "maxProperties", schema);
    schema["properties"] = {{"extras", json::object()}};
    schema["patternProperties"] = {{"^x-", json::object()}};
    schema["additionalProperties"] = rule_schema(rule.options[0]);
    return schema;
  }

  static void add_length(const Length& length, const char* least, const char* most, json& schema) {
    if (length.min > 0) schema[least] = length.min;
    if (length.max != std::numeric_limits<int64_t>::max()) schema[most] = length.max;
  }

  json record_reference(const Record& record, const Rule* tagged) {
    return define(record.name, [&] { return record_schema(record, tagged); });
  }

  // `tagged`: the rule that chooses this record by its "type", or nullptr.
  json record_schema(const Record& record, const Rule* tagged) {
    json properties = json::object(), required = json::array();
    if (tagged != nullptr) {
      properties["type"] = {{"const", record.name}};
      if (!tagged->tag_optional || &record != tagged->records[0].get()) required.push_back("type");
    }
    for (const Field& field : record.fields) {
      if (field.need == Need::later) continue;
      properties[std::string(field.key)] = field_schema(field);
      if (field.need == Need::required) required.push_back(field.key);
    }
    properties["extras"] = {{"description", "Free."}};
    json schema = {{"title", record.title}, {"type", "object"}, {"properties", std::move(properties)}};
    if (!required.empty()) schema["required"] = std::move(required);
    schema["patternProperties"] = {{"^x-", json::object()}};
    schema["additionalProperties"] = false;
    json exclusions = json::array();
    for (const auto& keys : record.exclusive) {
      for (size_t i = 1; i < keys.size(); ++i) exclusions.push_back({{"not", both_schema(keys[0], keys[i])}});
    }
    if (!exclusions.empty()) schema["allOf"] = std::move(exclusions);
    return schema;
  }

  // Has both members, which it names as its own: linters take a required name that is no property for a misspelt one.
  static json both_schema(std::string_view a, std::string_view b) {
    json properties = json::object();
    for (const std::string_view key : {a, b}) properties[std::string(key)] = json::object();
    return {{"properties", std::move(properties)}, {"required", {a, b}}};
  }

  json field_schema(const Field& field) {
    json schema = {{"title", field.title}};
    if (!field.description.empty()) schema["description"] = field.description;
    if (!field.default_json.empty()) schema["default"] = json::parse(field.default_json);
    schema.update(rule_schema(field.rule));
    return schema;
  }

  json defs_ = json::object();
};

}  // namespace

std::string scene_schema_json(const Limits& limits) { return SchemaWriter().write(scene_grammar(limits)).dump(2); }

}  // namespace tilelight
