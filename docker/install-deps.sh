#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what is missing of the package lists beside this script, by apt: packages.txt, and with --test, --fuzz, --load
# or --fresh also what those need. Costs milliseconds when nothing is missing.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

lists=("$here/packages.txt")
for arg in "$@"; do
  case "$arg" in
    --test|--fuzz|--load|--fresh) lists+=("$here/packages-${arg#--}.txt") ;;
    *) echo "usage: install-deps.sh [--test] [--fuzz] [--load] [--fresh]" >&2; exit 2 ;;
  esac
done
mapfile -t wanted < <(sed -e 's/#.*//' -e '/^\s*$/d' "${lists[@]}")

if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
  echo "This script knows Debian 12 and its kin (apt). Please install what these packages hold, by your own means:" >&2
  printf '  %s\n' "${wanted[@]}" >&2
  exit 1
fi

is_installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }
missing=()
for package in "${wanted[@]}"; do
  # Node.js from another source than Debian brings its own npm.
  [ "$package" = npm ] && command -v npm >/dev/null && continue
  [ "$package" = nodejs ] && command -v node >/dev/null && continue
  is_installed "$package" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

sudo=()
if [ "$(id -u)" -ne 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "Missing packages, and neither root nor sudo to install them. Ask an administrator for:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
  fi
  sudo=(sudo)
fi
echo "Installing ${#missing[@]} packages by apt: ${missing[*]}"
export DEBIAN_FRONTEND=noninteractive
"${sudo[@]}" apt-get -qq update
"${sudo[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq install -y --no-install-recommends "${missing[@]}" >/dev/null
