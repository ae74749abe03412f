#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# usage: run.sh QUADRANT_GAP FOLDER [table|pid|xy|panel]  (as root; QUADRANT_TESTS=all; else, or without LinuxCNC, says so: 77)
# The components in LinuxCNC itself, without a screen. HAL alone: bad pins, changes while it runs, another period. Then
# the machine of examples/linuxcnc/machine under LinuxCNC's planner, recorded, imported and diagnosed.
# With `table`: the comparison of docs/linuxcnc.md instead. With `pid`, `xy` or `panel`: only what is done with the stock
# pid, by quadrant_xy, or by the panel.
set -eu
skip() { echo "SKIPPED: LinuxCNC: $*"; exit 77; }
[ "${QUADRANT_TESTS-}" = all ] || skip "only with QUADRANT_TESTS=all"
[ "$(id -u)" = 0 ] || skip "run as root: the components go to its modules, and it is run as a user of its own"
for tool in linuxcnc halrun halcmd halsampler; do
    command -v $tool >/dev/null || skip "no $tool: apt-get install linuxcnc-uspace linuxcnc-uspace-dev"
done
[ -e /usr/include/linuxcnc/hal.h ] || skip "no hal.h: apt-get install linuxcnc-uspace-dev"
/usr/bin/python3 -c 'import linuxcnc' || skip "/usr/bin/python3 has no module linuxcnc: apt-get install linuxcnc-uspace"
for tool in script su useradd; do command -v $tool >/dev/null || skip "no $tool (bsdutils, passwd)"; done
if pgrep -x rtapi_app >/dev/null; then skip "another one is running on this machine (rtapi_app)"; fi

gap=$(realpath "$1")
out=$2
here=$(cd "$(dirname "$0")" && pwd)
example=$(realpath "$here/../../examples/linuxcnc")
modules=/usr/lib/linuxcnc/modules
user=quadrant-hal
rm -rf "$out"
mkdir -p "$out/kept"
out=$(realpath "$out")
work=$(mktemp -d) # where the user may go: a build folder may be root's alone
made_user=no
clean() {
    if [ $made_user = yes ]; then userdel -r $user 2>/dev/null || true; fi
    for name in quadrant_axis quadrant_xy quadrant_plant; do
        rm -f $modules/$name.so
        [ ! -e "$out/kept/$name.so" ] || mv "$out/kept/$name.so" $modules/
    done
    cp -r "$work/." "$out/"
    rm -rf "$work"
}
trap clean EXIT
for name in quadrant_axis quadrant_xy quadrant_plant; do
    [ ! -e $modules/$name.so ] || mv $modules/$name.so "$out/kept/" # somebody installed them: back at the end
done
sh "$example/build.sh" --install
id $user >/dev/null 2>&1 || { useradd -m -s /bin/sh $user && made_user=yes; }
chmod 755 "$work"

failed=0
claim() { # WHAT COMMAND...
    what=$1
    shift
    if "$@"; then echo "ok: $what"; else echo "FAILED: $what" && failed=1; fi
}

machine() { # NAME SED_ARGUMENT...      a run of the machine with its INI file changed
    name=$1
    shift
    cp -r "$example/machine" "$work/$name"
    sed -i "$@" "$work/$name/quadrant.ini"
    chown -R $user "$work/$name"
    su $user -c "cd '$work/$name' && timeout 300 script -qfec 'linuxcnc quadrant.ini' run.log" </dev/null >/dev/null ||
        { echo "FAILED: $name: LinuxCNC stopped:" && tail -20 "$work/$name/run.log" && exit 1; }
}

