// SPDX-License-Identifier: Apache-2.0
// Orders: requests that want a render, which is answered with its image where the client waits for it, else with a job;
// a retry finds the job of its first try.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "server/http/handlers.h"

namespace tilelight::server {

// What the client wants for an answer.
struct Wish {
  std::optional<ImageFormat> image;  // wait and answer with it; nothing: answer with the job
};

// "format" says how a job keeps its image; an image that is waited for is what Accept says.
inline ImageFormat format_of(const Wish& wish, ImageFormat of_job) { return wish.image.value_or(of_job); }
inline Priority priority_of(const Wish& wish, std::optional<Priority> asked) {
  return asked.value_or(wish.image ? Priority::normal : Priority::batch);
}

// content_hash: of all that makes two requests under one idempotency key the same. prepare: what to render; not called
// for a retry whose job is still there.
Reply accept_order(Services& services, const Request& request, const std::string& content_hash,
                   const std::function<::tl::expected<RenderRequest, Problem>(const Wish&)>& prepare);

}  // namespace tilelight::server
