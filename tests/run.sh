#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: tests/run.sh          everything that a change must pass
#        tests/run.sh all      and a second sanitizer (threads), clang-tidy, longer fuzzing, every case of every test but "long"
#        tests/run.sh long     before a release: all by g++, a soak of 1e9 samples, each file compiled alone (the label "long")
#        tests/run.sh PHASE... of: release sanitize thread fuzz tidy long
# Environment: QUADRANT_SHARED  folder with gap/ and data/ (default: shared beside the repository)
#              QUADRANT_BUILD   where to build (default: build in the repository)
# The last line is "N passed, N failed, N skipped"; the exit code is 1 when something failed.
set -u
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root" || exit 1
build=${QUADRANT_BUILD:-$root/build}
shared=${QUADRANT_SHARED:-$root/../shared}
[ ! -d "$shared" ] || shared=$(cd "$shared" && pwd)
export QUADRANT_SHARED="$shared"
export CCACHE_BASEDIR="${CCACHE_BASEDIR-$root}" CCACHE_NOHASHDIR=1 # what one clone compiled, another need not
logs=$build/logs
mkdir -p "$logs"
jobs=$(nproc 2>/dev/null || echo 2)

fuzz_seconds=20          # of processor time, all fuzzers together
tests=                   # CMake's QUADRANT_TESTS
optimised=clang          # the preset of the phase release: a test compiles in half of the time that g++ takes
large_pages=glibc.malloc.hugetlb=1 # of the memory of Clang: a sixth of its time
together=13              # CMake's QUADRANT_TOGETHER: half of the processor time, and up to 3.1 GB a compiler

