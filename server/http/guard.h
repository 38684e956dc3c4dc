// SPDX-License-Identifier: Apache-2.0
// check_guard: what keeps web pages of others away from the server: Host against names of others that resolve to us
// (DNS rebinding), Sec-Fetch-Site, Origin and content type against forms and scripts of other sites. Pure.
#pragma once

#include "server/config.h"
#include "server/http/message.h"

namespace tilelight::server {

// 421: Host is not one of our names; 403: another site's page; 415: a body that is not application/json.
::tl::expected<void, Problem> check_guard(const Request& request, const Config& config);

}  // namespace tilelight::server
