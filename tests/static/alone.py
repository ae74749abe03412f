#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Every source that is compiled together with others compiles alone, too: it includes what it uses.

alone.py BUILD_DIRECTORY: takes the commands of compile_commands.json; syntax only, on all cores.
"""
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys


def sources_of(unit):
    """The sources that a source made by CMake (Unity/) or by together.cmake (together/) includes."""
    if unit.parent.name not in ("Unity", "together"):
        return []
    return [pathlib.Path(p) for p in re.findall(r'^#include "(/[^"]+\.cpp)"', unit.read_text(), re.M)]


def compiled_alone(command, folder, unit, source):
    words = [w for w in shlex.split(command) if not w.endswith("ccache")]
    out = words.index("-o")
    del words[out:out + 2]
    words = [str(source) if w == str(unit) else w for w in words] + ["-fsyntax-only"]
    run = subprocess.run(words, cwd=folder, capture_output=True, text=True)
    return source, run.returncode, run.stderr


def main():
    build = pathlib.Path(sys.argv[1])
    jobs = []
    for entry in json.loads((build / "compile_commands.json").read_text()):
        unit = pathlib.Path(entry["file"])
        jobs += [(entry["command"], entry["directory"], unit, s) for s in sources_of(unit)]
    if not jobs:
        print("no source is compiled together with others (QUADRANT_TOGETHER): skipped")
        return 77
    faults = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for source, code, said in pool.map(lambda job: compiled_alone(*job), jobs):
            if code != 0:
                faults += 1
                print(f"FAILED: {source} does not compile alone:\n" + "\n".join(said.splitlines()[:6]))
    print(f"{len(jobs)} sources, {faults} faults")
    return 1 if faults else 0


sys.exit(main())
