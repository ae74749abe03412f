#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-cnc analyse beside a closed form written here: the mill's PID and the milling table's cascade, every law of the virtual
CNC, a loop that is not stable, what is refused. analyse.py PROGRAM SCRATCH"""
import cmath
import copy
import json
import math
import pathlib
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[2]
program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
scratch.mkdir(parents=True, exist_ok=True)
machines = root / "examples/programs/quadrant_cnc"
mill = json.loads((machines / "mill.json").read_text())
faults = []


def analysed(machine, *options):
    (scratch / "machine.json").write_text(json.dumps(machine))
    ran = subprocess.run([program, "analyse", "--cnc", scratch / "machine.json", "--json", *options], capture_output=True, text=True)
    return json.loads(ran.stdout) if ran.returncode == 0 else ran


def expect(good, what):
    print("ok  " if good else "BAD ", what)
    if not good:
        faults.append(what)


def near(found, wanted, share, what):
    expect(abs(found - wanted) <= share * abs(wanted), f"{what}: {found:.6g}, in closed form {wanted:.6g}")


def held_axis(gain, damping, period):
    """x/u and v/u of gain/(s (s + damping)) behind a hold, at z."""
    kept = math.exp(-damping * period)
    gained = (1 - kept) / damping
    way = (period - gained) / damping
    return (lambda z: gain * (way + gained * gained / (z - kept)) / (z - 1)), (lambda z: gain * gained / (z - kept))


def pid_of_the_mill(axis, period):
    drive, control = axis["drive"], axis["control"]
    screw = drive["pitch_m"] / (2 * math.pi)
    x, v = held_axis(drive["amplifier_A_per_V"] * drive["torque_constant_Nm_per_A"] * screw / drive["inertia_kg_m2"],
                     drive["viscous_Nm_s_per_rad"] / drive["inertia_kg_m2"], period)
    p, i, d = control["gain_V_per_m"], control["integral_gain_V_per_m_s"], control["derivative_gain_V_s_per_m"]
    return lambda z: (p + i * period * z / (z - 1)) * x(z) + d * v(z)


def main():
    period = mill["servo_period_s"]
    found = analysed(mill)
    expect(list(found["axes"]) == ["x", "y", "z"], "every axis of the mill is analysed")
    for name, axis in found["axes"].items():
        loop = pid_of_the_mill(mill["axes"][name], period)
        # The drive's steps in time leave some 4e-6 of the sensitivity; where the open loop is larger than its inverse nothing is compared.
        rows = [(row, loop(cmath.exp(2j * math.pi * row[0] * period))) for row in axis["response"]["rows"]]
        worst = max(abs(complex(row[3], row[4]) - 1 / (1 + wanted)) for row, wanted in rows)
        expect(worst < 2e-5, f"sensitivity of axis {name}: {worst:.1e} from the closed form at most")
        worst = max(abs(complex(row[1], row[2]) / wanted - 1) for row, wanted in rows if abs(wanted) < 100)
        expect(worst < 1e-3, f"open loop of axis {name}, up to 40 dB: {worst:.1e} of the closed form at most")
        at = lambda f: loop(cmath.exp(2j * math.pi * f * period))
        lines = [10 ** (k / 4000) for k in range(-4000, 10796)]
        crossing = next(b for a, b in zip(lines, lines[1:]) if abs(at(a)) >= 1 > abs(at(b)))
        near(axis["phase_margins"][0]["deg"], 180 + math.degrees(cmath.phase(at(crossing))), 5e-3, f"phase margin of axis {name} [deg]")
        near(axis["sensitivity_peak"], max(abs(1 / (1 + at(f))) for f in lines if f < 0.499 / period), 1e-3, f"sensitivity peak of axis {name}")

    laws = {
        "p_pi": {"position_gain_per_s": 60, "gain_V_s_per_m": 400, "integral_gain_V_per_m": 25000, "acceleration_gain_V_s2_per_m": 1.58},
        "sliding_mode": {"sliding_per_s": 200, "gain_V_s_per_m": 300, "adaptation_V_per_m": 30000},
        "lead_lag": {"crossover_Hz": 25},
        "pole_placement": {"natural_Hz": 20, "observer_Hz": 35},
        "zero_phase": {"natural_Hz": 20, "observer_Hz": 35},
        "generalized_predictive": {"effort_m_per_V": 3e-5},
        "state_feedback": {"position_gain_V_per_m": 6e4, "velocity_gain_V_s_per_m": 400, "encoder_noise_m": 4e-7, "drift_V": 30},
    }
    for law, keys in laws.items():
        machine = copy.deepcopy(mill)
        machine["axes"] = {"x": machine["axes"]["x"]}
        machine["axes"]["x"]["control"] = {"law": law, **keys}
        axis = analysed(machine)["axes"]["x"]
        expect(axis["stable"] and axis["linear"] and axis["sensitivity_peak"] < 3, f"{law}: stable, sensitivity {axis['sensitivity_peak']:.3g}")
        expect("settling_s" in axis["step"]["linear"], f"{law}: its step settles")

    hot = copy.deepcopy(mill)
    hot["axes"] = {"x": hot["axes"]["x"]}
    rise = analysed(hot)["axes"]["x"]["gain_may_rise_dB"]
    for by, stable in ((rise - 0.3, True), (rise + 0.3, False)):
        for key in ("gain_V_per_m", "integral_gain_V_per_m_s", "derivative_gain_V_s_per_m"):
            hot["axes"]["x"]["control"][key] = mill["axes"]["x"]["control"][key] * 10 ** (by / 20)
        axis = analysed(hot)["axes"]["x"]
        expect(axis["stable"] == stable and ("response" in axis) == stable, f"{by:.1f} dB more gain: {'stable' if axis['stable'] else 'not stable'}")

    step = analysed(mill, "--axis", "y", "--step", "1e-4")
    expect(list(step["axes"]) == ["y"] and step["axes"]["y"]["step"]["size_m"] == 1e-4, "one axis, and a step of its own size")
    for options, words in ((["--axis", "q"], "axes: has no axis q; it has x, y, z"), (["--step", "-1"], "--step")):
        ran = analysed(mill, *options)
        expect(not isinstance(ran, dict) and ran.returncode == 2 and words in ran.stderr, f"refused: {words}")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
