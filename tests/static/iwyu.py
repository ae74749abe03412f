#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: iwyu.py ROOT [HEADER...]: every core header includes each standard header that it uses itself (include-what-you-use).

Without headers all outside diagnosis/. A header of ours may come through another one of ours: base/error.hpp brings units and signals.
Not asked for: what is inside the compiler's library (bits/, ext/), and what the program names for another header's sake: <memory> and
<initializer_list> for std::vector, <system_error> and <charconv> for each other, <cstdlib> for std::abs, <tuple> for xsimd. Exit code 77 without include-what-you-use, 2 when it fails on a header."""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

root = pathlib.Path(sys.argv[1]).resolve()
include = root / "include"
headers = [pathlib.Path(h) for h in sys.argv[2:]] or sorted(
    h for h in (include / "quadrant").rglob("*.hpp") if "diagnosis" not in h.relative_to(include).parts)
for_others = {"memory", "initializer_list", "system_error", "charconv", "cstdlib", "tuple"}
program = shutil.which("include-what-you-use") or shutil.which("iwyu")
if not program:
    print("SKIPPED: no include-what-you-use (Debian: iwyu)")
    sys.exit(77)


def missing(header):
    """Standard headers that the header uses and does not include."""
    run = subprocess.run([program, "-std=c++20", f"-I{include}", "-Xiwyu", "--no_fwd_decls", header],
                         capture_output=True, text=True)
    said = run.stdout + run.stderr
    if "error:" in said or not re.search(r"has correct #includes|should add these lines", said):
        print(f"{header}: include-what-you-use fails\n{said[-600:]}")
        sys.exit(2)
    adds = re.search(r"should add these lines:\n(.*?)\n\n", said, re.S)
    names = re.findall(r"^#include <([a-z_0-9]+)>", adds[1], re.M) if adds else []
    return [n for n in names if n not in for_others]


with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
    found = list(zip(headers, pool.map(missing, headers)))
faults = [f"{header}: uses <{name}> without including it" for header, names in found for name in names]
print("\n".join(faults) or f"{len(headers)} headers include what they use of the standard library")
sys.exit(bool(faults))
