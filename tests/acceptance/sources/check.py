#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Logs of the sources' machines, made by the library's own blocks, beside machine files that describe the same machines:
no gap, or one within the tolerances, and no cause at 0.5 or above. On a table whose y axis has a third more friction
than its file, friction of y is named, and the corrected file predicts the error at the reversals within 20 %.
usage: check.py SOURCE_LOGS QUADRANT_GAP FOLDER [NAME...]
NAME: these cases instead of the default ones, which are two, or all with QUADRANT_TESTS=all"""
import json, os, subprocess, sys
from concurrent.futures import ThreadPoolExecutor
from fnmatch import fnmatch

FRICTION = {"coulomb_friction", "stribeck_friction"}
DEFAULT = ("table.raised.attraction.sine100", "cnc.diamond")

# What is not as it should be, and why. A case of these that is as it should be fails the check: its line then goes.
NOT_YET = {
    # y, 100 mm/s, friction that reaches its level at once: the force is at its floor (0.87 N), one band is not
    "table.cascade.no_bound.sine100": "a delay 0.1 ms below the file's is claimed at 0.64, though nothing differs",
    # LuGre's contact beside the file's single spring: 0.1 um in means of 22 ms at the reversals, where a count is 1 um
    "stage.direct.bs3800": "unexplained, though the force gap (41 mN) lies below its floor (48 mN)",
}


def run(*words):
    done = subprocess.run(words, capture_output=True, text=True, timeout=900)
    if done.returncode != 0:
        raise RuntimeError(done.stderr.strip() or f"exit code {done.returncode}")
    return done.stdout


def claims(found):
    sure = [c for c in found["causes"] if c["probability"] >= 0.5]
    return [(c["axis"], c["effect"], round(c["probability"], 2)) for c in sure]


def equal_machine(found):
    """The machine file is equal to the machine."""
    if found["verdict"] not in ("no_gap", "within_tolerance") or claims(found):
        return f"{found['verdict']}, claims {claims(found)}"


def raised_friction(found, logs, gap, folder):
    """The machine's y axis has a third more Coulomb and static friction than its file."""
    named = claims(found)
    if not any(axis == "y" and effect in FRICTION for axis, effect, _ in named):
        return f"friction of y is not named: {found['verdict']}, claims {named}"
    if any(axis != "y" or effect not in FRICTION for axis, effect, _ in named):
        return f"more than friction of y is named: {named}"
    run(gap, "apply", "--machine", f"{folder}/machine.json", "--diagnosis", f"{folder}/found.json",
        "--out", f"{folder}/corrected.json")
    error = json.loads(run(logs, "reversals", f"{folder}/corrected.json", f"{folder}/log.csv"))["y"]
    ratio = error["simulated_m"] / error["log_m"]
    logged, simulated = (1e6 * error[key] for key in ("log_m", "simulated_m"))
    print(f"    reversals of y: log {logged:.2f} um, corrected file {simulated:.2f} um")
    if not 0.8 <= ratio <= 1.2:
        return f"the corrected file predicts {ratio:.2f} of the error at the reversals"


def judge(logs, gap, scratch, name):
    folder = f"{scratch}/{name}"
    try:
        run(logs, "make", scratch, name)
        run(gap, "diagnose", "--quiet", "--machine", f"{folder}/machine.json", "--log", f"{folder}/log.csv",
            "--json", f"{folder}/found.json")
        with open(f"{folder}/found.json") as f:
            found = json.load(f)
        raised = name.startswith("table.raised")
        return raised_friction(found, logs, gap, folder) if raised else equal_machine(found)
    except RuntimeError as e:
        return str(e)


def main(logs, gap, scratch, *names):
    names = names or (run(logs, "list").split() if os.environ.get("QUADRANT_TESTS") == "all" else DEFAULT)
    with ThreadPoolExecutor(int(os.environ.get("JOBS", "2"))) as pool:
        results = list(pool.map(lambda name: judge(logs, gap, scratch, name), names))
    bad = 0
    for name, wrong in zip(names, results):
        why = next((why for pattern, why in NOT_YET.items() if fnmatch(name, pattern)), None)
        if why and wrong:
            print(f"{name}: not yet ({why}): {wrong}")
        else:
            bad += bool(why) or wrong is not None
            print(f"{name}: {'is as it should be, but stands under NOT_YET' if why else wrong or 'ok'}")
    print(f"{len(results) - bad} of {len(results)} as they should be")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
