#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The log that the repository ships, as a newcomer runs it: named right, the same bytes as gap.example wrote (whose page and
# JSON are looked at by gap.example.browser and docs.schemas), the same cause with --fast.
# usage: shipped.sh PROGRAM ROOT SCRATCH WRITTEN      WRITTEN: JSON and page of gap.example, without .json and .html
set -eu
program=$1 root=$2 scratch=$3 written=$4
mkdir -p "$scratch"
"$program" diagnose --machine "$root/examples/data/machine.json" --log "$root/examples/data/log.csv" \
    --holdout "$root/examples/data/holdout.csv" --json "$scratch/again.json" --report "$scratch/again.html" >"$scratch/again.txt"
cmp "$written.json" "$scratch/again.json"
cmp "$written.html" "$scratch/again.html"
head -n 3 "$scratch/again.txt"
grep -q '^Stribeck friction is missing from the simulation of axis x' "$scratch/again.txt"
# Fewer models tried, the same verdict and cause.
"$program" diagnose --fast --machine "$root/examples/data/machine.json" --log "$root/examples/data/log.csv" \
    --holdout "$root/examples/data/holdout.csv" >"$scratch/fast.txt"
[ "$(head -n 1 "$scratch/fast.txt")" = "$(head -n 1 "$scratch/again.txt")" ]
grep -q '^Stribeck friction is missing from the simulation of axis x' "$scratch/fast.txt"
