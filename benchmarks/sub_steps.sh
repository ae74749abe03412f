#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: sub_steps.sh [times]     what a sub-step on Stribeck friction costs: stick_slip beside C that is semi-implicit
# Instructions of a period by callgrind, and the error over 20 s, with every compiler that is there. Exit code 1 when stick_slip
# needs more than 1.5 times the instructions of C that is as accurate; 77 without valgrind. `times`: CPU time as well.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
command -v valgrind >/dev/null || { echo "no valgrind: skipped"; exit 77; }
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
count() { # PROGRAM WHICH [standing]: instructions a period; a second has 2000, and the axis rests from the third on
    for seconds in $([ -z "${3-}" ] && echo 1 2 || echo 2 3); do
        valgrind --tool=callgrind --callgrind-out-file=/dev/null "$1" "$2" $seconds ${3-} 2>&1 >/dev/null |
            sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
    done | awk 'NR == 1 { few = $1 } NR == 2 { printf "%.1f", ($1 - few) / 2000 }'
}
failed=0
for compiler in ${COMPILERS:-g++ clang++}; do
    command -v $compiler >/dev/null || continue
    $compiler -std=c++20 -O3 -DNDEBUG -ffp-contract=off "-I$root/include" "$root/benchmarks/sub_steps.cpp" -o "$dir/sub_steps"
    "$dir/sub_steps" errors >"$dir/errors"
    printf '%-20s %-10s %26s %16s %10s\n' sub_steps compiler 'instructions a period' 'error, um' standing
    for which in typed motor plain plain_as_accurate; do
        counted=$(count "$dir/sub_steps" $which)
        off=$(sed -n "s/^$which //p" "$dir/errors")
        at_rest=$(count "$dir/sub_steps" $which standing)
        printf '%-20s %-10s %26s %16s %10s\n' $which $compiler "$counted" "$off" "$at_rest"
        echo "$which $counted $off" >>"$dir/$compiler"
    done
    awk -v compiler=$compiler '{ n[$1] = $2; off[$1] = $3 }
        END { ratio = n["typed"] / n["plain_as_accurate"]
            printf "%s: stick_slip needs %.2f times the instructions of C as accurate, %.2f times with as many sub-steps\n", compiler, ratio, n["typed"] / n["plain"]
            if (off["plain_as_accurate"] < 0.97 * off["typed"]) { print "C is more accurate than stick_slip: give it fewer sub-steps"; exit 1 }
            if (ratio > 1.5) { print "allowed is 1.5"; exit 1 } }' "$dir/$compiler" || failed=1
    [ "${1-}" != times ] || "$dir/sub_steps" times
done
exit $failed
