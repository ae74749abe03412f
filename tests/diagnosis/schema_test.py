#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
# Long: a list of files that each schema must take or refuse.
"""Validates files against docs/schema with python3-jsonschema.
usage: schema_test.py [--practice DIR] [--simulation FILE ...] [--forecast FILE ...] [--circle FILE ...] [--compensation FILE ...]
                      [--comparison FILE ...] [DIAGNOSIS.json ...]
Always: the schemas themselves, every machine file, map, diagnosis and log under examples/ and tests/, and small files that each schema
must refuse. With --practice: the machines and log headers of the practice set. Then every diagnosis that is given."""
import argparse
import copy
import csv
import json
import pathlib
import re
import sys

import jsonschema

root = pathlib.Path(__file__).resolve().parents[2]
faults = []
checked = 0


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


def validator(name):
    folder = root / "docs" / "schema"
    schema = load(folder / f"{name}.schema.json")
    jsonschema.Draft202012Validator.check_schema(schema)
    # A reference to another schema of the folder is a file beside it.
    resolver = jsonschema.RefResolver((folder / "here").as_uri(), schema)
    return jsonschema.Draft202012Validator(schema, resolver=resolver)


def keys_of_the_reader():
    """Box of the machine file -> keys of the controller that read/machine_keys.hpp knows. Those of effects are generated (docs.effects)."""
    text = (root / "include/quadrant/diagnosis/machine_file/machine_keys.hpp").read_text(encoding="utf-8")
    tables = {}
    return {box: {key for table in names for key in re.findall(r'"(\w+)"', re.search(rf"\b{table}\{{(.*?)\n?\}};", text, re.S)[1])}
            for box, names in tables.items()}


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
arguments.add_argument("--simulation", type=pathlib.Path, action="append", default=[])
arguments.add_argument("--forecast", type=pathlib.Path, action="append", default=[])
arguments.add_argument("--circle", type=pathlib.Path, action="append", default=[])
arguments.add_argument("--compensation", type=pathlib.Path, action="append", default=[])
arguments.add_argument("--comparison", type=pathlib.Path, action="append", default=[])
arguments.add_argument("diagnoses", nargs="*", type=pathlib.Path)
given = arguments.parse_args()
machine, log, diagnosis, simulation, forecast, import_map = map(
    validator, ("machine", "log", "diagnosis", "simulation", "forecast", "import"))
compensation, comparison = map(validator, ("compensation", "comparison"))

for box, keys in keys_of_the_reader().items():
    checked += 1
    if difference := keys ^ machine.schema["$defs"][box]["properties"].keys():
        faults.append(f"machine.schema.json and the reader differ in the keys of {box}: {sorted(difference)}")

by_name = {"quadrant.machine/1": machine, "quadrant.import/1": import_map, "quadrant.diagnosis/1": diagnosis}
for folder in (root / "examples", root / "tests"):
    for path in sorted(folder.rglob("*.json")):
        content = load(path)
        if isinstance(content, dict) and content.get("schema") in by_name:
            accept(by_name[content["schema"]], content, path)
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
for path in given.simulation:
    accept(simulation, load(path), path)
for path in given.forecast:
    accept(forecast, load(path), path)
circle = validator("circle")
for path in given.circle:
    content = load(path)
    accept(circle, content, path)
    for way, to in [(["source"], "eye"), (["runs", 0, "feed_m_per_s"], 0), (["errors", 0, "error"], "gremlin"), (["colour"], 1),
                    (["errors", 0, "ci95"], ...), (["errors", 0, "share"], 2), (["runs"], []), (["errors", 0, "axis"], "z")]:
        refuse(circle, changed(content, way, to), f"circle with {way} = {to}")
for path in given.compensation:
    accept(compensation, load(path), path)
for path in given.comparison:
    accept(comparison, load(path), path)
if not given.diagnoses:
    print("SKIPPED: no diagnosis file was given", file=sys.stderr)

