# SPDX-License-Identifier: BSL-1.0
# Long: population() draws, diagnoses and counts the machines of one kind.
"""Two encoders, and motion without a command, through the program: raw CSV of machines from encoders_machine.py, whose truth is known.

  encoders.py PROGRAM             one machine of each kind, refusals, apply
  encoders.py PROGRAM population  24 machines of each of the two kinds, drawn; prints the figures
"""
import json
import os
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from encoders_machine import positions, two_encoders  # noqa: E402

PROGRAM = os.path.abspath(sys.argv[1])
FOLDER = tempfile.mkdtemp()
FAULTS = []


def check(holds, what):
    if not holds:
        FAULTS.append(what)
        print("FAULT:", what)


def program(*arguments):
    return subprocess.run([PROGRAM, *arguments], cwd=FOLDER, capture_output=True, text=True)


def written(name, machine, transmission=None):
    machine["axes"]["x"]["transmission"].update(transmission or {})
    with open(os.path.join(FOLDER, name + ".json"), "w") as out:
        json.dump(machine, out)


def diagnosed(name, machine, transmission=None):
    written(name, machine, transmission)
    run = program("diagnose", "--machine", name + ".json", "--log", name + ".csv", "--json", name + ".out.json", "--report",
                  name + ".html")
    if run.returncode:
        raise SystemExit(f"{name}: {run.stderr}")
    with open(os.path.join(FOLDER, name + ".out.json")) as file:
        return json.load(file), run.stdout


def claims(diagnosis):
    return [c for c in diagnosis["causes"] if c["group_probability"] >= 0.5]


def value(cause, key):
    found = cause["parameters"][key]["value"]
    return found[0] if isinstance(found, list) else found


def near(found, true, within):
    return abs(found - true) <= within


# What each effect must be found with: its name, its key, its true value and how near.
def judged(diagnosis, effect, key=None, true=0.0, within=0.0):
    named = claims(diagnosis)
    if effect is None:
        return not named and diagnosis["verdict"] in ("no_gap", "within_tolerance")
    if len(named) != 1 or named[0]["effect"] != effect:
        return False
    return key is None or near(value(named[0], key), true, within)


BACKLASH, STIFFNESS = "transmission.backlash_m", "transmission.stiffness_N_per_m"
TRAVEL, COULOMB = "transmission.travel_per_turn_m", "transmission.motor_coulomb_N"
KNOWN = {"stiffness_N_per_m": 2e8}


def some(*names, of):
    """With QUADRANT_TESTS=all every machine, by default those of these names."""
    return [m for m in of if m[0] in names or os.environ.get("QUADRANT_TESTS") == "all"]


def each_two():
    for name, known, truth, law in some("healthy", "play", "soft", "pitch", "motor", of=[
            ("healthy", KNOWN, (None,), {}),
            ("worn", dict(KNOWN, backlash_m=10e-6), (None,), {"play": 10e-6}),
            ("play", KNOWN, ("lost_motion", BACKLASH, 12e-6, 2e-6), {"play": 12e-6}),
            ("coarse", {"stiffness_N_per_m": 3e7}, ("lost_motion", BACKLASH, 15e-6, 10e-6),
             {"play": 15e-6, "stiffness": 3e7, "motor_count": 2e-6, "count": 5e-6}),
            ("soft", {}, ("wind_up", STIFFNESS, 1.5e7, 1.5e6), {"stiffness": 1.5e7}),
            ("softer", {"stiffness_N_per_m": 5e7}, ("wind_up", STIFFNESS, 3e7, 3e6), {"stiffness": 3e7}),
            ("pitch", KNOWN, ("pitch_error", "transmission.pitch_error_m", 5e-6, 5e-7), {"pitch": 5e-6}),
            ("lead", KNOWN, ("scale_error", TRAVEL, 0.010002, 2e-7), {"lead": 2e-4}),
            ("motor", {"stiffness_N_per_m": 5e6}, ("motor_friction", COULOMB, 40, 4),
             {"stiffness": 5e6, "motor_friction": 40, "band": 25})]):
        d, _ = diagnosed(name, two_encoders(os.path.join(FOLDER, name), 1, **law), known)
        check(judged(d, *truth), f"two encoders, {name}: {d['verdict']}, {claims(d)}")
    d, words = diagnosed("both", two_encoders(os.path.join(FOLDER, "both"), 2, play=20e-6, stiffness=2e7), {})
    found = {c["effect"]: c for c in claims(d)}
    check(set(found) == {"lost_motion", "wind_up"}, f"play and wind-up: {list(found)}")
    if "lost_motion" in found and "wind_up" in found:
        check(near(value(found["lost_motion"], BACKLASH), 20e-6, 2e-6), "play beside wind-up, within 2 counts")
        check(near(value(found["wind_up"], STIFFNESS), 2e7, 2e6), "wind-up beside play, within 10 %")
    check("between the two encoders" in words, "the terminal says where")
    # Applied, nothing is missing.
    run = program("apply", "--machine", "both.json", "--diagnosis", "both.out.json", "--out", "fixed.json")
    check(run.returncode == 0, f"apply: {run.stderr}")
    run = program("diagnose", "--machine", "fixed.json", "--log", "both.csv", "--json", "again.json")
    check(run.returncode == 0 and json.load(open(os.path.join(FOLDER, "again.json")))["verdict"] in
          ("no_gap", "within_tolerance"), f"the corrected machine has no gap: {run.stdout[:200]}{run.stderr}")


