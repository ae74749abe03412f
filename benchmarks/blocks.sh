#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Long: writes one page from top to bottom.
# usage: [REPETITIONS=40] [ROUNDS=450] blocks.sh >docs/benchmarks.md
#                                           instructions and time per sample of every block, of the whole axis, of both axes, of
#                                           what one would write or take instead, and how the times of the two-axis loop are
#                                           distributed; on a quiet machine. Fewer repetitions and rounds: to try the script.
# The loops of both axes are timed once, in turns, for each compiler and -march (peers.sh march): every table and sentence about
# them takes its figures from that measurement, and a sentence that says a ratio is written here from it.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
build=${QUADRANT_BUILD:-$root/build}
command -v valgrind >/dev/null || { echo "no valgrind: skipped" >&2; exit 77; }
here=$build/blocks-g++
mkdir -p "$build"
{
    cmake -S "$root" -B "$here" -G Ninja -DCMAKE_CXX_COMPILER=g++ -DCMAKE_BUILD_TYPE=Release -DQUADRANT_BUILD_TESTS=OFF &&
        cmake --build "$here" --target blocks_count blocks_time xy_loop xy_loop_count quadrant-latency &&
        { ! cmake --build "$here" --target help | grep -q plant_pass_sse2 ||
            cmake --build "$here" --target plant_pass_sse2 plant_pass_avx2 plant_pass_avx512f; } &&
        { ! command -v arm-none-eabi-g++ >/dev/null || cmake --build "$here" --target latency_cortex_m7; }
} >"$here.log" 2>&1 || { cat "$here.log" >&2; exit 1; }

