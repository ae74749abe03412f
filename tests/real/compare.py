#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Two logs of a real position servo beside each other (servo_pendulum): with its gain at 200 and at 400 the gain is what
differs, and its values are those that the firmware was told (its documented scale, in the machine files); two
motions with the same gain are alike.
usage: compare.py PROGRAM SHARED     exit code 77: the records are not there"""
import json, os, subprocess, sys, tempfile


def compared(program, data, first, second, folder):
    out = os.path.join(folder, "compared.json")
    at = lambda name: os.path.join(data, name)
    done = subprocess.run([program, "compare", "--quiet", at(first), at(second), "--machine", at("001/machine.json"), "--json", out],
                          capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if done.returncode != 0:
        sys.exit(f"BAD  {first} beside {second}: exit code {done.returncode}: {done.stderr.strip()}")
    with open(out) as file:
        return json.load(file)


def described_gain(data, case):
    with open(os.path.join(data, case, "machine.json")) as file:
        return json.load(file)["axes"]["q"]["drive"]["position_gain_per_rad"]


def main(program, shared):
    data = os.path.join(shared, "data", "servo_pendulum")
    if not os.path.isdir(os.path.join(data, "001")):
        print(f"SKIPPED: no {data}")
        return 77
    bad = 0
    with tempfile.TemporaryDirectory() as folder:
        differ = compared(program, data, "001/log.csv", "002/log.csv", folder)
        alike = compared(program, data, "001/log.csv", "001/holdout.csv", folder)
    names = [d["effect"] for d in differ["differences"]]
    bad += names != ["drive_gain"]
    print(f"gain 200 beside gain 400: {differ['likeness']} {names}")
    for log, case in (("first", "001"), ("second", "002")):
        told = described_gain(data, case)
        value = differ["differences"][0][log]["drive.position_gain_per_rad"]["value"] if names else 0
        bad += abs(value / told - 1) > 0.1
        print(f"  {log}: {value:.3g} 1/rad, as the firmware was told {told:.3g}")
    names = [d["effect"] for d in alike["differences"]]
    bad += names != []
    print(f"two motions with one gain: {alike['likeness']} {names}")
    return 1 if bad else 0


sys.exit(main(*sys.argv[1:3]))
