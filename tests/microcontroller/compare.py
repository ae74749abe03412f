#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: compare.py HOST OTHER NAME     what every_block printed on the host and elsewhere; exit code 1 when too far apart

A block whose headers call none of exp, log, pow, sin, cos and the like must be equal bit for bit. Where they do, the C
libraries differ in the last place: within 4 units in the last place of the block's largest output. (Of each single output
it is the last figure that is printed: large where terms cancel.)"""
import pathlib
import re
import struct
import sys

INCLUDE = pathlib.Path(__file__).parents[2] / "include/quadrant"
CALL = re.compile(r"\b(exp|expm1|log|log1p|log10|pow|sin|cos|tan|sinh|cosh|tanh|asin|acos|atan|atan2|polar)\(")
TAKES_A_LAW = {"friction_feedforward"}  # as a template argument: no header of it shows what is called
# Gains solved from a Riccati equation of exp, sin and cos: what is allowed instead; measured 24 on the Cortex-M7.
SOLVED = {("harmonic_force_observer", "double"): 32}


def calls(header, seen):
    """Whether a header or what it includes of this library calls such a function, in code."""
    if header in seen:
        return False
    seen.add(header)
    code = re.sub(r"//.*", "", header.read_text())
    return bool(CALL.search(code)) or any(
        calls((header.parent / inner).resolve(), seen) for inner in re.findall(r'#include "(.*?)"', code))


def transcendental(block):
    base = block.split(",")[0]
    return base in TAKES_A_LAW or any(calls(header.resolve(), set()) for header in INCLUDE.glob(f"*/{base}.hpp"))


def read(path):
    rows = {}
    with open(path) as lines:
        for line in lines:
            number, block, bits = line.rstrip("\n").split("|")
            rows[number, block] = bits.split()
    return rows


def number_of(bits):
    return struct.unpack(">f" if len(bits) == 8 else ">d", bytes.fromhex(bits))[0]


def place(bits):  # neighbours differ by one
    i, top = int(bits, 16), 1 << (4 * len(bits) - 1)
    return top - i if i & top else i


host, other = read(sys.argv[1]), read(sys.argv[2])
name, bad, equal = sys.argv[3], 0, 0
if host.keys() != other.keys() or len(host) < 100:
    sys.exit(f"{name}: not the same blocks ({len(host)} and {len(other)})")
for (number, block), bits in host.items():
    theirs = other[number, block]
    if len(bits) != len(theirs) or len(bits) != 400:
        sys.exit(f"{name}: {block} ({number}) has {len(bits)} and {len(theirs)} samples")
    if bits == theirs:
        equal += 1
        continue
    ours = [number_of(b) for b in bits]
    apart = max(abs(a - number_of(b)) for a, b in zip(ours, theirs))
    units = apart / max(map(abs, ours)) / (2**-23 if number == "float" else 2**-52)
    single = max(abs(place(a) - place(b)) for a, b in zip(bits, theirs))
    allowed = SOLVED.get((block, number), 4 if transcendental(block) else 0)
    print(f"{name}: {block} ({number}): {units:.2f} of the largest output, {single} of each")
    if not units <= allowed:
        print(f"FAILED: allowed are {allowed}")
        bad = 1
must = sum(not transcendental(block) for _, block in host)
print(f"{name}: {must} of {len(host)} must be equal bit for bit")
print(f"{name}: {equal} of {len(host)} equal bit for bit")
sys.exit(bad)
