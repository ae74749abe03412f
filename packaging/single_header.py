#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: single_header.py INCLUDE VERSION OUT      all core headers as one file, in the order in which they include each other

Comments stay. Includes of the standard library and of Boost come once, sorted, at the top; those that depend on the compiler
stay where they are. The same input gives the same bytes."""
import pathlib
import re
import sys

include, version, out = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3])
outside, done, text = set(), set(), []


def add(header):
    if header in done:
        return
    done.add(header)
    own, depth = [], 0
    for line in header.read_text(encoding="utf-8").splitlines():
        inner, system = re.match(r'#include "(.*)"', line), re.match(r"#include (<.*>)", line)
        if inner:
            add((header.parent / inner[1]).resolve())
        elif system and depth == 0:
            outside.add(system[1])
        elif line != "#pragma once" and not line.startswith("// SPDX-License-Identifier"):
            depth += bool(re.match(r"# *if", line)) - bool(re.match(r"# *endif", line))
            own.append(line)
    text.append(f"// --- {header.relative_to(include)}\n" + "\n".join(own).strip("\n") + "\n")


add((include / "quadrant/quadrant.hpp").resolve())
head = f"""// SPDX-License-Identifier: BSL-1.0
// Quadrant {version}: all core headers in one file, written by packaging/single_header.py. Needs C++20 and Boost.Units.
#pragma once
"""
includes = "".join(f"#include {name}\n" for name in sorted(outside))
out.write_text(head + includes + "\n" + "\n".join(text), encoding="utf-8")
