#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# quadrant-latency as it is used: what it writes and refuses. How long anything takes is not asked: other tests run meanwhile.
# usage: program.sh QUADRANT_LATENCY SCRATCH
set -eu
latency=$1 dir=$2
rm -rf "$dir"
mkdir -p "$dir"
cd "$dir"
fail() { echo "FAILED: $*"; cat said; exit 1; }
says() { grep -qE -- "$1" said || fail "does not say '$1'"; }

# ---- an answer, and the exit code that goes with it ----
code=0
"$latency" --seconds 1 --html page.html >said 2>err || code=$?
for row in 'cache warm' 'standing' 'reversing' 'cache cold' 'every period' 'the clock alone'; do
    says "^$row +[0-9]+ +[0-9.]+ +[0-9.]+ +[0-9.]+"
done
says '^real-time priority.*: (granted|not granted \(.*\); .+)$'
says '^pinned to core [0-9]+: (granted|not granted)'
says '^memory locked: (granted|not granted)'
case $code in
0) says '^Yes, it fits 500 us: .* the margin is [0-9.]+ us\.$' ;;
1) says '^The loop fits 500 us: .*% of the period\. This computer did not keep the period: .*% of the period\.|^No, it does not fit 500 us: .*% of the period' ;;
*) fail "exit code $code" ;;
esac
awk '/^(cache (warm|cold)|standing|reversing) / { i = /^cache/ ? 3 : 2; if (!($i > 0 && $(i + 1) <= $(i + 2) && $(i + 2) <= $(i + 3))) exit 1 }' said || fail "no order in a row"
grep -q "$(grep -oE '^(Yes, it|No, it|The loop)[^:]*' said | sed 's/ us/ µs/')" page.html || fail "the page says something else"
! grep -qE 'src=|<link|@import' page.html || fail "the page loads something"
if command -v gnuplot >/dev/null; then
    grep -q '<svg' page.html || fail "no picture"
else
    grep -q 'gnuplot is not installed' page.html || fail "does not say why there is no picture"
fi
echo "ok: $(tail -n 2 said | head -n 1)"

# ---- a period that is hard to keep: the word goes with the number ----
code=0
"$latency" --seconds 0.3 --period_us 1 --html short.html >said 2>err || code=$?
[ $code = 1 ] || fail "exit code $code, not 1: no timer keeps a period of 1 us"
says '^(No, it does not fit|The loop fits) 1\.00 us: .* computes for [0-9.]+ us \(median\), [0-9.]+ % of the period'
awk '/^(No, it|The loop fits)/ { match($0, /\(median\), [0-9.]+ %/); share = substr($0, RSTART + 10) + 0
         if (/^No/ ? share < 100 : share > 100) exit 1 }' said || fail "the word does not go with the number"

# ---- instructions, which do not depend on what else runs ----
if command -v valgrind >/dev/null; then
    "$latency" --bound >said 2>err || fail "exit code $? with --bound: $(cat err)"
    for kind in 'first sample' moving reversing 'held for a NaN' retune 'cycle fades' standing 'beyond the limit'; do says "^$kind"; done
    says '^The most of a sample: [0-9]+ typed, [0-9]+ typed in lanes'
    if [ -f "$(dirname "$latency")/quadrant-latency-cortex-m7.elf" ] && command -v qemu-system-arm >/dev/null; then
        says '^The most of a sample: .*, [0-9]+ on a Cortex-M7'
        # Another processor, the same loop: what costs more there costs more here, and an instruction does about as much.
        awk '/^moving/ { here = $3; there = $7 } /^cycle fades/ { fades = $8 } /^standing/ { rest = $11 } /^held/ { held = $9 }
            END { if (!(there > here / 2 && there < 3 * here && fades > there && rest <= 1.05 * there && held < there / 10)) exit 1 }' said ||
            fail "the counts of the Cortex-M7 are not what they have to be"
    else
        says '^Cortex-M7: SKIPPED: .*Debian package'
        echo "SKIPPED: the Cortex-M7 of --bound: $(grep '^Cortex-M7' said)"
    fi
    # Parked costs no more than moving; a sample in which the memory fades reads it twice.
    awk '/^moving/ { moving = $3; lanes = $5 } /^cycle fades/ { fades = $4; in_lanes = $6 } /^standing/ { at_rest = $7; rest_lanes = $9 }
        END { if (!(moving > 0 && at_rest <= 1.05 * moving && rest_lanes <= 1.05 * lanes && fades > moving && in_lanes > lanes)) exit 1 }' said ||
        fail "the counts are not what they have to be"
    said_before=$(cat said)
    "$latency" --bound >said 2>err
    [ "$said_before" = "$(cat said)" ] || fail "two counts differ"
    echo "ok: $(tail -n 1 said)"
else
    code=0
    "$latency" --bound >said 2>&1 || code=$?
    [ $code = 2 ] || fail "exit code $code without valgrind"
fi

# ---- what is refused: exit code 2, nothing written ----
refuses() { # WORDS OPTIONS
    words=$1
    shift
    code=0
    "$latency" "$@" >said 2>&1 || code=$?
    [ $code = 2 ] || fail "exit code $code, not 2, for $*"
    grep -qF -- "$words" said || fail "does not say '$words'"
    ! ls out.html* >/dev/null 2>&1 || fail "something was written for $*"
    echo "ok: $*: refused"
}
refuses '--period_us' --period_us 0 --html out.html
refuses '--period_us' --period_us nan --html out.html
refuses '--seconds' --seconds -1 --html out.html
refuses '--core' --core x --html out.html
refuses 'nowhere/out.html: cannot be written' --seconds 1 --html nowhere/out.html
