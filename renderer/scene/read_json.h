// SPDX-License-Identifier: Apache-2.0
// read_document: JSON text to Document, refusing on the way what is no JSON or too much of it.
#pragma once

#include <string_view>

#include <tl/expected.hpp>

#include "renderer/scene/document.h"
#include "renderer/scene/limits.h"
#include "renderer/scene/parse.h"

namespace tilelight {

// Bytes, nesting and the number of values are held to the limits while reading. Numbers beyond the range of a double,
// invalid UTF-8 and a NUL, even behind the document, are errors; equal names in one object are kept, as
// Document::duplicates.
::tl::expected<Document, SceneErrors> read_document(std::string_view text, const Limits& limits);

}  // namespace tilelight
