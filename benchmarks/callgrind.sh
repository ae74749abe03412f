#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: callgrind.sh [BOUND]     instructions per servo period of the typed loops beside the hand-written ones
# Builds axis_loop_count and xy_loop_count with every compiler that is there, counts instructions with valgrind for two
# numbers of samples (their difference is free of the start-up), prints two tables. Exit code 1 when typed needs more than
# BOUND (1.05) times what hand_written needs, 77 when there is no valgrind. Of both axes together clang++ is shown but not
# judged: it leaves memory and friction as calls, through which the quantities of Boost.Units go by address.
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

worst=0
table() { # TARGET THIRD NOT_JUDGED
    printf '%-12s %-10s %10s %14s %24s %8s\n' "${1%_count}" compiler typed hand_written "$2" ratio
    for compiler in g++ clang++; do
        command -v $compiler >/dev/null || continue
        here=$build/count-$compiler
        cmake -S "$root" -B "$here" -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DCMAKE_BUILD_TYPE=Release \
            -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_EXAMPLES=OFF >"$here.log" 2>&1 &&
            cmake --build "$here" --target "$1" >>"$here.log" 2>&1 || { cat "$here.log"; exit 1; }
        program=$here/benchmarks/$1
        "$program" same || { echo "$compiler: the loops do not agree bit for bit"; exit 1; }
        typed=$(per_sample "$program" typed)
        hand=$(per_sample "$program" hand_written)
        third=$(per_sample "$program" "$2")
        ratio=$(awk "BEGIN { printf \"%.3f\", $typed / $hand }")
        printf '%-12s %-10s %10s %14s %24s %8s\n' '' $compiler "$typed" "$hand" "$third" "$ratio"
        [ $compiler = "$3" ] || worst=$(awk "BEGIN { print ($ratio > $worst) ? $ratio : $worst }")
    done
}
table axis_loop_count hand_written_unchecked ''
table xy_loop_count virtual_graph clang++
if awk "BEGIN { exit !($worst > $bound) }"; then
    echo "a typed loop needs $worst times the instructions of the hand-written one; allowed is $bound"
    exit 1
fi
