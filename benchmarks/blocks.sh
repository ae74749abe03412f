#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: blocks.sh >docs/benchmarks.md      instructions per sample of every block, of the whole axis, of what one would
#                                           write or take instead; a few minutes
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
build=${QUADRANT_BUILD:-$root/build}
command -v valgrind >/dev/null || { echo "no valgrind: skipped" >&2; exit 77; }
here=$build/count-g++
mkdir -p "$build"
program=$here/benchmarks/blocks_count
{
    cmake -S "$root" -B "$here" -G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Release \
        -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_EXAMPLES=OFF && cmake --build "$here" --target blocks_count
} >"$here.log" 2>&1 || { cat "$here.log" >&2; exit 1; }

instructions() { # NUMBER SAMPLES
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$program" "$1" "$2" 2>&1 >/dev/null |
        sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
}
rows() { # the names that begin with a = are loops and comparisons
    "$program" list >"$here/list.txt" || { echo "the notches do not agree" >&2; exit 1; }
    while read -r number name; do
        few=$(instructions "$number" 1000)
        many=$(instructions "$number" 5000)
        awk -v name="$name" "BEGIN { printf \"| %s | %.1f |\n\", name, ($many - $few) / 4000 }"
    done <"$here/list.txt"
}
rows >"$here/rows.txt"

cat <<EOF
# Benchmarks

Instructions per sample, counted by callgrind (repeatable, independent of the machine's load), $(g++ -dumpfullversion | sed 's/^/g++ /'), -O3.
Written by \`sh benchmarks/blocks.sh >docs/benchmarks.md\`; the parameters are those of \`tests/conformance/blocks.hpp\`.
Input is noise of the amplitude that the list gives. The call and the summing loop are included: \`through\` shows what
passing a number costs. Library functions (\`sin\`, \`exp\`) are counted as what they execute.

## Blocks

| block | instructions per sample |
|---|---|
$(grep -v '^| = ' "$here/rows.txt")

## The axis of the milling table, and notches without the library

\`milling_axis\`: \`milling_axis_boxes\` for one position loop, without plant; friction \`maxwell_slip<4>\`, observer
\`disturbance_observer\`, memory \`repetitive\` with 90 and 61 taps. The notches have no NaN policy; the one in
Eigen is a fixed-size state space. All three notches are compared sample by sample before anything is counted.

| | instructions per sample |
|---|---|
$(grep '^| = ' "$here/rows.txt" | sed 's/^| = /| /')
EOF
