#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: [COMPILERS=g++] callgrind.sh [BOUND]     instructions per servo period of the typed loops beside the hand-written ones
# Builds axis_loop_count and xy_loop_count with every compiler that is there, counts instructions with valgrind for two
# numbers of samples (their difference is free of the start-up), prints tables: one axis, both axes with the memory's
# FIR filters, both without; one axis and both axes parked for 32 000 periods, and turning round every ten. Then both axes
# for x86-64-v3 (products and sums may be fused), beside an expert's loop. Exit code 1 when typed needs more than BOUND
# (1.05) times what hand_written needs in any table, or typed_lanes in motion or turning round more than EXPERT_BOUND times
# what the expert's loop needs; 77 when there is no valgrind. EXPERT_BOUND: see docs/benchmarks.md. At rest it is not asked:
# an expert's loop does nothing there against subnormal numbers. Last the sub-steps of a plant (sub_steps.sh), whose bound
# is its own.
set -eu
bound=${1:-1.05} expert_bound=1.10
root=$(cd "$(dirname "$0")/.." && pwd)
build=${QUADRANT_BUILD:-$root/build}
mkdir -p "$build"
command -v valgrind >/dev/null || { echo "no valgrind: skipped"; exit 77; }

instructions() { # PROGRAM WHICH N
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
}
per_sample() { # PROGRAM WHICH [MOTION]
    first=1000
    [ "${3-}" != standing ] || case $1 in *axis_loop*) first=52000 ;; *) first=32000 ;; esac # after its rest
    instructions "$1" "$2" $first ${3-} >"$1.few" & # beside the longer run
    many=$(instructions "$1" "$2" $((first + 10000)) ${3-})
    wait
    few=$(cat "$1.few")
    awk "BEGIN { d = 0$many - 0$few; good = 0$few > 0 && d > 0; if (good) printf \"%.1f\", d / 10000; exit !good }" ||
        { echo "$1 $2 ${3-}: valgrind counted nothing: it may not know an instruction of it" >&2; exit 1; }
}

worst=0
table() { # TARGET THIRD SUFFIX [MOTION]
    printf '%-20s %-10s %10s %14s %24s %8s\n' "${1%_count}$3${4:+ $4}" compiler typed hand_written "$2" ratio
    for compiler in ${COMPILERS:-g++ clang++}; do
        command -v $compiler >/dev/null || continue
        here=$build/count-$compiler
        program=$here/benchmarks/$1
        "$program" same || { echo "$compiler: the loops do not agree bit for bit"; exit 1; }
        typed=$(per_sample "$program" "typed$3" $4)
        hand=$(per_sample "$program" "hand_written$3" $4)
        third=$(per_sample "$program" "$2$3" $4)
        ratio=$(awk "BEGIN { printf \"%.3f\", $typed / $hand }")
        printf '%-20s %-10s %10s %14s %24s %8s\n' '' $compiler "$typed" "$hand" "$third" "$ratio"
        worst=$(awk "BEGIN { print ($ratio > $worst) ? $ratio : $worst }")
    done
}
for compiler in ${COMPILERS:-g++ clang++}; do
    command -v $compiler >/dev/null || continue
    here=$build/count-$compiler
    cmake -S "$root" -B "$here" -G Ninja -DCMAKE_CXX_COMPILER=$compiler -DCMAKE_BUILD_TYPE=Release \
        -DQUADRANT_BUILD_TESTS=OFF -DQUADRANT_BUILD_EXAMPLES=OFF >"$here.log" 2>&1 &&
        cmake --build "$here" --target axis_loop_count xy_loop_count >>"$here.log" 2>&1 || { cat "$here.log"; exit 1; }
done
table axis_loop_count hand_written_unchecked '' ''
table xy_loop_count virtual_graph '' ''
table xy_loop_count virtual_graph _without_fir ''
table axis_loop_count hand_written_unchecked '' standing
table xy_loop_count virtual_graph '' standing
table axis_loop_count hand_written_unchecked '' reversing
table xy_loop_count virtual_graph '' reversing

worst_lanes=0
v3=$build/count-v3
mkdir -p "$v3"
for compiler in ${COMPILERS:-g++ clang++}; do # the register that a FIR filter sums in: the same bits
    command -v $compiler >/dev/null && grep -q avx2 /proc/cpuinfo || continue
    $compiler -std=c++20 -O3 -march=x86-64-v3 -ffp-contract=off -I"$root/include" -o "$v3/fir_bits-$compiler" "$root/benchmarks/fir_bits.cpp"
    "$v3/fir_bits-$compiler"
done
for row in ':' '_without_fir:' ':standing' ':reversing'; do
    fir=${row%:*} motion=${row#*:}
    printf '%-20s %-10s %10s %12s %14s %10s %18s\n' "xy_loop v3$fir${motion:+ $motion}" compiler typed typed_lanes hand_written expert "lanes / expert"
    for compiler in ${COMPILERS:-g++ clang++}; do
        command -v $compiler >/dev/null || continue
        grep -q avx2 /proc/cpuinfo || continue
        program=$v3/xy_loop_count-$compiler
        [ "$row" != : ] || $compiler -std=c++20 -O3 -DNDEBUG -march=x86-64-v3 -ffp-contract=fast -I"$root/include" \
            -I"$root/examples/programs" -o "$program" "$root/benchmarks/xy_loop_count.cpp"
        "$program" same_commands || { echo "$compiler, v3: the loops do not give the same commands"; exit 1; }
        typed=$(per_sample "$program" "typed$fir" $motion)
        lanes=$(per_sample "$program" "typed_lanes$fir" $motion)
        hand=$(per_sample "$program" "hand_written$fir" $motion)
        expert=$(per_sample "$program" "expert$fir" $motion)
        ratio=$(awk "BEGIN { printf \"%.3f\", $lanes / $expert }")
        printf '%-20s %-10s %10s %12s %14s %10s %18s\n' '' $compiler "$typed" "$lanes" "$hand" "$expert" "$ratio"
        worst=$(awk "BEGIN { r = $typed / $hand; print (r > $worst) ? r : $worst }")
        case $row in : | :reversing) ;; *) continue ;; esac
        worst_lanes=$(awk "BEGIN { print ($ratio > $worst_lanes) ? $ratio : $worst_lanes }")
    done
done
if awk "BEGIN { exit !($worst_lanes > $expert_bound) }"; then
    echo "typed_lanes needs $worst_lanes times the instructions of the expert's loop; allowed is $expert_bound"
    exit 1
fi
if awk "BEGIN { exit !($worst > $bound) }"; then
    echo "a typed loop needs $worst times the instructions of the hand-written one; allowed is $bound"
    exit 1
fi
sh "$root/benchmarks/sub_steps.sh"
