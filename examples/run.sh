#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The first command of the README, for a bare Debian 12: installs what is missing, builds quadrant-gap, and asks it why
# the machine in examples/data does not do what its simulation says.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
build=$root/build/run
log=$build/build.log
data=$root/examples/data
mkdir -p "$build"

sh "$root/examples/install.sh" g++ cmake ninja-build libboost-dev libeigen3-dev nlohmann-json3-dev libfmt-dev \
    libcli11-dev libssl-dev libjs-dygraphs

# The sources, in as many compilations as there are cores: what they share is compiled once in each. One for the
# library and one for the program take the least processor time, and up to 3.1 GB for each of the two compilers.
cores=$(nproc 2>/dev/null || echo 2)
together=$((25 / cores + 1))
free=$(awk '$1 == "MemAvailable:" { print int($2 / 1e6) }' /proc/meminfo 2>/dev/null)
if [ "$cores" -le 2 ] && [ "${free:-0}" -ge 7 ]; then together=30; fi
# The passes over a log, for the registers of this processor only.
passes=avx2
if grep -qw avx512f /proc/cpuinfo 2>/dev/null; then passes=avx512; fi
build_it() {
    cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DQUADRANT_BUILD_TESTS=OFF \
        -DQUADRANT_BUILD_BENCHMARKS=OFF -DQUADRANT_TOGETHER=$together -DQUADRANT_PASSES=$passes \
        -DQUADRANT_FAST_LAWS=OFF &&
        cmake --build "$build" --target quadrant-gap --parallel "$cores"
}
program=$build/examples/quadrant-gap
echo "building quadrant-gap (once; some 220 s of processor time, more with less than 8 GB, shared by $cores cores; what the compiler says: $log)"
began=$(date +%s)
build_it >"$log" 2>&1 || {
    tail -n 30 "$log" >&2
    echo "The build failed; the whole of it: $log" >&2
    exit 1
}
echo "built in $(($(date +%s) - began)) s"

set -- diagnose --machine "$data/machine.json" --log "$data/log.csv" --holdout "$data/holdout.csv" \
    --json "$build/diagnosis.json" --report "$build/report.html"
echo "running quadrant-gap $*"
"$program" "$@"
echo
echo "Report: $build/report.html"
