# SPDX-License-Identifier: Apache-2.0
# Tilelight behind Varnish (7): a cache for pictures of stored scenes, which never change. Varnish speaks no TLS, so it
# stands behind something that does, or beside it. Put the address of what stands before it, and start
#   tilelightd --allowed-hosts render.example --trusted-proxy 127.0.0.1
# Varnish hands on Host and adds to X-Forwarded-For by itself. tests/proxies tests this file; it replaces addresses and
# the port alone.
vcl 4.1;

# Whose word on scheme, host and prefix is handed on: what ends TLS before Varnish, and must set or delete the fields
# below, as the other files do. Nobody else has a say in them.
acl tls_terminator {
  "127.0.0.1";
}

backend tilelight {
  .host = "127.0.0.1";
  .port = "8080";
  .first_byte_timeout = 60s;     # Varnish's own; over --max-wait-s (40) of tilelightd
  .between_bytes_timeout = 60s;  # a stream of events has a comment every 15 seconds
}

sub vcl_recv {
  if (client.ip !~ tls_terminator) {
    unset req.http.X-Forwarded-Proto;
    unset req.http.X-Forwarded-Host;
    unset req.http.X-Forwarded-Prefix;
  }
  # Nothing else is for caches, and requests that wait must not wait for each other.
  if (req.method != "GET" && req.method != "HEAD" || req.url !~ "^/v1/scenes/[0-9a-f]+/image") {
    return (pass);
  }
  # What Accept means for a picture, in one spelling: Varnish keeps a copy for each, because of Vary.
  if (req.http.Accept !~ "^image/(jpeg|x-exr|svg\+xml)$") {
    set req.http.Accept = "image/png";
  }
}
