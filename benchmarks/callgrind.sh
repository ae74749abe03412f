#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: callgrind.sh [BOUND]     instructions per servo period of the typed loops beside the hand-written ones
# Builds axis_loop_count and xy_loop_count with every compiler that is there, counts instructions with valgrind for two
# numbers of samples (their difference is free of the start-up), prints three tables: one axis, both axes with the memory's
# FIR filters, both without. Exit code 1 when typed needs more than BOUND (1.05) times what hand_written needs in any of them,
# 77 when there is no valgrind.
set -eu
bound=${1:-1.05}
root=$(cd "$(dirname "$0")/.." && pwd)
build=${QUADRANT_BUILD:-$root/build}
mkdir -p "$build"
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

worst=0
table() { # TARGET THIRD SUFFIX
    printf '%-20s %-10s %10s %14s %24s %8s\n' "${1%_count}$3" compiler typed hand_written "$2" ratio
    for compiler in g++ clang++; do
        command -v $compiler >/dev/null || continue
        here=$build/count-$compiler
        cmake -S "$root" -B "$here" -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DCMAKE_BUILD_TYPE=Release \
            -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_EXAMPLES=OFF >"$here.log" 2>&1 &&
            cmake --build "$here" --target "$1" >>"$here.log" 2>&1 || { cat "$here.log"; exit 1; }
        program=$here/benchmarks/$1
        "$program" same || { echo "$compiler: the loops do not agree bit for bit"; exit 1; }
        typed=$(per_sample "$program" "typed$3")
        hand=$(per_sample "$program" "hand_written$3")
        third=$(per_sample "$program" "$2$3")
        ratio=$(awk "BEGIN { printf \"%.3f\", $typed / $hand }")
        printf '%-20s %-10s %10s %14s %24s %8s\n' '' $compiler "$typed" "$hand" "$third" "$ratio"
        worst=$(awk "BEGIN { print ($ratio > $worst) ? $ratio : $worst }")
    done
}
table axis_loop_count hand_written_unchecked ''
table xy_loop_count virtual_graph ''
table xy_loop_count virtual_graph _without_fir
if awk "BEGIN { exit !($worst > $bound) }"; then
    echo "a typed loop needs $worst times the instructions of the hand-written one; allowed is $bound"
    exit 1
fi
