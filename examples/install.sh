#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: install.sh PACKAGE...     installs the Debian packages that are missing; asks nothing; quiet when none is
set -u
command -v dpkg-query >/dev/null || {
    echo "This is not Debian: going on in the hope that the equivalents of these are here: $*"
    exit 0
}
missing=
for package; do
    dpkg-query -W -f='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
    as_root=
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root='sudo -n'
else
    echo "Missing Debian packages, and neither root nor sudo without a password to install them. As root:" >&2
    echo "    apt-get update && apt-get install$missing" >&2
    exit 1
fi
log=$(mktemp)
echo "installing$missing"
if { $as_root apt-get -q update && $as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get -q install -y --no-install-recommends $missing; } >"$log" 2>&1 </dev/null; then
    rm -f "$log"
else
    tail -n 20 "$log" >&2
    echo "apt-get failed; all it said: $log" >&2
    exit 1
fi
