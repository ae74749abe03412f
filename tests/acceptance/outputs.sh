#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Outputs never destroy: what every program does with the paths that it writes to.
# usage: outputs.sh QUADRANT-GAP ROOT SCRATCH QUADRANT-LATENCY QUADRANT-CNC
set -eu
program=$1 root=$2 scratch=$3 latency=$4 cnc=$5
rm -rf "$scratch"
mkdir -p "$scratch/tmp"
cd "$scratch"
data=$root/examples/data
raw=$root/examples/import/halsampler.txt map=$root/examples/import/halsampler.map.json

fail() { echo "FAILED: $*"; exit 1; }
refuses() { # WORDS ARGUMENTS...
    words=$1 code=0
    shift
    "$program" "$@" </dev/null >said.txt 2>&1 || code=$?
    [ "$code" = 2 ] || fail "exit code $code, not 2: $*: $(cat said.txt)"
    grep -qF -- "$words" said.txt || fail "does not say '$words': $(cat said.txt)"
    echo "ok: $(head -n 1 said.txt)"
}
import_to() { "$program" import --quiet --map "$map" "$raw" "$1"; }
no_leftovers() {
    find . -name '*.tmp-*' -o -name '*.part' | grep . && fail "$1 leaves files behind"
    return 0
}

import_to plain.csv
cp plain.csv kept.csv

# A link stays, and its target gets the file; also where there is none yet.
ln -s plain.csv link.csv
ln -s "$PWD/later.csv" ahead.csv
echo old >plain.csv
import_to link.csv
import_to ahead.csv
[ -L link.csv ] && [ -L ahead.csv ] || fail 'a link was replaced'
cmp plain.csv kept.csv && cmp later.csv kept.csv
# A FIFO and a device are written to.
mkfifo pipe.csv
cat pipe.csv >heard.csv &
import_to pipe.csv
wait $!
[ -p pipe.csv ] || fail 'a FIFO was replaced'
cmp heard.csv kept.csv
import_to /dev/null
[ -c /dev/null ] || fail 'a device was replaced'
# Permissions stay.
chmod 640 plain.csv
import_to plain.csv
[ "$(stat -c %a plain.csv)" = 640 ] || fail 'permissions were changed'
echo 'ok: links, FIFO, device'

# An output that is an input, by any of its names, is refused, and the input stays as it was.
cp "$raw" raw.txt
cp "$data/machine.json" m.json
head -n 7000 "$data/log.csv" >log.csv # enough to be diagnosed, many times
cp log.csv l.csv
ln -s m.json other_name.json
refuses 'would destroy what input 1 reads' import --map "$map" raw.txt raw.txt
cp "$map" map.json
refuses 'would destroy what --map reads' import --map map.json raw.txt ./map.json
refuses 'would destroy what --machine reads' diagnose --machine m.json --log l.csv --json m.json
refuses 'would destroy what --machine reads' simulate --machine m.json --log l.csv --json other_name.json
refuses 'would destroy what --log reads' simulate --machine m.json --log l.csv --report ./l.csv
refuses 'would destroy what --diagnosis reads' apply --machine m.json --diagnosis l.csv --out l.csv
refuses 'would destroy what --log reads' init --log l.csv --out l.csv
refuses 'would destroy what --motion reads' forecast --machine m.json --diagnosis d.json --motion l.csv --json l.csv
refuses 'would destroy what --log reads' compensate --machine m.json --diagnosis d.json --log l.csv --controller l.csv
refuses 'would destroy what --log reads' circle --log l.csv --json l.csv
cmp raw.txt "$raw" && cmp m.json "$data/machine.json" && cmp l.csv log.csv && cmp map.json "$map"
# Two outputs on one path are refused.
refuses 'cannot both be written to it' simulate --machine m.json --log l.csv --json same --report ./same
refuses 'cannot both be written to it' simulate --machine m.json --log l.csv --json - --report -
refuses 'cannot both be written to it' init --log l.csv --out begun.md --mass 1 --force-constant 1
[ ! -e same ] && [ ! -e begun.md ]

