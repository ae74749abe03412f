#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: host.sh COMPILER WORK FLAGS...   all blocks without exceptions and run-time types, on the host: the same refusals
set -eu
compiler=$1 work=$2
shift 2
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$work"
"$compiler" "$@" -o "$work/throws" "$here/refusals.cpp"
"$compiler" "$@" -fno-exceptions -fno-rtti -o "$work/jumps" "$here/refusals.cpp"
"$work/throws" >"$work/throws.txt"
"$work/jumps" >"$work/jumps.txt"
cat "$work/jumps.txt"
cmp "$work/throws.txt" "$work/jumps.txt"
for said in 'nothing: nothing was made yet' 'and mended: made' 'a loop: made' \
    'a notch above half the sampling rate: notch.centre = 1200 Hz: must lie between 0 and half the sampling rate (1000 Hz)' \
    'field of a part: cogging_force.period = 0 m: must be finite and above 0' \
    'a loop with a bad box: proportional_integral.limit = -10 V: must be above 0 (infinite: no limit)'; do
    grep -qxF "$said" "$work/jumps.txt" || { echo "it does not say: $said"; exit 1; }
done
if "$work/jumps" direct >"$work/direct.txt" 2>&1; then
    echo "a constructor that refuses ends well without exceptions"
    exit 1
fi
grep -q '^notch.centre = 1200 Hz: ' "$work/direct.txt"
! grep -q 'is in use' "$work/direct.txt"