def each_chain():
    gain = "drive.position_gain_per_s"
    for name, truth, law in some("still", "slack", "warm", "steps", "late", of=[
            ("still", (None,), {}),
            ("noisy", (None,), {"noise": 2e-6}),
            ("slack", ("lost_motion", BACKLASH, 20e-6, 2e-6), {"play": 20e-6}),
            ("slow", ("lost_motion", BACKLASH, 15e-6, 10e-6), {"play": 15e-6, "period": 0.1}),
            ("fast", ("lost_motion", BACKLASH, 15e-6, 10e-6), {"play": 15e-6, "period": 0.01}),
            ("warm", ("scale_error", TRAVEL, 0.0050004, 5e-8), {"lead": 8e-5}),
            ("turns", ("pitch_error", "transmission.pitch_error_m", 6e-6, 6e-7), {"pitch": 6e-6}),
            ("steps", ("missed_steps", "missed_step_m", -40e-6, 2e-6), {"steps": [(30, 40e-6), (60, 80e-6)]}),
            ("late", ("command_delay", "drive.command_delay_s", 0.03, 0.002), {"late": 0.03, "asked": True}),
            ("lags", ("drive_gain", gain, 1 / 0.03, 3), {"lag": 0.03, "asked": True})]):
        d, words = diagnosed(name, positions(os.path.join(FOLDER, name), 3, **law))
        check(judged(d, *truth), f"two positions, {name}: {d['verdict']}, {claims(d)}")
    d, words = diagnosed("drift", positions(os.path.join(FOLDER, "drift"), 4, drift=5e-7))
    check(not claims(d) and d["verdict"] == "unexplained" and "drifts" in words, "a drift is no effect of the list")


def refused(what, name, machine, *says):
    written(name, machine)
    run = program("diagnose", "--machine", name + ".json", "--log", "slack.csv" if name.startswith("p") else "play.csv")
    check(run.returncode == 2 and run.stderr.count("\n") == 1 and all(s in run.stderr for s in says),
          f"{what}: {run.returncode} {run.stderr}")


def bad_input():
    machine = json.load(open(os.path.join(FOLDER, "play.json")))
    axis = machine["axes"]["x"]
    axis["transmission"]["travel_per_turn_m"] = 0.005
    refused("another ratio", "ratio", machine, "2 times as far", "travel_per_turn_m 0.01,")
    del axis["transmission"]["travel_per_turn_m"]
    refused("no ratio", "none", machine, "travel_per_turn_m is missing", "0.01 m a turn")
    axis["transmission"] = {"travel_per_turn_m": 0.01, "stifness_N_per_m": 1e8}
    refused("a slip of the pen", "slip", machine, "did you mean stiffness_N_per_m?")
    axis["transmission"] = {"travel_per_turn_m": 0.01, "kind": "rope"}
    refused("a kind that is none", "kind", machine, '"screw", "belt", "gear"')
    chain = {"schema": "quadrant.machine/1", "sample_period_s": 0.02,
             "axes": {"x": {"transmission": {"kind": "screw"}, "encoder": {"resolution_m": 1e-6}}}}
    lines = open(os.path.join(FOLDER, "play.csv")).read().split("\n")
    turned = [lines[0]] + [",".join(c[:3] + [str(-float(c[3]))] + c[4:]) for c in (r.split(",") for r in lines[1:] if r)]
    with open(os.path.join(FOLDER, "turned.csv"), "w") as out:
        out.write("\n".join(turned) + "\n")
    run = program("diagnose", "--machine", "play.json", "--log", "turned.csv")
    check(run.returncode == 2 and "-1 times as far" in run.stderr and "turn the sign" in run.stderr,
          f"opposite sign: {run.stderr}")
    with open(os.path.join(FOLDER, "alone.csv"), "w") as out:
        out.write("t_s,x_cmd_V,x_pos_m\n" + "".join(f"{i * 0.02:.2f},1,{i * 1e-4:.5f}\n" for i in range(400)))
    written("alone", chain)
    run = program("diagnose", "--machine", "alone.json", "--log", "alone.csv")
    check(run.returncode == 2 and "two positions are compared" in run.stderr, f"one position: {run.stderr}")
    run = program("simulate", "--machine", "alone.json", "--log", "slack.csv")
    check(run.returncode == 2 and "needs the forces" in run.stderr, f"no forces: {run.stderr}")


