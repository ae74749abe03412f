#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: pictures.sh CMAKE BUILD OUT     the pictures of docs/blocks are what docs/generators/block_pictures writes, byte for byte
set -u
cmake=$1 build=$2 out=$3
cd "$(dirname "$0")/../.." || exit 1
"$cmake" --build "$build" --target block_pictures >"$out.txt" 2>&1 || { cat "$out.txt"; exit 1; }
rm -rf "$out"
"$build/examples/block_pictures" "$out" || exit 1
diff -r "$out" docs/blocks/pictures && exit 0
echo "FAILED: after $build/examples/block_pictures docs/blocks/pictures look at each of these, and commit it"
exit 1