good_machine = {
    "schema": "quadrant.machine/1", "sample_period_s": 0.001, "excluded_effects": ["backlash"],
    "axes": {"x": {
        "plant": {"mass_kg": 1, "force_constant_N_per_V": 1, "static_N": 2, "stribeck_velocity_m_per_s": 0.01,
                  "cogging_period_m": 0.03, "cogging_N": [1, 2], "cogging_phase_rad": [0, 1]},
        "actuator": {"dac_bits": 16, "dac_range_V": 20},
        "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 1, "velocity_gain_V_s_per_m": 1,
                       "velocity_filter_Hz": 100, "notch": {"frequency_Hz": 300, "width": 0.1}}}}}
x = ["axes", "x"]
accept(machine, good_machine, "the machine of this test")
accept(machine, changed(good_machine, x + ["controller"], {"kind": "vendor", "any": []}), "an unknown controller")
accept(machine, changed(good_machine, x + ["controller", "notch"], {"frequency_Hz": 300, "damping": 0.1}), "the old name of a key")
refuse(machine, changed(good_machine, x + ["controller", "notch", "damping"], 0.1), "a key under both of its names")
every_kind = load(root / "tests" / "controllers" / "machines.json")
for kind, axis in every_kind["axes"].items():
    way = ["axes", kind, "controller"]
    refuse(machine, changed(every_kind, way + ["colour"], 1), f"{kind} with an unknown key")
    for key, value in axis["controller"].items():
        if key != "kind":
            refuse(machine, changed(every_kind, way + [key], {"is": "none"}), f"{kind} with {key} of another form")
accept(machine, changed(changed(good_machine, x + ["controller", "velocity_estimator"], "two_sample_mean"),
                        x + ["controller", "velocity_filter_Hz"], ...), "two_sample_mean without a filter")
for path, to in [
        (["schema"], "quadrant.machine/2"), (["sample_period_s"], ...), (["sample_period_s"], 0), (["axes"], {}),
        (["excluded_effects"], ["gremlins"]), (["colour"], 1), (["axes"], {"a b": good_machine["axes"]["x"]}),
        (x + ["plant"], ...), (x + ["plant", "mass_kg"], ...), (x + ["plant", "mass_kg"], "1"),
        (x + ["plant", "mass_g"], 1), (x + ["plant", "force_constant_N_per_A"], 1), (x + ["plant", "delay_s"], 2),
        (x + ["plant", "stribeck_velocity_m_per_s"], ...), (x + ["plant", "cogging_period_m"], ...),
        (x + ["tolerance"], {"mass": -0.1}), (x + ["tolerance"], {"mass_kg": 0.1}), (x + ["encoder"], {"resolution_m": -1}),
        (x + ["actuator", "dac_range_V"], ...), (x + ["actuator", "dac_bits"], 15.5),
        (x + ["actuator", "command_is"], "guessed"), (x + ["controller", "kind"], ...),
        (x + ["controller", "velocity_filter_Hz"], ...), (x + ["controller", "velocity_feedforward"], "1"),
        (x + ["controller", "gain"], 1), (x + ["controller", "notch", "width"], ...)]:
    refuse(machine, changed(good_machine, path, to), f"machine with {'.'.join(path)} = {to}")

every_effect = copy.deepcopy(good_machine)
every_effect["axes"]["x"]["plant"] |= {
    "coulomb_N": 1, "gms_weights": [0.25, 0.75], "gms_stiffness_N_per_m": [1e6, 1e7], "gms_attraction_N_per_s": 1e5, "presliding_damping_s": 0.001,
    "friction_position_amplitude": -0.2, "friction_position_period_m": 0.1, "friction_position_phase_rad": 1,
    "friction_drift": 1.5, "friction_drift_time_s": 3, "load_friction": 0.2, "mode_mass_kg": 0.1, "mode_frequency_Hz": 70, "mode_damping": 0.02,
    "backlash_m": 1e-6, "spring_N_per_m": -5, "coupling": -0.1, "ripple": 0.02, "ripple_period_m": 0.024, "ripple_phase_rad": 0}
