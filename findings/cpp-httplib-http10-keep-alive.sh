#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# cpp-httplib is a C++ HTTP library; pinned here: Debian 12 libcpp-httplib-dev 0.11.4+ds-1+deb12u1.
#
# Expected: a server that will close the connection after an answer says "Connection: close" in it (RFC 9112, 9.6). An
# answer in HTTP/1.1 without it means that the connection stays (9.3), and a Keep-Alive field with a timeout announces
# for how long (RFC 2068, 19.7.1.1). Connection options are case-insensitive (RFC 9110, 7.6.1).
#
# Found: the answer to an HTTP/1.0 request is labelled HTTP/1.1, says "Keep-Alive: timeout=5, max=5" and has no
# Connection field, but the connection is closed at once. So it is if the client asked for "Connection: keep-alive" in
# lower case; with "Keep-Alive" in capitals the connection does stay. Nothing in the answers tells the two apart.
#
# Why it matters to a user of a render server: health checks, benchmark tools and older proxies speak HTTP/1.0. One that
# believes the answer keeps the connection in its pool and loses the next request that it sends there.
set -euo pipefail

work=$(mktemp -d)
server=
finish() {
  if [[ -n $server ]]; then kill "$server" 2>/dev/null || true; wait "$server" 2>/dev/null || true; fi
  rm -rf "$work"
}
trap finish EXIT
stop() { echo "CHANGED OR UNTESTED: $*" >&2; exit 1; }

# Takes the pinned packages, and those of their dependencies that this system lacks, without installing any.
fetch_debian() {
  local missing deb
  missing=$(missing_for "$@") || { apt-get update -qq && missing=$(missing_for "$@"); } ||
    stop "apt knows no way to install $*; the pinned version has to be one that Debian 12 offers"
  mkdir "$work/debs" "$work/root"
  # shellcheck disable=SC2086  # one word a package
  (cd "$work/debs" && apt-get -qq -o APT::Sandbox::User=root download "$@" $missing) ||
    stop "the packages $* could not be downloaded"
  for deb in "$work"/debs/*.deb; do dpkg -x "$deb" "$work/root"; done
}
missing_for() {
  apt-get --simulate install --no-install-recommends --allow-downgrades "$@" 2>/dev/null | awk '/^Inst/ { print $2 }'
}

fetch_debian libcpp-httplib-dev=0.11.4+ds-1+deb12u1 libcpp-httplib0.11=0.11.4+ds-1+deb12u1
include=$work/root/usr/include
lib=$work/root/usr/lib/x86_64-linux-gnu
cat >"$work/server.cpp" <<'CPP'
#include <httplib.h>
#include <iostream>
int main() {
  httplib::Server server;
  server.Get("/image", [](const httplib::Request&, httplib::Response& answer) {
    answer.set_content("image", "image/png");
  });
  std::cout << server.bind_to_any_port("127.0.0.1") << std::endl;
  server.listen_after_bind();
}
CPP
# The three definitions are those of the package's own pkg-config file: the library was built with them.
g++ -std=c++17 -DCPPHTTPLIB_OPENSSL_SUPPORT -DCPPHTTPLIB_ZLIB_SUPPORT -DCPPHTTPLIB_BROTLI_SUPPORT \
  -isystem "$include" -isystem "$include/x86_64-linux-gnu" "$work/server.cpp" \
  -L"$lib" -l:libcpp-httplib.so.0.11 -Wl,--allow-shlib-undefined -pthread -o "$work/server" ||
  stop "the test server does not compile with the pinned header"
LD_LIBRARY_PATH=$lib "$work/server" >"$work/port" &
server=$!
for _ in {1..50}; do [[ -s $work/port ]] && break; sleep 0.1; done
port=$(cat "$work/port")
[[ -n $port ]] || stop "the test server did not start within 5 s"

echo "Version: cpp-httplib $(sed -n 's/.*CPPHTTPLIB_VERSION "\(.*\)".*/\1/p' "$include/httplib.h")"
echo "Input: GET of five octets, sent once on a new connection; after 2 s the connection counts as kept."
failed=0
# check VERSION CONNECTION-FIELD FATE KEEP-ALIVE CLOSE: the last three are what is expected to be found.
check() {
  local head fate=closed keep_alive close=no
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET /image HTTP/%s\r\nHost: localhost\r\n%s\r\n' "$1" "${2:+Connection: $2$'\r\n'}" >&3
  timeout 2 cat <&3 >"$work/answer" || fate=kept
  exec 3>&-
  head=$(tr -d '\r' <"$work/answer" | sed '/^$/q')
  keep_alive=$(sed -n 's/^Keep-Alive: //p' <<<"$head")
  grep -qi '^Connection: close$' <<<"$head" && close=yes
  printf 'Seen: HTTP/%s, Connection: %-10s  %s, Keep-Alive "%s", says close: %s; connection %s\n' \
    "$1" "${2:-(none)}" "${head%% *}" "$keep_alive" "$close" "$fate"
  [[ $fate == "$3" && $keep_alive == "$4" && $close == "$5" ]] || failed=1
}
check 1.0 '' closed 'timeout=5, max=5' no
check 1.0 keep-alive closed 'timeout=5, max=5' no
check 1.0 Keep-Alive kept 'timeout=5, max=5' no
check 1.1 '' kept 'timeout=5, max=5' no
check 1.1 close closed '' yes

((failed == 0)) || stop "an answer is not the one stated at the top of this script"
echo "As stated: HTTP/1.0 requests get a Keep-Alive promise on a connection that is closed at once."
