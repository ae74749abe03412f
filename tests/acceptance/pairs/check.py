#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Pairs of simulated sisters, compared (make_pairs.cpp): of those that differ by one effect this is named,
and nothing else; of those that are equal nothing is named. A name counts as right where it is that of a difference,
or one that the comparison calls confusable with it. Beside a force in no list the difference may stay without a
name, but not get a wrong one.
usage: check.py PAIR_LOGS QUADRANT_GAP FOLDER [SEED [NUMBER...]]
NUMBER: 0 to 29 differ, 30 to 59 are equal, 60 to 69 differ beside a force in no list; default six of each of the
first two, every third with QUADRANT_TESTS=all, all with "every" (40 minutes of processor time). Passes where nine of ten of those that differ are right, no equal pair is
blamed, and none of the last gets a wrong name.
"""
import json, os, subprocess, sys, time
from concurrent.futures import ThreadPoolExecutor

DEFAULT = [0, 1, 2, 3, 12, 14, 30, 31, 33, 35, 36, 37]
pair_logs, gap, folder = sys.argv[1:4]
seed = sys.argv[4] if len(sys.argv) > 4 else "1"
every = sys.argv[5:] == ["every"]
numbers = list(range(70)) if every else [int(n) for n in sys.argv[5:]]
if not numbers:
    numbers = list(range(1, 70, 3)) if os.environ.get("QUADRANT_TESTS") == "all" else DEFAULT


def one(number):
    here = os.path.join(folder, str(number))
    os.makedirs(here, exist_ok=True)
    subprocess.run([pair_logs, here, seed, str(number)], check=True)
    with open(f"{here}/truth.json") as file:
        truth = json.load(file)[0]
    files = os.path.join(here, str(number))
    began = time.time()
    done = subprocess.run(
        [gap, "compare", f"{files}/a.csv", f"{files}/b.csv", "--machine", f"{files}/machine.json", "--quiet",
         "--threads", "1", "--json", f"{here}/comparison.json"], capture_output=True, text=True)
    if done.returncode:
        return truth, None, done.stderr.strip() or f"exit code {done.returncode}", time.time() - began
    with open(f"{here}/comparison.json") as file:
        return truth, json.load(file), "", time.time() - began


def said(found):
    return ["/".join([d["effect"], *d["confusable_with"]]) + f" {d['probability']:.2f} in {d['found_in']}"
            for d in found["differences"]]


kinds = ("differ", "equal", "beside a force in no list")
right, asked, wrong = ({kind: 0 for kind in kinds} for _ in range(3))
with ThreadPoolExecutor(os.cpu_count()) as pool:
    for truth, found, error, seconds in pool.map(one, numbers):
        kind = kinds[truth["number"] // 30]
        asked[kind] += 1
        names = [{d["effect"], *d["confusable_with"]} for d in found["differences"]] if found else []
        fine = found is not None and (len(names) == 1 and truth["effect"] in names[0] if truth["effect"] else not names)
        right[kind] += fine
        wrong[kind] += sum(truth["effect"] not in name for name in names)
        open_names = [d["effect"] for d in found["undecided"]] if found else []
        print(f"{truth['number']:3} {'right    ' if fine else 'NOT RIGHT'} {truth['effect'] or 'equal'} "
              f"({truth['size']:.1f}, {truth['in']}), both: {truth['common'] or 'nothing'}: "
              f"{error or found['likeness']} {said(found) if found else ''} undecided {open_names} {seconds:.0f} s",
              flush=True)
for kind in kinds:
    print(f"{kind}: {right[kind]} of {asked[kind]} right, {wrong[kind]} wrong names")
sys.exit(right["differ"] < 0.9 * asked["differ"] or right["equal"] < asked["equal"] or wrong[kinds[2]] > 0)
