#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: rooms.py ROOT: no header includes itself by a detour, and the rooms stand in order.

The order is that of the tables under "Rooms" and "Rooms of the diagnosis" in docs/CONTRIBUTING.md: a room includes itself
and rooms above it in the table. What lies beside the rooms includes any of them, and no room includes it but one that
holds the parts of a call of the same name (compare.hpp, compare/).

Numbered examples are for reading: no test includes one. A test includes from tests/, what it tests from examples/programs
and examples/linuxcnc, and what writes the docs from docs/generators; no program and no generator includes a test.

Every header opens its namespace inside the inline version namespace of this interface, so that two versions in one
program are two sets of symbols.

At the top stand these folders and no other; `build` and those of a tool, which begin with a dot, are not looked at.
"""
import os
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
include = root / "include"
headers = sorted(p for p in (include / "quadrant").rglob("*") if p.suffix in (".hpp", ".ipp"))
faults = []


def included_by(header):
    text = header.read_text()
    for name in re.findall(r'^\s*#\s*include "([^"]+)"', text, re.M):
        yield pathlib.Path(os.path.normpath(header.parent / name))
    for name in re.findall(r"^\s*#\s*include <(quadrant/[^>]+)>", text, re.M):
        yield include / name


graph = {header: list(included_by(header)) for header in headers}
for header, targets in graph.items():
    faults += [f"{header}: includes {t}, which is not there" for t in targets if t not in graph]

done, path = set(), []


def visit(header):
    if header in path:
        faults.append("cycle: " + " -> ".join(p.name for p in path[path.index(header):] + [header]))
    elif header not in done:
        path.append(header)
        for target in graph.get(header, []):
            visit(target)
        path.pop()
        done.add(header)


sys.setrecursionlimit(10 * len(headers) + 1000)
for header in headers:
    visit(header)

page = (root / "docs/CONTRIBUTING.md").read_text()


def order_of(heading):
    section = page.split(f"## {heading}\n")[1].split("\n## ")[0]
    return re.findall(r"^\| `([a-z_]+)/` \|", section, re.M)


def hold(top, heading, what_is_above):
    """The rooms of `top` stand in the order of the page; what lies in `top` itself includes rooms and is included by none."""
    order = order_of(heading)
    rooms = {p.name for p in top.iterdir() if p.is_dir()}
    if rooms != set(order):
        faults.append(f"docs/CONTRIBUTING.md lists {sorted(order)}, {top.name} holds {sorted(rooms)}")

    def room(header):
        inside = header.relative_to(top).parts
        return inside[0] if len(inside) > 1 else None

    for header, targets in graph.items():
        if not header.is_relative_to(top) or room(header) not in order:
            continue
        for target in targets:
            if not target.is_relative_to(top):
                continue
            if room(target) is None and (top / f"{room(header)}.hpp").exists():
                continue  # parts of a call, which may ask other calls
            if room(target) is None:
                faults.append(f"{header.relative_to(top)} includes {what_is_above} {target.name}")
            elif room(target) in order and order.index(room(target)) > order.index(room(header)):
                faults.append(f"{header.relative_to(top)} includes {target.relative_to(top)}, a room further down")
    return order


order = hold(include / "quadrant", "Rooms", "what holds all rooms,")
order += hold(include / "quadrant/diagnosis", "Rooms of the diagnosis", "the call")

from_tests = ("tests", "examples/programs", "examples/linuxcnc", "docs/generators")
for folder, may, found_in in (
    ("tests", from_tests, ("tests", "examples", "examples/programs", "docs/generators")),
    ("examples/programs", ("examples/programs",), ("examples/programs",)),
    ("docs/generators", ("docs/generators", "examples/programs"), ("docs/generators", "examples/programs")),
):
    for source in (p for p in (root / folder).rglob("*") if p.suffix in (".hpp", ".cpp", ".cc", ".h")):
        for name in re.findall(r'^\s*#\s*include "([^"]+)"', source.read_text(), re.M):
            places = [pathlib.Path(os.path.normpath(base / name)) for base in (source.parent, *(root / f for f in found_in))]
            target = next((p for p in places if p.is_file()), None)  # none: made by the build, or of the library
            if target and not target.is_relative_to(root / "include") and not any(target.is_relative_to(root / f) for f in may):
                faults.append(f"{source.relative_to(root)}: includes {target.relative_to(root)}; a file of {folder} does not")

for header in headers:
    for found in re.findall(r"^(?:inline )?namespace quadrant(?!::inline v0\b)[^;={]*\{", header.read_text(), re.M):
        faults.append(f"{header.relative_to(root)}: '{found.strip()}': write namespace quadrant::inline v0")

TOP = {"include", "tests", "benchmarks", "examples", "docs", "packaging"}
there = {p.name for p in root.iterdir() if p.is_dir() and p.name != "build" and not p.name.startswith(".")}
if there != TOP:
    faults.append(f"at the top stand {sorted(there)}, not {sorted(TOP)}")

for fault in faults:
    print(fault)
if not headers or not order:
    sys.exit("nothing was looked at")
print(f"{len(headers)} headers, {len(order)} rooms, {len(faults)} faults")
sys.exit(1 if faults else 0)
