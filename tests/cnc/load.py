#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Cutting load and accelerometer of quadrant-cnc beside closed forms written here: how far a harmonic of the cutter moves the table, force and
torque, rapid moves, how much stiffer an axis gets by its accelerometer, the diagnosis of a log with a load. load.py PROGRAM QUADRANT_GAP SCRATCH"""
import cmath
import copy
import json
import math
import pathlib
import subprocess
import sys

gap = sys.argv.pop(2)
from analyse import expect, faults, held_axis, mill, near  # reads PROGRAM and SCRATCH

program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
T, axis = mill["servo_period_s"], mill["axes"]["x"]
drive, control = axis["drive"], axis["control"]
screw = drive["pitch_m"] / (2 * math.pi)
newtons_a_volt = drive["amplifier_A_per_V"] * drive["torque_constant_Nm_per_A"] / screw
B, A = newtons_a_volt / (drive["inertia_kg_m2"] / screw**2), drive["viscous_Nm_s_per_rad"] / drive["inertia_kg_m2"]
of_x, of_v = held_axis(B, A, T)


def machine(**keys):
    m = copy.deepcopy(mill)
    del m["axes"]["y"], m["axes"]["z"]
    m["axes"]["x"]["drive"]["backlash_m"] = 0
    m["axes"]["x"]["encoder"] = {}
    m["axes"]["x"]["tachometer"] = {}
    m["axes"]["x"]["command"] = {"limit_V": 5}
    m["axes"]["x"].update(keys)
    return m


def ran(m, path, *options):
    (scratch / "load.json").write_text(json.dumps(m))
    return subprocess.run([program, "run", "--cnc", scratch / "load.json", "--path", path, "--quiet", "--json", *options], capture_output=True, text=True)


def log_of(m, path):
    done = ran(m, path, "--log", scratch / "load.csv")
    expect(done.returncode == 0, f"runs: {done.stderr}")
    head, *rows = (scratch / "load.csv").read_text().split()
    where = head.split(",").index("x_pos_m"), head.split(",").index("x_ref_m")
    return [tuple(float(row.split(",")[i]) for i in where) for row in rows]


long, short = scratch / "long.nc", scratch / "rapid.nc"
long.write_text("G21 G61\nG1 X200 F3000\n")  # four seconds at 50 mm/s: the friction stands
short.write_text("G21 G61\nG0 X100\nG0 X0\n")

# A harmonic of the spindle, and the position that it leaves along a stroke of constant speed, where dry friction is a constant.
spindle, force = 20.0, 400.0
load = {"spindle_Hz": spindle, "cosine_N": [0, force]}
loop = lambda z: (control["gain_V_per_m"] + control["integral_gain_V_per_m_s"] * T * z / (z - 1)) * of_x(z) + control["derivative_gain_V_s_per_m"] * of_v(z)
z = cmath.exp(2j * math.pi * 2 * spindle * T)
wanted = abs(force / newtons_a_volt * of_x(z) / (1 + loop(z)))
pairs = log_of(machine(cutting_load=load), long)


def second_harmonic(pairs):
    middle = pairs[1500:3500]  # whole turns of the spindle, far from both ends
    return 2 / len(middle) * abs(sum((x - r) * cmath.exp(-2j * math.pi * 2 * spindle * T * k) for k, (x, r) in enumerate(middle)))


near(second_harmonic(pairs), wanted, 0.02, "amplitude of the second harmonic at the table [m]")

# The same as a torque on the screw; a mean; nothing in rapid moves.
torque = log_of(machine(cutting_load={"spindle_Hz": spindle, "cosine_Nm": [0, force * screw]}), long)
expect(max(abs(a[0] - b[0]) for a, b in zip(pairs, torque)) < 1e-9, "a torque on the screw is a force on the table")
bare, pushed = log_of(machine(), long), log_of(machine(cutting_load={"spindle_Hz": spindle, "mean_N": 300}), long)
expect(max(abs(a[0] - b[0]) for a, b in zip(bare[:300], pushed[:300])) > 1e-6, "a mean pushes")
expect(abs(bare[2500][0] - pushed[2500][0]) < 0.2e-6, "and the integral takes it")
a, b = log_of(machine(), short), log_of(machine(cutting_load={"spindle_Hz": spindle, "mean_N": 300, "cosine_N": [200]}), short)
expect(a == b, "no load in rapid moves")

# An accelerometer: 1 + gain B times as stiff where acceleration rules.
def stiffness(m):
    (scratch / "load.json").write_text(json.dumps(m))
    done = subprocess.run([program, "analyse", "--cnc", scratch / "load.json", "--quiet", "--json"], capture_output=True, text=True)
    expect(done.returncode == 0, f"is analysed: {done.stderr}")
    rows = json.loads(done.stdout)["axes"]["x"]["response"]["rows"]
    return {row[0]: (complex(row[1], row[2]), complex(row[3], row[4])) for row in rows}


gain, corner = 0.5 / B, 120.0
bare, with_it = stiffness(machine()), stiffness(machine(acceleration_feedback={"gain_V_s2_per_m": gain, "filter_Hz": corner}))
t = math.tan(math.pi * corner * T)


def more_at(f):
    """Cut at the command: the accelerometer's path beside the law's; it reads the mean acceleration of the last period."""
    z = cmath.exp(2j * math.pi * f * T)
    return gain * t * (z + 1) / ((1 + t) * z - (1 - t)) * (1 - 1 / z) / T * of_v(z)


for wanted_f in (5, 40, 100, 250):
    f = min(bare, key=lambda f: abs(f - wanted_f))
    near(abs(with_it[f][0]), abs(bare[f][0] + more_at(f)), 0.01, f"open loop with the accelerometer at {f:.0f} Hz")
refused = ran(machine(control={"law": "zero_phase", "natural_Hz": 15, "damping": 0.8, "observer_Hz": 25}, acceleration_feedback={"gain_V_s2_per_m": 1, "filter_Hz": 90}), long)
expect(refused.returncode == 2 and "acceleration_feedback with a law that looks ahead" in refused.stderr, f"refused: {refused.stderr}")
quieter = second_harmonic(log_of(machine(cutting_load=load, acceleration_feedback={"gain_V_s2_per_m": gain, "filter_Hz": corner}), long))
z = cmath.exp(2j * math.pi * 2 * spindle * T)
near(quieter, abs(force / newtons_a_volt * of_x(z) / (1 + loop(z) + more_at(2 * spindle))), 0.02, "the same with the accelerometer [m]")

# A load that the exported machine does not know is a gap, and is named.
m = copy.deepcopy(mill)
del m["axes"]["y"], m["axes"]["z"]
m["axes"]["x"]["cutting_load"] = {"spindle_Hz": 23.3, "cosine_N": [400, 200, 260], "sine_N": [0, 100, 130]}
strokes = scratch / "strokes.nc"
strokes.write_text("G21 G61\n" + "".join(f"G1 X{60 if k % 2 == 0 else -40} F{3000 + 1500 * k}\n" for k in range(6)))
done = ran(m, strokes, "--log", scratch / "cut.csv", "--export-gap-machine", scratch / "cut.json")
expect(done.returncode == 0 and any("cutting load" in note for note in json.loads(done.stdout)["notes"]), f"the load is noted: {done.stderr}")
done = subprocess.run([gap, "diagnose", "--quiet", "--machine", scratch / "cut.json", "--log", scratch / "cut.csv", "--json", scratch / "cut.found.json"], capture_output=True, text=True)
found = json.loads((scratch / "cut.found.json").read_text()) if done.returncode == 0 else {"causes": [], "verdict": done.stderr}
claims = [c["effect"] for c in found["causes"] if c["probability"] >= 0.5]
expect(claims == ["cutting_force"], f"the diagnosis names the cut: {found['verdict']}, {claims}")
sys.exit(1 if faults else 0)
