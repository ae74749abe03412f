#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""usage: compare.py NAME=RECORD ...     records of run_program.py, columns as plant.hal writes them
Prints one row of a Markdown table for each: tracking error of both axes over each program (of turns.ngc the last two
turns), and what a call of the controller took."""
import math
import re
import sys


def clocks_per_us():
    """HAL's .time counts the processor's clock (TSC); its frequency is what the kernel measured."""
    found = re.search(r"cpu MHz\s*: ([\d.]+)", open("/proc/cpuinfo").read())
    return float(found.group(1)) if found else float("nan")


def error_um(rows, axis):
    return [1000 * (row[1 + 3 * axis] - row[2 + 3 * axis]) for row in rows]


def figures(rows):
    out = []
    for axis in (0, 1):
        e = error_um(rows, axis)
        out.append(f"{math.sqrt(sum(x * x for x in e) / len(e)):.1f} / {max(map(abs, e)):.1f}")
    return out


def moving(rows):
    """Without the rest before and after."""
    at = [i for i in range(1, len(rows)) if rows[i][1] != rows[i - 1][1] or rows[i][4] != rows[i - 1][4]]
    return rows[at[0]:at[-1] + 1]


print("| controller | program | x error, rms / largest [um] | y | a call, median / 99.9 % [us] |")
print("|---|---|---|---|---|")
for argument in sys.argv[1:]:
    name, path = argument.split("=", 1)
    record = [[float(cell) for cell in line.split()] for line in open(path) if "overrun" not in line]
    if any(b[0] != a[0] + 1 for a, b in zip(record, record[1:])):
        sys.exit(path + ": rows were lost")
    for line in open(path + ".programs"):
        program, first, last = line.split()
        rows = moving(record[int(first):int(last)])
        if program.startswith("turns"):
            rows = rows[len(rows) * 8 // 10:]
        clocks = sorted(row[c] / clocks_per_us() for row in rows for c in (7, 8))
        took = f"{clocks[len(clocks) // 2]:.2f} / {clocks[len(clocks) * 999 // 1000]:.2f}"
        print(f"| {name} | {program.removesuffix('.ngc')} | " + " | ".join(figures(rows)) + f" | {took} |")
