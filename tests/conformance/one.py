#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The conformance suite of one block: seconds of compiling, where that of all blocks takes minutes.
usage: one.py NAME     the entries of blocks.hpp whose name begins with NAME
Environment: CXX  the compiler (default g++)
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

here = Path(__file__).resolve().parent
root = here.parents[1]
if len(sys.argv) != 2:
    sys.exit(__doc__)
list_of_blocks = (here / "blocks.hpp").read_text()
begin = list_of_blocks.index("    entry{")
end = list_of_blocks.index("\n};\n", begin)
entries = [e.rstrip().rstrip(",") for e in re.split(r"(?m)^(?=    entry\{)", list_of_blocks[begin:end])]
chosen = [e for e in entries if re.match(rf'    entry\{{\s*"{re.escape(sys.argv[1])}', e)]
if not chosen:
    sys.exit(f"{here / 'blocks.hpp'} has no entry whose name begins with {sys.argv[1]}")
with tempfile.TemporaryDirectory() as work:
    for path in here.glob("*pp"):
        (Path(work) / path.name).write_text(path.read_text())
    (Path(work) / "blocks.hpp").write_text(list_of_blocks[:begin] + ",\n".join(chosen) + list_of_blocks[end:])
    cases = sorted(path for path in here.glob("*.cpp") if path.name != "sources.cpp")  # which have a list of their own
    everything = Path(work) / "everything.cpp"
    everything.write_text(f'#include "{root}/tests/main.cpp"\n' + "".join(f'#include "{path.name}"\n' for path in cases))
    program = Path(work) / "one"
    subprocess.run([os.environ.get("CXX", "g++"), "-std=c++20", "-O0", f"-I{root}/include", f"-I{root}/tests", everything,
                    "-o", program], check=True)
    print(f"{len(chosen)} of {len(entries)} entries")
    sys.exit(subprocess.run([program]).returncode)
