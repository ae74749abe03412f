#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Records of robots that the shared folder may lack (docs/real says where to get them), from the raw files
through import to diagnose, each skipped loudly where it is not there.
usage: robots.py PROGRAM SHARED     exit code 77: no record is there
As diagnose.py: what is not found yet is run and printed, and fails as soon as it is found."""
import sys

import diagnose
from diagnose import claimed, claims, meets, nothing_before_the_tap

MEASURED = {"command_is": "measured"}


def joint(inertia, viscous):
    return {"plant": {"inertia_kg_m2": inertia, "viscous_Nm_s_per_rad": viscous},
            "tolerance": {"inertia": 0.2, "viscous": 0.15}, "actuator": MEASURED}


def wheel(viscous):
    """Volts are the unit of its torque."""
    return {"plant": {"inertia_kg_m2": 0.003, "viscous_Nm_s_per_rad": viscous, "torque_constant_Nm_per_V": 1},
            "tolerance": {"inertia": 0.3, "viscous": 0.4, "torque_constant": 0.02}, "actuator": {}}


TX40 = {"q1": joint(1.1, 8.05), "q2": joint(0.97, 5.53), "q4": joint(0.035, 1.11)}
# Amperes are the unit of its forces.
TIAGO = {
    "torso": {"plant": {"mass_kg": 1, "viscous_N_s_per_m": 3.7, "force_constant_N_per_A": 1},
              "tolerance": {"mass": 0.5, "viscous": 0.2, "force_constant": 0.02},
              "encoder": {"resolution_m": 3.9e-5}, "actuator": MEASURED},
    "arm1": {"plant": {"inertia_kg_m2": 0.24, "viscous_Nm_s_per_rad": 2.2, "torque_constant_Nm_per_A": 1},
             "tolerance": {"inertia": 0.5, "viscous": 0.2, "torque_constant": 0.02},
             "encoder": {"resolution_rad": 1.534e-5}, "actuator": MEASURED},
}
# A per cent of the command is a volt, and a volt a newton metre.
DRONE = {"q": {"plant": {"inertia_kg_m2": 3.1, "viscous_Nm_s_per_rad": 2.0, "torque_constant_Nm_per_V": 1},
               "tolerance": {"inertia": 0.2, "viscous": 0.6, "torque_constant": 0.02},
               "actuator": {"lag_s": 0.1}}}


def cyclo(inertia, viscous):
    """Torque behind the gear, by the drive's current."""
    return {"joint": {"plant": {"inertia_kg_m2": inertia, "viscous_Nm_s_per_rad": viscous},
                      "tolerance": {"inertia": 0.2, "viscous": 0.5}, "actuator": MEASURED}}


def servo(friction=None, gain=1.87, **more):
    """Goals and positions only: stiffness 1.87 * 12 V * 0.245 N m/V = 5.5 N m/rad, by the servo's current."""
    plant = {"inertia_kg_m2": 0.0085, "viscous_Nm_s_per_rad": 0.12, "torque_constant_Nm_per_V": 0.245,
             "delay_s": 0}
    tolerance = {"inertia": 0.3, "viscous": 0.4, "position_gain": 0.1, "supply": 0.05, "torque_constant": 0.1,
                 "command_delay": 0.5}
    if friction:
        plant["coulomb_Nm"], tolerance["coulomb"] = friction, 0.15
    return {"plant": {**plant, **more}, "tolerance": tolerance, "encoder": {"resolution_rad": 0.00153398},
            "actuator": {},
            "drive": {"kind": "position_servo", "position_gain_per_rad": gain, "maximum_duty": 1,
                      "supply_V": 12, "command_delay_s": 0.03}}