diagnose() { # NAME PERIOD_MS
    cd "$work/$1"
    sed -i "s/\"scale\": 1}/\"scale\": $2}/" record.map.json
    sed -i "s/\"sample_period_s\": 0.001/\"sample_period_s\": $(python3 -c "print($2 / 1000)")/" machine.json
    "$gap" import --map record.map.json record.txt log.csv >import.txt
    "$gap" diagnose --machine machine.json --log log.csv --json found.json --quiet
    cd - >/dev/null
}
said() { # NAME EXPRESSION of v (verdict), named (axis and effect of every claim)
    python3 - "$work/$1/found.json" "$2" <<'END'
import json, sys
found = json.load(open(sys.argv[1]))
v = found["verdict"]
named = {c["axis"] + "." + c["effect"] for c in found["causes"] if c["probability"] >= 0.5}
print("   ", v, sorted(named))
sys.exit(0 if eval(sys.argv[2]) else 1)
END
}

if [ "${3-}" = table ]; then
    turns='s/circle.ngc diamond.ngc/& turns.ngc/'
    machine pid "$turns; s/= quadrant.hal/= pid.hal/; s/quadrant-axis\.\(.\)\.time/pid.\1.do-pid-calcs.time/"
    machine cascade "$turns; s/^FRICTION_\(COULOMB\|STATIC\) = .*/FRICTION_\1 = 0/; s/^OBSERVER_ON = 1/OBSERVER_ON = 0/"
    machine friction "$turns; s/^OBSERVER_ON = 1/OBSERVER_ON = 0/"
    machine observer "$turns"
    machine memory "$turns; s/^MEMORY_WEIGHT = 0/MEMORY_WEIGHT = 1/; s/^MEMORY_CYCLE = 1/MEMORY_CYCLE = 1.884956/"
    python3 "$example/compare.py" "pid=$work/pid/record.txt" "cascade=$work/cascade/record.txt" \
        "and friction=$work/friction/record.txt" "and observer=$work/observer/record.txt" \
        "and memory=$work/memory/record.txt"
    exit 0
fi

# Both axes in one component: xy.hal in the place of quadrant.hal.
of_table='s/= quadrant.hal/= xy.hal/; s/quadrant-axis.0.time/quadrant-xy.0.time/; s/quadrant-axis.1.time/servo-thread.time/'
whole_table() {
    machine xy "$of_table"
    diagnose xy 1
    claim "1 kHz, quadrant_xy, nothing injected: no gap" said xy 'v in ("no_gap", "within_tolerance") and not named'
    machine xy_injected "$of_table; s/^HALFILE = plant.hal/&\nHALFILE = inject.hal/"
    diagnose xy_injected 1
    claim "1 kHz, quadrant_xy, cogging and delay on x: both named, and nothing else" \
        said xy_injected 'named == {"x.cogging", "x.time_delay"}'
}
if [ "${3-}" = xy ]; then
    whole_table
    exit $failed
fi

if [ "${3-}" != panel ]; then
# LinuxCNC's own pid without its feedforwards, and a file that knows neither the mass nor the friction well. What
# compensate says is typed into the INI file, and the machine runs again: the following error falls as forecast.
pid='s/= quadrant.hal/= pid.hal/; s/quadrant-axis\.\(.\)\.time/pid.\1.do-pid-calcs.time/'
machine untuned "$pid; s/^\(FF[12]\) = .*/\1 = 0/"
python3 "$here/typed_values.py" describe "$work/untuned"
diagnose untuned 1
cd "$work/untuned"
"$gap" compensate --machine machine.json --diagnosis found.json --log log.csv --json gained.json --quiet
cd - >/dev/null
machine tuned "$pid; $(python3 "$here/typed_values.py" type "$work/untuned")"
"$gap" import --map "$work/tuned/record.map.json" "$work/tuned/record.txt" "$work/tuned/log.csv" >/dev/null
claim "the stock pid: with the values typed the following error falls as forecast, rms and peak, within 15 %" \
    python3 "$here/typed_values.py" compare "$work/untuned" "$work/tuned"
[ "${3-}" != pid ] || exit $failed

