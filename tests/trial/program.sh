#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# quadrant-gap trial on two machines: the seal holds, the diagnosed folders hold no truth, the same seed says the same.
# usage: program.sh PROGRAM FOLDER
set -e
program=$1
out=$2
rm -rf "$out"
mkdir -p "$out"
fail() { echo "$1"; exit 1; }
population="--machines 20 --seed 2 --only 6,16"

"$program" trial $population --no-forecast --json "$out/a.json" --report "$out/a.html" --keep "$out/kept" > "$out/a.txt"
sealed=$(sed -n '1s/.*SHA-256 //p' "$out/a.txt")
[ "$(sha256sum < "$out/kept/truth.json" | cut -d' ' -f1)" = "$sealed" ] || fail "the truth is not what was sealed"
grep -q "$sealed" "$out/a.json" "$out/a.html" || fail "the seal is not in the result"
[ "$(ls -d "$out"/kept/*/ | wc -l)" = 2 ] || fail "two machines were asked for"
for folder in "$out"/kept/*/; do
    for file in machine.json log.csv holdout.csv diagnosis.json; do
        [ -s "$folder$file" ] || fail "$folder$file is missing"
    done
    grep -q -e '"effects"' -e 'cloud' "$folder/machine.json" && fail "$folder/machine.json tells the truth"
done
grep -q "Right answers" "$out/a.txt" || fail "no summary"
grep -q "</html>" "$out/a.html" || fail "no page"

"$program" trial $population --no-forecast --quiet --jobs 1 --json "$out/b.json"
cmp "$out/a.json" "$out/b.json" || fail "the same seed said something else"

schema=$(dirname "$0")/schema_test.py
if /usr/bin/python3 -c 'import jsonschema' 2>/dev/null; then
    /usr/bin/python3 "$schema" "$out/a.json"
else
    echo "SKIPPED: no python3-jsonschema"
fi

"$program" trial --machines 4 --only 4 2> "$out/refused.txt" && fail "machine 4 of 4 was accepted"
grep -q -e "--only" "$out/refused.txt" || fail "no word about --only"
for option in --json --report; do # said before the work, not after it
    code=0
    "$program" trial --machines 4 $option "$out/missing/a" > "$out/refused.txt" 2>&1 || code=$?
    [ $code = 2 ] || fail "$option into a folder that is not there ends with $code"
    [ "$(cat "$out/refused.txt")" = "quadrant-gap: $out/missing/a: cannot be written: no such folder" ] ||
        fail "$option into a folder that is not there says $(cat "$out/refused.txt")"
done
code=0
"$program" trial --machines 4 --keep "$out/a.json" > "$out/refused.txt" 2>&1 || code=$?
[ $code = 2 ] || fail "--keep in the place of a file ends with $code"
code=0
TMPDIR=$out/missing "$program" trial --machines 4 --only 0 --quiet 2> "$out/refused.txt" || code=$?
[ $code = 2 ] || fail "without a folder for temporary files it ends with $code"
echo "two machines, sealed and repeated"
