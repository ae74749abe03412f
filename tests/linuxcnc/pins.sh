#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# Called by pins.hal. Exit code of halrun is not ours: the last line says how many claims failed.
a=quadrant-axis.0 failed=0
get() { halcmd getp "$1"; }
claim() { # WHAT PIN VALUE      within three seconds
    for i in $(seq 60); do
        [ "$(get "$2")" != "$3" ] || { echo "ok: $1" && return; }
        sleep 0.05
    done
    echo "FAILED: $1: $2 is $(get "$2")" && failed=$((failed + 1))
}
same() { # WHAT A B
    if [ "$2" = "$3" ]; then echo "ok: $1"; else echo "FAILED: $1: $2, $3" && failed=$((failed + 1)); fi
}
below() { # WHAT PIN LIMIT      for half a second
    worst=$(for i in $(seq 20); do get "$2" && sleep 0.02; done | sed 's/^-//' | sort -g | tail -1)
    if awk "BEGIN {exit !($worst < $3)}"; then echo "ok: $1: $worst"; else
        echo "FAILED: $1: $2 was $worst" && failed=$((failed + 1))
    fi
}

claim "a block is built once the thread runs" $a.fault FALSE
halcmd setp $a.enable TRUE
sleep 1
below "the axis follows to 50 um" $a.wire.position-error 50e-6

for change in "position-gain 120" "velocity-gain 45" "observer-on 1" "memory-weight 1" "memory-cycle 0.5" "notch-centre 250"; do
    halcmd setp $a.${change% *} ${change#* }
    sleep 0.1
    claim "$change: in use" $a.pending FALSE
    same "$change: not refused" "$(get $a.refused)" FALSE
    same "$change: no fault" "$(get $a.fault)" FALSE
done
below "the axis follows to 50 um" $a.wire.position-error 50e-6

for bad in nan inf -1; do
    halcmd setp $a.velocity-integral $bad
    [ $bad != -1 ] || halcmd setp $a.notch-centre 600
    claim "parameter $bad: refused" $a.refused TRUE
    same "parameter $bad: no fault" "$(get $a.fault)" FALSE
done
below "the axis follows to 50 um" $a.wire.position-error 50e-6
halcmd setp $a.velocity-integral 450
halcmd setp $a.notch-centre 330
claim "right again" $a.refused FALSE

halcmd unlinkp $a.command
for bad in nan inf 1e30; do
    halcmd setp $a.command $bad
    claim "command $bad: fault" $a.fault TRUE
    held=$(get $a.output)
    sleep 0.1
    same "command $bad: the output is held" "$(get $a.output)" "$held"
    halcmd setp $a.enable FALSE
    claim "disabled: no fault" $a.fault FALSE
    same "disabled: 0 V" "$(get $a.output)" 0
    halcmd setp $a.command "$(get $a.feedback)"
    halcmd setp $a.enable TRUE
    sleep 0.1
    same "enabled where it stands: no fault" "$(get $a.fault)" FALSE
done

halcmd delf $a slow
halcmd addf $a fast
sleep 0.5
claim "another period: a new block" $a.fault FALSE
halcmd delf $a fast
echo "failed: $failed"
