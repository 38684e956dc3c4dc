// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "renderer/base/hash.h"
#include "server/http/documents.h"
#include "server/http/handlers.h"
#include "server/http/page_files.h"
#include "server/http/target.h"

namespace tilelight::server {
namespace {

constexpr const char* kContentSecurityPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob: data:; connect-src 'self'; "
    "form-action 'none'; base-uri 'none'; frame-ancestors 'none'";

// By segments, so that an encoded / in one of them is none.
const EmbeddedFile* find_page_file(std::vector<std::string> segments) {
  if (segments.size() == 1 && segments[0].empty()) segments[0] = "index.html";
  const auto is_at = [&](const EmbeddedFile& file) { return path_segments(file.path) == segments; };
  const auto file = std::find_if(kPageFiles.begin(), kPageFiles.end(), is_at);
  return file == kPageFiles.end() ? nullptr : &*file;
}

Response tagged(const Request& request, std::string_view etag, std::string_view media_type, std::string_view bytes) {
  Response response{200, {}, std::string(media_type), ""};
  if (has_current(request, etag)) {
    response = empty_response(304);
  } else {
    response.body = bytes;
  }
  return response.with("ETag", std::string(etag)).with("Cache-Control", "no-cache");
}

std::string tag_of(const std::string& text) { return "\"" + sha256_hex(text).substr(0, 32) + "\""; }

}  // namespace

bool is_page_file(const std::vector<std::string>& segments) { return find_page_file(segments) != nullptr; }

Reply get_page_file(Services&, const Request& request) {
  const EmbeddedFile* file = find_page_file(request.segments);
  if (!file) return problem(404, "no_page", "this program was built without the page");
  return tagged(request, file->etag, file->media_type, file->bytes)
      .with("Content-Security-Policy", kContentSecurityPolicy)
      .with("Referrer-Policy", "no-referrer")
      .with("Cross-Origin-Opener-Policy", "same-origin")
      .with("Cross-Origin-Resource-Policy", "same-origin");
}

Reply get_openapi(Services& services, const Request& request) {
  const Descriptions& made = services.descriptions;
  const std::string url = request.prefix.empty() ? "/" : request.prefix;  // holds nothing that JSON would escape
  return tagged(request, tag_of(made.openapi_hash + url), "application/json",
                made.openapi_before_url + url + made.openapi_after_url);
}

Reply get_limits(Services& services, const Request& request) {
  const std::string limits = limits_document(services.config);
  return tagged(request, tag_of(limits), "application/json", limits);
}

Reply get_scene_schema(Services& services, const Request& request) {
  const std::string& schema = services.descriptions.scene_schema;
  return tagged(request, tag_of(schema), "application/schema+json", schema);
}

}  // namespace tilelight::server
