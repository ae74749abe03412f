#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The program with files that are wrong: one line that says where, exit code 2, nothing half-written.
# usage: bad_input.sh PROGRAM ROOT SCRATCH
set -eu
program=$1 root=$2 scratch=$3
rm -rf "$scratch"
mkdir -p "$scratch"
cd "$scratch"
cp "$root/examples/data/machine.json" "$root/examples/data/log.csv" .

refuses() { # WORDS MACHINE LOG
    code=0
    "$program" diagnose --machine "$2" --log "$3" --json out.json --report out.html >said.txt 2>&1 || code=$?
    [ "$code" = 2 ] || { echo "exit code $code, not 2: $(cat said.txt)"; exit 1; }
    [ "$(wc -l <said.txt)" = 1 ] || { echo "more than one line: $(cat said.txt)"; exit 1; }
    grep -qF -- "$1" said.txt || { echo "does not say '$1': $(cat said.txt)"; exit 1; }
    ! ls out.* >/dev/null 2>&1 || { echo "something was written for: $1"; exit 1; }
    echo "ok: $(cat said.txt)"
}
machine() { sed "$1" machine.json >m.json; }
log() { sed "$1" log.csv >l.csv; }

refuses 'nothing.json: no such file' nothing.json log.csv
refuses 'nothing.csv: no such file' machine.json nothing.csv
machine 's/"mass_kg": [0-9.]*/"mass_kg": "heavy"/'
refuses 'm.json: axes.x.plant.mass_kg: ' m.json log.csv
machine 's/mass_kg/mass_g/'
refuses 'axes.x.plant.mass_g: unknown key; did you mean mass_kg?' m.json log.csv
machine 's/"axes"/"excluded_effects": ["gremlins"], "axes"/'
refuses 'gremlins' m.json log.csv
machine 's/"sample_period_s": 0.0005/"sample_period_s": 0.001/'
refuses 'the sample period is 0.0005 s' m.json log.csv
machine 's/"x"/"z"/'
refuses 'axis x is not described' m.json log.csv
machine '$d'
refuses 'm.json:' m.json log.csv
log '500s/,[^,]*,/,nan,/'
refuses 'l.csv:500:' machine.json l.csv
log '500s/^[0-9.]*/0.001/'
refuses 'l.csv:500:1:' machine.json l.csv
log '500s/$/,7/'
refuses 'l.csv:500:' machine.json l.csv
log '1s/x_cmd_V/x_volt/'
refuses 'x_cmd_V' machine.json l.csv
head -n 2 log.csv >l.csv
refuses 'holds one sample only' machine.json l.csv
sed -n '1p;2000,2039p' log.csv >l.csv
refuses 'some to start the observer and a block to score' machine.json l.csv
awk -F, 'NR == 1 { print; next } { print $1 ",0,0,0" }' log.csv >l.csv
refuses 'axis x does not move' machine.json l.csv
"$program" diagnose --machine machine.json --log log.csv --json no/such/folder.json >said.txt 2>&1 && exit 1
grep -q 'cannot be written' said.txt
echo "ok: $(cat said.txt)"

# A controller kind that is not known is no error: the axis is diagnosed from the command onwards, with a note.
machine 's/cascade_p_pi/gain_scheduled/'
"$program" diagnose --machine m.json --log log.csv >said.txt
grep -q 'controller kind "gain_scheduled" is not known' said.txt
echo 'ok: unknown controller kind noted'
