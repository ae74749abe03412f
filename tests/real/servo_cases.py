#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""63 cases made of the records of a real position servo (servo_pendulum): three gains, three pairs of motions, and of each pair
one case where nothing is wrong and six whose machine file is wrong in one thing, by a factor drawn with the seed; two of
three with the measured duty. Judged as servo.py judges. The factors are large, but not all of them can be seen on every motion.
usage: servo_cases.py PROGRAM SHARED [SEED]     exit code 77: the records are not there, 1: a healthy servo is blamed"""
import concurrent.futures, csv, json, os, random, subprocess, sys, tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from servo import right

MOTIONS = [("sin_sin", "up_and_down"), ("sin_time_square", "sin_sin"), ("up_and_down", "sin_time_square")]
FRICTION = ["coulomb_Nm", "static_Nm", "stribeck_velocity_rad_per_s", "load_friction"]
PRODUCT = ["drive_gain", "force_constant", "torque_constant", "supply_voltage", "actuator_gain"]  # one name without a duty
CASES = ["nothing", "gain", "torque", "gravity", "payload", "viscous", "friction"]


def rows_of(path, with_duty):
    with open(path) as file:
        table = list(csv.reader(file))
    columns = ["t_s", "q_ref_rad", "q_pos_rad"] + (["q_cmd_V", "q_duty", "q_supply_V"] if with_duty else [])
    at = [table[0].index(c) for c in columns]
    return [[row[i] for i in at] for row in table]


def make(folder, data, machine, gain, motions, case, draw):
    """Writes one case; returns what is true of it."""
    log, holdout = ("{}/records/{}_kp{}.csv".format(data, m, gain) for m in motions)
    with_duty = draw.random() < 0.65
    axis = machine["axes"]["q"]
    plant, drive = axis["plant"], axis["drive"]
    drive["position_gain_per_rad"] = 0.0028774 * gain
    said = {"truth": "none", "accept": [], "allow": [], "kind": "none" if case == "nothing" else "single"}
    if case == "gain":
        drive["position_gain_per_rad"] *= draw.choice([0.5, 0.6, 1.6, 2])
        said.update(truth="controller_mismatch", accept=["drive_gain"] if with_duty else PRODUCT)
    elif case == "torque":
        plant["torque_constant_Nm_per_V"] *= draw.choice([0.5, 0.6, 1.7, 2])
        said.update(truth="force_constant", accept=PRODUCT[2:] if with_duty else PRODUCT + ["controller_mismatch"])
    elif case == "gravity":
        for key in ("gravity_torque_Nm", "gravity_phase_rad"):
            del plant[key]
        del axis["payload"]
        said.update(truth="gravity", accept=["payload_mass", "payload"])
    elif case == "payload":
        times = draw.choice([0.3, 0.5, 1.7, 2])
        plant["inertia_kg_m2"] += 0.0049 * (times - 1)
        plant["gravity_torque_Nm"] *= times
        axis["payload"]["mass_kg"] *= times
        said.update(truth="payload_mass", accept=["gravity", "arm_length", "payload"], allow=["mass", "inertia"])
    elif case == "viscous":
        plant["viscous_Nm_s_per_rad"] *= draw.choice([0.25, 0.3, 2.5, 3])
        said.update(truth="viscous_friction", accept=["back_emf"])
    elif case == "friction":
        for key in FRICTION:
            del plant[key]
        said.update(truth="coulomb_friction",
                    accept=["stribeck_friction", "load_friction", "static_friction", "presliding_friction"])
    rows = rows_of(log, with_duty)
    machine["sample_period_s"] = (float(rows[-1][0]) - float(rows[1][0])) / (len(rows) - 2)
    os.makedirs(folder)
    for name, content in (("log.csv", rows), ("holdout.csv", rows_of(holdout, with_duty))):
        with open(os.path.join(folder, name), "w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(content)
    with open(os.path.join(folder, "machine.json"), "w") as file:
        json.dump(machine, file)
    return said


def diagnosed(program, folder):
    at = lambda name: os.path.join(folder, name)
    done = subprocess.run([program, "diagnose", "--quiet", "--threads", "1", "--machine", at("machine.json"), "--log", at("log.csv"),
                           "--holdout", at("holdout.csv"), "--json", at("said.json")], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"BAD  {folder}: exit code {done.returncode}: {done.stderr.strip()}")
    with open(at("said.json")) as file:
        return json.load(file)


def main(program, shared, seed="1"):
    data = os.path.join(shared, "data", "servo_pendulum")
    if not os.path.isdir(os.path.join(data, "records")):
        print(f"SKIPPED: no {data}/records")
        return 77
    draw, good, blamed = random.Random(int(seed)), {c: 0 for c in CASES}, 0
    with tempfile.TemporaryDirectory() as root, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        cases = []
        for gain, described in ((100, "003"), (200, "001"), (400, "002")):
            for motions in MOTIONS:
                for case in CASES:
                    with open(os.path.join(data, described, "machine.json")) as file:
                        machine = json.load(file)
                    folder = os.path.join(root, f"{len(cases):03}")
                    cases.append((folder, f"{case}, gain {gain}, {motions[0]}", case,
                                  make(folder, data, machine, gain, motions, case, draw)))
        for (_, words, case, said), d in zip(cases, pool.map(lambda c: diagnosed(program, c[0]), cases)):
            ok = right(said, d)
            good[case] += ok
            blamed += case == "nothing" and any(c["group_probability"] >= 0.5 for c in d["causes"])
            print("ok " if ok else "no ", words, "|", d["verdict"], "; ".join(
                f"{c['effect']} {c['probability']:.2f} of {c['group_probability']:.2f}" for c in d["causes"]), flush=True)
    print(sum(good.values()), "of", len(cases), "right:", ", ".join(f"{c} {n}" for c, n in good.items()), f"of {len(MOTIONS) * 3} each")
    return 1 if blamed else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
