#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: compile_cost.sh >docs/compile_cost.md     what it costs to include each header, and to compile a full loop
#        compile_cost.sh check                     fails when the headers read a tenth more lines than the page says
#        compile_cost.sh files [BUILD]             fails when a file of the diagnosis takes more than 15 s or 600 MB, also
#                                                  beside a reference that is compiled in the same minute (compile_files.py)
# Environment: RUNS   compilations of each, of which the fastest counts (default 3)
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
page=$root/docs/compile_cost.md
runs=${RUNS:-3}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export LC_ALL=C
cd "$root/include"

lines() { # FLAGS... FILE      what the compiler has to read
    g++ -std=c++20 -I"$root/include" -E -P "$@" | wc -l
}
seconds() { # COMPILER ARGUMENTS...    processor time of the fastest run
    for run in $(seq "$runs"); do
        bash -c 'TIMEFORMAT="%U %S"; time "$@"' - "$@" 2>&1 | awk '{ print $1 + $2 }'
    done | sort -n | head -n 1
}
row() { # NAME SOURCE FLAGS...
    name=$1 source=$2
    shift 2
    printf '| %s | %s' "$name" "$(lines "$source")"
    for compiler in g++ clang++; do
        printf ' | %.2f' "$(seconds $compiler -std=c++20 -I"$root/include" "$@" "$source")"
    done
    printf ' |\n'
}
including() { # HEADER...
    printf '#include <%s>\n' "$@" >"$work/source.cpp"
    echo "$work/source.cpp"
}

if [ "${1-}" = check ]; then
    now=$(lines "$(including quadrant/quadrant.hpp)")
    before=$(sed -n 's/^| quadrant\.hpp | \([0-9]*\) .*/\1/p' "$page")
    echo "quadrant.hpp reads $now lines, $before in docs/compile_cost.md"
    [ "$now" -le $((before + before / 10)) ]
    exit
fi

files() { # [BUILD]    rows of a table: the files of quadrant_diagnosis_once in a build of the preset `release`
    if [ "${1-}" = "" ]; then
        cmake -S "$root" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=g++ \
            -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_BENCHMARKS=OFF >&2
    fi
    python3 "$root/benchmarks/compile_files.py" "${1:-$work/build}"
}
if [ "${1-}" = files ]; then
    files "${2-}"
    exit
fi

cat <<END
# Cost of compiling

For whoever waits for a compiler. You get what each header adds to a compilation.

Processor seconds of one compilation, the fastest of $runs, and the lines that the compiler reads (comments and blank lines
not counted). $(g++ --version | head -n 1), $(clang++ --version | head -n 1). Written by
\`sh benchmarks/compile_cost.sh >docs/compile_cost.md\`; a test fails when quadrant.hpp reads a tenth more lines than here.

## A full loop

With \`-O2\`: \`examples/02_closed_loop.cpp\` is a cascade on a motor, \`servo_axis.cpp\` the largest loop of
\`examples/microcontroller\` (cascade, notch, friction, observer, memory).

| source | lines | g++ | clang++ |
|---|---|---|---|
END
row 02_closed_loop.cpp "$root/examples/02_closed_loop.cpp" -O2 -c -o "$work/object"
row servo_axis.cpp "$root/examples/microcontroller/servo_axis.cpp" -O2 -DSERVO_NUMBER=double -c -o "$work/object"

cat <<END

## The diagnosis, compiled once

The files of the CMake target \`quadrant_diagnosis_once\`, with g++ \`-O2\`. None may take more than 15 s or 600 MB
(\`sh benchmarks/compile_cost.sh files\`, in ctest \`headers.files\` of \`sh tests/run.sh long\`).

| file | s | MB |
|---|---|---|
END
files || echo "a file takes more than it may" >&2
cat <<END

## One header alone

With \`-fsyntax-only\`. The first rows are what all the others stand on: a file with nothing of ours costs that much.

| header | lines | g++ | clang++ |
|---|---|---|---|
END
row '(std: array, cmath, complex)' "$(including array cmath complex)" -fsyntax-only
row '(and Boost.Units: quantity, force, velocity)' \
    "$(including array cmath complex boost/units/quantity.hpp boost/units/systems/si/force.hpp boost/units/systems/si/velocity.hpp)" -fsyntax-only
row quadrant.hpp "$(including quadrant/quadrant.hpp)" -fsyntax-only
for header in $(find quadrant -name '*.hpp' ! -path '*/diagnosis/*' ! -name quadrant.hpp | sort); do
    row "${header#quadrant/}" "$(including "$header")" -fsyntax-only
done
