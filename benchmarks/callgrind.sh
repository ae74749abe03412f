#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: callgrind.sh [BOUND]     instructions per servo period of the typed axis loop beside the hand-written one
# Builds axis_loop_count with every compiler that is there, counts instructions with valgrind for two numbers of samples
# (their difference is free of the start-up), prints a table. Exit code 1 when typed needs more than BOUND (1.05) times
# what hand_written needs, 77 when there is no valgrind.
set -eu
bound=${1:-1.05}
root=$(cd "$(dirname "$0")/.." && pwd)
build=${QUADRANT_BUILD:-$root/build}
command -v valgrind >/dev/null || { echo "no valgrind: skipped"; exit 77; }

instructions() { # PROGRAM WHICH N
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
}
per_sample() { # PROGRAM WHICH
    few=$(instructions "$1" "$2" 1000)
    many=$(instructions "$1" "$2" 11000)
    awk "BEGIN { printf \"%.1f\", ($many - $few) / 10000 }"
}

printf '%-10s %10s %14s %24s %8s\n' compiler typed hand_written hand_written_unchecked ratio
worst=0
for compiler in g++ clang++; do
    command -v $compiler >/dev/null || continue
    here=$build/count-$compiler
    cmake -S "$root" -B "$here" -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DCMAKE_BUILD_TYPE=Release \
        -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_EXAMPLES=OFF >"$here.log" 2>&1 &&
        cmake --build "$here" --target axis_loop_count >>"$here.log" 2>&1 || { cat "$here.log"; exit 1; }
    "$here/benchmarks/axis_loop_count" same || { echo "$compiler: the loops do not agree bit for bit"; exit 1; }
    typed=$(per_sample "$here/benchmarks/axis_loop_count" typed)
    hand=$(per_sample "$here/benchmarks/axis_loop_count" hand_written)
    bare=$(per_sample "$here/benchmarks/axis_loop_count" hand_written_unchecked)
    ratio=$(awk "BEGIN { printf \"%.3f\", $typed / $hand }")
    printf '%-10s %10s %14s %24s %8s\n' $compiler "$typed" "$hand" "$bare" "$ratio"
    worst=$(awk "BEGIN { print ($ratio > $worst) ? $ratio : $worst }")
done
if awk "BEGIN { exit !($worst > $bound) }"; then
    echo "the typed loop needs $worst times the instructions of the hand-written one; allowed is $bound"
    exit 1
fi
