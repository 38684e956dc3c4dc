// SPDX-License-Identifier: Apache-2.0
// Bytes as a scene document, as overrides of a view, and as a chess position. Nothing crashes; every error says what
// and where, and its pointer leads into the document; what is accepted means the same however it is spelled.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "renderer/base/characters.h"
#include "renderer/scene/parse.h"
#include "tests/fuzz/require.h"

namespace tilelight::fuzz {
namespace {

using nlohmann::json;

std::string told(std::string_view text, const SceneErrors& errors) {
  std::string out(text);
  for (const SceneError& e : errors.errors) out += "\n" + e.pointer + ": " + e.code + ": " + e.detail;
  return out;
}

bool resolves(const json& document, const std::string& pointer) {
  return document.contains(json::json_pointer(pointer));
}

// Of equal keys `document` has the last alone, and of no JSON nothing: there no pointer can be tried.
bool can_resolve(const json& document, const SceneErrors& errors) {
  return !document.is_discarded() && errors.kind == SceneErrors::Kind::invalid &&
         std::none_of(errors.errors.begin(), errors.errors.end(),
                      [](const SceneError& e) { return e.code == "duplicate_key"; });
}

// Errors that lie in what is merged with the text have no line.
void check_errors(std::string_view text, const json& document, const SceneErrors& errors) {
  REQUIRE(!errors.errors.empty(), std::string(text));
  const bool has_places = can_resolve(document, errors);
  for (const SceneError& error : errors.errors) {
    REQUIRE(!error.code.empty() && !error.detail.empty(), told(text, errors));
    REQUIRE(error.line == 0 || !has_places || resolves(document, error.pointer), told(text, errors));
    json(error.detail + error.hint + error.pointer).dump();  // throws on what is not UTF-8
  }
  REQUIRE(errors.kind != SceneErrors::Kind::not_json || document.is_discarded(), told(text, errors));
}

void check_scene(std::string_view text, const json& document, const Limits& limits) {
  const auto parsed = parse_scene(text, limits);
  if (!parsed) {
    check_errors(text, document, parsed.error());
    return;
  }
  REQUIRE(!document.is_discarded(), std::string(text));
  for (const SceneWarning& warning : parsed->warnings)
    REQUIRE(resolves(document, warning.pointer), std::string(text) + "\n" + warning.pointer);

  const auto again = parse_scene(document.dump(1), limits);  // keys sorted, numbers spelled by another
  REQUIRE(again, told(text, again.error()));
  REQUIRE(again->scene_id == parsed->scene_id && again->compile_key == parsed->compile_key, std::string(text));
  REQUIRE(again->view == parsed->view, std::string(text));

  // A view on top of itself is itself.
  const auto view = parse_view("{}", parsed->view, limits);
  REQUIRE(view, told(text, view.error()));
  REQUIRE(*view == parsed->view, std::string(text));
}

void check_view(std::string_view text, const json& document, const Limits& limits) {
  View base;
  base.camera = Camera{Projection::perspective, Vec3(1.0, 2.0, 3.0), Vec3(0.0), Vec3(0.0, 1.0, 0.0), 30.0, 1.0};
  const auto view = parse_view(text, base, limits);
  if (!view) {
    check_errors(text, document, view.error());
    return;
  }
  const auto again = parse_view(text, *view, limits);
  REQUIRE(again, told(text, again.error()));
  REQUIRE(*again == *view, std::string(text));
}

// The placement field of these squares, as the standard spells it.
std::string placement_of(const ChessSquares& squares) {
  std::string out;
  for (size_t rank = squares.size(); rank-- > 0;) {
    for (const auto& man : squares[rank]) {
      const char letter = man ? "prnbqk"[static_cast<size_t>(man->piece)] : '1';
      out += man && man->side == Side::white ? static_cast<char>(letter - 'a' + 'A') : letter;
    }
    if (rank > 0) out += '/';
  }
  return out;
}

void check_fen(std::string_view text) {
  const auto position = parse_fen(text);
  if (!position) {
    REQUIRE(!position.error().empty() && visible_text(position.error()) == position.error(), std::string(text));
    return;
  }
  for (const std::string& sentence : position->left_out)
    REQUIRE(!sentence.empty() && visible_text(sentence) == sentence, std::string(text));
  const auto again = parse_fen(placement_of(position->squares));
  REQUIRE(again && again->squares == position->squares && again->left_out.empty(), std::string(text));
}

// As the library reads it, but for a NUL, which it takes for the end.
json read_plainly(std::string_view text) {
  if (text.find('\0') != std::string_view::npos) return json(json::value_t::discarded);
  return json::parse(text, nullptr, false);
}

}  // namespace
}  // namespace tilelight::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace tilelight;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  Limits limits;
  limits.json_depth = 12;
  limits.json_values = 2000;
  const auto document = fuzz::read_plainly(text);
  fuzz::check_scene(text, document, limits);
  fuzz::check_view(text, document, limits);
  fuzz::check_fen(text);
  return 0;
}
