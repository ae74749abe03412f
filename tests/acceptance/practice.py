#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-gap on practice logs, simulated by code that shares nothing with the library: those that practice_set.py writes, or those of
SHARED/gap/practice. A log must be explained by its effects, first and alone; one whose effect is in no list must end without a claim.
usage: practice.py PROGRAM FOLDER     the folder with truth.json, or SHARED; exit code 77: the logs are not there"""
import json, os, subprocess, sys, tempfile
from concurrent.futures import ThreadPoolExecutor

def diagnose_log(program, folder, more):
    with tempfile.TemporaryDirectory() as out:
        path = os.path.join(out, "d.json")
        run = subprocess.run([program, "diagnose", "--quiet", "--machine", f"{folder}/machine.json", "--log",
                              f"{folder}/log.csv", "--json", path, *more], capture_output=True, text=True, timeout=300)
        if run.returncode != 0:
            return None, run.stderr.strip()
        with open(path) as f:
            return json.load(f), ""


def complaint(truth, d):
    names = [c["effect"] for c in d["causes"]]
    claims = [c["effect"] for c in d["causes"] if c["probability"] >= 0.5]
    want = [] if truth["kind"] == "none" else truth["truth"].split("+")
    if truth["kind"] == "none":
        return "" if d["verdict"] == "within_tolerance" and not claims else f"{d['verdict']}, claims {claims}"
    if truth["kind"] == "unknown":
        good = d["verdict"] in ("partly_explained", "unexplained") and not claims
        return "" if good else f"{d['verdict']}, claims {claims} for what is in no list"
    allowed = [{w} | set(truth["accept"]) for w in want]
    good = (d["verdict"] == "explained" and len(claims) == len(want) and names[: len(want)] == claims
            and all(any(n in a for n in claims) for a in allowed))
    return "" if good else f"{d['verdict']}, claims {claims}, wanted {want}"


def main(program, folder):
    own = os.path.isfile(os.path.join(folder, "truth.json"))
    practice = folder if own else os.path.join(folder, "gap", "practice")
    if not os.path.isdir(practice):
        print(f"SKIPPED: no {practice}")
        return 77
    with open(os.path.join(practice, "truth.json")) as f:
        truth = json.load(f)
    if not own and os.environ.get("QUADRANT_TESTS") != "all":  # three minutes of CPU for all of them
        truth = {i: truth[i] for i in sorted(truth) if i in sorted(truth)[2::3] or truth[i]["kind"] == "unknown"}
        print("every third log and what is in no list; all with QUADRANT_TESTS=all, as in `sh tests/run.sh all`")
    with ThreadPoolExecutor(2) as pool:
        results = list(pool.map(lambda i: diagnose_log(program, f"{practice}/{i}", ["--holdout", f"{practice}/{i}/holdout.csv"]), sorted(truth)))
    bad = 0
    for i, (d, error) in zip(sorted(truth), results):
        wrong = error if d is None else complaint(truth[i], d)
        bad += bool(wrong)
        print(f"{i} {truth[i]['truth']}: {wrong or 'ok'}")
    print(f"{len(truth) - bad} of {len(truth)} as they should be")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
