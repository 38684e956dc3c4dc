#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# cpp-httplib is a C++ HTTP library; pinned here: Debian 12 libcpp-httplib-dev 0.11.4+ds-1+deb12u1.
#
# Expected: a client that does not know the length may ask for more than there is, and the range then ends with the
# content (RFC 9110, 14.1.2): for bytes=0-65535 of 16 octets, "Content-Range: bytes 0-15/16". A Content-Range whose last
# position is not below the complete length is invalid, and who receives one must not combine the part with a stored
# one (RFC 9110, 14.4).
#
# Found: the body is right, but Content-Range repeats the range asked for, "bytes 0-65535/16". Ranges that end within
# the content, or have no end, are answered rightly.
#
# Why it matters to a user of a render server: readers of pictures and resuming downloads ask for a first block of
# fixed size. For a picture smaller than the block they get an answer that they have to treat as invalid.
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
    answer.set_content("0123456789abcdef", "image/png");
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
echo "Input: GET with a Range field for 16 octets, 0123456789abcdef."
failed=0
# check RANGE BY-RFC FOUND BODY
check() {
  local status range body
  exec 3<>"/dev/tcp/127.0.0.1/$port"
  printf 'GET /image HTTP/1.1\r\nHost: localhost\r\nRange: bytes=%s\r\nConnection: close\r\n\r\n' "$1" >&3
  timeout 5 cat <&3 | tr -d '\r' >"$work/answer"
  exec 3>&-
  status=$(awk 'NR == 1 { print $2 }' "$work/answer")
  range=$(sed -n 's/^Content-Range: bytes //p' "$work/answer")
  body=$(sed '1,/^$/d' "$work/answer")
  printf 'Seen: bytes=%-8s  %s, body %-16s  Content-Range bytes %-11s  by RFC 9110 bytes %s\n' \
    "$1" "$status" "$body" "$range" "$2"
  [[ $status == 206 && $range == "$3" && $body == "$4" ]] || failed=1
}
check 0-3 0-3/16 0-3/16 0123
check 12- 12-15/16 12-15/16 cdef
check 0-15 0-15/16 0-15/16 0123456789abcdef
check 0-65535 0-15/16 0-65535/16 0123456789abcdef
check 12-99 12-15/16 12-99/16 cdef

((failed == 0)) || stop "an answer is not the one stated at the top of this script"
echo "As stated: the last position in Content-Range can lie past the end of the content."
