#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: compile_files.py BUILD: processor seconds and memory of compiling each file of the diagnosis with g++ -O2, as rows of a table.

BUILD was configured with CMAKE_EXPORT_COMPILE_COMMANDS. Exit code 1: a file takes more than 15 s or 600 MB, in the best of three
runs. As many compile at a time as there are cores. No compiler cache is asked. Other programs on the computer make a compiler slower,
in processor time too. So a file above 15 s is compared with compile_reference.cpp, which holds nothing of ours and is compiled
right after it: 15 s are those of a computer on which that takes 9 s."""
import concurrent.futures
import json
import math
import os
import shlex
import subprocess
import sys
import tempfile

most_seconds, most_megabytes, runs = 15, 600, 3
reference, reference_seconds = os.path.join(os.path.dirname(os.path.abspath(__file__)), "compile_reference.cpp"), 9


def measured(command, folder):
    """Seconds of the processor and megabytes of one compilation."""
    process = subprocess.Popen(command, cwd=folder)
    _, status, used = os.wait4(process.pid, 0)
    if status:
        raise SystemExit(f"does not compile: {shlex.join(command)}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def own_command(entry, out):
    """The compiler's command for one file of the build, at -O2, without a launcher before it."""
    words = shlex.split(entry["command"])
    words = words[next(i for i, word in enumerate(words) if os.path.basename(word).startswith("g++")):]
    words[words.index("-o") + 1] = out
    return [*words, "-O2"]


def reference_command(entry, out):
    """The same compiler on the reference: its standard and the folders of other libraries, not ours."""
    words = own_command(entry, out)
    keep = [words[0], "-std=c++20", "-O2"]
    for at, word in enumerate(words):
        if word == "-isystem":
            keep += words[at:at + 2]
    return [*keep, "-c", reference, "-o", out]


def main(build):
    with open(os.path.join(build, "compile_commands.json")) as file:
        entries = [e for e in json.load(file) if "/quadrant_diagnosis_once.dir/" in e["command"]]
    if not entries:
        raise SystemExit(f"{build} makes no file of the diagnosis with g++")
    too_much = []
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        def cost(entry):
            command = own_command(entry, os.path.join(folder, os.path.basename(entry["file"]) + ".o"))
            best = math.inf
            for _ in range(runs):
                seconds, megabytes = measured(command, entry["directory"])
                if seconds > most_seconds:  # is it the file, or what runs beside it?
                    beside = measured(reference_command(entry, command[command.index("-o") + 1] + ".beside"), entry["directory"])[0]
                    seconds *= min(1, reference_seconds / beside)
                best = min(best, seconds)
                if best <= most_seconds:
                    break
            return best, megabytes

        entries.sort(key=lambda e: e["file"])
        for entry, (seconds, megabytes) in zip(entries, pool.map(cost, entries)):
            name = os.path.basename(entry["file"])
            print(f"| {name} | {seconds:.1f} | {megabytes:.0f} |", flush=True)
            if seconds > most_seconds or megabytes > most_megabytes:
                too_much.append(name)
    if too_much:
        print(f"above {most_seconds} s or {most_megabytes} MB: {', '.join(too_much)}", file=sys.stderr)
    return 1 if too_much else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
