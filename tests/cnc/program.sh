#!/bin/sh
# SPDX-License-Identifier: BSL-1.0
# The program as it is used: what it writes, what it refuses, that its log and machine file are what quadrant-gap reads, that it
# is fast and its memory does not grow.
# usage: program.sh QUADRANT_CNC QUADRANT_GAP ROOT SCRATCH
set -eu
cnc=$1 gap=$2 root=$3 dir=$4
rm -rf "$dir"
mkdir -p "$dir"
cd "$dir"
machines=$root/examples/programs/quadrant_cnc paths=$root/examples/path
mill=$machines/mill.json
fail() { echo "FAILED: $*"; exit 1; }

# ---- what is refused: one line that says where, exit code 2, nothing half-written ----
cp "$mill" cnc.json
refuses() { # WORDS PROGRAM [MACHINE]
    code=0
    "$cnc" run --cnc "${3-cnc.json}" --path "$2" --log out.csv --report out.html --json out.json \
        --export-gap-machine out.gap >said 2>&1 || code=$?
    [ $code = 2 ] || fail "exit code $code, not 2: $(cat said)"
    [ "$(wc -l <said)" = 1 ] || fail "more than one line: $(cat said)"
    grep -qF -- "$1" said || fail "does not say '$1': $(cat said)"
    ! ls out.* >/dev/null 2>&1 || fail "something was written for: $1"
    echo "ok: $(cat said)"
}
nc() { printf 'G21 G90 F1000\nG1 X10\n%b\nM30\n' "$1" >p.nc; }
nc 'G2 X20 Y0 I3 J0';               refuses 'p.nc:3:11: the end of the arc is not on it' p.nc
nc 'G1 X11 F0';                     refuses 'p.nc:3:8: the feed is zero' p.nc
printf 'G21\nG1 X1\n' >p.nc;        refuses 'p.nc:2:4: the feed is zero' p.nc
nc 'G0 X301';                       refuses 'p.nc:3: axis x would go to 301 mm, beyond its limit 300 mm' p.nc
nc 'G1 X297\nG2 X297 Y-10 I0 J-5';  refuses 'p.nc:4: axis x would go to 302 mm' p.nc
nc 'G28 X0';                        refuses 'p.nc:3:1: "G28" is not supported' p.nc
nc 'G64\nG1 X20\nY20';              refuses 'p.nc:4: the path turns by 90 degrees at its end' p.nc
cat >p.cl <<'CL'
FEDRAT/100,MMPM
SPLINE/QUINTIC
GOTO/1,0,0
GOTO/2,1,0
GOTO/2,1,0
SPLINE/OFF
FINI
CL
refuses 'p.cl:5:1: GOTO: the spline has two points at the same place' p.cl
edit() { sed "$1" "$mill" >cnc.json; }
edit 's/"profile"/"reach_the_feed": true, "profile"/'
nc 'G1 X90 F3000\nX93';             refuses 'p.nc:4: the jerk limit cannot be met within the block' p.nc
printf 'G21 F100\nG1 Z1\n' >p.nc
sed '/"z": {/,$d; s/3000/3000/' "$mill" | sed '$s/},/}/' >cnc.json
printf '}}\n' >>cnc.json;           refuses 'p.nc:2: the machine has no axis z' p.nc
edit 's/"pid"/"pdi"/';              refuses 'cnc.json: axes.x.control.law: "pdi" is none of cascade_p_pi,' "$paths/circle.nc"
edit 's/inertia_kg_m2/inertia_kg/'; refuses 'cnc.json: axes.x.drive.inertia_kg: unknown key; did you mean inertia_kg_m2?' "$paths/circle.nc"
edit 's/trapezoidal/constant/';     refuses 'cnc.json: trajectory.jerk_m_per_s3: only trapezoidal and cubic' "$paths/circle.nc"
edit 's/"law": "pid".*}/"law": "lead_lag", "crossover_Hz": 400}/'; refuses 'cnc.json: axes.x: design_lead_lag.' "$paths/circle.nc"
cp "$mill" cnc.json
refuses 'nothing.nc: cannot be opened' nothing.nc
refuses 'nothing.json: no such file' "$paths/circle.nc" nothing.json
"$cnc" run --cnc cnc.json --path "$paths/circle.nc" --log no/such.csv >said 2>&1 && fail "wrote into no folder"
grep -q 'no/such.csv: cannot be written: no such folder' said || fail "$(cat said)"
"$cnc" run --cnc cnc.json >said 2>&1 && fail "no path is no fault"
grep -q -- --path said || fail "$(cat said)"
"$cnc" run --help | grep -q -- --export-gap-machine || fail "no help"

# ---- the same figures by every way, and the source's: Table 11 for PID prints 37.5 and 41.2 um, play left out ----
"$cnc" run --cnc "$mill" --path "$paths/diamond.nc" --json d.json --log d.csv --report report.html >said
"$cnc" run --cnc "$mill" --path "$paths/diamond.nc" --json >again.json
python3 - <<'PY'
import csv, json
a, b = json.load(open("d.json")), json.load(open("again.json"))
for j in (a, b): j.pop("wall_time_s"), j.pop("cpu_time_s")
assert a == b, "two runs differ"
for axis, printed in (("x", 37.5e-6), ("y", 41.2e-6)):
    error = a["axes"][axis]["error_max_m"]
    print(f"{axis}: {1e6 * error:.1f} um, printed {1e6 * printed:.1f}")
    assert abs(error - printed) < 0.1 * printed
