#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""The rows of quadrant-reproduce --json: complete, of the right form, and as near to the reference as issue 3 asks.

figures.py ROWS.json
"""
import json
import math
import sys

KEYS = ["id", "quantity", "unit", "simulated", "published_simulated", "published_measured", "reference_computation", "note"]
LOOP = ["velocity_gain_margin", "velocity_phase_margin", "velocity_bandwidth", "position_gain_margin", "position_phase_margin",
        "position_bandwidth"]
MODEL = LOOP + ["tracking_ratio_10Hz", "min_dynamic_stiffness", "velocity_corner", "position_corner"]
PUSH = [f"error_{hz}Hz_{how}" for hz in (1, 58, 100) for how in ("off", "on")]
GLITCH = ["quadrant_glitch_100", "quadrant_glitch_10"]

# As shared/reference/thesis.md lists them under "Experiments".
ASKED = {"thesis.repetitive": ["gamma_p", "gamma_np"]}
for axis in "xy":
    ASKED[f"thesis.loop.{axis}"] = MODEL
    ASKED[f"thesis.loop_modes.{axis}"] = MODEL
    ASKED[f"thesis.loop_dob.{axis}"] = LOOP
    ASKED[f"thesis.dob_force.{axis}"] = PUSH
    ASKED[f"thesis.identify.{axis}"] = ["Fc", "Fs"] + [f"virgin_{um}um" for um in (1, 5, 15, 30)]
    for how in ("none", "static", "gms"):
        ASKED[f"thesis.friction.{axis}.{how}"] = ASKED[f"thesis.friction_dob.{axis}.{how}"] = GLITCH
for how in ("none", "static", "gms", "dob", "dob_static", "dob_gms"):
    ASKED[f"thesis.circle.{how}"] = ["radial_max", "radial_rms"]
for configuration in ("i", "ii", "iii"):
    ASKED[f"thesis.cutting.{configuration}"] = ["radial_rms"]
for axis in "xy":
    ASKED[f"thesis.frf.{axis}"] = ["A", "B", "Td"]
    ASKED[f"thesis.a_prime.{axis}"] = ["A_prime"]
    ASKED[f"thesis.feedforward.{axis}"] = ["error_without", "error_with"]
for kind, harmonics in (("observer", (1, 2, 3, 15)), ("ferraris", (1, 2, 3, 15)), ("ferraris_tracking", (1, 3, 15))):
    ASKED[f"thesis.harmonics.{kind}"] = [f"rms_{how}_{h}" for h in harmonics for how in ("off", "on")]
for configuration in ("i", "ii", "iii"):
    ASKED[f"thesis.real_cut.{configuration}"] = ["radial_rms"]
ASKED["thesis.ferraris_calibration"] = ["sensitivity", "offset"]
ASKED["thesis.harmonic_observer"] = ["error_23Hz"] + [f"rms_{how}_{h}" for h in (1, 3) for how in ("off", "on")]
# As shared/reference/virtual_cnc.md lists them.
for law in ("pid", "smc"):
    for path in ("diamond", "circle"):
        ASKED[f"vcnc.{path}.{law}"] = ["x_error_max", "y_error_max", "contour_error_max"]
    for axis in "xy":
        ASKED[f"vcnc.margins.{axis}.{law}"] = ["gain_margin", "phase_margin", "bandwidth"]
for case in (1, 2, 3):
    ASKED[f"vcnc.fuzzy.case{case}"] = ["ks", "rho", "peak_error", "iterations"]
ASKED["vcnc.fuzzy.table"] = [f"{attribute}_{state}_{gain}" for attribute in ("OSC", "PHM", "TRE") for gain in ("ks", "rho")
                             for state in (("EL", "LA", "ME", "SM", "OK") if attribute == "TRE" else ("HIUN", "LIUN", "ACCP", "LIOQ", "HIOQ"))]
# As shared/reference/linear_stage.md lists them.
for move in ("move_300mm", "move_20mm"):
    ASKED[f"stage.{move}"] = ["peak_speed", "settling_time", "max_error", "final_error", "peak_current"]
for how in ("none", "lugre"):
    ASKED[f"stage.move_500um.{how}"] = ["settling_time", "max_error", "final_error"]
ASKED["stage.bs3800"] = ["max_error", "rms_estimate_error"]

# Figures of the reference that the program must hold beside its own: a change of these is no repair.
REFERENCE = {
    ("thesis.loop.x", "position_gain_margin"): 15.6, ("thesis.loop.y", "position_bandwidth"): 29.3,
    ("thesis.loop.x", "min_dynamic_stiffness"): 13.4, ("thesis.loop_dob.x", "position_bandwidth"): 33.7,
    ("thesis.loop_dob.y", "position_gain_margin"): 12.9,
    ("thesis.friction.x.none", "quadrant_glitch_100"): 21.8, ("thesis.friction.y.none", "quadrant_glitch_100"): 30.4,
    ("thesis.friction.x.static", "quadrant_glitch_100"): 5.0, ("thesis.friction.y.static", "quadrant_glitch_100"): 10.6,
    ("thesis.friction.x.gms", "quadrant_glitch_100"): 0.94, ("thesis.friction.y.gms", "quadrant_glitch_100"): 1.3,
    ("thesis.friction.x.none", "quadrant_glitch_10"): 16.8, ("thesis.friction.y.none", "quadrant_glitch_10"): 20.9,
    ("thesis.friction.x.static", "quadrant_glitch_10"): 9.7, ("thesis.friction.y.static", "quadrant_glitch_10"): 20.4,
    ("thesis.friction.x.gms", "quadrant_glitch_10"): 0.17, ("thesis.friction.y.gms", "quadrant_glitch_10"): 0.41,
    ("thesis.cutting.i", "radial_rms"): 11.4, ("thesis.cutting.ii", "radial_rms"): 4.4,
    ("vcnc.diamond.pid", "x_error_max"): 36.9, ("vcnc.diamond.pid", "y_error_max"): 40.8,
    ("vcnc.diamond.pid", "contour_error_max"): 9.0, ("vcnc.diamond.smc", "x_error_max"): 12.5,
    ("vcnc.diamond.smc", "y_error_max"): 11.9, ("vcnc.diamond.smc", "contour_error_max"): 8.5,
    ("thesis.repetitive", "gamma_p"): 0.0628, ("thesis.repetitive", "gamma_np"): 6.02,
}


# Never worse than trials at random places, on machines that neither search has seen.
NEVER_WORSE = [("stage.tuning.ga", "stage.tuning.random", quantity)
               for quantity in ("fitness_on_unseen_seed_1", "fitness_on_unseen_seed_2", "fitness_on_unseen", "fitness_on_unseen_worst")]


def tolerance(identifier):
    return 0.02 if identifier.startswith(("thesis.loop", "thesis.repetitive", "thesis.frf")) else 0.10


def faults(rows):
    found = {}
    for row in rows:
        name = f"{row.get('id')} {row.get('quantity')}"
        if list(row) != KEYS:
            yield f"{name}: keys {list(row)}"
            continue
        if (row["id"], row["quantity"]) in found:
            yield f"{name}: twice"
        found[row["id"], row["quantity"]] = row
        for key in KEYS[3:7]:
            value = row[key]
            if value is not None and (isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value)):
                yield f"{name}: {key} = {value}"
        if row["note"] is not None and (not isinstance(row["note"], str) or not row["note"]):
            yield f"{name}: a note that is empty is null"
        if row["simulated"] is None and row["note"] is None:
            yield f"{name}: no figure, and no note that says why"
        reference = row["reference_computation"]
        if reference is not None:
            off = math.inf if row["simulated"] is None else abs(row["simulated"] / reference - 1)
            print(f"{name}: {row['simulated']} beside {reference}: {100 * off:.2f} %")
            if off > tolerance(row["id"]):
                yield f"{name}: {row['simulated']} lies {100 * off:.1f} % from the reference {reference}"
    for identifier, quantities in ASKED.items():
        for quantity in quantities:
            if (identifier, quantity) not in found:
                yield f"{identifier} {quantity}: no row"
            elif found[identifier, quantity]["simulated"] is None:
                yield f"{identifier} {quantity}: no figure"
    for one, other, quantity in NEVER_WORSE:
        costs = [found.get((identifier, quantity), {}).get("simulated") for identifier in (one, other)]
        if None in costs or costs[0] > costs[1]:
            yield f"{one} {quantity}: {costs[0]} beside {costs[1]} of {other}"
    for key, reference in REFERENCE.items():
        if key in found and found[key]["reference_computation"] != reference:
            yield f"{' '.join(key)}: the reference is {reference}, not {found[key]['reference_computation']}"


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = json.load(file)
    wrong = list(faults(rows))
    for each in wrong:
        print(f"FAILED: {each}")
    print(f"{len(rows)} rows, {len(wrong)} faults")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
