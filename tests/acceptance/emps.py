#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""quadrant-gap on a real positioning axis: the EMPS benchmark record [Janot2019], read in place from ../shared/data/emps.
usage: emps.py PROGRAM SHARED     exit code 77: the record is not there"""
import csv, json, math, os, subprocess, sys, tempfile
from practice import diagnose_log


def free_simulation(plant, rows):
    """rms [m], from row 20 on, of force to position with nothing fed back: from the recorded start, in steps of 0.05 ms."""
    t, _, measured, command = zip(*rows)
    step, a_row = (t[-1] - t[0]) / (len(t) - 1) / 20, 20
    mass, gain, viscous = plant["mass_kg"], plant["force_constant_N_per_V"], plant["viscous_N_s_per_m"]
    coulomb, offset = plant.get("coulomb_N", 0), plant.get("constant_force_N", 0)
    turns = plant.get("viscous_asymmetry", 0), plant.get("coulomb_asymmetry", 0)
    x, v = measured[0], (measured[20] - measured[0]) / (t[20] - t[0])
    error = 0
    for k, (y, u) in enumerate(zip(measured, command)):
        if k >= 20:
            error += (x - y) ** 2
        push = gain * u + offset
        for _ in range(a_row):
            v += step * (push - viscous * (1 + (turns[0] if v > 0 else -turns[0])) * v) / mass
            stop = step * coulomb * (1 + (turns[1] if v > 0 else -turns[1])) / mass
            v = 0 if abs(v) <= stop else v - math.copysign(stop, v)
            x += step * v
    return math.sqrt(error / (len(t) - 20))


def claims_alone(program, record, d):
    """The plant that apply writes: with the claims and without the suspects."""
    with tempfile.TemporaryDirectory() as out:
        said, better = os.path.join(out, "d.json"), os.path.join(out, "m.json")
        with open(said, "w") as f:
            json.dump(d, f)
        subprocess.run([program, "apply", "--machine", f"{record}/machine.json", "--diagnosis", said, "--out", better],
                       check=True, capture_output=True)
        with open(better) as f:
            return json.load(f)["axes"]["x"]["plant"]


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
    yield second["group_probability"] >= 0.5, f"the group is claimed at {second['group_probability']:.2f}"
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
    with open(f"{record}/log.csv") as f:
        rows = [[float(cell) for cell in row] for row in list(csv.reader(f))[1:]]
    rms = free_simulation(claims_alone(program, record, d), rows)
    results.append((rms <= 0.015, f"free simulation with the claims alone: {1e3 * rms:.1f} mm rms (asked: 15 at most)"))
    for good, text in results:
        print("ok  " if good else "BAD ", text)
    return 0 if all(good for good, _ in results) else 1


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
