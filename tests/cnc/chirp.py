#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-cnc analyse --chirp beside axes and a controller that are simulated here: the response, its coherence, what --write-frf hands on
to --frf, and what is refused. chirp.py PROGRAM SCRATCH"""
import cmath
import json
import math
import pathlib
import random
import subprocess
import sys

from analyse import expect, faults, mill

program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
scratch.mkdir(parents=True, exist_ok=True)
machine = pathlib.Path(__file__).resolve().parents[2] / "examples/programs/quadrant_cnc/mill.json"
T = mill["servo_period_s"]

# A mass of 3 t on 2.5 /s of damping and a mode beside it, as two sections with a zero-order hold; 0.63 m/s2 a volt.
gain, damping, mode_Hz, zeta, share = 0.63, 2.5, 160.0, 0.03, 0.25


class Axis:
    def __init__(self):
        self.x = self.v = self.q = self.w = 0.0
        self.kept = math.exp(-damping * T)
        self.gained = (1 - self.kept) / damping
        w, d = 2 * math.pi * mode_Hz, 2 * math.pi * mode_Hz * math.sqrt(1 - zeta * zeta)
        decay, c, s = math.exp(-zeta * w * T), math.cos(d * T), math.sin(d * T)
        self.a = decay * (c + zeta * w / d * s), decay * s / d, -decay * w * w / d * s, decay * (c - zeta * w / d * s)
        self.w2 = w * w

    def read(self):
        return self.x + self.q

    def step(self, u):
        goal = gain * u / damping
        self.x, self.v = self.x + goal * T + (self.v - goal) * self.gained, goal + (self.v - goal) * self.kept
        rest = share * gain * u / self.w2  # where the mode would stand
        q, w = self.q - rest, self.w
        self.q, self.w = rest + self.a[0] * q + self.a[1] * w, self.a[2] * q + self.a[3] * w


def exact(f):
    """Position over command at the samples: that of both sections with the hold."""
    z = cmath.exp(2j * math.pi * f * T)
    a = Axis()
    rigid = gain / damping * ((T - a.gained) + a.gained * (1 - a.kept) / (z - a.kept)) / (z - 1)
    b0, b1 = (1 - a.a[0]) * share * gain / a.w2, -a.a[2] * share * gain / a.w2
    determinant = (z - a.a[0]) * (z - a.a[3]) - a.a[1] * a.a[2]
    return rigid + ((z - a.a[3]) * b0 + a.a[1] * b1) / determinant


def log(name, noise, samples=32000, period=T, resting=False, seconds=30.0, size=40e-6):
    """A PD loop with a chirp of 1 to 400 Hz in its reference (or added to its command)."""
    axis, rows, seed = Axis(), ["t_s,x_ref_m,x_pos_m,x_cmd_V"], random.Random(7)
    before = 0.0
    for k in range(samples):
        t = k * T
        chirp = math.sin(2 * math.pi * seconds / math.log(400) * (400 ** (t / seconds) - 1))
        reference = 0.0 if resting else size * chirp
        reading = axis.read() + seed.gauss(0, noise)
        velocity = (reading - before) / T
        before = reading
        u = 30e3 * (reference - reading) - 150 * velocity + (0.3 * chirp if resting else 0)
        rows.append(f"{k * period:.7f},{reference:.12f},{reading:.12f},{u:.9f}")
        axis.step(u)
    (scratch / name).write_text("\n".join(rows) + "\n")
    return scratch / name


def run(*options):
    return subprocess.run([program, "analyse", "--cnc", machine, "--axis", "x", "--quiet", "--json", *options], capture_output=True, text=True)


def lines_of(path):
    head, *rows = path.read_text().split()
    expect(head == "frequency_Hz,real_m_per_V,imag_m_per_V,coherence", f"columns of {path.name}: {head}")
    return [tuple(map(float, row.split(","))) for row in rows]


for name, noise, resting, within in (("quiet", 1e-9, False, 0.03), ("noisy", 0.3e-6, False, 0.08), ("pushed", 1e-9, True, 0.03)):
    chirp = log(f"{name}.csv", noise, resting=resting)
    ran = run("--chirp", chirp, "--write-frf", scratch / f"{name}.frf.csv", "--report", scratch / f"{name}.html")
    expect(ran.returncode == 0, f"{name}: {ran.stderr}")
    if ran.returncode:
        continue
    found = json.loads(ran.stdout)
    lines = lines_of(scratch / f"{name}.frf.csv")
    expect(all(c >= 0.5 for *_, c in lines), f"{name}: coherence of what is kept")
    sure = [(f, complex(re, im)) for f, re, im, c in lines if c > 0.95 and 3 < f < 350 and abs(f - mode_Hz) > 8]
    off = sorted(abs(g / exact(f) - 1) for f, g in sure)
    middle = off[len(off) // 2] if off else math.inf
    expect(len(sure) > 100 and middle < within, f"{name}: {len(sure)} coherent lines, off by {middle:.4f} in the middle, {off[-1] if off else 0:.3f} at most")
    expect(("command to position" in " ".join(found["notes"])) == resting, f"{name}: notes {found['notes']}")
    again = run("--frf", scratch / f"{name}.frf.csv")
    expect(again.returncode == 0, f"{name}: --frf of what --write-frf wrote: {again.stderr}")
    if again.returncode == 0:
        a, b = (x["axes"]["x"]["measured"] for x in (found, json.loads(again.stdout)))
        same = a.get("proposed_control", a.get("no_gains")), b.get("proposed_control", b.get("no_gains"))
        expect(same[0] == same[1], f"{name}: the same proposal: {same}")
    if not resting:
        notch = found["axes"]["x"]["measured"].get("proposed_control", {}).get("notch")
        expect(notch is None or abs(notch["frequency_Hz"] - mode_Hz) < 5, f"{name}: a notch, if there is one, stands at the mode of {mode_Hz} Hz: {notch}")

quiet = scratch / "quiet.csv"
short = scratch / "short.csv"
short.write_text("".join(line + "\n" for line in quiet.read_text().split("\n")[:400]))
other = log("other.csv", 1e-9, samples=6000, period=2 * T)
still = scratch / "still.csv"
seed = random.Random(3)  # position and command have nothing to do with each other
still.write_text("t_s,x_ref_m,x_pos_m,x_cmd_V\n" + "".join(f"{k * T:.6f},0.1,{0.1 + seed.gauss(0, 1e-6):.9f},{seed.gauss(0, 1):.6f}\n" for k in range(6000)))
for options, words in (
    (["--chirp", short], "short.csv: holds 399 samples: a response needs 512 or more"),
    (["--chirp", other], "other.csv: t_s: a sample lasts 0.002 s, the servo period of the machine is 0.001 s"),
    (["--chirp", still], "still.csv: "),
    (["--chirp", quiet, "--frf", scratch / "quiet.frf.csv"], "--chirp and --frf say the same"),
    (["--write-frf", scratch / "none.csv"], "--write-frf needs --chirp"),
    (["--chirp", quiet, "--write-frf", quiet], "would destroy what --chirp reads"),
):
    ran = run(*options)
    expect(ran.returncode == 2 and ran.stderr.count("\n") == 1 and words in ran.stderr, f"refused: {words}: {ran.stderr}")
sys.exit(1 if faults else 0)