STS3250 = {"q": {
    "plant": {"inertia_kg_m2": 0.045, "viscous_Nm_s_per_rad": 0.6, "torque_constant_Nm_per_V": 0.41},
    "tolerance": {"inertia": 0.5, "viscous": 0.4, "position_gain": 0.1, "supply": 0.05, "torque_constant": 0.2,
                  "command_delay": 0.5},
    "encoder": {"resolution_rad": 0.00153398}, "actuator": {},
    "drive": {"kind": "position_servo", "position_gain_per_rad": 11.6, "maximum_duty": 0.97, "supply_V": 12,
              "command_delay_s": 0.02}}}
MOUSE = {"left": wheel(0.02), "right": wheel(0.021)}
UR5 = {q: {"plant": {"inertia_kg_m2": inertia, "torque_constant_Nm_per_A": constant},
           "tolerance": {"inertia": 0.1, "torque_constant": 0.05}, "encoder": {"resolution_rad": 1e-4},
           "actuator": MEASURED}
       for q, inertia, constant in (("q1", 8.2, 14.87), ("q2", 21.6, 13.26), ("q3", 5.0, 11.13))}
PANDA = {"q7": {"plant": {"inertia_kg_m2": 0.004}, "tolerance": {"inertia": 0.5}, "actuator": MEASURED}}

LOGS = {
    "tx40": ("staubli_tx40", ["staubli_tx40/pos_read_data.csv", "staubli_tx40/curr_data.csv"],
             ["--sample-period", "0.002"]),
    "tiago": ("tiago", ["tiago/tiago_position.csv", "tiago/tiago_effort.csv"], []),
    "mouse": ("micromouse", ["micromouse/controllerDelayImpact5ms.csv"], ["--resample"]),
    **{m: ("so101", [f"so101/{m}/{what}.csv" for what in ("state_motor", "control")], ["--to", "30"])
       for m in ("large_amplitude", "repetitive_motion", "chirp_sweep", "multisine")},
    **{f"cyclo_{n}": ("cyclo_actuator", [f"cyclo_actuator/trajectory_{n}.csv"], ["--resample"])
       for n in ("mounted", "bar", "350gr", "700gr")},
    **{f"sts_{n}": ("sts3250", [f"sts3250/{n}.csv"], ["--sample-period", "0.02055"])
       for n in ("sin_sin", "up_and_down")},
    "panda": ("panda", ["panda/panda.csv"], ["--resample"]),
    **{f"ur5_{n}": ("ur5", [f"ur5/joint_{n}.csv"], ["--resample"]) for n in (1, 2, 3)},
    "ur5_slow": ("ur5", ["ur5/joint_1.csv"], ["--resample", "--sample-period", "0.1"]),
    "drone": ("quarter_drone", ["quarter_drone/dados_14_drone.csv"], ["--resample"]),
    "drone_fast": ("quarter_drone", ["quarter_drone/14_drone_seq_20260529_195254.csv"], ["--resample"]),
}
RECORDS = {
    "tx40": ("tx40", None, TX40, []),
    "tiago": ("tiago", None, TIAGO, []),
    "mouse": ("mouse", None, MOUSE, []),
    "panda": ("panda", None, PANDA, []),
    **{f"ur5_{n}": (f"ur5_{n}", None, {f"q{n}": UR5[f"q{n}"]}, []) for n in (1, 2, 3)},
    "ur5_slow": ("ur5_slow", None, {"q1": UR5["q1"]}, []),
    "drone": ("drone", None, DRONE, []),
    "servo_healthy": ("large_amplitude", "repetitive_motion", {"rotation": servo(0.055)}, []),
    "servo_friction": ("large_amplitude", "repetitive_motion", {"rotation": servo()}, []),
    "servo_gain": ("large_amplitude", "multisine", {"rotation": servo(0.055, gain=3.74)}, []),
    "elbow_friction": ("repetitive_motion", "chirp_sweep", {"elbow": servo(constant_torque_Nm=0.21)}, []),
    "elbow_weight": ("repetitive_motion", "chirp_sweep", {"elbow": servo(0.207)}, []),
    "sts3250": ("sts_sin_sin", "sts_up_and_down", STS3250, []),
    "cyclo_mounted": ("cyclo_mounted", None, cyclo(0.17, 0.17), []),
    "cyclo_bar": ("cyclo_bar", None, cyclo(0.2, 0.3), []),
    "cyclo_350gr": ("cyclo_350gr", None, cyclo(0.23, 0.47), []),
    "cyclo_700gr": ("cyclo_700gr", None, cyclo(0.3, 0.83), []),
    "drone_held": ("drone_fast", "drone", DRONE, []),
}


