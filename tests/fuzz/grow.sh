#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: grow.sh FUZZER FOUND    keeps in tests/fuzz/NAME.tar.xz what the inputs in FOUND (build/found/NAME) and those kept
#                                before reach: the smallest input for each branch, none above 1200 bytes. How often a
#                                branch is taken is not kept: three times as many inputs, which a run would spend its
#                                first seconds on, and finds again
set -eu
fuzzer=$1 found=$2
name=$(basename "$fuzzer")
kept=$(cd "$(dirname "$0")" && pwd)/$name.tar.xz
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/before" "$work/after"
[ ! -f "$kept" ] || tar -C "$work/before" -xJf "$kept"
"$fuzzer" -merge=1 -use_counters=0 -max_len=1200 "$work/after" "$work/before" "$found" >"$work/said" 2>&1 || { tail "$work/said" >&2; exit 1; }
(cd "$work/after" && tar --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner -cJf "$kept" .)
echo "$(ls "$work/before" | wc -l) inputs before, $(ls "$work/after" | wc -l) now in $kept"
