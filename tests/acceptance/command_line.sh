#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The command line helps: the nearest name for a mistyped word, numbers that are none refused, errors that say what to
# do next, progress in lines where there is no terminal.
# usage: command_line.sh QUADRANT-GAP ROOT SCRATCH QUADRANT-LATENCY QUADRANT-CNC
set -eu
program=$1 root=$2 scratch=$3 latency=$4 cnc=$5
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
data=$root/examples/data

fail() { echo "FAILED: $*"; exit 1; }
says() { # WORDS PROGRAM ARGUMENTS...: exit code 2 and these words
    words=$1 code=0
    shift
    "$@" </dev/null >said.txt 2>&1 || code=$?
    [ "$code" = 2 ] || fail "exit code $code, not 2: $*: $(cat said.txt)"
    grep -qF -- "$words" said.txt || fail "does not say '$words': $(cat said.txt)"
    echo "ok: $words"
}
says 'there is no diagnos; did you mean diagnose?' "$program" diagnos --log l.csv
says '--hold-out; did you mean --holdout?' "$program" diagnose --log l.csv --hold-out h.csv
! grep -q 'is required' said.txt || fail "asks for what has another name: $(cat said.txt)"
says '--jsn; did you mean --json?' "$program" simulate --jsn=x.json
says '--period; did you mean --period_us?' "$latency" --period 125
[ ! -x "$cnc" ] || says '--report_; did you mean --report?' "$cnc" run --report_ x.html
says '--threads: ' "$program" diagnose --machine m.json --log l.csv --threads -3
says '--threads: ' "$program" fleet . --threads -3
says '--seed: ' "$program" trial --seed -1
says '--only: ' "$program" trial --only -1
says '--limit: ' "$program" trial --limit -1
for word in -3 1x nan; do says '--jobs: ' "$program" trial --jobs "$word"; done

sed 's/"mass_kg"/"mas_kg"/' "$data/machine.json" >m.json
says 'unknown key; did you mean mass_kg?' "$program" simulate --machine m.json --log "$data/log.csv"
tr , ';' <"$data/log.csv" | head -n 2000 >semicolons.csv
says 'bring the file in with quadrant-gap import' "$program" simulate --machine "$data/machine.json" --log semicolons.csv
head -n 2000 "$data/log.csv" | python3 -c 'import sys; sys.stdout.buffer.write(sys.stdin.read().encode("utf-16-le"))' >utf16.csv
says 'it is UTF-16 without a byte order mark' "$program" simulate --machine "$data/machine.json" --log utf16.csv

"$program" import --quiet "$root/tests/diagnosis/tables/snappy.parquet" slow.csv
says 'slow.csv: does not show what its machine is (axis x: --mass is missing' "$program" compare slow.csv "$data/log.csv"
says 'give a machine file, which quadrant-gap init begins' "$program" compare slow.csv "$data/log.csv"

# Progress without a terminal: lines in per cent with the time that is left.
"$program" trial --machines 3 --jobs 1 --no-forecast >trial.txt 2>progress.txt
! grep -q "$(printf '\033')" progress.txt || fail 'escape codes without a terminal'
[ ! -s progress.txt ] || grep -qE '^ *[0-9]+ %' progress.txt || fail "no per cent: $(cat progress.txt)"
echo 'ok: progress'
