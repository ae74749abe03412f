#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-gap circle as it is used: a ball-bar's files, servo logs, bad files.
usage: program.py PROGRAM SCRATCH"""
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys

program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def run(*arguments, code=0):
    done = subprocess.run([program, "circle", *map(str, arguments)], cwd=scratch, capture_output=True, text=True)
    check(done.returncode == code, f"{arguments} ends with {done.returncode}: {done.stdout}{done.stderr}")
    return done.stdout if code == 0 else done.stderr


def ball_bar(name, radius, runs):
    """A machine out of square by 100 um/m whose x has 6 um of play and lags 0.3 ms behind y; the centre is off."""
    dice, rows = random.Random(3), []
    for feed, turning in runs:
        table = None
        for k in range(-200, int(2.6 * math.pi * radius / feed / 0.004)):
            a = 0.5 + turning * feed / radius * k * 0.004
            x, y = radius * math.cos(a - turning * feed / radius * 6e-4), radius * math.sin(a - turning * feed / radius * 3e-4)
            table = x if table is None else min(max(table, x - 3e-6), x + 3e-6)
            if k >= 0:
                place = table - 1e-4 * y + 12e-6, y - 7e-6
                rows.append((math.degrees(math.atan2(place[1], place[0])), math.hypot(*place) + dice.gauss(0, 2e-7)))
    (scratch / name).write_text("t_s,angle_deg,radius_m,nominal_radius_m\n" + "".join(
        f"{0.004 * k:.3f},{angle:.4f},{r:.7f},{radius}\n" for k, (angle, r) in enumerate(rows)))


def servo_log(name, feeds, kv=(50, 52)):
    """Two position loops without feedforward, seen by their encoders: circles both ways with a rest between."""
    period, place, rows = 1e-3, None, []
    for feed in feeds:
        for turning in (1, -1):
            for k in range(-300, int(2.2 * math.pi * 0.03 / feed / period)):
                a = turning * max(k, 0) * feed / 0.03 * period
                reference = 0.03 * math.cos(a), 0.03 * math.sin(a)
                place = place or list(reference)
                for i in (0, 1):
                    place[i] += (1 - math.exp(-kv[i] * period)) * (reference[i] - place[i])
                rows.append((*reference, *place))
    (scratch / name).write_text("t_s,x_ref_m,y_ref_m,x_pos_m,y_pos_m,x_cmd_V,y_cmd_V\n" + "".join(
        f"{period * k:.3f},{a:.7f},{b:.7f},{c:.7f},{d:.7f},0.{k % 7},0\n" for k, (a, b, c, d) in enumerate(rows)))


ball_bar("slow.csv", 0.1, [(0.03, 1), (0.03, -1)])
ball_bar("fast.csv", 0.1, [(0.06, 1), (0.06, -1)])
said = run("--log", "slow.csv", "--log", "fast.csv", "--json", "bar.json", "--report", "bar.html", "--verbose")
for words in ("servo mismatch", "0.300 ms", "squareness", "backlash x", "stick slip"):
    check(words in said, f"'{words}' is not said: {said}")
bar = json.loads((scratch / "bar.json").read_text())
found = {e["error"] + e["axis"]: e for e in bar["errors"] if e["verdict"] == "found"}
check(list(found) == ["servo_mismatch", "squareness", "backlashx"], f"found are {list(found)}")
for name, truth in (("servo_mismatch", 3e-4), ("squareness", 1e-4), ("backlashx", 6e-6)):
    low, high = found[name]["ci95"]
    check(low <= truth <= high, f"{name}: {found[name]['value']}, not {truth}")
check(abs(sum(e["share"] for e in found.values()) - 1) < 1e-9, "the shares do not add up to 1")
check(run("--log", "slow.csv", "--quiet") == "", "--quiet is not quiet")

servo_log("log.csv", (0.05, 0.1))
run("--log", "log.csv", "--json", "log.json", "--quiet")
log = json.loads((scratch / "log.json").read_text())
check(log["source"] == "encoder" and [r["direction"] for r in log["runs"]] == ["counterclockwise", "clockwise"] * 2,
      f"the runs are {log['runs']}")
found = [e["error"] for e in log["errors"] if e["verdict"] == "found"]
check(set(found) == {"radius_change", "servo_mismatch", "amplitude_mismatch"}, f"found in the log: {found}")
lag = next(e for e in log["errors"] if e["error"] == "servo_mismatch")
check(abs(lag["value"] / (1 / 50 - 1 / 52) - 1) < 0.05, f"servo mismatch {lag['value']}")
hidden = [e["error"] for e in log["errors"] if e["verdict"] == "not_visible"]
check("squareness" in hidden and "scale_mismatch" in hidden, f"not visible: {hidden}")

excluding = {"schema": "quadrant.machine/1", "sample_period_s": 0.001, "excluded_effects": ["backlash"],
             "axes": {"x": {"plant": {"mass_kg": 1, "force_constant_N_per_V": 1}}}}
(scratch / "direct.json").write_text(json.dumps(excluding))
said = run("--log", "slow.csv", "--machine", "direct.json")
check("backlash" not in said and "reversal lag x" in said, f"an excluded effect is blamed: {said}")

text = (scratch / "slow.csv").read_text().splitlines()
(scratch / "nan.csv").write_text("\n".join(text[:200] + [text[200].replace("0.1", "nan", 1)] + text[201:]))
(scratch / "short.csv").write_text("\n".join(text[:900]))
(scratch / "line.csv").write_text("t_s,x_ref_m,x_pos_m,x_cmd_V\n" + "".join(f"{k * 1e-3:.3f},{k},{k},0\n" for k in range(99)))
for files, words in ((["none.csv"], "none.csv: no such file"), (["nan.csv"], "nan.csv:201:"), (["short.csv"], "no whole turn"),
                     (["line.csv"], "line.csv: a circle needs two axes"), (["slow.csv", "log.csv"], "of another kind"),
                     (["slow.csv", "--machine", "none.json"], "none.json: no such file")):
    files = ["--log", files[0], *(files[1:] if files[1:2] == ["--machine"] else sum((["--log", f] for f in files[1:]), []))]
    said = run(*files, "--json", "out.json", "--report", "out.html", code=2)
    check(words in said and said.count("\n") == 1, f"{files} says {said}, not '{words}'")
    check(not list(scratch.glob("out.*")), f"{files}: something was written")
print("ok")
