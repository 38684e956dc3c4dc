// SPDX-License-Identifier: Apache-2.0
// What the tests of the scene language share: a document with everything in it, mutations of documents, a JSON Schema
// validator of the keywords that the schema uses, and short spellings.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/parse.h"

namespace tilelight::test {

// Every key of the language at least once, and valid.
std::string_view full_document();

// {"objects": [`object`]} with further members before it, e.g. R"("lights": [],)".
std::string scene_of(std::string_view object, std::string_view members = "");

// The scene, or a failed expectation that lists the errors, and an empty one.
ParsedScene parsed(std::string_view text);
// The errors, or a failed expectation and none.
std::vector<SceneError> errors_of(std::string_view text, const Limits& limits = {});
// The first error of this code, or a failed expectation.
SceneError error_of(std::string_view text, std::string_view code, const Limits& limits = {});
std::string listed(const std::vector<SceneError>& errors);

// Whether an RFC 6901 pointer leads somewhere in the document.
bool pointer_resolves(std::string_view document, const std::string& pointer);

// Documents that differ from the given one in one place: values replaced by others of every kind, members left out,
// members added.
std::vector<std::string> single_mutations(std::string_view document);

// Judges documents by a JSON Schema.
class SchemaJudge {
 public:
  explicit SchemaJudge(std::string_view schema);
  ~SchemaJudge();
  bool accepts(std::string_view document) const;
  // The document with every absent member for which the schema states a default; `count` of them.
  std::string with_defaults(std::string_view document, int& count) const;

 private:
  struct State;
  State* state_;
};

}  // namespace tilelight::test
