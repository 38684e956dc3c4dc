// SPDX-License-Identifier: Apache-2.0
// Orders: requests that want a render, which is answered with its image where the client waits for it, else with a job;
// a retry finds the job of its first try.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/http/handlers.h"

namespace tilelight::server {

// What a request has ordered.
struct Ordered {
  RenderRequest render;              // its format is that of a job; an image that is waited for is what Accept says
  std::optional<Priority> priority;  // nothing: by whether the client waits
};

// content_hash: of all that makes two requests under one idempotency key the same. prepare: what to render; not called
// for a retry whose job is still there.
Reply accept_order(Services& services, const Request& request, const std::string& content_hash,
                   const std::function<::tl::expected<Ordered, Problem>()>& prepare);

}  // namespace tilelight::server
