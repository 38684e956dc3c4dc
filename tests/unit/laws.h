// SPDX-License-Identifier: Apache-2.0
// The laws of the house, as functions of one source file: who may include whom, which library goes through which
// door, and whose mathematics reaches the image. Pure but for read_sources.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tilelight::laws {

struct SourceFile {
  std::string path;  // from the root of the repository, with '/'
  std::string text;
};

// All .h and .cpp files under renderer/ and server/, by path.
std::vector<SourceFile> read_sources(const std::filesystem::path& root);

// What a file breaks, as lines "path:line: what, and what is allowed". Empty if nothing.
using Violations = std::vector<std::string>;

// Rooms include only from their left; paths start at the root; the renderer knows no server; the server comes in by
// the public door. `public_headers` is what renderer/renderer.h includes, and itself.
Violations broken_room_laws(const SourceFile& file, const std::vector<std::string>& public_headers);
std::vector<std::string> public_headers_of(const SourceFile& renderer_h);

// One door per dependency.
Violations broken_door_laws(const SourceFile& file);

// No transcendental function of the C library or of GLM in the renderer, outside base/elementary.
Violations broken_maths_law(const SourceFile& file);

// The licence line first, and no file over 600 lines.
Violations broken_form_laws(const SourceFile& file);

}  // namespace tilelight::laws
