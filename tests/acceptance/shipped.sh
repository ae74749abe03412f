#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The log that the repository ships, as a newcomer runs it: named right, the same bytes twice, a diagnosis that its schema
# accepts, a report that a browser shows.   usage: shipped.sh PROGRAM ROOT SCRATCH SHARED
set -eu
program=$1 root=$2 scratch=$3 shared=$4
mkdir -p "$scratch"
for run in 1 2; do
    "$program" diagnose --machine "$root/examples/data/machine.json" --log "$root/examples/data/log.csv" \
        --holdout "$root/examples/data/holdout.csv" --json "$scratch/$run.json" --report "$scratch/$run.html" \
        >"$scratch/$run.txt"
done
cmp "$scratch/1.json" "$scratch/2.json"
cmp "$scratch/1.html" "$scratch/2.html"
cmp "$scratch/1.txt" "$scratch/2.txt"
head -n 3 "$scratch/1.txt"
grep -q '^Stribeck friction is missing from the simulation of axis x' "$scratch/1.txt"
# Fewer models tried, the same verdict and cause.
"$program" diagnose --fast --machine "$root/examples/data/machine.json" --log "$root/examples/data/log.csv" \
    --holdout "$root/examples/data/holdout.csv" >"$scratch/fast.txt"
[ "$(head -n 1 "$scratch/fast.txt")" = "$(head -n 1 "$scratch/1.txt")" ]
grep -q '^Stribeck friction is missing from the simulation of axis x' "$scratch/fast.txt"
/usr/bin/python3 "$root/tests/diagnosis/schema_test.py" --practice "$shared/gap/practice" "$scratch/1.json"
sh "$root/tests/report/browser.sh" "$scratch/1.html" --expect-verdict explained --expect-cause stribeck_friction \
    --shots "$scratch"
