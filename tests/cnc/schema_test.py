#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The machine files of quadrant-cnc against docs/schema/cnc.schema.json, its figures against cnc_run.schema.json, the keys of the schema against those of the reader, and what
quadrant-cnc refuses or not, beside what the schema does: schema_test.py PROGRAM SCRATCH [MACHINE_FILE_OF_THE_GAP ...]"""
import copy
import json
import pathlib
import re
import subprocess
import sys

import jsonschema

root = pathlib.Path(__file__).resolve().parents[2]
program, scratch = sys.argv[1], pathlib.Path(sys.argv[2])
faults, checked = [], 0


def validator(name):
    schema = json.loads((root / "docs/schema" / name).read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    resolver = jsonschema.RefResolver((root / "docs/schema/here").as_uri(), schema)  # other schemas are files beside it
    return jsonschema.Draft202012Validator(schema, resolver=resolver)


def expect(ok, message):
    global checked
    checked += 1
    if not ok:
        faults.append(message)


schema, figures = validator("cnc.schema.json"), validator("cnc_run.schema.json")
analysis = validator("cnc_analysis.schema.json")
for name in ("mill", "milling_table"):
    ran = subprocess.run([program, "analyse", "--cnc", root / f"examples/programs/quadrant_cnc/{name}.json", "--json"], stdout=subprocess.PIPE, check=True)
    for fault in analysis.iter_errors(json.loads(ran.stdout)):
        faults.append(f"analysis of {name}: {fault.message[:200]}")
    checked += 1
for last in (400, 12):  # a band that reaches far enough for gains, one that does not tell whether the loop is stable
    (scratch / "measured.csv").write_text("frequency_Hz,magnitude_m_per_V,phase_deg\n" + "".join(f"{f},{0.015 / f**2},{-180 - 0.18 * f}\n" for f in range(1, last)))
    ran = subprocess.run([program, "analyse", "--cnc", root / "examples/programs/quadrant_cnc/mill.json", "--axis", "x", "--frf", scratch / "measured.csv", "--json"],
                         stdout=subprocess.PIPE, check=True)
    said = json.loads(ran.stdout)
    faults += [f"analysis of a measured axis: {fault.message[:200]}" for fault in analysis.iter_errors(said)]
    found = said["axes"]["x"]["measured"]
    expect(("proposed_control" in found) == (last == 400) and ("stability_not_told" in found) == (last == 12), f"measured up to {last} Hz: {found}")
    if "proposed_control" in found:  # as a machine file takes it
        machine = json.loads((root / "examples/programs/quadrant_cnc/mill.json").read_text())
        machine["axes"]["x"]["control"] = found["proposed_control"]
        (scratch / "proposed.json").write_text(json.dumps(machine))
        expect(schema.is_valid(machine), f"not a control: {found['proposed_control']}")
        subprocess.run([program, "analyse", "--quiet", "--cnc", scratch / "proposed.json"], check=True)
keys = (root / "examples/programs/quadrant_cnc/cnc_keys.hpp").read_text(encoding="utf-8")


def table(name):
    """The keys of a table of the reader."""
    return set(re.findall(r'"(\w+)"', re.search(rf"\b{name} ?(?:=[^{{]*)?\{{(.*?)\}}\)?;", keys, re.S)[1]))


for box, tables in {"trajectory": ["trajectory_keys", "trajectory_other_keys"], "limits": ["limit_keys"], "axis": ["axis_keys"],
                    "ball_screw": ["ball_screw_keys", "ball_screw_other_keys"], "friction": ["friction_keys"],
                    "linear_motor": ["linear_motor_keys", "kind_key"], "encoder": ["encoder_keys", "encoder_other_keys"],
                    "tachometer": ["tachometer_keys"], "command": ["command_keys", "command_other_keys"],
                    "friction_feedforward": ["friction_feedforward_keys"], "accelerometer": ["accelerometer_keys"],
                    "acceleration_feedback": ["acceleration_feedback_keys"],
                    "cutting_load": ["cutting_load_keys", "cutting_load_other_keys"]}.items():
    read = set().union(*map(table, tables))
    difference = read ^ schema.schema["$defs"][box]["properties"].keys()
    expect(not difference, f"cnc.schema.json and the reader differ in the keys of {box}: {sorted(difference)}")

machines = sorted((root / "examples/programs/quadrant_cnc").glob("*.json"))
expect(len(machines) >= 2, "no machine files")
for path in machines:
    expect(schema.is_valid(json.loads(path.read_text())), f"{path} is not valid")
gap = validator("machine.schema.json")
for path in sys.argv[3:]:
    for error in gap.iter_errors(json.loads(pathlib.Path(path).read_text())):
        faults.append(f"{path}: {error.message}")
    checked += 1

mill = json.loads((root / "examples/programs/quadrant_cnc/mill.json").read_text())
del mill["axes"]["y"], mill["axes"]["z"]
stroke = scratch / "stroke.nc"
stroke.write_text("G21 G1 X1 F6000\n")


def both(change, good):
    """Schema and program say the same of a changed machine."""
    machine = copy.deepcopy(mill)
    change(machine, machine["axes"]["x"])
    path = scratch / "changed.json"
    path.write_text(json.dumps(machine))
    ran = subprocess.run([program, "run", "--cnc", path, "--path", stroke, "--json"], capture_output=True, text=True)
    expect(schema.is_valid(machine) == good, f"the schema {'refuses' if good else 'accepts'} {machine}")
    if good:  # the figures that it printed are what their schema says
        for error in figures.iter_errors(json.loads(ran.stdout)):
            faults.append(f"run --json: {'/'.join(map(str, error.absolute_path))}: {error.message}")
    expect((ran.returncode == 0) == good, f"quadrant-cnc {'refuses' if good else 'accepts'} {machine}: {ran.stderr}")
    expect(good or ran.stderr.count("\n") == 1 and "changed.json" in ran.stderr, f"not one line with the file: {ran.stderr}")


def law(**keys):
    return lambda m, x: x.update(control=keys)


both(lambda m, x: None, True)
for good in [law(law="pid", gain_V_per_m=7e4, derivative_gain_V_s_per_m=300, derivative_corner_Hz=300, velocity_weight=0.9),
             law(law="p_pi", position_gain_per_s=40, gain_V_s_per_m=200, integral_gain_V_per_m=9000, acceleration_gain_V_s2_per_m=1.5),
             law(law="sliding_mode", sliding_per_s=200, gain_V_s_per_m=300, adaptation_V_per_m=3e4, plant_gain_m_per_s2_V=0.6),
             law(law="cascade_p_pi", position_gain_per_s=40, velocity_gain_V_s_per_m=150, velocity_estimator="two_sample_mean",
                 notch={"frequency_Hz": 200, "width": 0.1}),
             law(law="pole_placement", natural_Hz=15, observer_Hz=25), law(law="zero_phase", natural_Hz=15, damping=0.8, observer_Hz=25),
             law(law="lead_lag", crossover_Hz=20), law(law="generalized_predictive", effort_m_per_V=1e-5),
             law(law="state_feedback", position_gain_V_per_m=5e4, velocity_gain_V_s_per_m=400, encoder_noise_m=4e-7, drift_V=10),
             law(law="linuxcnc_pid", units_per_m=1000, Pgain=70, Igain=800, Dgain=0.3),
             law(law="milling_axis", position_gain_per_s=40, velocity_gain_V_s_per_m=150, velocity_filter_Hz=100),
             law(law="predictive", position_error_m=1e-5, velocity_error_m_per_s=0.01, increment_V=0.05, horizon=20),
             lambda m, x: x.update(friction_feedforward={"scale": 0.9, "width_m_per_s": 0.002}),
             lambda m, x: m["trajectory"].update(start_m=[0, 0, 0], corner_tolerance_m=0, profile="cubic_acceleration"),
             lambda m, x: x["drive"].update(current_limit_A=20, lead_error=1e-5, table_mass_kg=200, compliance_m_per_N=1e-9),
             lambda m, x: x.update(accelerometer={"noise_m_per_s2": 0.05}, acceleration_feedback={"gain_V_s2_per_m": 0.5, "filter_Hz": 100}),
             lambda m, x: x.update(cutting_load={"spindle_Hz": 20, "mean_N": 50, "cosine_N": [100, 0, 20], "sine_N": [3], "entry_s": 0.01}),
             lambda m, x: x.update(cutting_load={"spindle_Hz": 20, "sine_Nm": [0.1]}),
             lambda m, x: x.update(encoder={"resolution_m": 1e-6, "noise_m": 1e-7, "on": "motor"})]:
    both(good, True)
for bad in [lambda m, x: m.pop("trajectory"), lambda m, x: m.update(schema="quadrant.cnc/2"), lambda m, x: m.update(servo_period_s=0),
            lambda m, x: m.update(colour=1), lambda m, x: m.update(seed=1.5), lambda m, x: m.update(axes={}),
            lambda m, x: m["axes"].update(a=x), lambda m, x: x.pop("drive"), lambda m, x: x.pop("command"),
            lambda m, x: x.update(travel_m=[1]), lambda m, x: x["drive"].update(kind="rack"), lambda m, x: x["drive"].update(pitch_mm=10),
            lambda m, x: x["drive"].pop("pitch_m"), lambda m, x: x["drive"]["friction"].pop("backward"),
            lambda m, x: x["drive"].update(lead_error=0.2), lambda m, x: x["drive"].update(backlash_m=-1e-6),
            lambda m, x: x["command"].pop("dac_bits"), lambda m, x: x["command"].update(limit_V=0),
            lambda m, x: x["encoder"].update(on="desk"), lambda m, x: m["trajectory"].update(profile="square"),
            lambda m, x: m["trajectory"].update(reach_the_feed=1), lambda m, x: m["trajectory"].update(start_m=[0, 0]),
            lambda m, x: x.update(acceleration_feedback={"gain_V_s2_per_m": 0.5}),
            lambda m, x: x.update(cutting_load={"spindle_Hz": 20}), lambda m, x: x.update(cutting_load={"mean_N": 1}),
            lambda m, x: x.update(cutting_load={"spindle_Hz": 20, "mean_N": 1, "mean_Nm": 1}),
            lambda m, x: x.update(cutting_load={"spindle_Hz": 20, "cosine_N": []}),
            law(law="pdi", gain_V_per_m=1), law(gain_V_per_m=1), law(law="pid"), law(law="pid", gain_V_per_m="much"),
            law(law="cascade_p_pi", position_gain_per_s=40, velocity_gain_V_s_per_m=150), law(law="pole_placement", natural_Hz=15),
            lambda m, x: x.update(drive={"kind": "linear_motor", "mass_kg": 100, "force_constant_N_per_V": 100, "static_N": 3})]:
    both(bad, False)

for fault in faults:
    print(fault, file=sys.stderr)
print(f"{checked} checked, {len(faults)} faults")
sys.exit(1 if faults else 0)
