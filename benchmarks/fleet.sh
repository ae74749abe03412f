#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# How a fleet scales on this computer: the table of docs/fleet.md. Wants quadrant-gap and, for the rows of MPI, quadrant-gap-mpi.
# usage: fleet.sh FOLDER-OF-PROGRAMS FOLDER-OF-LOGS     (build/release/examples, build/practice by tests/acceptance/practice_set.py)
set -eu
programs=$1 logs=$2
cores=$(nproc)
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
mpirun="mpirun --oversubscribe"
[ "$(id -u)" != 0 ] || mpirun="$mpirun --allow-run-as-root"
echo "$cores cores ($(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -n 1)), load before the run $(cut -d' ' -f1 /proc/loadavg)"
echo
echo '| | logs | wall [s] | CPU [s] | logs a minute | times one job |'
echo '|---|---|---|---|---|---|'
measure() { # NAME COMMAND...
    name=$1
    shift
    rm -rf "$out/results"
    bash -c 'TIMEFORMAT="%R %U %S"; time "$@" >/dev/null 2>&1' - "$@" "$logs" --out "$out/results" --quiet 2>"$out/time"
    n=$(find "$out/results" -name '*.done.json' | wc -l)
    first=${first:-$(cut -d' ' -f1 "$out/time")}
    awk -v name="$name" -v n="$n" -v first="$first" '{ printf "| %s | %d | %.1f | %.1f | %.1f | %.2f |\n", name, n, $1, $2 + $3, 60 * n / $1, first / $1 }' "$out/time"
}
jobs=1
while [ "$jobs" -le "$cores" ]; do
    measure "\`--jobs $jobs\`" "$programs/quadrant-gap" fleet --threads 1 --jobs "$jobs"
    jobs=$((2 * jobs))
done
if [ -x "$programs/quadrant-gap-mpi" ]; then
    jobs=2
    while [ "$jobs" -le "$cores" ]; do
        measure "\`mpirun -n $jobs\`" $mpirun -n "$jobs" "$programs/quadrant-gap-mpi"
        jobs=$((2 * jobs))
    done
fi
