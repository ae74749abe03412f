#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: valgrind.sh PROGRAM ROOT FOLDER    quadrant-gap diagnoses a short log under valgrind: no wrong access, no value that was
#                                           never set, nothing at the start of the program that valgrind cannot run. Exit code 77: no valgrind
set -eu
command -v valgrind >/dev/null || { echo "SKIPPED: no valgrind"; exit 77; }
program=$1 data=$2/examples/data out=$3
mkdir -p "$out"
head -n 2500 "$data/log.csv" >"$out/log.csv"
valgrind -q --error-exitcode=9 "$program" diagnose --quiet --machine "$data/machine.json" --log "$out/log.csv" --json "$out/diagnosis.json" \
    2>"$out/valgrind.txt" || { cat "$out/valgrind.txt"; echo "FAILED: quadrant-gap under valgrind"; exit 1; }
grep -q '"verdict"' "$out/diagnosis.json" || { echo "FAILED: no verdict"; exit 1; }
