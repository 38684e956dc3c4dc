// SPDX-License-Identifier: Apache-2.0
// What a proxy in front says of the client: X-Forwarded-For, -Proto, -Host and -Prefix, believed from the proxies that
// the operator names and from nobody else. The Forwarded of RFC 7239 is not read: proxies that write the X- fields hand
// it on as a client has sent it, and whoever reads both believes that client. Pure.
#pragma once

#include <vector>

#include "server/address.h"
#include "server/http/message.h"

namespace tilelight::server {

// Fills in who asks, and under which scheme, host and prefix. REQUIRES: request.client is the peer's address.
// X-Forwarded-For grows to the right, each proxy adding whom it saw: the client is the rightmost address that is no
// trusted proxy's, and what stands left of it is hearsay. An entry that is no address ends the way there, at the proxy
// that wrote it. Of other fields with several values that one counts which stands at the client's place, or the
// leftmost where there are fewer; one that cannot be what it should is not believed.
void believe_proxies(Request& request, const std::vector<Network>& trusted);

}  // namespace tilelight::server
