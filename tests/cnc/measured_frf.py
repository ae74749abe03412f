#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-cnc analyse --frf beside a closed form written here: the mill's PID around axes that the machine file does not know, the
proposed gains and notch of a cascade and the margins that they leave, what is refused. measured_frf.py PROGRAM SCRATCH"""
import cmath
import json
import math
import pathlib
import subprocess
import sys

from analyse import expect, faults, held_axis, mill, near, pid_of_the_mill

program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
scratch.mkdir(parents=True, exist_ok=True)
machine = pathlib.Path(__file__).resolve().parents[2] / "examples/programs/quadrant_cnc/mill.json"
period, axis = mill["servo_period_s"], mill["axes"]["x"]
lines = [10 ** (k / 200) for k in range(-100, int(200 * math.log10(0.49 / period)))]
z_of = lambda f: cmath.exp(2j * math.pi * f * period)


def written(rows, header="frequency_Hz,magnitude_m_per_V,phase_deg", name="measured.csv"):
    (scratch / name).write_text(header + "\n" + "".join(",".join(map(str, row)) + "\n" for row in rows))
    return scratch / name


def run(file, *options):
    return subprocess.run([program, "analyse", "--cnc", machine, "--axis", "x", "--frf", file, "--json", *options], capture_output=True, text=True)


def analysed(response):
    rows = [(f, abs(g), math.degrees(cmath.phase(g))) for f, g in ((f, response(f)) for f in lines)]
    ran = run(written(rows))
    if ran.returncode:
        print(ran.stderr)
        sys.exit(1)
    return json.loads(ran.stdout)["axes"]["x"]


drive, control = axis["drive"], axis["control"]
screw = drive["pitch_m"] / (2 * math.pi)
plain = held_axis(drive["amplifier_A_per_V"] * drive["torque_constant_Nm_per_A"] * screw / drive["inertia_kg_m2"],
                  drive["viscous_Nm_s_per_rad"] / drive["inertia_kg_m2"], period)


def mode(f, centre=180, damping=0.02, share=0.5):
    """A structural mode beside the rigid axis, as a factor."""
    r = 1j * f / centre
    return 1 + share * r * r / (1 + 2 * damping * r + r * r) * -1


slower = lambda f: 0.6 * plain[0](z_of(f)) * z_of(f) ** -1  # a weaker axis that answers one period later
rigid = lambda f: plain[0](z_of(f))
modal = lambda f: plain[0](z_of(f)) * mode(f)
p, i, d = control["gain_V_per_m"], control["integral_gain_V_per_m_s"], control["derivative_gain_V_s_per_m"]
for name, response in (("the axis itself", rigid), ("a weaker and later axis", slower)):
    found = analysed(response)
    of_file = pid_of_the_mill(axis, period)
    at = lambda f: of_file(z_of(f)) * response(f) / rigid(f)  # the tachometer's part goes with the position's
    # Behind 0.4 of the rate the response falls steeply to its zero at half the rate: what lies between two lines is off by up to 6e-3.
    rows = [(row, at(row[0])) for row in found["response"]["rows"] if row[0] < 0.4 / period]
    worst = max(abs(complex(row[1], row[2]) / wanted - 1) for row, wanted in rows if abs(wanted) < 100)
    expect(worst < 1e-3, f"{name}: open loop, up to 40 dB: {worst:.1e} of the closed form at most")
    crossing = next(b for a, b in zip(lines, lines[1:]) if abs(at(a)) >= 1 > abs(at(b)))
    fine = [crossing * (1 - 0.02 * k / 2000) for k in range(2000)]
    crossing = max(f for f in fine if abs(at(f)) >= 1)
    near(found["phase_margins"][0]["frequency_Hz"], crossing, 2e-3, f"{name}: crossover [Hz]")
    near(found["phase_margins"][0]["deg"], 180 + math.degrees(cmath.phase(at(crossing))), 1e-2, f"{name}: phase margin [deg]")
    near(found["sensitivity_peak"], max(abs(1 / (1 + at(f))) for f in lines), 5e-3, f"{name}: sensitivity peak")
    expect(found.get("stable") is True, f"{name}: stable")


def comes_to_rest(share, late):
    """The same loop in time, from a first deviation: its axis `share` as strong and `late` periods later."""
    kept = math.exp(-drive["viscous_Nm_s_per_rad"] / drive["inertia_kg_m2"] * period)
    damping = drive["viscous_Nm_s_per_rad"] / drive["inertia_kg_m2"]
    gained = (1 - kept) / damping
    gain = share * drive["amplifier_A_per_V"] * drive["torque_constant_Nm_per_A"] * screw / drive["inertia_kg_m2"]
    x, v, total, waiting, largest = 1e-6, 0.0, 0.0, [0.0] * late, [0.0, 0.0]
    for k in range(20000):
        total += i * period * x
        waiting.append(-(p * x + total + d * v))
        u = waiting.pop(0)
        x, v = x + gained * v + gain * (period - gained) / damping * u, kept * v + gain * gained * u
        largest[k >= 10000] = max(largest[k >= 10000], abs(x))
        if abs(x) > 1:
            return False
    return largest[1] < 0.5 * largest[0]


told = [(late, analysed(lambda f: 0.6 * plain[0](z_of(f)) * z_of(f) ** -late)["stable"], comes_to_rest(0.6, late)) for late in range(6)]
expect(all(a == b for _, a, b in told) and told[0][1] and not told[-1][1], f"stable as the same loop in time, by periods of delay: {told}")


def filtered(f, corner):
    """The velocity of a filtered derivative: w s / (s + w), bilinear (docs/formats.md)."""
    s, w = 2 / period * (z_of(f) - 1) / (z_of(f) + 1), 2 * math.pi * corner
    return w * s / (s + w)


def notch(f, at, width):
    s, w = (z_of(f) - 1) / (z_of(f) + 1), math.tan(math.pi * at * period)
    return (s * s + w * w) / (s * s + width * w * s + w * w)


def margins(loop):
    """Least |phase margin|, |gain margin| and |1 + L| of a loop, on dense lines."""
    dense = [lines[0] * (lines[-1] / lines[0]) ** (k / 40000) for k in range(40001)]
    values = [loop(f) for f in dense]
    phase = min(abs(math.degrees(cmath.phase(-b))) for a, b in zip(values, values[1:]) if (abs(a) >= 1) != (abs(b) >= 1))
    gain = min((abs(20 * math.log10(abs(b))) for a, b in zip(values, values[1:]) if (a.imag < 0) != (b.imag < 0) and a.real < 0 and b.real < 0), default=math.inf)
    return phase, gain, min(abs(1 + v) for v in values)


for name, response, notched in (("rigid axis", rigid, False), ("axis with a mode at 180 Hz", modal, True)):
    measured = analysed(response)["measured"]
    expect("proposed_control" in measured, f"{name}: gains are proposed ({measured.get('no_gains', '')})")
    if "proposed_control" not in measured:
        continue
    c = measured["proposed_control"]
    kp, ki, kv, corner = (c[k] for k in ("velocity_gain_V_s_per_m", "velocity_integral_V_per_m", "position_gain_per_s", "velocity_filter_Hz"))
    expect(("notch" in c) == notched, f"{name}: {'a' if notched else 'no'} notch ({measured.get('no_notch', '')})")
    if "notch" in c:
        near(c["notch"]["frequency_Hz"], 180, 0.02, f"{name}: notch [Hz]")
    stop = lambda f: notch(f, c["notch"]["frequency_Hz"], c["notch"]["width"]) if "notch" in c else 1
    forward = lambda f, by=1: by * (kp + ki / (2j * math.pi * f)) * stop(f) * response(f)
    velocity = lambda f, by=1: forward(f, by) * filtered(f, corner)
    position = lambda f, by=1: by * kv * forward(f) / (1 + velocity(f))
    for what, loop in (("velocity loop", velocity), ("position loop", position)):
        phase, gain, modulus = margins(loop)
        kept = phase > 44.7 and gain > 5.95 and modulus > 0.497
        expect(kept, f"{name}, {what}: {phase:.1f} deg, {gain:.2f} dB, {modulus:.3f}: what was wanted is kept")
        phase, gain, modulus = margins(lambda f: loop(f, 1.06))
        expect(phase < 45 or gain < 6 or modulus < 0.5, f"{name}, {what}: 6 % more gain breaks it")

good = [(f, 1 / f, -180) for f in range(1, 20)]
changed = lambda k, row: good[:k] + [row] + good[k + 1:]
usual = "frequency_Hz,magnitude_m_per_V,phase_deg"
for header, rows, words in (
    ("frequency_Hz,gain,phase_deg", good, ':1:14: the column "gain" is none of'),
    ("frequency_Hz,phase_deg,phase_deg", good, ":1:24: the column phase_deg is there twice"),
    ("magnitude_m_per_V,phase_deg,coherence", good, ":1:1: the header must name the column frequency_Hz"),
    ("frequency_Hz,magnitude_m_per_V,imag_m_per_V", good, ":1:1: the header must name either"),
    (usual, changed(4, (5, "x", -180)), ':6:3: magnitude_m_per_V: "x" is not a number'),
    (usual, changed(4, (5, 0, -180)), ":6:3: magnitude_m_per_V: 0 must be above 0"),
    (usual, changed(4, (4, 1, -180)), ":6:1: frequency_Hz: 4 must be above that of the row before (4)"),
    (usual, changed(0, (0, 1, -180)), ":2:1: frequency_Hz: 0 must be above 0"),
    (usual, changed(18, (500, 1, -180)), ":20:1: frequency_Hz: 500 must be below half the servo rate (500 Hz)"),
    (usual, changed(4, (5, 1)), ":6:4: the row has 2 cells, the header 3"),
    (usual, changed(4, (5, 1, 1, 1)), ":6:7: more cells than the 3 of the header"),
    (usual, changed(4, ("",)), ":6:1: a blank line inside the table"),
    ("frequency_Hz,magnitude_m_per_V,phase_deg,coherence", [(*r, 1.5) for r in good], ":2:12: coherence: 1.5 must lie between 0 and 1"),
    ("frequency_Hz,real_m_per_V,imag_m_per_V", [(r[0], 0, 0) for r in good], ":2:3: real_m_per_V: 0 must not be 0 together"),
    (usual, good[:5], ": holds 5 frequencies: must hold 10 or more"),
):
    ran = run(written(rows, header, "bad.csv"))
    expect(ran.returncode == 2 and ran.stderr.count("\n") == 1 and f"bad.csv{words}" in ran.stderr, f"refused: bad.csv{words} {ran.stderr if words not in ran.stderr else ''}")
ran = subprocess.run([program, "analyse", "--cnc", machine, "--frf", written(good), "--json"], capture_output=True, text=True)
expect(ran.returncode == 2 and "--axis must say which" in ran.stderr, "refused: --frf without --axis")
short = run(written([(10 + f, *r[1:]) for f, r in zip(range(19), good)]))
expect(short.returncode == 0 and "stable" not in json.loads(short.stdout)["axes"]["x"], "a band that ends too early does not tell whether the loop is stable")
sys.exit(1 if faults else 0)