# "-" is standard output; words then go to standard error.
"$program" import --map "$map" "$raw" - >from_output.csv 2>words.txt
cmp from_output.csv kept.csv
grep -q 'rows, sample period' words.txt
"$program" simulate --machine m.json --log l.csv --json - 2>/dev/null | python3 -m json.tool >/dev/null
# A failed write of standard output is the exit code 1, with one line: of every subcommand, with much and with little to
# write, files and words.
"$program" diagnose --quiet --fast --machine m.json --log l.csv --json d.json
unwritten() { # PROGRAM ARGUMENTS...
    code=0
    "$@" >/dev/full 2>said.txt || code=$?
    shift
    [ $code = 1 ] || fail "$*: exit code $code, not 1, though standard output is full: $(cat said.txt)"
    [ "$(grep -c 'standard output cannot be written$' said.txt)" = 1 ] ||
        fail "$*: does not say once that standard output failed: $(cat said.txt)"
}
unwritten "$program" --help
unwritten "$program" --version
unwritten "$program" diagnose --help
unwritten "$program" import --map "$map" "$raw" -
for words in "" "--json -" "--report -"; do unwritten "$program" simulate --machine m.json --log l.csv $words; done
slow="--json=-" # what takes seconds writes words and a page with QUADRANT_TESTS=all, too
[ "${QUADRANT_TESTS-}" != all ] || slow="words --json=- --report=-"
for way in $slow; do
    unwritten "$program" diagnose --fast --machine m.json --log l.csv ${way#words}
    unwritten "$program" compare l.csv log.csv --machine m.json ${way#words}
done
unwritten "$program" trial --machines 1 --no-forecast
[ "$slow" = "--json=-" ] || unwritten "$program" trial --machines 1 --no-forecast --json -
for words in "" "--json -"; do
    unwritten "$program" forecast --machine m.json --diagnosis d.json --motion l.csv $words
    unwritten "$program" compensate --machine m.json --diagnosis d.json --log l.csv $words
done
unwritten "$program" compensate --machine m.json --diagnosis d.json --log l.csv --controller -
unwritten "$program" apply --machine m.json --diagnosis d.json --out -
unwritten "$program" apply --machine m.json --diagnosis d.json --out applied.json
for what in mjcf linuxcnc drive compensation; do unwritten "$program" export --machine m.json --$what -; done
unwritten "$program" init --log l.csv --unchecked --out - --mass 1 --force-constant 1
unwritten "$program" init --log l.csv --unchecked --out begun.json --mass 1 --force-constant 1
printf 'G21 G90 F3000\nG1 X30\nG64 P0.01\nG3 X30 Y0 I-30 J0\nG3 X30 Y0 I-30 J0\nM30\n' >circle.nc
"$cnc" run -q --cnc "$root/examples/programs/quadrant_cnc/mill.json" --path circle.nc --log circle.csv
for words in "" "--json -" "--report -"; do unwritten "$program" circle --log circle.csv $words; done
unwritten "$program" import --propose "$root/examples/import/odrive.csv" -
mkdir -p full/a
cp m.json full/machine.json
cp l.csv full/a/log.csv
unwritten "$program" fleet --jobs 1 --out full_out full
for words in "" "--json" "--report -"; do
    unwritten "$cnc" run --cnc "$root/examples/programs/quadrant_cnc/mill.json" --path "$root/examples/path/diamond.nc" $words
    unwritten "$cnc" analyse --cnc "$root/examples/programs/quadrant_cnc/mill.json" $words
done
unwritten "$cnc" run --cnc "$root/examples/programs/quadrant_cnc/mill.json" --path "$root/examples/path/diamond.nc" --log -
# What goes to files is written all the same.
unwritten "$program" simulate --machine m.json --log l.csv --json - --report written.html
grep -q '</html>' written.html
echo 'ok: standard output'

# A folder that may not be written to, a folder in the place of a file: refused, nothing left.
mkdir folder.csv
code=0
import_to folder.csv 2>said.txt || code=$?
[ $code = 2 ] && grep -q 'is a directory' said.txt || fail "a folder as output: $(cat said.txt)"
code=0
import_to missing/x.csv 2>said.txt || code=$?
[ $code = 2 ] && grep -q 'no such folder' said.txt || fail "a missing folder: $(cat said.txt)"

# Temporary names are unique: a file that has the name that an older version used stays.
echo mine >page.html.part
"$latency" --seconds 0.2 --html page.html >/dev/null 2>&1 || [ $? = 1 ]
[ "$(cat page.html.part)" = mine ] || fail "quadrant-latency wrote over somebody's file"
rm page.html.part
grep -q '</html>' page.html
# On the disk before it has its name.
if command -v strace >/dev/null && strace -o trace.txt -e trace=fsync,fdatasync,rename "$program" import --quiet --map "$map" "$raw" s.csv 2>/dev/null; then
    grep -oE '^(fsync|rename)' trace.txt | tr '\n' ' ' | grep -q 'fsync rename' || fail "no fsync before rename: $(cat trace.txt)"
    echo 'ok: fsync before rename'
else
    echo 'SKIPPED: fsync before rename (no strace that works here)'
fi

# A FIFO that is called log.csv does not hang a fleet.
mkdir -p fleet/a
cp m.json fleet/machine.json
mkfifo fleet/a/log.csv
code=0
timeout 60 "$program" fleet --jobs 1 --out fleet_out fleet >said.txt 2>&1 || code=$?
[ $code = 2 ] || fail "a fleet with a FIFO: exit code $code: $(cat said.txt)"
grep -q 'is no regular file' said.txt || fail "a fleet with a FIFO: $(cat said.txt)"
echo 'ok: a FIFO in a fleet'

# Interrupted programs leave nothing behind.
interrupt() { # SIGNAL SECONDS PROGRAM ARGUMENTS...: with a temporary folder of its own
    signal=$1 seconds=$2
    shift 2
    TMPDIR=$PWD/tmp "$@" >said.txt 2>&1 &
    id=$!
    sleep "$seconds"
    kill -"$signal" $id
    code=0
    wait $id || code=$?
    [ $code -gt 128 ] || fail "$* was not interrupted (exit code $code): $(cat said.txt)"
}
interrupt TERM 2 "$program" trial --machines 20 --jobs 1 --quiet
[ -z "$(ls tmp)" ] || fail "an interrupted trial leaves $(ls tmp)"
for k in $(seq 20); do
    mkdir -p "many/$k"
    cp l.csv "many/$k/log.csv"
done
cp m.json many/machine.json
interrupt HUP 1.5 "$program" fleet --jobs 1 --out many_out many
[ -z "$(find many_out -name '.working-*')" ] || fail "an interrupted fleet leaves $(find many_out -name '.working-*')"
if [ -x "$cnc" ]; then
    awk 'BEGIN { print "G21 G17 G90 G61 F300"; for (k = 0; k < 4000; ++k) print "G1 X" (k % 2 ? 20 : 0) " Y" (k % 3) }' >long.nc
    interrupt TERM 1 "$cnc" run --quiet --cnc "$root/examples/programs/quadrant_cnc/mill.json" --path long.nc --log cnc.csv
    [ ! -e cnc.csv ] || fail 'an interrupted run leaves a log'
fi
no_leftovers 'an interrupted program'
echo "ok: interrupted"
