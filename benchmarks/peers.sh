#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: peers.sh [march]     tables of docs/benchmarks.md: small blocks beside what others use, and what -march does
# Instructions of a sample by callgrind (-O3, no -march), nanoseconds of CPU time with three -march; then both axes of the milling
# table with every -march and both compilers. Everything in one run. `march`: only the second table. LinuxCNC's components
# (linuxcnc-uspace), Eigen (libeigen3-dev) and liquid-dsp (libliquid-dev) have rows where they are installed. Exit code 1 when
# two rows of a group do not give the same.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT
grep -q avx2 /proc/cpuinfo && machines='x86-64 x86-64-v3 native' || machines='x86-64 native'

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
        for flags in $(echo "$machines" | sed 's/native/native native,-mprefer-vector-width=256/'); do
            options=$(echo "$flags" | tr , ' ')
            $compiler -std=c++20 -O3 -DNDEBUG -march=$options -ffp-contract=fast -rdynamic -I"$root/include" -I"$root/examples/programs" \
                -o "$dir/xy" "$root/benchmarks/xy_loop.cpp" -lbenchmark -lpthread -ldl
            "$dir/xy" --benchmark_filter='xy_loop/(typed|typed_lanes|hand_written|expert)(/without_fir)?$' --benchmark_min_time=0.005 \
                --benchmark_repetitions=40 --benchmark_format=csv 2>/dev/null | awk -F'"' -v row="$compiler -march=$options" '
                /^"/ { t = $NF; sub(/.*,/, "", t); if (!($2 in best) || t < best[$2]) best[$2] = t }
                function ns(name) { return name in best ? sprintf("%.1f", 1e9 * best[name]) : "" }
                END { p = "xy_loop/"; printf "| `%s` | %s | %s | %s | %s | %s | %s |\n", row, ns(p "typed"), ns(p "typed_lanes"),
                      ns(p "hand_written"), ns(p "expert"), ns(p "typed_lanes/without_fir"), ns(p "expert/without_fir") }'
        done
    done
}
[ "${1-}" = march ] || { peers && echo; }
march_table
