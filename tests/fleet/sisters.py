#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Who differs from its sisters, and by what: diagnoses with known differences, written by a program in the place of quadrant-gap.
usage: sisters.py QUADRANT_GAP FOLDER"""
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
stub = folder / "stub.py"
stub.write_text(f"""#!{sys.executable}
import sys, pathlib
words = dict(zip(sys.argv[2::2], sys.argv[3::2])) if "--quiet" not in sys.argv else dict(zip(
    [w for w in sys.argv[2:] if w != "--quiet"][::2], [w for w in sys.argv[2:] if w != "--quiet"][1::2]))
log = pathlib.Path(words["--log"])
pathlib.Path(words["--json"]).write_text(log.read_text())
pathlib.Path(words["--report"]).write_text("<!doctype html></html>")
""")
stub.chmod(0o755)
bad = 0


def expect(good, what):
    global bad
    bad += not good
    print("ok  " if good else "BAD ", what)


def cause(effect, key, value, half, before, after, probability=0.97, rotary=False):
    force = "torque_rms_Nm" if rotary else "force_rms_N"
    return {"axis": "x", "effect": effect, "probability": probability, "group_probability": probability, "confusable_with": [],
            "shrink": 0.5, "parameters": {key: {"value": value, "ci95": [value - half, value + half]}},
            f"gap_before_{force}": before, f"gap_after_{force}": after}


def diagnosis(causes, machine="a" * 64, rotary=False):
    force, position = ("torque_rms_Nm", "position_rms_rad") if rotary else ("force_rms_N", "position_rms_m")
    gap = {force: 30, "noise_floor_" + force: 2, position: 1e-6}
    return {"verdict": "explained", "causes": causes, "files": {"machine": {"name": "m", "sha256": machine}},
            "axes": {"x": {"kind": "rotary" if rotary else "linear", "gap": gap, "gap_after": gap}}}


def run(name, logs):
    """What the terminal ranks, and the rows of the overview's table."""
    here = folder / name
    here.mkdir()
    (here / "machine.json").write_text("{}")
    for log, text in logs.items():
        (here / f"{log}.log.csv").write_text(json.dumps(text))
    done = subprocess.run([program, "fleet", here, "--program", stub, "--jobs", "2"], capture_output=True, text=True, timeout=60)
    if done.returncode:
        sys.exit(f"{name}: {done.stdout}{done.stderr}")
    told = done.stdout.split("Different from their sisters:\n")
    page = (here / "diagnosed/fleet.html").read_text()
    section = re.search(r'<section id="sisters">.*?</section>', page, re.S)
    rows = re.findall(r"<tr><th scope=\"row\">.*?</tr>", section[0], re.S) if section else []
    return [line.strip() for line in told[1].splitlines()] if len(told) > 1 else [], [
        re.sub(r"<[^>]+>", "|", r) for r in rows], section is not None


friction = lambda value: cause("coulomb_friction", "coulomb_N", value, 2, 30, 10)
alike = {f"press{k}": diagnosis([friction(100 + k)]) for k in range(5)}

told, rows, there = run("alike", alike)
expect(there and told == [] and rows == [], f"what all have is no difference: {told}")

odd = dict(alike, press3=diagnosis([friction(103), cause("cogging", "cogging_N", 40, 1, 30, 10)]))
told, rows, _ = run("one_has_it", odd)
expect(told == ["press3: cogging, axis x: 40.0 N; sisters: none has it (28.3 N rms)"], f"one has an effect: {told}")
expect(len(rows) == 1 and "press3" in rows[0] and "Cogging" in rows[0], f"in the overview: {rows}")

odd = dict(alike, press1=diagnosis([friction(160)]))
told, rows, _ = run("another_value", odd)
expect(len(told) == 1 and told[0].startswith("press1: Coulomb friction, axis x: 160 N; sisters: 100 N to 104 N"), f"another value: {told}")

odd = dict(alike, press2=diagnosis([]))
told, rows, _ = run("lacks_it", odd)
expect(len(told) == 1 and told[0].startswith("press2: Coulomb friction, axis x: does not have it") and "4 of 4 have it" in told[0],
       f"one lacks what all have: {told}")

odd = dict(alike, press0=diagnosis([friction(100), cause("time_delay", "delay_s", 0.002, 1e-4, 10, 9)]),
           press4=diagnosis([friction(104), cause("cogging", "cogging_N", 40, 1, 30, 10)]))
told, rows, _ = run("ranked", odd)
expect([t.split(",")[0] for t in told] == ["press4: cogging", "press0: time delay"], f"the larger force first: {told}")
expect(len(rows) == 2 and "press4" in rows[0], "the same in the overview")

odd = dict(alike, press3=diagnosis([friction(103), cause("cogging", "cogging_N", 40, 1, 30, 10, probability=0.3)]))
expect(run("a_suspect", odd)[0] == [], "a suspect is no difference")
expect(run("inside", dict(alike, press1=diagnosis([friction(106)])))[0] == [], "a value inside their spread is no difference")
expect(run("too_small", dict(alike, press1=diagnosis([cause("coulomb_friction", "coulomb_N", 160, 2, 4, 3.5)])))[0] == [],
       "another value whose force drowns in the noise")
wide = {f"press{k}": diagnosis([friction(v)]) for k, v in enumerate((100, 104, 112, 118))}
expect(run("among_few", wide)[0] == [], "of few, no further off than they are from each other")
expect(not run("two", dict(list(odd.items())[:2]))[2], "of two nobody is odd")
other = dict(alike, press3=diagnosis([friction(300)], machine="b" * 64))
expect(run("another_file", other)[0] == [], "a machine with a file of its own is nobody's sister")
turning = {f"joint{k}": diagnosis([cause("coulomb_friction", "coulomb_Nm", 3 + 0.01 * k, 0.05, 3, 1, rotary=True)], rotary=True)
           for k in range(4)}
turning["joint2"] = diagnosis([cause("coulomb_friction", "coulomb_Nm", 6, 0.05, 6, 1, rotary=True)], rotary=True)
told, rows, _ = run("rotary", turning)
expect(len(told) == 1 and told[0].startswith("joint2: Coulomb friction, axis x: 6.0 N m"), f"a rotary axis: {told}")
sys.exit(bad > 0)
