#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: gallery.sh CMAKE BUILD OUT     the pictures of docs/gallery.md are what docs/generators/gallery writes, byte for byte
set -u
cmake=$1 build=$2 out=$3
cd "$(dirname "$0")/../.." || exit 1
"$cmake" --build "$build" --target gallery >"$out.txt" 2>&1 || { cat "$out.txt"; exit 1; }
rm -rf "$out"
"$build/examples/gallery" "$out" || exit 1
diff -r "$out" docs/gallery && exit 0
echo "FAILED: after $build/examples/gallery docs/gallery look at each of these, and commit it"
exit 1