every_effect["axes"]["x"]["encoder"] = {"resolution_m": 1e-7, "cyclic_m": 1e-7, "cyclic_period_m": 0.0004, "cyclic_phase_rad": 1}
every_effect["axes"]["x"]["process"] = {"fundamental_Hz": 20, "force_N": [3, 1], "phase_rad": [0, 1], "mean_N": -2}
every_effect["axes"]["x"]["actuator"] |= {"lag_s": 0.001, "drive_limit_V": 4, "dead_zone_V": 0.01, "loss_probability": 0.1, "command_is": "measured"}
accept(machine, every_effect, "a machine with every effect")
for path, to in [
        (["plant", "gms_weights"], ...), (["plant", "gms_weights"], [0.1] * 5), (["plant", "gms_weights"], []),
        (["plant", "friction_position_amplitude"], 1), (["plant", "friction_drift"], -1), (["plant", "mode_frequency_Hz"], ...),
        (["plant", "ripple_period_m"], ...), (["plant", "coupling"], "1"), (["encoder", "cyclic_period_m"], ...),
        (["process", "force_N"], ...), (["process", "phase_rad"], 1), (["actuator", "lag_s"], 2),
        (["actuator", "loss_probability"], 1)]:
    refuse(machine, changed(every_effect, x + path, to), f"machine with {'.'.join(path)} = {to}")

# A rotary axis has the same keys, word by word in its own units.
words = {"m": "rad", "m2": "rad2", "N": "Nm", "kg": "kg_m2", "mass": "inertia", "force": "torque", "length": "angle"}


def rotary(value):
    if isinstance(value, dict):
        return {re.sub("[^_.]+", lambda w: words.get(w[0], w[0]), key): rotary(v) for key, v in value.items()}
    return value


accept(machine, every_kind | {"axes": {name: rotary(axis) for name, axis in every_kind["axes"].items()}}, "rotary axes with every controller kind")
of_an_angle = changed(every_effect, x, rotary(every_effect["axes"]["x"]))
accept(machine, of_an_angle, "a rotary machine with every effect")
refuse(machine, changed(of_an_angle, x + ["plant", "coulomb_N"], 1), "a rotary plant with newtons")
refuse(machine, changed(of_an_angle, x + ["encoder", "resolution_m"], 1), "a rotary encoder with metres")
refuse(machine, changed(every_effect, x + ["plant", "coulomb_Nm"], 1), "a linear plant with newton metres")
# What only a rotary axis has: gravity, and a payload on an arm.
only_rotary = {"plant": {"gravity_torque_Nm": 3.2, "gravity_phase_rad": 0.3}, "tolerance": {"gravity_torque": 0.1},
               "payload": {"mass_kg": 0.35, "arm_m": 0.18, "link_mass_kg": 0.06}}
for box, keys in only_rotary.items():
    for key, value in keys.items():
        refuse(machine, changed(every_effect, x + [box], every_effect["axes"]["x"].get(box, {}) | {key: value}),
               f"a linear {box} with {key}")
weighted = of_an_angle
for box, keys in only_rotary.items():
    weighted = changed(weighted, x + [box], weighted["axes"]["x"].get(box, {}) | keys)
accept(machine, weighted, "a rotary machine with gravity and a payload")
for box in ("plant", "tolerance", "encoder", "actuator", "process", "payload", "axis"):
    checked += 1
    of_line = machine.schema["$defs"][box]["properties"]
    of_angle = machine.schema["$defs"]["rotary_" + box]["properties"].keys() - only_rotary.get(box, {}).keys()
    if rotary(dict.fromkeys(of_line)).keys() != of_angle:
        faults.append(f"machine.schema.json: the keys of rotary_{box} are not those of {box} in its words")