case "${1-}" in
'') set -- release sanitize fuzz ;;
all)
    [ $# = 1 ] || { echo "all stands alone"; exit 2; }
    fuzz_seconds=60 tests=all
    set -- release sanitize thread fuzz tidy
    ;;
esac
for phase; do [ "$phase" != long ] || tests=all optimised=release; done

passed=0 failed=0 skipped=0
packages= # the process that installs what only tests run
count() { # PASSED FAILED SKIPPED
    passed=$((passed + $1)) failed=$((failed + $2)) skipped=$((skipped + $3))
}
broken() { # MESSAGE LOG
    printf 'FAILED: %s\n' "$1"
    grep -E 'FAILED: |[Ee]rror[: ]|: warning: ' "$2" | head -n 20
    echo ...
    tail -n 20 "$2"
    printf '(all of it: %s)\n' "$2"
    count 0 1 0
}
left_out() {
    printf 'SKIPPED: %s\n' "$1"
    count 0 0 1
}

# The packages that only tests run are there (below).
installed() {
    [ -z "$packages" ] || wait "$packages" || { echo "FAILED: packages for the tests were not installed"; exit 1; }
    packages=
}

# Configures and builds a preset in $build/PRESET: build_preset PRESET TARGET...
build_preset() {
    preset=$1
    shift
    {
        cmake --preset "$preset" -B "$build/$preset" "-DQUADRANT_SHARED=$shared" "-DQUADRANT_TESTS=$tests" \
            -DQUADRANT_TOGETHER=$together &&
            GLIBC_TUNABLES=$large_pages cmake --build "$build/$preset" --parallel "$jobs" --target "$@" -- -k 0
    } >"$logs/$preset-build.txt" 2>&1 && return
    broken "building $preset" "$logs/$preset-build.txt"
    return 1
}

# Counts what ctest -V wrote: cases for a doctest executable, else one per test. Names what failed or was left out.
tally() { # LOG
    awk '
        /^[0-9]+: \[doctest\] test cases:/ {
            id = $1 + 0
            n = split($0, part, "|")
            for (i = 2; i <= n; ++i) { split(part[i], w, " "); cases[id, w[2]] += w[1] }
            seen[id] = 1
        }
        /^[0-9]+: SKIPPED: / { ++named[$1 + 0]; sub(/^[0-9]+: /, ""); print > "/dev/stderr" }
        /^ *[0-9]+\/[0-9]+ Test +#[0-9]+: / {
            match($0, /#[0-9]+/)
            id = substr($0, RSTART + 1, RLENGTH - 1) + 0
            rest = substr($0, RSTART + RLENGTH + 2)
            name = rest
            sub(/ .*/, "", name)
            good = rest ~ /   Passed  /
            out = rest ~ /\*\*\*(Skipped|Not Run \(Disabled\))/
            if (seen[id]) {
                # doctest counts as skipped what another test of the same executable runs, too
                p += cases[id, "passed"]; f += cases[id, "failed"]; s += named[id]
                if (!good && !cases[id, "failed"]) f += 1
            } else if (good) p += 1
            else if (out) { s += 1; print "SKIPPED: " name > "/dev/stderr" }
            else f += 1
            if (!good && !out) print "FAILED: " name > "/dev/stderr"
        }
        END { print p + 0, f + 0, s + 0 }' "$1"
}
run_ctest() { # PRESET CTEST-ARGUMENTS...
    installed
    preset=$1
    shift
    log=$logs/$preset-ctest.txt
    ctest --test-dir "$build/$preset" --no-tests=error -V --parallel $((jobs + 1)) "$@" >"$log" 2>&1
    code=$?
    before=$failed
    count $(tally "$log")
    [ $code = 0 ] && return
    [ $failed != $before ] || broken "ctest in $preset" "$log"
    # What the failed ones said.
    awk '/^ *[0-9]+\/[0-9]+ Test +#[0-9]+: / && !/   Passed  / && !/\*\*\*Skipped/ { match($0, /#[0-9]+/); bad[substr($0, RSTART + 1, RLENGTH - 1)] = 1 }
         { line[NR] = $0 }
         END { for (i = 1; i <= NR; ++i) { split(line[i], w, ":"); if (w[1] in bad) print line[i] } }' "$log" | tail -n 100
    printf '(all of it: %s)\n' "$log"
}

release() { # every test but "long": what must not compile and the consumers by g++, instruction counts, pages in a browser
    build_preset $optimised all && run_ctest $optimised -LE long
}
long() { # what takes an hour, and a change hardly breaks; and the test executables as g++ compiles them
    build_preset $optimised all && run_ctest $optimised -L long && run_ctest $optimised -R '^unit\.'
}
sanitize() { # Clang, address and undefined-behaviour sanitizers: the test executables, and the fuzzer beside them
    build_preset sanitize unit_tests fuzz && run_ctest sanitize -R '^unit\.'
}
thread() { # Clang, thread sanitizer: diagnoses side by side, each on all cores
    build_preset thread test_threads && run_ctest thread -R '^unit\.threads$'
}
fuzz() { # libFuzzer on the file readers; the first byte of an input chooses the reader
    build_preset sanitize fuzz || return
    installed # a seed is written by a script
    set -- "$build"/sanitize/tests/fuzz_*
    [ -x "$1" ] || { left_out "fuzz: no fuzzers"; return; }
    for fuzzer; do
        name=${fuzzer##*/}
        found=$build/found/$name # grows from run to run; what earlier runs found begins it (tests/fuzz/grow.sh)
        mkdir -p "$found"
        [ ! -f "tests/fuzz/$name.tar.xz" ] || tar -C "$found" -xJf "tests/fuzz/$name.tar.xz"
        { printf '\000' && head -n 40 examples/data/log.csv; } >"$found/log"
        { printf '\001' && cat examples/data/machine.json; } >"$found/machine"
        { printf '\002' && cat tests/fuzz/diagnosis.json; } >"$found/diagnosis"
        { printf '\003' && cat examples/import/twincat_scope.map.json; } >"$found/map"
        { printf '\004' && sed 's/^Name\t.*/Name\tr\ty\tu/' examples/import/twincat_scope.csv | head -n 60; } >"$found/foreign"
        { printf '\005G1 F9 X5\nG4 P1\nG64 P1 G2 X9 Y1 R9\nX0 Y0 I-1\n' && grep ^N examples/path/circle.nc; } >"$found/gcode"
        { printf '\006' && head -n 14 examples/path/butterfly.cl && printf 'SPLINE/OFF\nCIRCLE/0,-50,0,0,0,1,50\nGOTO/0,0,0\n'; } >"$found/cl"
        { printf '\007' && cat examples/programs/quadrant_cnc/milling_table.json; } >"$found/cnc"
        { printf '\010t_s,angle_deg,radius_m,nominal_radius_m\n' &&
            awk 'BEGIN { for (k = 0; k < 130; ++k) printf "%.2f,%d,%.7f,.1\n", k / 100, 3 * k, .1 + 1e-6 * (k % 3) }'; } >"$found/radius"
        { printf '\011' && python3 tests/diagnosis/mat_file_test.py --write; } >"$found/mat"
        { printf '\012' && cat tests/diagnosis/tables/snappy.parquet; } >"$found/parquet"
        { printf '\012' && cat tests/diagnosis/tables/gzip.parquet; } >"$found/parquet_gzip"
        { printf '\013' && cat tests/diagnosis/tables/packed.h5; } >"$found/hdf5"
        { printf '\013' && cat tests/diagnosis/tables/level73.mat; } >"$found/mat73"
        one_each=
        for job in $(seq "$jobs"); do
            "$fuzzer" -max_total_time=$((fuzz_seconds / $# / jobs)) -timeout=10 -rss_limit_mb=2048 -print_final_stats=1 \
                -artifact_prefix="$found/" "$found" >"$logs/$name-$job.txt" 2>&1 &
            one_each="$one_each $!"
        done
        good=1
        for job in $one_each; do wait "$job" || good=0; done
        cat "$logs/$name"-*.txt >"$logs/$name.txt"
        if [ $good = 1 ]; then
            awk -v name="$name" '/number_of_executed_units/ { n += $2 } END { print name ": " n " inputs" }' "$logs/$name.txt"
            count 1 0 0
        else
            broken "$name" "$logs/$name.txt"
        fi
    done
}
tidy() { # clang-tidy over every header
    installed
    build_preset tidy quadrant_headers quadrant_tidy && count 1 0 0
}

sh examples/install.sh g++ cmake ninja-build ccache libboost-dev libeigen3-dev nlohmann-json3-dev libfmt-dev \
    libcli11-dev libssl-dev libjs-dygraphs doctest-dev libbenchmark-dev clang libclang-rt-14-dev pkg-config dpkg-dev python3 \
    libnlopt-dev libnlopt-cxx-dev libxsimd-dev python3-dev python3-pybind11 || exit 1
# What only the tests run is unpacked while the first build compiles; "installed" waits for it.
sh examples/install.sh clang-tidy valgrind chromium chromium-driver python3-selenium python3-jsonschema gnuplot-nox doxygen \
    poppler-utils strace python3-numpy python3-pandas python3-setuptools python3-wheel python3-venv python3-pytest python3-build &
packages=$!
[ "$tests" != all ] || installed # one apt-get at a time
[ "$tests" != all ] || sh examples/install.sh gcc-arm-none-eabi libnewlib-arm-none-eabi \
    libstdc++-arm-none-eabi-newlib qemu-system-arm linuxcnc-uspace linuxcnc-uspace-dev python3-pyqt5.qtwebengine xvfb ||
    echo "going on without: microcontroller.qemu and linuxcnc.machine will be skipped"
[ "$tests" != all ] || sh examples/install.sh libmujoco-dev || echo "going on without: unit.mujoco will be skipped"
[ "$tests" != all ] || sh examples/install.sh libopenmpi-dev openmpi-bin || echo "going on without: fleet.mpi will be skipped"
[ "$tests" != all ] || sh examples/install.sh emscripten node-acorn || echo "going on without: web.page.* will be skipped"
[ "$tests" != all ] || sh examples/install.sh clang-22 || echo "going on without: symbols.nonblocking will be skipped"
[ "$tests" != all ] || sh examples/install.sh iwyu || echo "going on without: headers.include_what_you_use will be skipped"

# Nothing in the cache yet: no source is preprocessed to look there for it, which takes a second each. Later that second
# saves compiling what only changed its comments.
[ "$(ccache --print-stats 2>/dev/null | awk '$1 == "files_in_cache" { print $2 }')" != 0 ] || export CCACHE_DEPEND=1

for phase; do
    case $phase in
    release | sanitize | thread | fuzz | tidy | long) ;;
    *) echo "no phase $phase"; exit 2 ;;
    esac
    began=$(date +%s) p=$passed f=$failed s=$skipped
    printf '\n== %s\n' "$phase"
    $phase
    printf -- '-- %s: %s passed, %s failed, %s skipped in %s s\n' "$phase" $((passed - p)) $((failed - f)) \
        $((skipped - s)) $(($(date +%s) - began))
done
installed
echo
echo "$passed passed, $failed failed, $skipped skipped"
[ $failed = 0 ]
