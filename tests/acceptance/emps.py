#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-gap on a real positioning axis: the EMPS benchmark record [Janot2019], read in place from ../shared/data/emps.
usage: emps.py PROGRAM SHARED     exit code 77: the record is not there"""
import os, sys
from practice import diagnose_log


def check(d):
    from_to = d["axes"]["x"]["gap"]["force_rms_N"], d["axes"]["x"]["gap_after"]["force_rms_N"]
    first, second = d["causes"][0], d["causes"][1]
    low, high = first["parameters"]["coulomb_N"]["ci95"]
    group = {second["effect"], *second["confusable_with"]}
    read = {second["effect"], *(r["effect"] for r in second["readings"])}
    both = {"constant_force", "asymmetric_friction"}
    yield first["effect"] == "coulomb_friction", f"the first cause is {first['effect']}"
    yield first["probability"] >= 0.5, f"claimed at {first['probability']:.2f}"
    # A quarter of the value: the interval carries a model error as large as what is left beside the friction.
    yield low <= 20.4 <= high and high - low <= 5, f"Coulomb friction {low:.2f} to {high:.2f} N (published: 20.39)"
    yield group == both and read == both, f"the second is the group {sorted(group)} with readings {sorted(read)}"
    yield 19.7 <= from_to[0] <= 21.7, f"force gap before {from_to[0]:.2f} N rms (published: 20.7)"
    yield second["gap_after_force_rms_N"] < 2.5, f"after the two, held out: {second['gap_after_force_rms_N']:.2f} N"


def main(program, shared):
    record = os.path.join(shared, "data", "emps")
    if not os.path.isdir(record):
        print(f"SKIPPED: no {record} (the benchmark: nonlinearbenchmark.org, EMPS)")
        return 77
    d, error = diagnose_log(program, record, [])
    if d is None:
        print(error)
        return 1
    results = list(check(d))
    for good, text in results:
        print("ok  " if good else "BAD ", text)
    return 0 if all(good for good, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