# HAL alone.
cp "$here/pins.hal" "$here/pins.sh" "$work"
su $user -c "cd '$work' && timeout 120 halrun -f pins.hal" >"$work/pins.txt" 2>&1 || true
sed 's/^/    /' "$work/pins.txt"
claim "HAL alone: bad pins, changes while it runs, another period" grep -qx "failed: 0" "$work/pins.txt"

# The machine.
machine clean -e ''
diagnose clean 1
claim "1 kHz, nothing injected: no gap" said clean 'v in ("no_gap", "within_tolerance") and not named'
machine injected 's/^HALFILE = plant.hal/&\nHALFILE = inject.hal/'
diagnose injected 1
claim "1 kHz, cogging and delay on the pins of quadrant_plant: both named, on their axis, and nothing else" \
    said injected 'named == {"x.cogging", "x.time_delay"}'
machine fast 's/^SERVO_PERIOD = .*/SERVO_PERIOD = 250000/'
diagnose fast 0.25
claim "4 kHz, nothing injected: no gap" said fast 'v in ("no_gap", "within_tolerance") and not named'
whole_table
fi

# The panel: recorded, diagnosed, shown, the values saved; the next start has them.
if ! /usr/bin/python3 -c 'import PyQt5.QtWebEngineWidgets' 2>/dev/null || ! command -v xvfb-run >/dev/null; then
    echo "SKIPPED: LinuxCNC: the panel: no python3-pyqt5.qtwebengine or no xvfb"
    exit $failed
fi
cp -r "$example/machine" "$work/panel"
cp -r "$example/panel" "$work/panel/panel"
cp "$here/panel_display.py" "$gap" "$work/panel"
sed -i "s|^HALFILE = plant.hal|&\nHALFILE = inject.hal|
    s|^DISPLAY = .*|DISPLAY = ./panel_display.py $work/panel/panel $work/panel/${gap##*/} circle.ngc diamond.ngc|" "$work/panel/quadrant.ini"
chown -R $user "$work/panel"
su $user -c "cd '$work/panel' && export QTWEBENGINE_CHROMIUM_FLAGS='--disable-gpu --no-sandbox' && timeout 600 xvfb-run -a -s '-screen 0 1280x1024x24' \
    script -qfec 'linuxcnc quadrant.ini' run.log" </dev/null >/dev/null || { tail -20 "$work/panel/run.log"; failed=1; }
sed 's/^/    /' "$work/panel/panel.txt" | head -n 40
cp "$work/panel/diagnosed/diagnosis.json" "$work/panel/found.json"
claim "panel: both effects named from its own record" said panel 'named == {"x.cogging", "x.time_delay"}'
delay() { awk -F' *= *' -v s="$2" '/^\[/ { at = $0 } at == s && $1 == "DELAY" { print $2 }' "$1"; }
claim "panel: the delay of x is saved for the next start" \
    awk "BEGIN { d = $(delay "$work/panel/quadrant.ini" '[JOINT_0]') - 0.0012; exit !(d * d < 1e-8) }"
claim "panel: the file as it was stands beside" [ "$(delay "$work/panel/quadrant.ini.before" '[JOINT_0]')" = 0.0004 ]
claim "panel: y keeps its delay" awk "BEGIN { d = $(delay "$work/panel/quadrant.ini" '[JOINT_1]') - 0.0004; exit !(d * d < 1e-8) }"
for shot in panel values; do claim "panel: screenshot $shot.png" [ -s "$work/panel/screen_$shot.png" ]; done
# Started again with these values.
sed -i 's|^DISPLAY = .*|DISPLAY = ./run_program.py circle.ngc|' "$work/panel/quadrant.ini"
su $user -c "cd '$work/panel' && timeout 300 script -qfec 'linuxcnc quadrant.ini' again.log" </dev/null >/dev/null || failed=1
claim "panel: the machine starts with the saved values and runs" [ -s "$work/panel/record.txt" ]
exit $failed
