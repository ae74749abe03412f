#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""docs/reproduction.md against a run: the same words, and every figure within 0.5 % (distances within 0.6 of a per cent). The
rows of a search on a rough cost may differ in their figures: where it ends, the last digit of another libm's sine decides. So
may the digits of an exact zero.

same_text.py COMMITTED.md WRITTEN.md [--part]     --part: some experiments were written; their rows against the committed ones
"""
import re
import sys

NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?(?: %)?)")


ROUGH = ("| `stage.tuning.", "| `thesis.harmonic_observer` | zero_")


def differs(a, b):
    if a == b:
        return False
    if not (NUMBER.fullmatch(a) and NUMBER.fullmatch(b)) or a.endswith("%") != b.endswith("%"):
        return True
    if a.endswith("%"):
        return abs(float(a[:-2]) - float(b[:-2])) > 0.6
    return abs(float(a) - float(b)) > 0.005 * abs(float(a))


def rows(path):
    """The rows of experiments, by id and quantity."""
    lines = [line for line in open(path, encoding="utf-8") if line.startswith("| `")]
    return {tuple(line.split(" | ")[:2]): line for line in lines}


def part(committed, written):
    committed, written = rows(committed), rows(written)
    wrong = [(line, committed.get(key, "nothing\n")) for key, line in written.items()
             if len(a := NUMBER.split(committed.get(key, ""))) != len(b := NUMBER.split(line)) or any(map(differs, a, b))]
    for line, there in wrong[:20]:
        print(f"FAILED: committed {there}        written   {line}", end="")
    if wrong or len(written) < 60:
        sys.exit(f"{len(written)} rows; write it again: quadrant-reproduce --markdown docs/reproduction.md")
    print(f"{len(written)} rows agree")


def main():
    if sys.argv[3:] == ["--part"]:
        return part(*sys.argv[1:3])
    committed, written = ([NUMBER.split(line) for line in open(path, encoding="utf-8")] for path in sys.argv[1:3])
    wrong = [(k, "".join(a), "".join(b)) for k, (a, b) in enumerate(zip(committed, written), 1)
             if len(a) != len(b) or not "".join(a).startswith(ROUGH) and any(map(differs, a, b))]
    for k, a, b in wrong[:20]:
        print(f"FAILED: line {k}\n  committed {a}  written   {b}", end="")
    if len(committed) != len(written):
        print(f"FAILED: {len(committed)} lines committed, {len(written)} written")
    if wrong or len(committed) != len(written):
        sys.exit("write it again: quadrant-reproduce --markdown docs/reproduction.md")
    print(f"{len(written)} lines agree")


if __name__ == "__main__":
    main()