def population():
    dice = random.Random(23)
    def logs(low, high):
        return low * (high / low) ** dice.random()
    for kind in ("two encoders", "positions"):
        right = near_enough = blamed = healthy = box = 0
        box_of = {"command_delay": "drive", "drive_gain": "drive", "missed_steps": "drive"}
        machines = 24
        for i in range(machines):
            path = os.path.join(FOLDER, "m")
            if kind == "two encoders":
                count = logs(0.2e-6, 3e-6)
                law = {"motor_count": logs(0.05e-6, 2e-6), "count": count, "mass": logs(30, 300), "friction": logs(5, 60),
                       "stiffness": logs(5e7, 4e8), "viscous": logs(20, 200)}
                law["motor_mass"] = law["mass"] * dice.uniform(0.15, 0.6)
                law["constant"] = law["mass"] * dice.uniform(0.8, 1.5)
                law["friction"] = min(law["friction"], 2 * law["constant"])
                known = {"stiffness_N_per_m": law["stiffness"] * dice.uniform(0.95, 1.05)}
                effect = [None, "lost_motion", "wind_up", "pitch_error", "scale_error", None][i % 6]
                truth = (effect,)
                if effect == "lost_motion":
                    law["play"] = logs(4 * count, 40 * count)
                    truth = (effect, BACKLASH, law["play"], 2 * max(count, law["motor_count"]))
                if effect == "wind_up":
                    law["stiffness"] = known["stiffness_N_per_m"] * dice.uniform(0.2, 0.4)
                    truth = (effect, STIFFNESS, law["stiffness"], 0.1 * law["stiffness"])
                if effect == "pitch_error":
                    law["pitch"] = logs(4 * count, 20 * count)
                    truth = (effect, "transmission.pitch_error_m", law["pitch"], count)
                if effect == "scale_error":
                    law["lead"] = logs(5e-5, 5e-4)
                    truth = (effect, TRAVEL, 0.01 * (1 + law["lead"]), 0.001 * law["lead"] + 0.01 * count)
                d, _ = diagnosed("m", two_encoders(path, 100 + i, **law), known)
            else:
                law = {"period": 1 / dice.choice([10, 20, 50, 100]), "counter": dice.choice([1.25e-6, 2.5e-6, 5e-6, 1e-5]),
                       "count": dice.choice([0.5e-6, 1e-6, 5e-6]), "asked": dice.random() < 0.5}
                coarse = max(law["counter"], law["count"])
                effect = [None, "lost_motion", "scale_error", "pitch_error", "missed_steps", "lag"][i % 6]
                truth = (effect,)
                if effect == "lost_motion":
                    law["play"] = logs(3 * coarse, 20 * coarse)
                    truth = (effect, BACKLASH, law["play"], 2 * coarse)
                if effect == "scale_error":
                    law["lead"] = logs(5e-5, 5e-4)
                    truth = (effect, TRAVEL, 0.005 * (1 + law["lead"]), 0.00025 * law["lead"] + 1e-9)
                if effect == "pitch_error":
                    law["pitch"] = logs(1.5 * coarse, 10 * coarse)
                    truth = (effect, "transmission.pitch_error_m", law["pitch"], coarse)
                if effect == "missed_steps":
                    law["steps"] = [(dice.uniform(20, 70), law["counter"] * dice.choice([8, 16, 32]))]
                    truth = (effect, "missed_step_m", -law["steps"][0][1], coarse)
                if effect == "lag":
                    law["asked"] = True
                    how = dice.choice(["lag", "late"])
                    law[how] = logs(0.02, 0.08)
                    effect = {"lag": "drive_gain", "late": "command_delay"}[how]
                    key, true = {"lag": ("drive.position_gain_per_s", 1 / law["lag"] if how == "lag" else 0),
                                 "late": ("drive.command_delay_s", law[how])}[how]
                    truth = (effect, key, true, 0.1 * true)
                d, _ = diagnosed("m", positions(path, 200 + i, **law))
            named = claims(d)
            ok = [c["effect"] for c in named] == [effect] if effect else not named
            in_box = [box_of.get(c["effect"], "transmission") for c in named] == ([box_of.get(effect, "transmission")] if effect else [])
            healthy += effect is None
            blamed += effect is None and bool(named)
            right += ok
            box += in_box
            close = judged(d, *truth)
            near_enough += close
            if not close:
                print(f"  {kind} {i}: {truth} found {d['verdict']}",
                      [(c["effect"], round(c["probability"], 2), {k: v["value"] for k, v in c["parameters"].items()}) for c in d["causes"]], law)
        print(f"{kind}: right {right} of {machines}, box {box}, value and verdict too {near_enough}; blamed {blamed} of {healthy} healthy")


if sys.argv[2:] == ["population"]:
    population()
else:
    each_two()
    each_chain()
    bad_input()
    print("encoders:", "all hold" if not FAULTS else f"{len(FAULTS)} faults")
    sys.exit(bool(FAULTS))