def names_of(cause):
    return {cause["effect"], *cause["confusable_with"]}


def first_of(d, axis):
    return next((c for c in d["causes"] if c["axis"] == axis), None)


# What a regression on the motion has of the arm, N m and N m s: joint, effect, key, value.
UR5_KNOWN = [(1, "viscous_friction", "viscous_Nm_s_per_rad", 31.5), (1, "coulomb_friction", "coulomb_Nm", 21.2),
             (2, "gravity", "gravity_torque_Nm", 139), (2, "coulomb_friction", "coulomb_Nm", 14),
             (3, "gravity", "gravity_torque_Nm", 49.2), (3, "viscous_friction", "viscous_Nm_s_per_rad", 10.7),
             (3, "coulomb_friction", "coulomb_Nm", 7.4)]


def near(cause, key, value):
    return meets(cause, key, 0.95 * value, 1.05 * value)


def as_at_full_rate(d):
    """Friction alone is claimed, and none that the faster record of joint 1 excludes."""
    known = {effect: (key, value) for joint, effect, key, value in UR5_KNOWN if joint == 1}
    return all(c["effect"] in known and near(c, *known[c["effect"]]) for c in claims(d))


# record, what its page says, test
RIGHT = [
    ("tx40", "gravity is the first cause of joint 2 and claimed",
     lambda d: bool(claimed(d, "gravity", "q2")) and first_of(d, "q2") == claimed(d, "gravity", "q2")),
    ("tx40", "Coulomb friction of joint 2 is claimed and meets 8.26 N m",
     lambda d: meets(claimed(d, "coulomb_friction", "q2"), "coulomb_Nm", 8.26, 8.26)),
    ("tx40", "Coulomb friction of joint 1 is claimed and meets 7.1 to 8.1 N m",
     lambda d: meets(claimed(d, "coulomb_friction", "q1"), "coulomb_Nm", 7.1, 8.1)),
    ("tx40", "Coulomb friction of joint 4 is claimed and meets 2.48 N m",
     lambda d: meets(claimed(d, "coulomb_friction", "q4"), "coulomb_Nm", 2.48, 2.48)),
    ("tiago", "Coulomb friction of the torso is claimed and meets 0.67 A",
     lambda d: meets(claimed(d, "coulomb_friction", "torso"), "coulomb_N", 0.67, 0.67)),
    ("tiago", "the weight of the torso is claimed as a constant force",
     lambda d: bool(claimed(d, "constant_force", "torso"))),
    ("tiago", "Coulomb friction of arm 1, not Stribeck friction, is claimed and meets 0.14 A",
     lambda d: meets(claimed(d, "coulomb_friction", "arm1"), "coulomb_Nm", 0.14, 0.14)),
    ("servo_healthy", "nobody is blamed", lambda d: not claims(d)),
    ("servo_friction", "Coulomb friction is claimed and meets 0.054 to 0.06 N m",
     lambda d: meets(claimed(d, "coulomb_friction"), "coulomb_Nm", 0.054, 0.06)),
    ("servo_gain", "the gain, in a group with torque constant and supply, is the first cause, and nothing else",
     lambda d: bool(d["causes"]) and len(claims(d)) < 2 and "drive_gain" in names_of(d["causes"][0])
     and names_of(d["causes"][0]) <= {"drive_gain", "force_constant", "supply_voltage"}
     and d["causes"][0]["group_probability"] >= 0.5),
    ("elbow_friction", "Coulomb friction is claimed and meets 0.207 N m",
     lambda d: meets(claimed(d, "coulomb_friction"), "coulomb_Nm", 0.207, 0.207)),
    ("elbow_weight", "gravity, in a group with a constant torque, is the first cause and meets 0.21 N m",
     lambda d: d["causes"][0]["effect"] == "gravity" and d["causes"][0]["group_probability"] >= 0.5
     and meets(d["causes"][0], "gravity_torque_Nm", 0.21, 0.21)),
    ("mouse", "Coulomb friction of the right wheel is claimed and meets 1.2 to 1.3 V",
     lambda d: meets(claimed(d, "coulomb_friction", "right"), "coulomb_Nm", 1.2, 1.3)),
    ("drone", "gravity is the first cause, claimed, and meets 33 to 55 N m",
     lambda d: first_of(d, "q") is not None and first_of(d, "q") == claimed(d, "gravity", "q")
     and meets(claimed(d, "gravity", "q"), "gravity_torque_Nm", 33, 55)),
    ("drone", "no dead zone is claimed", lambda d: not claimed(d, "actuator_dead_zone", "q")),
    ("drone_held", "gravity is claimed with another motion held out",
     lambda d: bool(claimed(d, "gravity", "q"))),
    ("mouse", "Coulomb friction of the left wheel is claimed and meets 1.4 V",
     lambda d: meets(claimed(d, "coulomb_friction", "left"), "coulomb_Nm", 1.4, 1.4)),
    ("sts3250", "gravity is the first cause, claimed, and meets 1.33 N m",
     lambda d: bool(d["causes"]) and d["causes"][0] == claimed(d, "gravity")
     and meets(claimed(d, "gravity"), "gravity_torque_Nm", 1.33, 1.33)),
    ("cyclo_mounted", "Coulomb friction is claimed, meets 3.3 to 3.4 N m, and nothing else is claimed",
     lambda d: meets(claimed(d, "coulomb_friction"), "coulomb_Nm", 3.3, 3.4) and len(claims(d)) == 1),
    ("cyclo_bar", "Coulomb friction is claimed and meets 2.6 to 3.4 N m",
     lambda d: meets(claimed(d, "coulomb_friction"), "coulomb_Nm", 2.6, 3.4)),
    ("cyclo_700gr", "gravity is claimed and meets 2.8 to 3.0 N m",
     lambda d: meets(claimed(d, "gravity"), "gravity_torque_Nm", 2.8, 3.0)),
    ("cyclo_700gr", "Coulomb friction is claimed and meets 2.7 to 3.0 N m",
     lambda d: meets(claimed(d, "coulomb_friction"), "coulomb_Nm", 2.7, 3.0)),
    ("panda", "Coulomb friction is claimed, meets the 0.277 and 0.288 N m of the paper, and nothing else is",
     lambda d: meets(claimed(d, "coulomb_friction"), "coulomb_Nm", 0.277, 0.288) and len(claims(d)) == 1),
    *((f"ur5_{n}", f"{effect} of joint {n} is claimed and meets {value}",
       lambda d, q=f"q{n}", effect=effect, key=key, value=value: near(claimed(d, effect, q), key, value))
      for n, effect, key, value in UR5_KNOWN),
    ("ur5_slow", "ten rows a second: no friction is claimed that the faster record excludes",
     as_at_full_rate),
] + [(r, "nothing before the tap of a measured command is named", nothing_before_the_tap)
     for r in ("panda", "ur5_1", "ur5_2", "ur5_3", "tx40", "tiago",
               "cyclo_mounted", "cyclo_bar", "cyclo_350gr", "cyclo_700gr")]

NOT_YET = [
    ("cyclo_350gr", "gravity of 1.75 N m is claimed",
     lambda d: meets(claimed(d, "gravity"), "gravity_torque_Nm", 1.75, 1.75)),
]

if __name__ == "__main__":
    sys.exit(diagnose.main(*sys.argv[1:], diagnose.Suite(LOGS, RECORDS, RIGHT, NOT_YET)))
