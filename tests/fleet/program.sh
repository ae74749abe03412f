#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# quadrant-gap fleet on five logs of which two are broken: each other one has what diagnose writes, byte for byte; killed, it
# goes on where it was; what fails stops nobody.   usage: program.sh PROGRAM ROOT SCRATCH
set -eu
program=$1 root=$2 scratch=$3
. "$(dirname "$0")/common.sh"
fleet() { # EXIT-CODE ARGUMENTS...
    expected=$1 code=0
    shift
    "$program" fleet "$@" >said.txt 2>&1 || code=$?
    [ $code = "$expected" ] || fail "exit code $code of $*: $(cat said.txt)"
}

# Two broken logs stop nobody, and say why.
fleet 2 logs --out results
same results
says '5 logs: 0 done before, 0 failed before, 5 to do'
says '2 of 5 logs have no diagnosis'
says 'line/broken: logs/line/broken.log.csv:77:'
says 'alone: logs/alone/log.csv: no machine file'
grep -q 'broken.log.csv:77:' results/line/broken.error.json
[ ! -e results/line/broken.html ] || fail "a log that failed has a page"

# Nothing is done twice; what was damaged or changed is, and what is mended.
fleet 2 logs --out results
says '5 logs: 3 done before, 2 failed before (--retry does them again), 0 to do'
echo >>results/line/1.html
cp logs/press.log.csv logs/line/broken.log.csv
fleet 0 logs --out results --list
says 'line/1: not done'
says 'line/broken: not done'
says 'alone: failed: '
grep -q 'press: ' said.txt && grep 'press: ' said.txt | grep -q explained || fail "the verdict of press is not listed"

killed_and_resumed 2 one "$program" fleet --jobs 2

# A crash and one that never ends: two failures, and the rest is done.
mkdir ill
cp many/machine.json many/01.log.csv ill/
echo >ill/crash.log.csv
echo >ill/hang.log.csv
fleet 2 ill --program "$scratch/stub.sh" --limit 2 --jobs 3
says 'crash: died of signal 11'
says 'hang: no answer within 2 s'
[ -s ill/diagnosed/01.done.json ] || fail "the good one was not done"
: >ran.txt
fleet 2 ill --program "$scratch/stub.sh" --limit 2 --jobs 3 --retry
[ "$(ran)" = 2 ] || fail "--retry ran $(ran) of 2"

# A list instead of a search; what is refused before any work.
mkdir list
printf 'name,log,machine\nfirst,../many/01.log.csv,../many/machine.json\nsub/second,../many/02.log.csv,../many/machine.json\n' >list/fleet.csv
fleet 0 list --program "$scratch/stub.sh" --quiet
[ ! -s said.txt ] || fail "--quiet says $(cat said.txt)"
[ -s list/diagnosed/sub/second.html ] || fail "the second of the list has no page"
printf 'log,machine\n../many/01.log.csv,../many/machine.json\n' >list/fleet.csv
fleet 2 list
says 'list/fleet.csv:2:1: needs a name'
mkdir none
fleet 2 none
says 'none: no log'
fleet 2 nowhere
says 'nowhere: no such folder'
fleet 2 many --program "$scratch/nothing"
says 'nothing: no such program'
mkdir -p twice/a && echo >twice/a/log.csv && echo >twice/a.log.csv
fleet 2 twice
says 'results of the same name'
touch stuck
"$program" fleet many --program "$scratch/stub.sh" --out busy --jobs 1 >/dev/null 2>&1 &
at_work() { [ -n "$(ls -d "$1"/.working-* 2>/dev/null)" ]; }
in_ten_seconds "it does not begin" at_work busy
fleet 2 many --program "$scratch/stub.sh" --out busy
says 'busy: another fleet is at work in this folder'
kill -KILL $!
echo 'ok: what is refused'
