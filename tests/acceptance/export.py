#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Values for LinuxCNC, a drive and a table of corrections, against the equations of docs/formats.md and docs/linuxcnc.md.
usage: export.py QUADRANT_GAP FOLDER"""
import csv
import json
import math
import pathlib
import re
import subprocess
import sys

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
bad = 0


def expect(good, what):
    global bad
    bad += not good
    print("ok  " if good else "BAD ", what)


def near(a, b):
    return abs(a - b) <= 2e-5 * max(abs(a), abs(b))  # six digits are written


def export(machine, *options):
    (folder / "m.json").write_text(json.dumps(machine))
    return subprocess.run([program, "export", "--machine", folder / "m.json", *options], capture_output=True, text=True)


kp, kv, ki, vff, kf, m, b, c, s = 120, 55, 400, 0.9, 1200, 240, 700, 90, 130
x = {"plant": {"mass_kg": m, "force_constant_N_per_V": kf, "viscous_N_s_per_m": b, "coulomb_N": c, "static_N": s,
               "stribeck_velocity_m_per_s": 0.003, "delay_s": 0.0005, "backlash_m": 3e-5, "mode_mass_kg": 60, "mode_frequency_Hz": 80,
               "mode_damping": 0.02},
     "encoder": {"resolution_m": 1e-7}, "actuator": {"limit_V": 10},
     "controller": {"kind": "cascade_p_pi", "position_gain_per_s": kp, "velocity_gain_V_s_per_m": kv, "velocity_integral_V_per_m": ki,
                    "velocity_filter_Hz": 150, "velocity_feedforward": vff, "notch": {"frequency_Hz": 300, "width": 0.1}}}
cogging, phase, period = [40, 10], [0.3, -1.1], 0.032
y = {"plant": {"mass_kg": 10, "force_constant_N_per_V": 20, "viscous_N_s_per_m": 5, "cogging_period_m": period, "cogging_N": cogging,
               "cogging_phase_rad": phase, "constant_force_N": 2, "spring_N_per_m": 30, "backlash_m": 2e-5},
     "encoder": {"resolution_m": 1e-6, "cyclic_m": 1e-6, "cyclic_period_m": 0.002, "cyclic_phase_rad": 0.4},
     "controller": {"kind": "linuxcnc_pid", "Pgain": 5, "Igain": 7, "FF1": 0.02, "units_per_m": 1000}}
turning = {"plant": {"inertia_kg_m2": 0.01, "torque_constant_Nm_per_A": 0.5, "viscous_Nm_s_per_rad": 0.01}, "encoder": {"resolution_rad": 1e-4}}
machine = {"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"c": turning, "y": y, "x": x}}

done = export(machine, "--linuxcnc", folder / "l.txt", "--drive", folder / "d.csv", "--compensation", folder / "t.csv")
expect(done.returncode == 0, f"written: {done.stderr}")
text = (folder / "l.txt").read_text()
joints = re.findall(r"\[JOINT_(\d)\]\n# axis (\w)", text)
expect(joints == [("0", "x"), ("1", "y"), ("2", "c")], f"joints in the order of coordinates: {joints}")
ini, hal = text.split("# --- HAL file ---")
entries = dict(re.findall(r"^([A-Z_]+) = (\S+)$", ini.split("[JOINT_1]")[0], re.M))
pins = {k: float(v) for k, v in re.findall(r"quadrant-axis\.0\.(\S+)\s+(\S+)", hal)}
truth = {"position-gain": kp, "velocity-gain": kv, "velocity-integral": ki, "notch-centre": 300, "notch-width": 0.1, "plant-gain": kf / m,
         "plant-pole": b / m, "friction-coulomb": c / kf, "friction-static": s / kf, "friction-velocity": 0.003, "delay": 0.0005}
expect(set(pins) == set(truth) and all(near(pins[k], v) for k, v in truth.items()), f"pins of quadrant_axis: {pins}")
expect(all(near(float(entries[k.upper().replace("-", "_")]), v) for k, v in truth.items()), "the same in the INI file")
expect("BACKLASH" not in entries, "no BACKLASH where the encoder reads behind the play: it would move the load")
expect("reads behind the play of 0.03 mm" in done.stdout, "and the play is told")
play = export({"schema": "quadrant.machine/1", "sample_period_s": 0.01,
               "axes": {"z": {"encoder": {"resolution_m": 1e-6}, "transmission": {"backlash_m": 4e-5}}}}, "--linuxcnc", folder / "z.txt")
expect("BACKLASH = 0.04\n" in (folder / "z.txt").read_text(), f"the play before the scale in machine units: {play.stderr}")
export({"schema": "quadrant.machine/1", "sample_period_s": 0.01,
        "axes": {"z": {"encoder": {"resolution_m": 1e-6}, "transmission": {"backlash_m": 4e-5}}}}, "--compensation", folder / "z.csv")
shifts = {(r["command"], r["forward"], r["reverse"]) for r in csv.DictReader((folder / "z.csv").open())}
expect(shifts == {("0", "2e-05", "-2e-05")}, f"half of the play before the scale, forth and back: {shifts}")
pid = {k: float(v) for k, v in re.findall(r"# setp pid\.0\.(\S+)\s+(\S+)", hal)}


# Both laws on one motion, sample by sample, in the machine's millimetres: the outputs agree but for the velocity's filter.
def cascade_and_pid(T=1e-4, rows=4000):
    integral, error_sum, worst, largest = 0.0, 0.0, 0.0, 0.0
    r1 = r2 = y1 = 0.0
    for k in range(1, rows):
        t = k * T
        r, y = 0.02 * (1 - math.cos(9 * t)), 0.02 * (1 - math.cos(9 * t - 0.01)) - 0.02 * (1 - math.cos(0.01))
        v_ref, a_ref = (r - r1) / T, (r - 2 * r1 + r2) / T**2
        e = kp * (r - y) + vff * v_ref - (y - y1) / T
        integral += ki * T * e
        u = kv * e + integral + m / kf * a_ref + b / kf * v_ref
        err, err1 = 1000 * (r - y), 1000 * (r1 - y1)
        error_sum += err * T
        w = pid["Pgain"] * err + pid["Igain"] * error_sum + pid["Dgain"] * (err - err1) / T + pid["FF0"] * 1000 * r + \
            pid["FF1"] * 1000 * v_ref + pid["FF2"] * 1000 * a_ref
        if k > 2:
            worst, largest = max(worst, abs(u - w)), max(largest, abs(u))
        r2, r1, y1 = r1, r, y
    return worst / largest


expect(cascade_and_pid() < 1e-3, f"pid multiplied out is the cascade: {cascade_and_pid():.1e}")
expect("no feedforward against Coulomb friction (0.075 V)" in done.stdout, f"what pid lacks is told: {done.stdout.strip()}")
own = {k: float(v) for k, v in re.findall(r"^setp pid\.1\.(\S+)\s+(\S+)", hal, re.M)}
expect(own == {"FF1": 0.02, "Igain": 7, "Pgain": 5}, f"pins of a described pid: {own}")

values = {(r["axis"], r["quantity"]): r for r in csv.DictReader((folder / "d.csv").open())}
number = lambda *key: float(values[key]["value"])
expect(near(number("x", "acceleration feedforward"), m / kf) and near(number("x", "viscous feedforward"), b / kf) and
       near(number("x", "Coulomb feedforward"), c / kf), "feedforwards of a drive")
expect(near(number("x", "resonance (for a notch)"), 80 * math.sqrt(m / (m - 60))), "a resonance lies above its antiresonance")
expect(near(number("y", "offset against the constant force"), -0.1), "an offset")
expect(near(number("c", "inertia for a feedforward"), 0.01 * 2 * math.pi) and
       values["c", "inertia for a feedforward"]["odrive"] == "controller.config.inertia", "ODrive's inertia, in turns")

rows = [r for r in csv.DictReader((folder / "t.csv").open())]
expect({r["axis"] for r in rows} == {"y"}, "axes whose forces or errors depend on the place; the loop of x corrects its play")
good = True
for r in (r for r in rows if r["axis"] == "y"):
    at = float(r["position"])
    force = 2 - 30 * at + sum(n * math.sin(2 * math.pi * (i + 1) * at / period + p) for i, (n, p) in enumerate(zip(cogging, phase)))
    reading = 1e-6 * math.sin(2 * math.pi * at / 0.002 + 0.4)
    good = good and abs(float(r["command"]) + force / 20) < 1e-5 and abs(float(r["forward"]) - reading) < 1e-10 and \
        abs(float(r["reverse"]) - reading) < 1e-10
y_rows = [float(r["position"]) for r in rows if r["axis"] == "y"]
expect(good and y_rows[0] == 0 and near(y_rows[-1], period) and len(y_rows) >= 16 * 16, f"{len(y_rows)} rows that cancel force and error")
log = folder / "log.csv"
log.write_text("t_s,x_pos_m,x_cmd_V,y_pos_m,y_cmd_V,c_pos_rad,c_cmd_A\n" + "".join(
    f"{k * 1e-3:.3f},{0.1 * math.sin(k / 50):.7f},{math.sin(k / 50):.4f},{0.05 * math.cos(k / 60):.7f},{math.cos(k / 60):.4f},"
    f"{math.sin(k / 40):.6f},{math.sin(k / 40):.5f}\n" for k in range(1000)))
done = export(machine, "--compensation", folder / "t2.csv", "--log", log)
span = [float(r["position"]) for r in csv.DictReader((folder / "t2.csv").open()) if r["axis"] == "y"]
expect(abs(span[0] + 0.05) < 1e-4 and abs(span[-1] - 0.05) < 1e-4, f"the table covers where the log went: {span[0]} to {span[-1]} {done.stderr}")
for options, words in (((), "nothing is asked for"), (("--drive", folder / "m.json"), "would destroy what --machine reads"),
                       (("--log", log), "requires --compensation")):
    done = export(machine, *options)
    expect(done.returncode == 2 and words in done.stderr, f"refused: {done.stderr.strip().splitlines()[0] if done.stderr else done.stdout}")
sys.exit(bad > 0)
