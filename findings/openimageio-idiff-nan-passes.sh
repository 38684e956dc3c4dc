#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
#
# idiff and oiiotool compare pictures and belong to OpenImageIO; pinned here: Debian 12 openimageio-tools
# 2.4.7.1+dfsg-2.
#
# Expected: idiff's manual, "Raising the thresholds", says that the comparison fails if any pixels differ, unless the
# thresholds are raised; -hardfail fails it if any one pixel is off by more than its value. A number and a NaN differ,
# and no threshold can call them close.
#
# Found: a grey picture against one that is NaN in every channel gives PASS and exit code 0, in both orders, with
# -hardfail too, and with oiiotool --diff. The report that -v adds gives the largest error as nan, and 0 pixels over the
# threshold. One NaN in a whole picture passes in idiff just so. A finite difference in one channel does give FAILURE.
#
# Why it matters to a user of a render server: NaN is what a renderer leaves where its arithmetic broke. A regression
# test that compares with idiff lets a picture pass that is broken from edge to edge.
set -euo pipefail

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
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

# make_picture NAME GREY-COUNT OTHER OTHER-COUNT writes 4 by 4 RGB pixels as little-endian floats: 0.5, then OTHER.
make_picture() {
  local i
  {
    printf 'PF\n4 4\n-1.0\n'
    for ((i = 0; i < $2; ++i)); do printf '\x00\x00\x00\x3f'; done
    for ((i = 0; i < $4; ++i)); do printf '%b' "$3"; done
  } >"$work/$1.pfm"
}
nan='\x00\x00\xc0\x7f'
three_quarters='\x00\x00\x40\x3f'
make_picture grey 48 '' 0
make_picture one_brighter 47 "$three_quarters" 1
make_picture one_nan 47 "$nan" 1
make_picture all_nan 0 "$nan" 48

# The dependencies are those of the library; the tools' package asks for more only because of its viewer, left unused.
tools=openimageio-tools=2.4.7.1+dfsg-2
fetch_debian libopenimageio2.4=2.4.7.1+dfsg-2
(cd "$work" && apt-get -qq -o APT::Sandbox::User=root download $tools) || stop "$tools could not be downloaded"
dpkg -x "$work"/openimageio-tools_*.deb "$work/root"
export LD_LIBRARY_PATH=$work/root/usr/lib/x86_64-linux-gnu
bin=$work/root/usr/bin
cd "$work"
echo "Version: OpenImageIO $("$bin/idiff" --version)"
echo "Input: 4 by 4 pixels of 0.5, against itself and against copies with other values in one or all of 48 channels."

failed=0
# check EXPECTED-RESULT EXPECTED-CODE COMMAND...
check() {
  local result=$1 code=$2 seen seen_code=0
  shift 2
  seen=$("$bin/$1" "${@:2}" 2>&1) || seen_code=$?
  seen=$(tail -n 1 <<<"$seen")
  printf 'Seen: %-45s  %s, exit code %d\n' "$*" "$seen" "$seen_code"
  [[ $seen == "$result" && $seen_code == "$code" ]] || failed=1
}
check PASS 0 idiff grey.pfm grey.pfm
check FAILURE 2 idiff grey.pfm one_brighter.pfm
check PASS 0 idiff grey.pfm one_nan.pfm
check PASS 0 idiff grey.pfm all_nan.pfm
check PASS 0 idiff all_nan.pfm grey.pfm
check PASS 0 idiff -hardfail 0.1 grey.pfm all_nan.pfm
check PASS 0 oiiotool --diff grey.pfm all_nan.pfm

# The verbose report proves that the NaNs were read.
"$bin/idiff" -v grey.pfm all_nan.pfm >report
echo "Seen: with -v, largest error$(sed -n 's/.*Max error  *=\( [^ ]*\).*/\1/p' report), and$(
  grep -m 1 -o ' [0-9]* pixels .*' report)"
grep -q 'Max error  *= nan' report && grep -q ' 0 pixels' report || failed=1

((failed == 0)) || stop "a result is not the one stated at the top of this script"
echo "As stated: pixels that are NaN in only one of two pictures count as equal."
