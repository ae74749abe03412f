#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# program.sh QUADRANT_REPRODUCE DIR: what it lists, what it chooses, what it refuses, and a machine without gnuplot.
set -u
program=$1 dir=$2
rm -rf "$dir"
mkdir -p "$dir"
cd "$dir" || exit 1
failed=0
fail() {
    printf 'FAILED: %s\n' "$*"
    failed=1
}
refused() { # WORDS ARGUMENTS...: exit code 2, and says WORDS
    words=$1
    shift
    "$program" "$@" >out 2>err
    code=$?
    [ $code = 2 ] || fail "$* ends with $code"
    grep -qF -- "$words" err out || fail "$* does not say '$words': $(cat err out)"
}

refused 'no experiment is called "thesis.loop.z"; the nearest is thesis.loop.' --id thesis.loop.z
refused 'the nearest is thesis.friction.x.gms' --id thesis.friction.x.gsm --json never.json
refused 'no experiment is called ""' --id ''
refused 'no experiment is called' --id thesis.loop.x --id nonsense
refused --no-such-option --no-such-option
refused 'cannot be written: no such folder' --id thesis.repetitive --json missing/rows.json
[ ! -e never.json ] || fail "a file was written in spite of a bad id"

"$program" --list >list || fail "--list ends with $?"
for id in thesis.loop.x thesis.loop_modes.y thesis.circle.dob_gms thesis.cutting.iii thesis.repetitive; do
    grep -q "^$id " list || fail "--list lacks $id"
done
chosen() { # ID OTHER-OPTIONS: how many are listed
    "$program" --list "$@" | wc -l
}
[ "$(chosen --id thesis.loop)" = 2 ] || fail "--id thesis.loop names $(chosen --id thesis.loop)"
[ "$(chosen --id thesis.circle.dob)" = 1 ] || fail "an id that begins others is not taken alone"
[ "$(chosen --id 'thesis.friction*.y.*')" = 6 ] || fail "a glob names $(chosen --id 'thesis.friction*.y.*')"
[ "$(chosen --id thesis.loop.x --id thesis.repetitive --id thesis.loop.x)" = 2 ] || fail "--id is not repeatable"

"$program" --id thesis.loop.x --id thesis.repetitive --json rows.json >out 2>err || fail "--json ends with $?"
[ ! -e quadrant_reproduction.html ] || fail "a page was written though only rows were asked for"
[ "$(grep -c '"quantity"' rows.json)" = 19 ] || fail "rows.json has $(grep -c '"quantity"' rows.json) rows"
"$program" --quiet --id thesis.repetitive --json quiet.json >out 2>err || fail "--quiet ends with $?"
[ ! -s out ] && [ ! -s err ] || fail "--quiet says $(cat out err)"

PATH=/nonexistent "$program" --id thesis.loop.x >out 2>err || fail "without gnuplot it ends with $?"
for said in err quadrant_reproduction.html; do
    grep -q 'gnuplot-nox' $said || fail "without gnuplot $said does not name the package"
done
grep -q 'data-quantity="position_gain_margin"' quadrant_reproduction.html || fail "without gnuplot the page has no tables"
grep -q '<svg' quadrant_reproduction.html && fail "without gnuplot the page has pictures"
exit $failed
