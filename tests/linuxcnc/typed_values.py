#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Values for LinuxCNC's pid, from quadrant-gap compensate into the INI file of a machine, and what they do.
  typed_values.py describe UNTUNED        the machine file gets the pid of the INI file, and an owner who knows mass and friction badly
  typed_values.py type UNTUNED            FF1 and FF2 of the best compensation of each axis, as a script for sed
  typed_values.py compare UNTUNED TUNED   following error of the second record beside the forecast made of the first
"""
import csv
import json
import math
import pathlib
import sys

WITHIN = 0.15


def pid_of(ini, joint):
    values, here = {}, False
    for line in ini.read_text().splitlines():
        if line.startswith("["):
            here = line.strip() == f"[JOINT_{joint}]"
        elif here and " = " in line:
            key, value = line.split(" = ", 1)
            values[key] = value
    return {"kind": "linuxcnc_pid", "units_per_m": 1000, "Pgain": float(values["P"]), "Igain": float(values["I"]),
            "Dgain": float(values["D"]), "FF1": float(values["FF1"]), "FF2": float(values["FF2"]), "maxoutput": 10,
            "error-previous-target": False}


def describe(folder):
    path = folder / "machine.json"
    machine = json.loads(path.read_text())
    for joint, name in enumerate("xy"):
        axis = machine["axes"][name]
        axis["controller"] = pid_of(folder / "quadrant.ini", joint)
        axis["plant"]["mass_kg"] *= 0.8
        axis["plant"]["viscous_N_s_per_m"] *= 0.2
    path.write_text(json.dumps(machine, indent=2))


def best_of(folder):
    gained = json.loads((folder / "gained.json").read_text())
    for name, axis in gained["axes"].items():
        by_keys = [c for c in axis["compensations"] if c["claimed"] and c["controller"] and not c["block"] and not c["settings"]]
        yield name, axis["measured"], min(by_keys, key=lambda c: c["after"]["rms_m"]["value"])


def type_values(untuned):
    new = {name: best["controller"] for name, _, best in best_of(untuned)}
    where = {"x": r"/^\[JOINT_0\]/,/^\[JOINT_1\]/", "y": r"/^\[JOINT_1\]/,$"}
    print("; ".join(f"{where[name]}s/^{key} = .*/{key} = {keys.get(key, 0):.6g}/"
                    for name, keys in new.items() for key in ("FF1", "FF2")))


def compare(untuned, tuned):
    with open(tuned / "log.csv") as file:
        rows = list(csv.DictReader(file))
    holds = True
    for name, before, best in best_of(untuned):
        error = [float(r[name + "_ref_m"]) - float(r[name + "_pos_m"]) for r in rows]
        found = {"rms_m": math.sqrt(sum(e * e for e in error) / len(error)), "peak_m": max(map(abs, error))}
        for what, value in found.items():
            forecast = best["after"][what]["value"]
            near = abs(value / forecast - 1) <= WITHIN
            print(f"    {name} {what}: {1e6 * before[what]:.1f} um, forecast {1e6 * forecast:.1f}, found {1e6 * value:.1f}",
                  best["controller"], "" if near else "NOT WITHIN 15 %")
            holds = holds and near and value < before[what]
    sys.exit(0 if holds else 1)


folders = [pathlib.Path(p) for p in sys.argv[2:]]
{"describe": describe, "type": type_values, "compare": compare}[sys.argv[1]](*folders)
