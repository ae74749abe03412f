#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every real record from its raw file to a log by one command of quadrant-gap import, without a script between.
usage: import.py PROGRAM SHARED     exit code 77: the records are not there"""
import csv, os, subprocess, sys, tempfile

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
SERVO = ["sin_sin", "sin_time_square", "up_and_down", "lift_and_drop"]

# map, raw files, options, columns of the log, rows (at least, at most), what the notes must say
RECORDS = [
    ("dfki_pendulum", [f"dfki_pendulum/{n}.measured.csv", f"dfki_pendulum/{n}.desired.csv"], [],
     "t_s,q_pos_rad,q_torque_Nm,q_ref_rad", rows, ["measured"])
    for n, rows in (("pd", (1160, 1170)), ("es", (3990, 4000)))
] + [
    ("dfki_double_pendulum", ["dfki_double_pendulum/20230629-143601.csv"], [],
     "t_s,q1_pos_rad,q1_torque_Nm,q2_pos_rad,q2_torque_Nm", (5000, 5000), ["no position reference", "measured"]),
    # 16 s at 1 kHz: rows that come late or twice, readings that repeat
    ("laas_anti_cogging", ["laas_anti_cogging/speed_test.txt"], ["--resample"],
     "t_s,q_pos_rad,q_current_A,q_ref_rad_per_s", (15700, 16001), ["resampled", "repeated readings", "only its speed"]),
    ("laas_anti_cogging", ["laas_anti_cogging/speed_test.txt"], ["--resample", "--to", "8"],
     "t_s,q_pos_rad,q_current_A,q_ref_rad_per_s", (7800, 8001), ["resampled"]),
    ("odrive_slow_move", ["odrive_cogging/odrive_slow2_nocomp_1.csv"], ["--resample"],
     "t_s,q_pos_rad,q_current_A", (4200, 4310), ["resampled", "resampling makes an error"]),
    (None, ["emps/log.csv"], [], "t_s,x_ref_m,x_pos_m,x_cmd_V", (24841, 24841), []),
    # Those that the shared folder may lack: docs/real says where they are.
    ("staubli_tx40", ["staubli_tx40/pos_read_data.csv", "staubli_tx40/curr_data.csv"], ["--sample-period", "0.002"],
     ",".join(["t_s"] + [f"q{j}_pos_rad" for j in range(1, 5)] + [f"q{j}_torque_Nm" for j in range(1, 5)]),
     (4499, 4501), ["no time column", "axis q1, q2, q3, q4: the command is a measured one"]),
    ("tiago", ["tiago/tiago_position.csv", "tiago/tiago_effort.csv"], [],
     "t_s,arm1_pos_rad,arm2_pos_rad,arm3_pos_rad,torso_pos_m,arm1_current_A,arm2_current_A,arm3_current_A,"
     "torso_current_A", (8015, 8025), ["resampled", "measured"]),
    ("so101", ["so101/large_amplitude/state_motor.csv", "so101/large_amplitude/control.csv"], [],
     "t_s,elbow_pos_rad,rotation_pos_rad,elbow_ref_rad,rotation_ref_rad", (6650, 6652), ["resampled"]),
    ("cyclo_actuator", ["cyclo_actuator/trajectory_700gr.csv"], ["--resample"],
     "t_s,joint_ref_rad,joint_pos_rad,joint_torque_Nm", (2100, 2260), ["rows lack a value", "rows have the stamp"]),
    ("quarter_drone", ["quarter_drone/14_drone_seq_20260529_195254.csv"], ["--resample"],
     "t_s,q_ref_rad,q_pos_rad,q_cmd_V", (6030, 6075), ["resampled", "rows are missing in 2 places"]),
    ("micromouse", ["micromouse/controllerDelayImpact5ms.csv"], ["--resample"],
     "t_s,left_cmd_V,left_ref_rad_per_s,left_vel_rad_per_s,right_cmd_V,right_ref_rad_per_s,right_vel_rad_per_s,"
     "left_pos_rad,right_pos_rad", (785, 791), ["the integral of left_vel_rad_per_s stands for it"]),
    ("micromouse", ["micromouse/controllerDelayImpact1ms.csv"], ["--resample"],
     "t_s,left_cmd_V,left_ref_rad_per_s,left_vel_rad_per_s,right_cmd_V,right_ref_rad_per_s,right_vel_rad_per_s,"
     "left_pos_rad,right_pos_rad", (600, 1060), ["--sample-period 0.0", "rows are missing every"]),
] + [
    (None, [f"servo_pendulum/records/{motion}_kp{kp}.csv"], ["--resample"],
     "t_s,q_ref_rad,q_pos_rad,q_cmd_V,q_duty,q_supply_V,q_enabled", (1000, 1800),
     ["resampled"] + (["the drive is off"] if motion == "lift_and_drop" else []))
    for motion in SERVO for kp in (100, 200, 400, 800)
]


def faults(program, data, out, record):
    name, raw, options, columns, (least, most), say = record
    command = [program, "import", *options]
    if name:
        command += ["--map", os.path.join(ROOT, "examples", "import", name + ".map.json")]
    done = subprocess.run(command + [os.path.join(data, r) for r in raw] + [out], capture_output=True, text=True,
                          stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        yield f"exit code {done.returncode}: {done.stderr.strip()}"
        return
    for words in say:
        if words not in done.stdout:
            yield f"no note says {words!r}"
    with open(out) as file:
        rows = list(csv.reader(file))
    if ",".join(rows[0]) != columns:
        yield f"columns {rows[0]}"
    if not least <= len(rows) - 1 <= most:
        yield f"{len(rows) - 1} rows, not {least} to {most}"
    times = [float(row[0]) for row in rows[1:]]
    if any(b <= a for a, b in zip(times, times[1:])):
        yield "stamps that do not increase"


def main(program, shared):
    data = os.path.join(shared, "data")
    bad = missing = 0
    with tempfile.TemporaryDirectory() as folder:
        for record in RECORDS:
            if not all(os.path.isfile(os.path.join(data, r)) for r in record[1]):
                print(f"SKIPPED: no {os.path.join(data, record[1][0])}")
                missing += 1
                continue
            found = list(faults(program, data, os.path.join(folder, "log.csv"), record))
            bad += bool(found)
            print("BAD " if found else "ok  ", " ".join(record[1] + record[2]), "; ".join(found))
    if missing == len(RECORDS):
        return 77
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
