// SPDX-License-Identifier: Apache-2.0
// The scene language, version 1: JSON in, Scene and View out, or every error at once. Pure; any thread.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <tl/expected.hpp>

#include "renderer/scene/limits.h"
#include "renderer/scene/scene.h"

namespace tilelight {

// One thing wrong with a document. `pointer` is a JSON pointer (RFC 6901) into it.
struct SceneError {
  std::string pointer;
  std::string code;    // unknown_key, wrong_type, out_of_range, unknown_name, not_in_this_release, limit, ...
  std::string detail;  // what was found and what is allowed
  std::vector<std::string> allowed;  // the allowed words, where they are few
  std::string hint;                  // did-you-mean, or what to do; may be empty
  int line = 0, column = 0;          // 1-based place in the text; 0 where unknown
};

struct SceneErrors {
  enum class Kind { not_json, too_large, invalid };  // HTTP 400, 413, 422
  Kind kind = Kind::invalid;
  std::vector<SceneError> errors;
};

struct ParsedScene {
  Scene scene;
  View view;
  std::string scene_id;     // SHA-256 of the canonical document, 64 hexadecimal digits
  std::string compile_key;  // the same without camera, image and render: equal keys compile equally
  std::vector<SceneWarning> warnings;
};

// Parses a whole scene document. Never throws on bad input; takes no memory for what exceeds a limit.
::tl::expected<ParsedScene, SceneErrors> parse_scene(std::string_view text, const Limits& limits);

// Parses {"camera"?, "image"?, "render"?} and merges it key by key over `base` (RFC 7396: null takes a key back to its
// default; without a camera the scene is framed). Pointers are into `text`; an error that lies in the base alone, or
// only in its meeting with `text`, has no line.
::tl::expected<View, SceneErrors> parse_view(std::string_view text, const View& base, const Limits& limits);

// Why a text is no JSON, or more of it than the limits allow; nothing if it is well.
std::optional<SceneErrors> find_json_errors(std::string_view text, const Limits& limits);

// A chess position as programs write and people paste it: a FEN or its placement field alone, with white space,
// labels, quotation marks or the tags of a game around it, with pockets, promoted marks, EPD operations or moves.
struct FenPosition {
  ChessSquares squares{};
  std::vector<std::string> left_out;  // of the text, as sentences; what a FEN has beside the squares is not told
};
::tl::expected<FenPosition, std::string> parse_fen(std::string_view fen);

// The scene that `tilelight chess` and the page's FEN field render: one chess position, a camera, two lights.
std::string chess_scene_json(std::string_view fen, int detail);

// The JSON Schema (2020-12) of the language with these limits.
std::string scene_schema_json(const Limits& limits);

// The limits as a JSON object, as published.
std::string limits_json(const Limits& limits);

}  // namespace tilelight