accept(log, ["x_cmd_V", "t_s", "note", "x_ref_m", "x_pos_m", "x_force_N"], "a log of this test")
accept(log, ["t_s", "c_ref_rad", "c_pos_rad", "c_cmd_Nm", "x_ref_m", "x_pos_m", "x_cmd_V"], "a log with a rotary axis")
accept(log, ["t_s", "x_pos_m", "x_cmd_V"], "a log without a reference")
accept(log, ["t_s", "q_pos_rad", "q_torque_Nm", "q_ref_rad_per_s", "q_enabled"], "a log with a measured torque")
for names in (["x_ref_m", "x_pos_m", "x_cmd_V", "a"], ["t_s", "x_ref_m", "x_cmd_V", "a"], ["t_s", "x_ref_m", "x_pos_m", "a"],
              ["t_s", "x_ref_m", "x_pos_m", "x_cmd_V", "x_pos_m"], ["t_s", "c_ref_rad", "c_pos_m", "c_cmd_Nm"],
              ["t_s", "x_ref_rad", "x_pos_rad", "x_cmd_V", "x_pos_m"], ["t_s", "c_ref_rad", "c_pos_rad", "c_cmd_N"],
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
of_an_angle = copy.deepcopy(good_diagnosis)
of_an_angle["axes"]["x"] |= {"kind": "rotary", "command_unit": "Nm", "gap": rotary(gap)}
of_an_angle["causes"][0] = rotary(good_diagnosis["causes"][0])
accept(diagnosis, of_an_angle, "a diagnosis of a rotary axis")
whole = copy.deepcopy(good_diagnosis) | {
    "not_seen": [{"axis": "x", "what": "scale", "instrument": "interferometer"}],
    "files": {"machine": {"name": "m.json", "sha256": "0" * 64}, "log": {"name": "l.csv", "sha256": "f" * 64}}}
whole["causes"][0]["parameters"]["cogging_period_m"]["on_bound"] = True
accept(diagnosis, whole, "a diagnosis with all that may be there")
refuse(diagnosis, changed(whole, ["files", "machine", "sha256"], "0"), "a digest that is none")
refuse(diagnosis, changed(whole, ["not_seen", 0, "what"], ...), "a blind spot without a name")
refuse(diagnosis, changed(of_an_angle, ["axes", "x", "kind"], "linear"), "a linear axis with torques")
refuse(diagnosis, changed(of_an_angle, ["causes", 0, "gap_before_force_rms_N"], 1), "a cause with force and torque")
for path, to in [
        (["verdict"], "perhaps"), (["verdict"], "no_gap"), (["axes", "x", "gap", "bandwidth_Hz"], ...),
        (["axes", "x", "where", 0, "basis"], ...), (["axes", "x", "where", 1, "block"], "mechanics"),
        (["axes", "x", "where", 1, "share"], 1.5), (["causes", 0, "probability"], None), (["causes", 0, "shrink"], 1.1),
        (["causes", 0, "effect"], "gremlins"), (["causes", 0, "parameters", "cogging_N", "ci95"], [0, 2]),
        (["causes", 0, "parameters", "cogging_period_m", "value"], [0.03]), (["remaining", "structure"], ...),
        (["next_experiment"], ...), (["colour"], 1)]:
    refuse(diagnosis, changed(good_diagnosis, path, to), f"diagnosis with {path} = {to}")

own = changed(good_diagnosis, ["causes", 0, "effect"], "gremlins")
accept(diagnosis, own | {"own_effects": ["gremlins"]}, "a diagnosis with an effect of the caller's own")
for key, to in (("confusable_with", ["gremlins"]), ("readings", [{"effect": "gremlins", "parameters": {}}])):
    refuse(diagnosis, changed(good_diagnosis, ["causes", 0, key], to), f"diagnosis with gremlins in {key}")

good_simulation = {"schema": "quadrant.simulation/1", "notes": [], "axes": {"x": {
    "closed_loop": True, "command_unit": "V", "gap": gap, "where": [{"view": "velocity", "finding": "", "share": 0.5}]}}}
accept(simulation, good_simulation, "the simulation of this test")
for path, to in [(["axes"], {}), (["axes", "x", "gap"], ...), (["axes", "x", "command_unit"], "mV"), (["schema"], "1"),
                 (["axes", "x", "where", 0, "share"], 2), (["axes", "x", "gap", "force_rms_N"], -1)]:
    refuse(simulation, changed(good_simulation, path, to), f"simulation with {path} = {to}")

good_forecast = {"schema": "quadrant.forecast/1", "notes": [], "axes": {"x": {"kind": "linear", "gap_before": gap, "gap_after": gap, "shrink": 0}}}
accept(forecast, good_forecast, "the forecast of this test")
for path, to in [(["axes", "x", "gap_after"], ...), (["axes", "x", "shrink"], 1.1), (["schema"], "1"), (["colour"], 1)]:
    refuse(forecast, changed(good_forecast, path, to), f"forecast with {path} = {to}")

coulomb = {"coulomb_N": {"value": 20, "ci95": [19, 21]}}
good_comparison = {
    "schema": "quadrant.comparison/1", "likeness": "differ", "verdict_first": "no_gap", "verdict_second": "explained", "notes": [],
    "axes": {"x": {"likeness": "differ", "kind": "linear", "explained": "second", "force_before_N": 20, "force_after_N": 1,
                   "force_own_N": 1, "force_common_N": 1, "floor_N": 0.5, "calibrated_first": {}, "calibrated_second": coulomb}},
    "differences": [{"axis": "x", "effect": "coulomb_friction", "probability": 0.97, "confusable_with": [], "first": {},
                     "second": coulomb, "found_in": "second", "gap_before_force_rms_N": 20, "gap_after_force_rms_N": 1,
                     "gap_before_position_rms_m": 1e-5, "gap_after_position_rms_m": 1e-6, "gain": 900, "loss": 800}],
    "undecided": []}
accept(comparison, good_comparison, "the comparison of this test")
for path, to in [(["likeness"], "similar"), (["axes", "x", "floor_N"], -1), (["differences", 0, "probability"], 2), (["schema"], "1"),
                 (["differences", 0, "second", "coulomb_N", "ci95"], ...), (["undecided"], ...), (["colour"], 1)]:
    refuse(comparison, changed(good_comparison, path, to), f"comparison with {path} = {to}")

units = set(re.findall(r'unit_name\{"([^"]+)"', (root / "include/quadrant/diagnosis/import/units.hpp").read_text()))
checked += 1
if units != set(import_map.schema["$defs"]["source"]["properties"]["unit"]["enum"]):
    faults.append("import.schema.json and import/units.hpp name other units")
good_map = load(root / "examples" / "import" / "twincat_scope.map.json")
for path, to in [(["time"], ...), (["axes"], {}), (["axes", "y", "position"], ...), (["separator"], "|"), (["header"], 0),
                 (["axes", "y", "command", "scale"], 0), (["axes", "y", "command", "unit"], "furlong"),
                 (["time"], {"period_s": 0}), (["colour"], 1), (["files"], []), (["layout"], "sampler"),
                 (["axes", "y", "command", "is"], "guessed"), (["axes", "y", "position", "is"], "measured"),
                 (["axes", "y", "position", "file"], 0)]:
    refuse(import_map, changed(good_map, path, to), f"map with {path} = {to}")
of_goals = changed(good_map, ["axes", "y", "command"], ...)
accept(import_map, of_goals, "map of a servo that takes positions")
refuse(import_map, changed(of_goals, ["axes", "y", "reference"], ...), "map with a position alone")
of_lists = changed(good_map, ["axes", "y", "position", "element"], 2)
accept(import_map, of_lists, "map of cells that hold lists")
refuse(import_map, changed(of_lists, ["axes", "y", "position", "element"], 0), "map with entry 0 of a list")
of_speed = changed(changed(good_map, ["axes", "y", "position"], ...), ["axes", "y", "velocity"],
                   {"column": 2, "unit": "mm/s"})
accept(import_map, of_speed, "map of an axis of which the speed was recorded")

for fault in faults:
    print(fault, file=sys.stderr)
print(f"{checked} checked, {len(faults)} faults")
sys.exit(1 if faults else 0)
