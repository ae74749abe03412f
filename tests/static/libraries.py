#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: libraries.py ROOT: nothing is used that a C++20 library of those that we support lacks (libc++ 13, emscripten 3.1.6).

The page is built in `sh tests/run.sh all` alone; what it could not be built with is found here. What stands in for the standard's
is in include/quadrant/base/portable.hpp, the only file that may name it.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()
LACKING = re.compile(r"\bstd::(?:ranges|views|format|jthread|stop_token|source_location|bit_cast|pmr|execution|"
                     r"lexicographical_compare_three_way)\b|#\s*include <(?:ranges|format|source_location|stop_token|memory_resource)>")
STANDS_IN = "include/quadrant/base/portable.hpp"


def faults_of(text):
    code = re.sub(r"//[^\n]*", "", text)
    return [(code.count("\n", 0, found.start()) + 1, found[0]) for found in LACKING.finditer(code)]


if len(faults_of("// std::ranges::sort\nstd::ranges::min_element(a);\n#include <format>\nstd::formatter;")) != 2:
    sys.exit("libraries.py does not find what it must, or more")
folders = ["include", "examples/web", "examples/programs/quadrant_gap", "examples/programs/page"]
files = [f for folder in folders for f in sorted((root / folder).rglob("*.?pp"))]
if len(files) < 500:
    sys.exit(f"only {len(files)} files were found")
faults = [f"{f.relative_to(root)}:{line}: not every library has {name}" for f in files if str(f.relative_to(root)) != STANDS_IN
          for line, name in faults_of(f.read_text())]
print("\n".join(faults + [f"{len(files)} files, {len(faults)} faults"]))
sys.exit(bool(faults))
