#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-cnc tune on the x axis of the mill from the three starts of [Yeung2006] Table 9: where it ends, what it writes, what it says of the
gains that it wrote, its schema and page, and what is refused. tune.py PROGRAM SCRATCH"""
import copy
import json
import pathlib
import subprocess
import sys

from analyse import expect, faults, mill

program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
scratch.mkdir(parents=True, exist_ok=True)
root = pathlib.Path(__file__).resolve().parents[2]


def machine(name, gain, adaptation):
    m = copy.deepcopy(mill)
    m["axes"]["x"]["control"] = {"law": "sliding_mode", "sliding_per_s": 200, "gain_V_s_per_m": gain, "adaptation_V_per_m": adaptation}
    (scratch / name).write_text(json.dumps(m, indent=2))
    return scratch / name


def run(*options):
    return subprocess.run([program, "tune", *options], capture_output=True, text=True)


try:
    import jsonschema
    schema = jsonschema.Draft202012Validator(json.loads((root / "docs/schema/cnc_tuning.schema.json").read_text()))
except ImportError:
    schema = None

# Printed: Ks 0.363, 0.315, 0.269 V s/mm and rho 47.16, 39.12, 37.16 V/mm; threshold and scale of the oscillation are not, so ranges are asked.
for name, gain, adaptation in (("noisy", 1e3, 100e3), ("sluggish", 10, 1e3), ("unstable", 10e3, 10000e3)):
    file, out = machine(f"{name}.json", gain, adaptation), scratch / f"{name}.tuned.json"
    ran = run("--cnc", file, "--axis", "x", "--out", out, "--json", scratch / f"{name}.trials.json", "--report", scratch / f"{name}.html")
    expect(ran.returncode == 0, f"{name}: {ran.stderr}")
    if ran.returncode:
        continue
    told = json.loads((scratch / f"{name}.trials.json").read_text())
    if schema:
        faults.extend(f"{name}: {e.message}" for e in schema.iter_errors(told))
    axis = told["axes"]["x"]
    first, last = axis["trials"][0], axis["trials"][-1]
    expect(axis["settled"] and first["gain_V_s_per_m"] == gain and first["adaptation_V_per_m"] == adaptation, f"{name}: begins where the file does")
    expect(("phase_margin_deg" in first) == (name != "unstable"), f"{name}: an unstable loop has no phase margin")
    expect(200 <= last["gain_V_s_per_m"] <= 400 and 30e3 <= last["adaptation_V_per_m"] <= 50e3, f"{name}: ends at {last}")
    expect(9e-6 < last["tracking_error_m"] < 16e-6, f"{name}: error {last['tracking_error_m']}")
    # Written back: only the two gains differ, and the tuner has nothing to say against them.
    before, after = json.loads(file.read_text()), json.loads(out.read_text())
    control = after["axes"]["x"]["control"]
    expect(control["gain_V_s_per_m"] == last["gain_V_s_per_m"] and control["adaptation_V_per_m"] == last["adaptation_V_per_m"], f"{name}: gains written")
    for key in ("gain_V_s_per_m", "adaptation_V_per_m"):
        before["axes"]["x"]["control"].pop(key), control.pop(key)
    expect(before == after, f"{name}: nothing else is changed")
    again = run("--cnc", out, "--axis", "x", "--json")
    expect(again.returncode == 0 and len(json.loads(again.stdout)["axes"]["x"]["trials"]) == 1, f"{name}: tuned gains stay")
    # The same stroke as a part program has the error that the trial had.
    (scratch / "stroke.nc").write_text("G21 G61 G1 X100 F12000\nX0\n")
    ran = subprocess.run([program, "run", "--cnc", out, "--path", scratch / "stroke.nc", "--json"], capture_output=True, text=True)
    error = json.loads(ran.stdout)["axes"]["x"]["error_max_m"]
    expect(0.8 < error / last["tracking_error_m"] < 1.2, f"{name}: run has {error}, the trial {last['tracking_error_m']}")

mended = machine("good.json", 300, 30e3)
for options, words in (
    (["--cnc", root / "examples/programs/quadrant_cnc/mill.json"], "axes.x.control.law: the rules tune sliding_mode, not pid"),
    (["--cnc", mended, "--axis", "x", "--distance", "2"], "axes.x.travel_m: holds no stroke of 2 m"),
    (["--cnc", mended, "--axis", "w"], "axes: has no axis w; it has x, y, z"),
    (["--cnc", mended, "--axis", "x", "--threshold", "600"], "--threshold 600 Hz must be below half the servo rate (500 Hz)"),
    (["--cnc", mended, "--axis", "x", "--out", mended], "would destroy what --cnc reads"),
    (["--cnc", machine("far.json", 10, 1e3), "--axis", "x", "--trials", "2", "--out", scratch / "never.json"], "the rules still ask for a change after 2 trials"),
    (["--cnc", machine("zero.json", 0, 1e3), "--axis", "x"], "axes.x.control: tune.gain = 0"),
):
    ran = run(*options)
    expect(ran.returncode == 2 and ran.stderr.count("\n") == 1 and words in ran.stderr, f"refused: {words}: {ran.stderr}")
expect(not (scratch / "never.json").exists(), "gains that did not settle are not written")
sys.exit(1 if faults else 0)
