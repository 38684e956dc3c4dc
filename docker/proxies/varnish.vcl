# SPDX-License-Identifier: Apache-2.0
# Tilelight behind Varnish (7): a cache for pictures of stored scenes, which never change. Varnish speaks no TLS, so it
# stands behind something that does, or beside it. Start
#   tilelightd --allowed-hosts render.example --trusted-proxy 127.0.0.1
# Varnish hands on Host and adds to X-Forwarded-For by itself. tests/proxies tests this file; it replaces the port alone.
vcl 4.1;

backend tilelight {
  .host = "127.0.0.1";
  .port = "8080";
  .first_byte_timeout = 60s;     # Varnish's own; over --max-wait-s (40) of tilelightd
  .between_bytes_timeout = 60s;  # a stream of events has a comment every 15 seconds
}

sub vcl_recv {
  # Nothing else is for caches, and requests that wait must not wait for each other.
  if (req.method != "GET" && req.method != "HEAD" || req.url !~ "^/v1/scenes/[0-9a-f]+/image") {
    return (pass);
  }
  # What Accept means for a picture, in one spelling: Varnish keeps a copy for each, because of Vary.
  if (req.http.Accept !~ "^image/(jpeg|x-exr|svg\+xml)$") {
    set req.http.Accept = "image/png";
  }
}