rows = list(csv.DictReader(open("d.csv")))
assert len(rows) == a["samples"], "the log is not whole"
assert abs(float(rows[-1]["t_s"]) - (a["samples"] - 1) * 1e-3) < 1e-9
assert max(abs(float(r["x_cmd_V"])) for r in rows) * 6.4898 - a["axes"]["x"]["current_max_A"] < 1e-6
# The log is on the path: corners to the micrometre, each side from rest to rest.
x = [float(r["x_ref_m"]) for r in rows]
assert abs(max(x) - 0.035355339) < 1e-9 and abs(min(x) + 0.035355339) < 1e-9
# Its error, by its own columns: reading against reference, which differ from table against reference by a count.
worst = max(abs(float(r["x_ref_m"]) - float(r["x_pos_m"])) for r in rows)
assert abs(worst - a["axes"]["x"]["error_max_m"]) < 1.3e-6, (worst, a["axes"]["x"]["error_max_m"])
PY
grep -q 'Tracking' report.html && grep -q 'polyline class="table"' report.html || fail "the report has no plots"

# ---- what quadrant-gap says of a machine that is its own simulation ----
for machine in mill milling_table; do
    "$cnc" run --cnc "$machines/$machine.json" --path "$paths/strokes.nc" --log $machine.csv --export-gap-machine $machine.gap.json -q
    "$gap" diagnose --machine $machine.gap.json --log $machine.csv --json $machine.found.json -q
    verdict=$(sed -n 's/^  "verdict": "\(.*\)",/\1/p' $machine.found.json)
    echo "$machine: $verdict"
    case $verdict in no_gap | within_tolerance) ;; *) fail "quadrant-gap says $verdict of $machine" ;; esac
done
# ... and that it would see another mass: else the verdicts above would mean nothing.
sed 's/"mass_kg": 164.87/"mass_kg": 214/' "$machines/milling_table.json" >other.json
"$cnc" run --cnc other.json --path "$paths/strokes.nc" --log other.csv -q
for log in milling_table other; do "$gap" simulate --machine milling_table.gap.json --log $log.csv --json $log.left.json -q; done
python3 - <<'PY'
import json
own, other = (json.load(open(f"{name}.left.json"))["axes"]["y"]["gap"]["force_rms_N"] for name in ("milling_table", "other"))
print(f"force gap of y: {own:.1f} N, with 30 % more mass {other:.1f} N")
assert other > 5 * own
PY

# ---- 5000 lines: how fast, and the same memory for 20 000; with QUADRANT_TESTS=all four times as many ----
few=5000
[ "${QUADRANT_TESTS-}" != all ] || few=20000
write() { # LINES FILE
    awk -v n="$1" 'BEGIN { print "G21 G90 G64 P0.01 F6000"
        for (i = 1; i < n; ++i) { a = i * 0.02; r = 5 + 40 * i / n + 1.5 * sin(9 * a)
            printf "G1 X%.4f Y%.4f\n", r * cos(a) - 5, r * sin(a) } }' >"$2"
}
sed '/"z": {/,$d' "$mill" | sed '$s/},/}/' >two.json
printf '}}\n' >>two.json
write $few long.nc
write $((4 * few)) longer.nc
python3 - "$cnc" <<'PY'
import json, os, subprocess, sys
# Of a program, the peak of its memory has that of whoever started it in it: a launcher that is smaller than the program.
LAUNCH = """import os, sys
child = os.fork() or os.execv(sys.argv[1], sys.argv[1:])
_, status, used = os.wait4(child, 0)
print(status, used.ru_utime + used.ru_stime, used.ru_maxrss)"""
def run(path):
    said = subprocess.run([sys.executable, "-I", "-S", "-c", LAUNCH, sys.argv[1], "run", "--cnc", "two.json", "--path", path, "--json",
                           "long.json", "--log", "long.csv", "--report", "long.html", "-q"], capture_output=True, text=True, check=True)
    status, seconds, memory = said.stdout.split()
    assert status == "0", said.stderr
    seconds, memory = float(seconds), int(memory)
    result = json.load(open("long.json"))
    print(f"{path}: {result['duration_s']:.0f} s in {seconds:.2f} s of CPU time with log and report, "
          f"{result['duration_s'] / seconds:.0f} times faster than real time, {memory} kB, report {os.path.getsize('long.html')} bytes")
    return seconds / result["duration_s"], memory
cost, memory = run("long.nc")
longer_cost, longer = run("longer.nc")
assert longer_cost < 1.5 * cost, "a second of motion costs more in a longer program" # both under the same load
assert longer < memory + 2000, "memory grows with the program"
PY

# ---- while it runs it tells how far it is, on a terminal: twice is enough, however fast the machine ----
write $((40 * few)) longest.nc
python3 - "$cnc" <<'PY'
import os, pty, signal, sys
def said_by(path, enough):
    child, terminal = pty.fork()
    if child == 0:
        os.execv(sys.argv[1], ["quadrant-cnc", "run", "--cnc", "two.json", "--path", path])
    said = b""
    try:
        while said.count(b" %  line ") < enough and (part := os.read(terminal, 65536)): said += part
        os.kill(child, signal.SIGKILL)
    except OSError: # the program has closed its end
        pass
    return said.decode(), os.waitpid(child, 0)[1]
said, _ = said_by("longest.nc", 2)
told = [line for line in said.split("\r") if " %  line " in line]
assert len(told) == 2, said
print(f"told twice, such as: {told[1].strip()[3:]}")
said, status = said_by("long.nc", 1000)
assert status == 0 and said.rstrip().endswith("faster than real time"), said
PY
