#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Validates files against docs/schema with python3-jsonschema.
usage: schema_test.py [--practice DIR] [DIAGNOSIS.json ...]
Always: the schemas themselves, every machine file and log under examples/ and tests/, and small files that each schema
must refuse. With --practice: the machines and log headers of the practice set. Then every diagnosis that is given."""
import argparse
import copy
import csv
import json
import pathlib
import sys

import jsonschema

root = pathlib.Path(__file__).resolve().parents[2]
faults = []
checked = 0


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


def validator(name):
    schema = load(root / "docs" / "schema" / f"{name}.schema.json")
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def header(path):
    with open(path, encoding="utf-8-sig", newline="") as file:
        return [name.strip() for name in next(csv.reader(file), [])]


def accept(schema, value, name):
    global checked
    checked += 1
    for error in schema.iter_errors(value):
        faults.append(f"{name}: {'/'.join(map(str, error.absolute_path))}: {error.message}")


def refuse(schema, value, name):
    global checked
    checked += 1
    if schema.is_valid(value):
        faults.append(f"accepted, but must be refused: {name}")


def changed(value, path, to):
    """A copy with one value replaced; `to` is `...` to remove it."""
    out = copy.deepcopy(value)
    *way, last = path
    place = out
    for key in way:
        place = place[key]
    if to is ...:
        del place[last]
    else:
        place[last] = to
    return out


arguments = argparse.ArgumentParser()
arguments.add_argument("--practice", type=pathlib.Path)
arguments.add_argument("diagnoses", nargs="*", type=pathlib.Path)
given = arguments.parse_args()
machine, log, diagnosis = validator("machine"), validator("log"), validator("diagnosis")

for folder in (root / "examples", root / "tests"):
    for path in sorted(folder.rglob("*.json")):
        content = load(path)
        if isinstance(content, dict) and content.get("schema") == "quadrant.machine/1":
            accept(machine, content, path)
    for path in sorted(folder.rglob("*.csv")):
        if "t_s" in header(path):
            accept(log, header(path), path)

if given.practice and given.practice.is_dir():
    for path in sorted(given.practice.glob("*/machine.json")):
        accept(machine, load(path), path)
    for path in sorted(given.practice.glob("*/*.csv")):
        accept(log, header(path), path)
else:
    print(f"SKIPPED: the practice set: {given.practice or 'no --practice'} is not there", file=sys.stderr)

for path in given.diagnoses:
    accept(diagnosis, load(path), path)
if not given.diagnoses:
    print("SKIPPED: no diagnosis file was given", file=sys.stderr)

good_machine = {
    "schema": "quadrant.machine/1", "sample_period_s": 0.001, "excluded_effects": ["backlash"],
    "axes": {"x": {
        "plant": {"mass_kg": 1, "force_constant_N_per_V": 1, "static_N": 2, "stribeck_velocity_m_per_s": 0.01,
                  "cogging_period_m": 0.03, "cogging_N": [1, 2], "cogging_phase_rad": [0, 1]},
        "actuator": {"dac_bits": 16, "dac_range_V": 20},
        "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 1, "velocity_gain_V_s_per_m": 1,
                       "velocity_filter_Hz": 100, "notch": {"frequency_Hz": 300, "damping": 0.1}}}}}
x = ["axes", "x"]
accept(machine, good_machine, "the machine of this test")
accept(machine, changed(good_machine, x + ["controller"], {"kind": "vendor", "any": []}), "an unknown controller")
accept(machine, changed(changed(good_machine, x + ["controller", "velocity_estimator"], "two_sample_mean"),
                        x + ["controller", "velocity_filter_Hz"], ...), "two_sample_mean without a filter")
for path, to in [
        (["schema"], "quadrant.machine/2"), (["sample_period_s"], ...), (["sample_period_s"], 0), (["axes"], {}),
        (["excluded_effects"], ["gremlins"]), (["colour"], 1), (["axes"], {"a b": good_machine["axes"]["x"]}),
        (x + ["plant"], ...), (x + ["plant", "mass_kg"], ...), (x + ["plant", "mass_kg"], "1"),
        (x + ["plant", "mass_g"], 1), (x + ["plant", "force_constant_N_per_A"], 1), (x + ["plant", "delay_s"], 2),
        (x + ["plant", "stribeck_velocity_m_per_s"], ...), (x + ["plant", "cogging_period_m"], ...),
        (x + ["tolerance"], {"mass": -0.1}), (x + ["tolerance"], {"mass_kg": 0.1}), (x + ["encoder"], {"resolution_m": -1}),
        (x + ["actuator", "dac_range_V"], ...), (x + ["actuator", "dac_bits"], 15.5), (x + ["controller", "kind"], ...),
        (x + ["controller", "velocity_filter_Hz"], ...), (x + ["controller", "velocity_feedforward"], "1"),
        (x + ["controller", "gain"], 1), (x + ["controller", "notch", "damping"], ...)]:
    refuse(machine, changed(good_machine, path, to), f"machine with {'.'.join(path)} = {to}")

accept(log, ["x_cmd_V", "t_s", "note", "x_ref_m", "x_pos_m", "x_force_N"], "a log of this test")
for names in (["x_ref_m", "x_pos_m", "x_cmd_V", "a"], ["t_s", "x_pos_m", "x_cmd_V", "a"], ["t_s", "x_ref_m", "x_pos_m", "a"],
              ["t_s", "x_ref_m", "x_pos_m", "x_cmd_V", "x_pos_m"], ["t_s", "c_ref_rad", "c_pos_rad", "c_cmd_Nm"],
              ["t_s", "x_ref_m", "x_pos_m", "x_cmd_V", "x_cmd_A"], ["t_s", "x_ref_m", "x_pos_m", "x_cmd_V", "y_pos_m"]):
    refuse(log, names, f"log with columns {names}")

gap = dict.fromkeys(["position_rms_m", "position_peak_m", "command_rms_V", "force_rms_N", "noise_floor_force_rms_N",
                     "bandwidth_Hz"], 0)
good_diagnosis = {
    "schema": "quadrant.diagnosis/1", "verdict": "explained",
    "axes": {"x": {"verdict": "explained", "gap": gap, "where": [
        {"view": "block", "block": "mechanics", "finding": "", "share": 0.5, "basis": "causes"},
        {"view": "velocity", "finding": "", "share": 0.5}]}},
    "causes": [{"axis": "x", "effect": "cogging", "probability": 1, "group_probability": 1, "confusable_with": [],
                "parameters": {"cogging_period_m": {"value": 0.03, "ci95": [0.02, 0.04]},
                               "cogging_N": {"value": [1, 2], "ci95": [[0, 2], [1, 3]]}},
                "gap_before_force_rms_N": 1, "gap_after_force_rms_N": 0, "gap_before_position_rms_m": 0,
                "gap_after_position_rms_m": 0, "shrink": 0.9, "shrink_ci95": [0.8, 1]}],
    "remaining": {"share_of_gap_unexplained": 0, "structure": ""},
    "next_experiment": {"motion": "", "separates": [], "expected_gain": 0}}
accept(diagnosis, good_diagnosis, "the diagnosis of this test")
for path, to in [
        (["verdict"], "perhaps"), (["verdict"], "no_gap"), (["axes", "x", "gap", "bandwidth_Hz"], ...),
        (["axes", "x", "where", 0, "basis"], ...), (["axes", "x", "where", 1, "block"], "mechanics"),
        (["axes", "x", "where", 1, "share"], 1.5), (["causes", 0, "probability"], None), (["causes", 0, "shrink"], 1.1),
        (["causes", 0, "effect"], "gremlins"), (["causes", 0, "parameters", "cogging_N", "ci95"], [0, 2]),
        (["causes", 0, "parameters", "cogging_period_m", "value"], [0.03]), (["remaining", "structure"], ...),
        (["next_experiment"], ...), (["colour"], 1)]:
    refuse(diagnosis, changed(good_diagnosis, path, to), f"diagnosis with {path} = {to}")

for fault in faults:
    print(fault, file=sys.stderr)
print(f"{checked} checked, {len(faults)} faults")
sys.exit(1 if faults else 0)
