// SPDX-License-Identifier: Apache-2.0
// The bodies of requests: a scene, or a scene with a view and wishes around it.
#pragma once

#include <initializer_list>
#include <optional>
#include <string_view>

#include "server/http/services.h"

namespace tilelight::server {

// A body is a scene if it has "objects", else {"scene": id or scene, "camera"?, "image"?, "render"?, ...}; the view is
// merged key by key over the scene's own.
struct RenderBody {
  ScenePtr scene;
  View view;
  std::vector<SceneWarning> warnings;
  std::optional<ImageFormat> format;
  std::optional<Priority> priority;
  double parse_ms = 0.0;
};
// `wishes`: which of "format" and "priority" the route knows. Large bodies are parsed on the pool.
::tl::expected<RenderBody, Problem> read_render_body(Services& services, std::string_view body,
                                                     std::initializer_list<std::string_view> wishes);

// {"samples"?, "rmse"?, "time_ms"?, "format"?, "priority"?}, of the first three at least one: a view that differs from
// the source's in its stop rules alone. A rule that the source's picture meets already is an error.
struct RefineBody {
  View view;
  std::optional<ImageFormat> format;
  std::optional<Priority> priority;
  double parse_ms = 0.0;
};
::tl::expected<RefineBody, Problem> read_refine_body(std::string_view body, const View& source,
                                                     const RenderReport& report, const Limits& limits);

// A scene document and nothing around it.
::tl::expected<ScenePtr, Problem> read_scene(Services& services, std::string_view body);

// {"seq", "camera"?, "image"?, "render"?, "moving"?}
struct ViewBody {
  int64_t seq = 0;
  bool is_moving = false;
  View view;
};
::tl::expected<ViewBody, Problem> read_view_body(std::string_view body, const View& base, const Limits& limits);

// A view from the query of a picture's address:
// position=4,5,9&target=..&up=..&fov_y_deg=..&width=..&height=..&samples=.. &exposure=... Errors point into the view
// that the query spells: /camera/position.
// others: parameters that the route reads by itself.
::tl::expected<View, Problem> read_view_query(const Request& request, const View& base, const Limits& limits,
                                              std::initializer_list<std::string_view> others = {});

}  // namespace tilelight::server