instructions() { # PROGRAM WHICH SAMPLES
    valgrind --tool=callgrind --callgrind-out-file=/dev/null "$@" 2>&1 >/dev/null |
        sed -n 's/.*Collected : *\([0-9]*\).*/\1/p'
}
per_sample() { # PROGRAM WHICH [MOTION]
    first=1000
    case ${3-}$1 in standing*xy_loop_count) first=32000 ;; esac # after its rest
    few=$(instructions "$1" "$2" $first ${3-})
    many=$(instructions "$1" "$2" $((first + 4000)) ${3-})
    awk "BEGIN { printf \"%.1f\", ($many - $few) / 4000 }"
}
shortest() { # PROGRAM [FILTER]: name and nanoseconds a sample, the shortest of REPETITIONS: short ones, which other programs leave alone
    "$1" --benchmark_filter="${2:-.}" --benchmark_min_time=0.005 --benchmark_repetitions="${REPETITIONS:-40}" --benchmark_format=csv 2>/dev/null |
        awk -F'"' '/^"/ { t = $NF; sub(/.*,/, "", t); t *= 1e9
            if (!($2 in best)) order[++n] = $2
            if (!($2 in best) || t < best[$2]) best[$2] = t }
            END { for (i = 1; i <= n; ++i) printf "%s|%.*f\n", order[i], best[order[i]] < 100 ? 1 : 0, best[order[i]] }' |
        grep -v '_\(mean\|median\|stddev\|cv\)|'
}
rows() { # the names that begin with = are loops and comparisons, with ~ sums
    "$here/benchmarks/blocks_count" list >"$here/list.txt" || { echo "the notches or the sums do not agree" >&2; exit 1; }
    shortest "$here/benchmarks/blocks_time" >"$here/times.txt"
    while read -r number name; do
        counted=$(per_sample "$here/benchmarks/blocks_count" "$number")
        at_rest=$(per_sample "$here/benchmarks/blocks_count" "$number" standing)
        time=$(awk -F'|' -v name="blocks/$name" '$1 == name { print $2 }' "$here/times.txt")
        rest=$(awk -F'|' -v name="standing/$name" '$1 == name { print $2 }' "$here/times.txt")
        echo "| $name | $counted | $at_rest | $time | $rest |"
    done <"$here/list.txt"
}
has() { sed -n 's/^flags[^:]*: *//p' /proc/cpuinfo | head -n 1 | tr ' ' '\n' | grep -qx "$1"; } # FLAG of the processor
timed() { # COMPILER MARCH NAME [FIELD]: of that measurement in turns: ns a sample; 3: that by the expert's; 4: median of the ratios
    [ -e "$here/turns-$1-$2" ] || return 0
    awk -F'|' -v name="xy_loop/$3" -v field="${4:-2}" '$1 == name { print $field }' "$here/turns-$1-$2"
}
by() { awk "BEGIN { printf \"%.2f\", $1 / $2 }"; }
both_axes() {
    for fir in '' _without_fir; do
        hand=$(per_sample "$here/benchmarks/xy_loop_count" hand_written$fir)
        for kind in typed typed_lanes hand_written virtual_graph; do
            name=$kind${fir:+/without_fir}
            counted=$(per_sample "$here/benchmarks/xy_loop_count" $kind$fir)
            echo "| xy_loop/$name | $counted | $(awk "BEGIN { printf \"%.3f\", $counted / $hand }") | $(timed g++ x86-64 $name) |"
        done
    done
    for motion in standing reversing; do # parked for 32 000 periods; turning round every ten
        hand=$(per_sample "$here/benchmarks/xy_loop_count" hand_written $motion)
        for kind in typed typed_lanes hand_written virtual_graph; do
            counted=$(per_sample "$here/benchmarks/xy_loop_count" $kind $motion)
            echo "| xy_loop/$kind/$motion | $counted | $(awk "BEGIN { printf \"%.3f\", $counted / $hand }") | $(timed g++ x86-64 $kind/$motion) |"
        done
    done
    shortest "$here/benchmarks/xy_loop" hal_chain |
        sed -n 's/^\(xy_loop\/hal_chain[^|]*\)|\(.*\)/| \1 | | | \2 |/p' # where LinuxCNC is installed
}
plant_passes() { # by instruction set; the program's own counter, the shortest of REPETITIONS
    for set in sse2 avx2 avx512f; do
        [ -x "$here/benchmarks/plant_pass_$set" ] && has $set || continue
        "$here/benchmarks/plant_pass_$set" --benchmark_min_time=0.02 --benchmark_repetitions="${REPETITIONS:-40}" --benchmark_format=csv 2>/dev/null |
            awk -F, -v set="$set" '/^"plant_pass/ && !/_(mean|median|stddev|cv)"/ { gsub(/"/, "", $1); t = $NF * 1e9
                if (!($1 in best)) order[++n] = $1
                if (!($1 in best) || t < best[$1]) best[$1] = t }
                END { for (i = 1; i <= n; ++i) printf "| %s, %s | %.1f |\n", order[i], set, best[order[i]] }'
    done
}
both_axes_v3() { # the same for x86-64-v3, products and sums fused where the compiler likes, beside an expert's loop
    [ -e "$here/turns-g++-x86-64-v3" ] || { echo "| (left out: this processor has no AVX2, FMA and BMI2) | | | | | | | |"; return; }
    for compiler in g++ clang++; do
        command -v $compiler >/dev/null || continue
        $compiler -std=c++20 -O3 -DNDEBUG -march=x86-64-v3 -ffp-contract=fast -I"$root/include" -I"$root/examples/programs" \
            -o "$here/v3_xy_loop_count" "$root/benchmarks/xy_loop_count.cpp" 2>>"$here.log" || { cat "$here.log" >&2; exit 1; }
        "$here/v3_xy_loop_count" same_commands || exit 1
        for fir in '' _without_fir; do
            kinds='typed typed_lanes hand_written expert'
            [ -z "$fir" ] || kinds='typed_lanes expert'
            expert=$(per_sample "$here/v3_xy_loop_count" expert$fir)
            for kind in $kinds; do
                counted=$(per_sample "$here/v3_xy_loop_count" $kind$fir)
                name=$kind${fir:+/without_fir}
                echo "| xy_loop/$name, $compiler | $counted | $(awk "BEGIN { printf \"%.3f\", $counted / $expert }") | $(timed $compiler x86-64-v3 $name) | $(timed $compiler x86-64-v3 $name/standing) | $(timed $compiler x86-64-v3 $name/reversing) | $(timed $compiler x86-64-v3 $name 3) | $(timed $compiler x86-64-v3 $name 4) |"
            done
        done
    done
}
counted_v3() { # KIND COMPILER COLUMN: of that table
    awk -F' *[|] *' -v name="xy_loop/$1, $2" -v column="$3" '$2 == name { print $(column + 2) }' "$here/xy_v3_rows.txt"
}
each_compiler() { # FUNCTION ARGUMENTS...: "A (g++) and B (clang++)", of those that were measured
    first=1
    for compiler in g++ clang++; do
        of=$("$@" $compiler)
        [ -n "$of" ] || continue
        [ $first = 1 ] || printf ' and '
        first=0
        printf '%s (%s)' "$of" $compiler
    done
}
instructions_by_expert() { counted_v3 "$1" "$2" 2; }
instructions_above() { # how many more than 1.10 times the expert's
    lanes=$(counted_v3 "$1" "$2" 1) expert=$(counted_v3 expert/without_fir "$2" 1)
    [ -z "$lanes" ] || awk "BEGIN { printf \"%.0f\", $lanes - 1.10 * $expert }"
}
time_by_expert() { timed "$2" x86-64-v3 "$1" 3; }
median_by_expert() { timed "$2" x86-64-v3 "$1" 4; }
lanes_by_typed() { # time of the lanes with v3 by that of the typed loop without -march
    lanes=$(timed "$1" x86-64-v3 typed_lanes) typed=$(timed "$1" x86-64 typed)
    [ -z "$lanes" ] || by "$lanes" "$typed"
}
native_by_v3() { # KIND COMPILER
    native=$(timed "$2" native "$1") v3=$(timed "$2" x86-64-v3 "$1")
    [ -z "$v3" ] || by "$native" "$v3"
}
narrow_by_native() { # KIND COMPILER
    narrow=$(timed "$2" native,-mprefer-vector-width=256 "$1") native=$(timed "$2" native "$1")
    [ -z "$narrow" ] || by "$narrow" "$native"
}
expert_text() {
    [ -e "$here/turns-g++-x86-64-v3" ] || return 0
    cat <<EOT
\`typed_lanes\` takes $(each_compiler time_by_expert typed_lanes) times the expert's time (the shortest of ${ROUNDS:-450} rounds of both),
$(each_compiler median_by_expert typed_lanes) as the median of the ratios of neighbours in a round; turning round $(each_compiler time_by_expert typed_lanes/reversing),
median $(each_compiler median_by_expert typed_lanes/reversing); without the FIR filters $(each_compiler time_by_expert typed_lanes/without_fir),
median $(each_compiler median_by_expert typed_lanes/without_fir). There it is the work that the expert does not do: 19 wires that can be read, faults by axis,
and what lets states die out; the filters hide it.
EOT
}
march_text() {
    [ -e "$here/turns-g++-x86-64-v3" ] || { echo "- This processor has no AVX2, FMA and BMI2: no row of x86-64-v3 or of the expert's loop was measured."; return; }
    cat <<EOT
- Take \`-march=x86-64-v3\` where the processor has AVX2 and FMA (Intel since 2013, AMD since 2015), and the lanes: $(each_compiler lanes_by_typed)
  times the time of the typed loop without \`-march\`.
- \`-march=native\` is \`$(g++ -march=native -Q --help=target | sed -n 's/^ *-march=[[:space:]]*//p' | head -n 1)\` here. It takes $(each_compiler native_by_v3 typed) times what v3 takes for the typed loop,
  $(each_compiler native_by_v3 typed_lanes) for the lanes, $(each_compiler native_by_v3 hand_written) for \`hand_written\`.
EOT
    if has avx512f; then
        cat <<EOT
  With \`-mprefer-vector-width=256\` the typed loop takes $(each_compiler narrow_by_native typed) times what it takes with \`native\` alone, \`hand_written\`
  $(each_compiler narrow_by_native hand_written). Our reading, which no hardware counter has confirmed: with AVX-512 g++ sums FIR filters that are written
  as plain loops in registers of 512 bits; such a load spans the sample that has just been stored, and waits until the store has reached the cache.
EOT
    else
        echo "  This processor has no AVX-512: nothing is said here about what \`native\` does with it."
    fi
    echo "- Blocks alone, with g++ and \`-march=x86-64-v3\`: \`-fno-tree-slp-vectorize\` takes $(awk -F'|' '{ printf "%s`%s` from %s to %s ns", (NR > 1 ? ", " : ""), $1, $2, $3 }' "$here/slp")."
    echo "  Our reading: g++ stores two states in one register and loads them one by one in the next sample, or the reverse, and waits for the store."
}
left_out() { # what has no row here
    has avx2 || echo 'AVX2 is not there: no row of it, of x86-64-v3 and of the expert.'
    has avx512f || echo 'AVX-512 is not there: it has no row.'
    command -v clang++ >/dev/null || echo 'clang++ is not there: it has no row.'
}
before=$(cut -d' ' -f1 /proc/loadavg)
rm -f "$here"/turns-* "$here/slp"
TURNS=$here sh "$root/benchmarks/peers.sh" >"$here/peers_and_march.txt"
rows >"$here/rows.txt"
both_axes >"$here/xy_rows.txt"
both_axes_v3 >"$here/xy_v3_rows.txt"
sed '/^$/,$d' "$here/peers_and_march.txt" >"$here/peers.txt"
sed '1,/^$/d' "$here/peers_and_march.txt" >"$here/march.txt"
busy=$(cut -d' ' -f1 /proc/loadavg)
(cd "$here" && examples/quadrant-latency >latency.txt) || true # 1: did not fit; the text says so

cat <<EOF
# Benchmarks

For whoever asks what a block costs. You get its instructions and its time per sample, and those of whole loops.

Instructions per sample, counted by callgrind (repeatable, independent of the machine's load), $(g++ -dumpfullversion | sed 's/^/g++ /'), -O3; nanoseconds
per sample on one of $(nproc) cores of $(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1), cache warm, the shortest of ${REPETITIONS:-40} runs.
The kernel lists these extensions of it: $(for flag in sse2 sse4_1 avx avx2 fma bmi2 avx512f avx512dq avx512bw avx512vl; do ! has $flag || printf '%s ' $flag; done | sed 's/ $//').
$(left_out)
Programs that wanted to run in the minute before: $before; priority of the session (autogroup): $(sed -n 's/.*nice //p' /proc/self/autogroup 2>/dev/null || true).
Other programs and a virtual machine's neighbours make a loop slower, so compare rows of one table, and take the instructions where a few percent matter.
Written by \`sh benchmarks/blocks.sh >docs/benchmarks.md\`; the parameters are those of \`tests/conformance/blocks.hpp\`.
Input is noise of the amplitude that the list gives. The call and the summing loop are included: \`through\` shows what
passing a number costs; \`standing\` is the same block with an input that rests. Library functions (\`sin\`, \`exp\`) are counted
as what they execute.

## Blocks

| block | instructions | standing | ns | ns, standing |
|---|---|---|---|---|
$(grep -v '^| [=~] ' "$here/rows.txt")

## The axis of the milling table, and notches without the library

\`milling_axis\`: \`milling_axis_boxes\`, the controller without a plant; friction \`maxwell_slip<4>\`, observer
\`disturbance_observer\`, memory \`repetitive\` with 90 and 61 taps. The notches have no NaN policy; the one in
Eigen is a fixed-size state space. All three notches are compared sample by sample before anything is counted.

| | instructions | standing | ns | ns, standing |
|---|---|---|---|---|
$(grep '^| = ' "$here/rows.txt" | sed 's/^| = /| /')

## Sums of FIR filters, and two axes in the lanes of one register

A filter of 90 taps, the input put into its memory included. \`repetitive\` sums in four parts over a window that does not
wrap (\`memory/fir.hpp\`): plain loops, which both compilers turn into SIMD from \`-O2\` on, with a smaller bound of the
rounding than the one sum has. Eight sums are quicker where the compiler unrolls them (\`-O3\`; at \`-O2\` g++ does not). Half the
multiplications (an even filter) leave as many additions and loads. Two axes in lanes with SSE2: what one axis does alone fills the
registers of a FIR filter already; the recursion of a notch is shorter in instructions, not in time, since it waits for itself. With AVX it is
another matter: see "Both axes in lanes" below. What stands in a group is compared sample by sample before anything is counted.

| | instructions | standing | ns | ns, standing |
|---|---|---|---|---|
$(grep '^| ~ ' "$here/rows.txt" | sed 's/^| ~ /| /')

## Both axes of the milling table

The controller of both axes: cascade, notch, inverse of the plant, GMS friction, disturbance observer, memory of second order with
its FIR filters of 90 and 61 taps, or without them. \`hand_written\`: one struct and one function in doubles with the same NaN
policy; \`virtual_graph\`: the same blocks, each behind a virtual call. Rows \`standing\` and \`reversing\`: both axes
parked for 32 000 periods, and turning round every ten. \`typed_lanes\`: both axes in the lanes of one register, here of SSE2. All but it give the same bits and flags over 20 000 samples,
NaN and overflow among them, looked at before anything is measured. The ratio is that of the instructions to \`hand_written\`;
\`sh benchmarks/callgrind.sh\` has it for clang++ too and fails above 1.05. \`hal_chain\`: LinuxCNC's own components (\`ddt\`, \`lowpass\`, \`biquad\`,
\`sum2\`, \`pid\`, \`limit1\`) called one after another as a HAL thread does. They make cascade, notch and inverse of the plant
only, so their time is to be laid beside "two axes of milling_axis" above.

| | instructions | ratio | ns |
|---|---|---|---|
$(cat "$here/xy_rows.txt")

## Both axes in lanes, beside an expert's loop

The same loop for x86-64-v3 (AVX2, FMA), compiled by \`-O3 -march=x86-64-v3 -ffp-contract=fast\`. \`expert\` (\`benchmarks/expert_xy.hpp\`) is written by hand
in the compilers' vector extension: both axes in lanes, every FIR coefficient loaded once for both, friction without a branch, an exponential
of 3e-13, rounding in one instruction, one range check at the inputs. It gives the same commands behind the DAC on the circle, at rest and
turning round (looked at before anything is counted), and nothing else: no wire to look at, one set of taps for both axes, no reset, settle,
retune, track or fade, and no protection from subnormal numbers at rest. \`typed_lanes\` has all of that, and its exponential is right to one unit in the
last place. That is what it pays for: 19 wires and tests for what has died out. Where both axes have the same taps, each coefficient is loaded once, as
the expert does; other taps are loaded for each axis. The ratio is that of the instructions to \`expert\`; \`sh benchmarks/callgrind.sh\` fails
above 1.10, on the circle and turning round. At rest, where the expert's loop does nothing against subnormal numbers, that ratio is not asked, and
without the FIR filters neither: there it is $(each_compiler instructions_by_expert typed_lanes/without_fir), and the code of g++ 12.2 says why. Instructions of a
sample by kind, counted in it once by hand, the expert's in brackets: arithmetic 123 (117), loads 64 (51), stores 85 (39), comparisons and selections
50 (25), branches 26 (9), moves, shuffles and addresses 94 (94). The stores are 19 wires that can be read after the sample, and the states of what can be
reset, settled and retuned; one of them is a spilled register. Selections and branches are what takes states to zero at rest. None of it can go without
the feature that it serves, and what is above 1.10, $(each_compiler instructions_above typed_lanes/without_fir) instructions, is hidden in the whole loop beside the FIR filters.

The times were taken in turns: a tenth of the motion by each loop, then the next tenth, ${ROUNDS:-450} rounds, every other one backwards. Each is the shortest of
its rounds; the last two columns are the time by the expert's on the circle: shortest by shortest, and the median of the ratios round by round.
$(expert_text)

| | instructions | ratio | ns | ns, standing | ns, reversing | ns by expert's | median |
|---|---|---|---|---|---|---|---|
$(cat "$here/xy_v3_rows.txt")

## Beside what others use

Small filters, laws and limits, one sample a call, in one run (\`sh benchmarks/peers.sh\`; g++ -O3 -ffp-contract=off, instructions without \`-march\`, CPU time
with three). LinuxCNC's components are those of Debian's \`linuxcnc-uspace\`, as compiled there, Eigen is \`libeigen3-dev\`, liquid-dsp is \`libliquid-dev\`
(float). iir1, CMSIS-DSP and wpimath are in no Debian package: their rows are their published forms, written again. Only this library's rows
hold their output at a NaN and tell; those of one group give the same over 20 000 samples (looked at before anything is measured), but for the
two rows that say another law in brackets.

$(cat "$here/peers.txt")

## Which -march

The loop of both axes (\`sh benchmarks/peers.sh march\`), -O3 -ffp-contract=fast, nanoseconds a sample, CPU time, the shortest of ${ROUNDS:-450} rounds in turns
(rows of one line ran in turns, lines one after the other; the same measurement as in the tables above):

$(cat "$here/march.txt")

$(march_text)

## The most instructions of a sample

What \`quadrant-latency --bound\` counts: each kind of sample for itself, by callgrind over directed inputs, so it does not depend on what else
runs. Compiled as the programs are (g++, -O3, SSE2). Beside it the same calls of the typed loop on a Cortex-M7 (Debian's arm-none-eabi g++, -O2, double
hardware), each instruction counted by QEMU: the program runs \`quadrant-latency-cortex-m7.elf\` where it lies beside it (target \`latency_cortex_m7\`;
without it or QEMU the last line says so). An own loop: [how to](howto/measure_my_loop.md).

\`\`\`
$("$here/examples/quadrant-latency" --bound)
\`\`\`

## A plant of the diagnosis

One row of one plant in the pass of a diagnosis over a log: an observer that the readings correct, around a \`servo_axis\` with Stribeck friction whose
delay splits each period, so that a row is two steps of it; \`undelayed\`: one step; \`cogging\`: two steps with four harmonics over the position.
\`standing\`: one that rests; \`scalar\`: one plant alone; \`lanes\`: 16 plants in one pass, the time divided by 16. Programs choose the instruction set when they start
(\`build/bench/benchmarks/plant_pass_avx2\` and its sisters; the target must be named when they are built).

| | ns a lane and row |
|---|---|
$(plant_passes)

## Sub-steps of a plant

One axis of 340 kg on Stribeck friction, 25 sub-steps a period of 500 us, driven back and forth and stopping on the way (\`sh benchmarks/sub_steps.sh times\`).
\`typed\`: \`stick_slip\` in a loop. \`motor\`: \`linear_motor\`, with delay, limit, DAC and encoder. \`plain\`: C that is semi-implicit. Both are of first order; the
error over 20 s is that beside 1000 sub-steps. \`plain_as_accurate\`: the same C with the 48 sub-steps that it takes for the error of \`typed\`. Last column: the axis rests, after a second of motion.

\`\`\`
$(sh "$root/benchmarks/sub_steps.sh" times)
\`\`\`

## How the times are distributed

What \`quadrant-latency\` says on this machine, which is a virtual one of $(nproc) cores that others use as well (programs that wanted to
run in the minute before: $busy):

\`\`\`
$(grep -v '^Page: ' "$here/latency.txt")
\`\`\`
EOF
