#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: bound.sh PROGRAM ARGUMENTS...      the most instructions of one call of a loop
# Runs PROGRAM under callgrind and counts each call of quadrant::measured_call (quadrant/analysis/measure.hpp) for itself, with all
# that it calls. Prints how many calls, the median, the most, and which call that was (the first is number 1). The count does not
# depend on what else runs; it is that of the inputs that PROGRAM gives, so give it every path. 77 without valgrind.
set -eu
command -v valgrind >/dev/null || { echo "no valgrind: skipped"; exit 77; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
LD_BIND_NOW=1 valgrind --tool=callgrind --toggle-collect='*measured_call*' --dump-after='*measured_call<*' \
    --callgrind-out-file="$dir/out" "$@" >"$dir/said" 2>"$dir/err" || { cat "$dir/said" "$dir/err"; exit 1; }
# One file a call: out.1, out.2, ... (Two patterns that are not the same: of two options for one pattern valgrind takes the last.)
for file in "$dir"/out.*; do
    sed -n "s/^\(totals\|summary\): *\([0-9]*\).*/${file##*.} \2/p" "$file" | tail -n 1
done | sort -n | awk '{ n[NR] = $2; if ($2 > most) { most = $2; at = $1 } }
    END { if (!NR) { print "no call of quadrant::measured_call"; exit 1 }
        count = NR; asort_by_hand(n, count)
        printf "%d calls, instructions: median %d, most %d (call %d)\n", count, n[int((count + 1) / 2)], most, at }
    function asort_by_hand(a, size,   i, j, t) {
        for (i = 2; i <= size; ++i) { t = a[i]; for (j = i - 1; j > 0 && a[j] > t; --j) a[j + 1] = a[j]; a[j + 1] = t } }'
