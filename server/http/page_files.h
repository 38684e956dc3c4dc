// SPDX-License-Identifier: Apache-2.0
// The files of the page, put into the program when it is built (embed_files.cmake). A fixed table: no path of a request
// reaches a file system.
#pragma once

#include <string_view>
#include <vector>

namespace tilelight::server {

struct EmbeddedFile {
  std::string_view path;  // "/js/main.js"
  std::string_view media_type;
  std::string_view etag;  // quoted, of the content's SHA-256
  std::string_view bytes;
};

extern const std::vector<EmbeddedFile> kPageFiles;
extern const EmbeddedFile kOpenApiFile;

}  // namespace tilelight::server
