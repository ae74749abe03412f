#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A practice set for a diagnosis: simulated axes, each with an effect that its machine file does not have.

    python3 tests/acceptance/practice_set.py FOLDER          FOLDER/NNN/machine.json, log.csv, holdout.csv; FOLDER/truth.json
    python3 tests/acceptance/practice.py PROGRAM FOLDER      judges a program on it, which is never shown truth.json

Written from docs/formats.md in plain Python. It shares no code and no numerical method with the library: friction is an impulse that
brings the mass to rest or takes its level off, where the library integrates and looks for events. The same call writes the same bytes.
"""
import json
import math
import os
import random
import sys

T = 0.0005  # servo period [s]
PARTS = 10  # steps of the mechanics in it
COUNT = 2.5e-7  # of the encoder [m]
LIMIT, DAC = 10.0, 20.0 / 2**16  # [V]

PLANT = {
    "mass_kg": 300.0,
    "force_constant_N_per_V": 1400.0,
    "viscous_N_s_per_m": 600.0,
    "delay_s": 0.0004,
    "coulomb_N": 110.0,
    "static_N": 150.0,
    "stribeck_velocity_m_per_s": 0.003,
}
TOLERANCE = {"mass": 0.02, "force_constant": 0.01, "viscous": 0.10, "coulomb": 0.05, "static": 0.05}
CONTROLLER = {
    "kind": "cascade_p_pi",
    "position_gain_per_s": 120,
    "velocity_gain_V_s_per_m": 50,
    "velocity_integral_V_per_m": 350,
    "velocity_filter_Hz": 180,
    "velocity_feedforward": 1,
    "acceleration_feedforward_V_s2_per_m": 0.2143,
    "viscous_feedforward_V_s_per_m": 0.4286,
    "coulomb_feedforward_V": 0,
}

# What the true machine has; what its file says instead (None: nothing); how the truth is to be named.
CASES = [
    ("none", {}, {}, []),
    ("coulomb_friction", {"static_N": None}, {"coulomb_N": None, "static_N": None, "stribeck_velocity_m_per_s": None}, []),
    ("stribeck_friction", {"static_N": 190.0}, {"static_N": None, "stribeck_velocity_m_per_s": None}, []),
    ("viscous_friction", {"viscous_N_s_per_m": 1100.0}, {"viscous_N_s_per_m": 600.0}, []),
    ("mass", {"mass_kg": 345.0}, {"mass_kg": 300.0}, ["force_constant"]),
    ("constant_force", {"constant_force_N": 55.0}, {"constant_force_N": None}, ["asymmetric_friction"]),
    ("position_spring", {"spring_N_per_m": 900.0}, {"spring_N_per_m": None}, []),
    ("cogging", {"cogging": (0.032, ((35.0, 0.4), (12.0, 2.0)))}, {"cogging": None}, []),
    ("time_delay", {"delay_s": 0.0010}, {"delay_s": 0.0004}, []),
    (
        "constant_force+cogging",
        {"constant_force_N": -60.0, "cogging": (0.024, ((40.0, 1.1),))},
        {"constant_force_N": None, "cogging": None},
        ["asymmetric_friction"],
    ),
    ("unknown", {"magnet": (70.0, 0.03, 0.012)}, {"magnet": None}, []),  # a force in no list, about one place
]


def motion(seconds, rng):
    """A reference: rest, moves of many lengths and speeds both ways, slow reversals. One list of positions [m]."""
    x, at = [0.0] * 400, 0.0
    while len(x) < seconds / T:
        slow = rng.random() < 0.3
        speed = math.exp(rng.uniform(math.log(0.001), math.log(0.01))) if slow else rng.uniform(0.03, 0.35)
        length = speed * rng.uniform(0.15, 0.4) if slow else rng.uniform(0.02, 0.18)
        length *= 1 if at < rng.uniform(-0.08, 0.08) else -1
        rows = max(int(2 * abs(length) / speed / T), 150)
        for k in range(1, rows + 1):
            s = k / rows
            x.append(at + length * (s - math.sin(2 * math.pi * s) / (2 * math.pi)))
        at += length
        x += [at] * rng.randrange(20, 160)
    return x[: int(seconds / T)]


class Controller:
    """cascade_p_pi, row by row."""

    def __init__(self):
        c = CONTROLLER
        self.w = 2 * math.pi * c["velocity_filter_Hz"]
        self.r = self.v_ref = self.y = self.v = self.integral = 0.0

    def __call__(self, r, y):
        c, w = CONTROLLER, self.w
        v_ref = (r - self.r) / T
        a_ref = (v_ref - self.v_ref) / T
        self.v = ((2 - w * T) * self.v + 2 * w * (y - self.y)) / (2 + w * T)
        e = c["position_gain_per_s"] * (r - y) + c["velocity_feedforward"] * v_ref - self.v
        i = self.integral + c["velocity_integral_V_per_m"] * T * e
        self.integral = max(-LIMIT, min(LIMIT, i))
        u = c["velocity_gain_V_s_per_m"] * e + self.integral
        u += c["acceleration_feedforward_V_s2_per_m"] * a_ref + c["viscous_feedforward_V_s_per_m"] * v_ref
        self.r, self.v_ref, self.y = r, v_ref, y
        u = max(-LIMIT, min(LIMIT, u))
        return math.copysign(math.floor(abs(u) / DAC + 0.5), u) * DAC


def simulate(plant, reference, rng):
    """Rows (t, reference, reading, command) of the axis under its controller."""
    h = T / PARTS
    mass, kf, viscous = plant["mass_kg"], plant["force_constant_N_per_V"], plant["viscous_N_s_per_m"]
    coulomb = plant.get("coulomb_N") or 0.0
    excess = max((plant.get("static_N") or 0.0) - coulomb, 0.0)
    vs = plant.get("stribeck_velocity_m_per_s") or 1.0
    constant, spring = plant.get("constant_force_N") or 0.0, plant.get("spring_N_per_m") or 0.0
    period, waves = plant.get("cogging") or (1.0, ())
    pull, place, reach = plant.get("magnet") or (0.0, 0.0, 1.0)
    late = round(plant["delay_s"] / h)
    control, x, v, acting = Controller(), 0.0, 0.0, 0.0
    coming, rows = [], []  # commands on their way: (step at which it acts, volts)
    for k, r in enumerate(reference):
        y = round((x + rng.gauss(0, 4e-8)) / COUNT) * COUNT
        u = control(r, y)
        rows.append((k * T, r, y, u))
        coming.append((k * PARTS + late, u))
        for step in range(k * PARTS, (k + 1) * PARTS):
            while coming and coming[0][0] <= step:
                acting = coming.pop(0)[1]
            force = kf * acting + constant - spring * x
            for i, (size, phase) in enumerate(waves, 1):
                force += size * math.sin(2 * math.pi * i * x / period + phase)
            if pull:
                near = (x - place) / reach
                force -= pull * near * math.exp(0.5 - 0.5 * near * near)
            free = (v + h / mass * force) / (1 + h / mass * viscous)
            stop = h / mass * (coulomb + excess * math.exp(-abs(v) / vs))
            new = math.copysign(max(abs(free) - stop, 0.0), free)
            x += h * 0.5 * (v + new)
            v = new
    return rows


def write_log(path, rows):
    with open(path, "w") as f:
        f.write("t_s,x_ref_m,x_pos_m,x_cmd_V\n")
        f.writelines(f"{t:.5f},{r:.12f},{y:.8f},{u:.6f}\n" for t, r, y, u in rows)


def write_case(folder, number, truth, has, says):
    rng = random.Random(1000 + number)
    plant = {**PLANT, **has}
    described = {k: v for k, v in {**plant, **says}.items() if v is not None and k not in ("cogging", "magnet")}
    for key, within in (("mass_kg", 0.02), ("force_constant_N_per_V", 0.01), ("viscous_N_s_per_m", 0.10), ("coulomb_N", 0.05)):
        plant[key] *= 1 + within * rng.uniform(-0.5, 0.5)  # the owner's values are true to half their tolerance
    machine = {
        "schema": "quadrant.machine/1",
        "sample_period_s": T,
        "axes": {
            "x": {
                "plant": described,
                "tolerance": TOLERANCE,
                "encoder": {"resolution_m": COUNT},
                "actuator": {"limit_V": LIMIT, "dac_bits": 16, "dac_range_V": 20},
                "controller": CONTROLLER,
            }
        },
    }
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "machine.json"), "w") as f:
        json.dump(machine, f, indent=2)
    write_log(os.path.join(folder, "log.csv"), simulate(plant, motion(7, rng), rng))
    write_log(os.path.join(folder, "holdout.csv"), simulate(plant, motion(4, rng), rng))


def main(folder):
    truth = {}
    for number, (name, has, says, accept) in enumerate(CASES, 1):
        write_case(os.path.join(folder, f"{number:03d}"), number, name, has, says)
        kind = name if name in ("none", "unknown") else "pair" if "+" in name else "single"
        truth[f"{number:03d}"] = {"kind": kind, "truth": name, "accept": accept}
    with open(os.path.join(folder, "truth.json"), "w") as f:
        json.dump(truth, f, indent=1)
    print(f"{len(truth)} machines in {folder}")


if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    main(sys.argv[1])
