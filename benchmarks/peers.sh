#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: [TURNS=FOLDER] peers.sh [march]     tables of docs/benchmarks.md: small blocks beside what others use, and what -march does
# Instructions of a sample by callgrind (-O3, no -march), nanoseconds of CPU time with three -march; then both axes of the milling
# table with every -march and both compilers, its loops in turns (xy_loop turns, ROUNDS of them, 450 by default). `march`: only the
# second table. FOLDER gets what was measured: turns-COMPILER-MARCH, of which every other table and sentence about these loops is
# made, and slp, three blocks without g++'s -ftree-slp-vectorize. A set of instructions that the processor lacks has no row.
# LinuxCNC's components (linuxcnc-uspace), Eigen (libeigen3-dev) and liquid-dsp (libliquid-dev) have rows where they are
# installed. Exit code 1 when two rows of a group do not give the same.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
turns=${TURNS:-$dir}
has() { sed -n 's/^flags[^:]*: *//p' /proc/cpuinfo | head -n 1 | tr ' ' '\n' | grep -qx "$1"; }
machines=x86-64
if has avx2 && has fma && has bmi2; then machines="$machines x86-64-v3"; fi
marches="$machines native"
if has avx512f; then marches="$marches native,-mprefer-vector-width=256"; fi
machines="$machines native"

peers() {
    command -v valgrind >/dev/null || { echo "no valgrind: skipped" >&2; exit 77; }
    liquid= libraries=
    [ ! -e /usr/include/liquid/liquid.h ] || { liquid=-DQUADRANT_PEER_LIQUID libraries=-lliquid; }
    for march in $machines; do
        g++ -std=c++20 -O3 -DNDEBUG -march=$march -ffp-contract=off -rdynamic $liquid -I"$root/include" -isystem /usr/include/eigen3 \
            -o "$dir/peers-$march" "$root/benchmarks/peers.cpp" -ldl $libraries
        "$dir/peers-$march" times >"$dir/times-$march"
    done
    "$dir/peers-x86-64" list >"$dir/list"
    case " $machines " in *' x86-64-v3 '*)
        g++ -std=c++20 -O3 -DNDEBUG -march=x86-64-v3 -fno-tree-slp-vectorize -ffp-contract=off -rdynamic $liquid -I"$root/include" \
            -isystem /usr/include/eigen3 -o "$dir/peers-slp" "$root/benchmarks/peers.cpp" -ldl $libraries
        "$dir/peers-slp" times >"$dir/times-slp"
        for name in 'quadrant backward_difference' 'quadrant pid' 'quadrant notch'; do # NAME|as it is|without it
            number=$(sed -n "s/^\([0-9]*\)|[^|]*|$name\( (.*)\)*$/\1/p" "$dir/list")
            echo "${name#quadrant }|$(sed -n "s/^$number|\([^|]*\)|.*/\1/p" "$dir/times-x86-64-v3")|$(sed -n "s/^$number|\([^|]*\)|.*/\1/p" "$dir/times-slp")"
        done >"$turns/slp"
        ;;
    esac
    counted() { # NUMBER: instructions of a sample
        for n in 1000 5000; do
            valgrind --tool=callgrind --callgrind-out-file=/dev/null "$dir/peers-x86-64" "$1" $n 2>&1 >/dev/null |
                sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
        done | awk 'NR == 1 { few = $1 } NR == 2 { printf "%.1f", ($1 - few) / 4000 }'
    }
    printf '| | | instructions |'
    for march in $machines; do printf ' ns, %s |' $march; done
    printf '\n|---|---|---|'
    for march in $machines; do printf -- '---|'; done
    echo
    while IFS='|' read -r number group name; do
        printf '| %s | %s | %s |' "$group" "$name" "$(counted "$number")"
        for march in $machines; do printf ' %s |' "$(sed -n "s/^$number|\([^|]*\)|.*/\1/p" "$dir/times-$march")"; done
        echo
    done <"$dir/list"
}
march_table() {
    echo '| | typed, ns | typed_lanes | hand_written | expert | typed_lanes, without FIR | expert, without FIR |'
    echo '|---|---|---|---|---|---|---|'
    for compiler in g++ clang++; do
        command -v $compiler >/dev/null || continue
        for flags in $marches; do
            options=$(echo "$flags" | tr , ' ')
            $compiler -std=c++20 -O3 -DNDEBUG -march=$options -ffp-contract=fast -rdynamic -I"$root/include" -I"$root/examples/programs" \
                -o "$dir/xy" "$root/benchmarks/xy_loop.cpp" -lbenchmark -lpthread -ldl
            "$dir/xy" turns "${ROUNDS:-450}" >"$turns/turns-$compiler-$flags" 2>/dev/null
            awk -F'|' -v row="$compiler -march=$options" '
                { ns[$1] = $2 }
                END { p = "xy_loop/"; printf "| `%s` | %s | %s | %s | %s | %s | %s |\n", row, ns[p "typed"], ns[p "typed_lanes"],
                      ns[p "hand_written"], ns[p "expert"], ns[p "typed_lanes/without_fir"], ns[p "expert/without_fir"] }' "$turns/turns-$compiler-$flags"
        done
    done
}
[ "${1-}" = march ] || { peers && echo; }
march_table
