#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: check.py COMPILER SCRATCH PROGRAM...

Commands that write files, with one allocation that fails and with one write that fails: it ends with an exit code of its own (no signal)
and a message, or did all that was asked for; a file that stood where it writes is as before, or the new one, whole; nothing is left beside.
What a program starts (gnuplot) has all memory, and its writes into a pipe do not fail; a page for which it could not be started is whole
when it says so. What quadrant-latency measures differs from run to run, and so does its answer: its page and its text count as
the same when they are whole.
"""
import hashlib
import math
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

root = Path(__file__).resolve().parents[3]
compiler, scratch, programs = sys.argv[1], Path(sys.argv[2]).resolve(), {Path(p).name: Path(p).resolve() for p in sys.argv[3:]}
shutil.rmtree(scratch, ignore_errors=True)
scratch.mkdir(parents=True)
shim = scratch / "fail_nth.so"
subprocess.run([compiler, "-std=c++20", "-O1", "-shared", "-fPIC", "-o", shim, Path(__file__).with_name("fail_nth.cpp")], check=True)

data, imports = root / "examples/data", root / "examples/import"
mill = root / "examples/programs/quadrant_cnc/mill.json"
everything = os.environ.get("QUADRANT_TESTS") == "all"
of_machine, found = ["--machine", data / "machine.json"], root / "tests/fuzz/diagnosis.json"
circles = scratch / "circles.csv"
with circles.open("w") as file:  # three turns each way; the encoder of x counts 100 um/m too much
    print("t_s,x_ref_m,x_pos_m,y_ref_m,y_pos_m", file=file)
    for k in range(6000):
        angle = (1 if k < 3000 else -1) * 2 * math.pi * k / 1000
        x, y = 0.03 * math.cos(angle), 0.03 * math.sin(angle)
        print(f"{k / 500:.3f},{x:.9f},{x * (1 + 1e-4):.7f},{y:.9f},{y:.7f}", file=file)
# What each program is asked for: its arguments, and the files that it writes.
asked = {
    "quadrant-gap": [
        (["import", "--map", imports / "halsampler.map.json", imports / "halsampler.txt", "log.csv"], ["log.csv"]),
        (["simulate", *of_machine, "--log", data / "log.csv", "--json", "gaps.json"], ["gaps.json"]),
        (["init", "--log", data / "log.csv", "--unchecked", "--mass", "1", "--force-constant", "1", "--out", "begun.json"],
         ["begun.json", "begun.md"]),
        (["apply", *of_machine, "--diagnosis", found, "--out", "corrected.json"], ["corrected.json"]),
        (["export", *of_machine, "--mjcf", "axis.xml", "--linuxcnc", "axis.txt", "--drive", "drive.csv", "--compensation", "table.csv"],
         ["axis.xml", "axis.txt", "drive.csv", "table.csv"]),
        (["forecast", *of_machine, "--diagnosis", found, "--motion", data / "log.csv", "--json", "forecast.json"], ["forecast.json"]),
        (["circle", "--log", circles, "--json", "circle.json", "--report", "circle.html"], ["circle.json", "circle.html"]),
    ],
    "quadrant-cnc": [
        (["analyse", "--cnc", mill, "--axis", "x", "--json", "figures.json", "--report", "axis.html"], ["figures.json", "axis.html"]),
    ],
    "quadrant-reproduce": [
        (["--id", "thesis.force.x", "--json", "rows.json", "--markdown", "rows.md", "--html", "page.html"],
         ["rows.json", "rows.md", "page.html"]),
    ],
    "quadrant-latency": [
        (["--seconds", "0.1", "--period_us", "1000", "--html", "latency.html"], ["latency.html"]),
    ],
}
if everything:  # seconds each time: whole diagnoses, whole runs
    shipped, quick = [*of_machine, "--log", data / "log.csv"], ["--fast", "--threads", "1"]
    asked["quadrant-gap"] += [
        (["diagnose", *quick, *shipped, "--json", "found.json", "--report", "page.html"], ["found.json", "page.html"]),
        (["compensate", *shipped, "--diagnosis", found, "--json", "gains.json", "--controller", "keys.json"], ["gains.json", "keys.json"]),
        (["compare", *quick, *of_machine, data / "log.csv", data / "holdout.csv", "--json", "differs.json", "--report", "page.html"],
         ["differs.json", "page.html"]),
    ]
    asked["quadrant-cnc"] += [
        (["run", "--cnc", mill, "--path", root / "examples/path/diamond.nc", "--json", "run.json", "--report", "run.html", "--log", "run.csv",
          "--export-gap-machine", "machine.json"], ["run.json", "run.html", "run.csv", "machine.json"]),
    ]
UNDRAWN_MARK = b"gnuplot could not draw this"
UNDRAWN = "a whole page that says that a picture is not drawn"
PLACES = 12  # of each, from the first to the last, closer together at the start where the program sets itself up
OLD = "what stood here before\n"
faults, tried, stopped = [], 0, 0


ANSWER = rb"(Yes, it fits|No, it does not fit|The loop fits) 1000 us: [^\n]*\n"  # of quadrant-latency


def seen(data):
    if data.startswith(b"<!doctype html>") and b"quadrant-latency" in data and data.endswith(b"</html>\n"):
        return UNDRAWN if UNDRAWN_MARK in data else "a whole page of times"
    if re.search(ANSWER + rb"Page: latency\.html\n$", data):
        return "a whole text of times"
    if UNDRAWN_MARK in data and data.endswith(b"</html>\n"):
        return UNDRAWN
    # What a run says of its own time differs from run to run.
    data = re.sub(rb'("(wall|cpu)_time_s": )[-+.e0-9]+', rb"\1", data)
    data = re.sub(rb"[-+.e0-9]+ s of CPU time, [-+.e0-9]+ times faster", b"", data)
    return hashlib.sha256(data).hexdigest()


def run(folder, program, arguments, outputs, **more):
    """Exit code, both outputs, the files: everything that a user would see afterwards."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name in outputs:
        (folder / name).write_text(OLD)
    before = more.pop("before", [])
    done = subprocess.run([*before, program, *arguments], cwd=folder, capture_output=True, timeout=300, **more)
    if done.returncode == 1 and re.search(ANSWER, done.stdout):
        done.returncode = 0  # the machine was busy: an answer as any other
    done.printed, done.stderr = seen(done.stdout), done.stderr.decode(errors="replace")
    files = {str(p.relative_to(folder)): seen(p.read_bytes()) for p in folder.rglob("*") if p.is_file()}
    return done, files


def places(last):
    return sorted({max(1, round(last ** (k / (PLACES - 1)))) for k in range(PLACES)})


def hold(what, done, files, good, good_files, old, outputs):
    global tried, stopped
    tried += 1
    files = {name: good_files.get(name) if is_now == UNDRAWN else is_now for name, is_now in files.items()}
    if not 0 <= done.returncode < 128:
        faults.append(f"{what}: ended by signal {-done.returncode}: {done.stderr.strip()[-200:]}")
    elif done.returncode == 0 and (files != good_files or done.printed != good.printed):
        faults.append(f"{what}: says all went well, and it did not")
    elif done.returncode != 0:
        stopped += 1
        if not done.stderr.strip() and "standard error" not in what:
            faults.append(f"{what}: exit code {done.returncode} without a word")
    for name in outputs:
        if files.get(name) not in (old, good_files[name]):
            faults.append(f"{what}: {name} is neither the old file nor the new one")
    for name in files.keys() - good_files.keys():
        faults.append(f"{what}: leaves {name} behind")


traces = shutil.which("strace") and subprocess.run(["strace", "-o", "/dev/null", "true"], capture_output=True).returncode == 0
for name, program in programs.items():
    for arguments, outputs in asked[name]:
        called = f"{name} {arguments[0]}"
        folder, old = scratch / "run", seen(OLD.encode())
        good, good_files = run(folder, program, arguments, outputs)
        if good.returncode != 0 or any(good_files[o] == old for o in outputs):
            faults.append(f"{called}: does not work with all memory: {good.stderr[-300:]}")
            continue
        count = scratch / "count"
        run(folder, program, arguments, outputs, env={**os.environ, "LD_PRELOAD": str(shim), "QUADRANT_COUNT_TO": str(count)})
        for n in places(int(count.read_text())):
            more = {**os.environ, "LD_PRELOAD": str(shim), "QUADRANT_FAIL_AT": str(n)}
            hold(f"{called}, allocation {n} fails", *run(folder, program, arguments, outputs, env=more), good, good_files, old, outputs)
        if not traces:
            continue
        trace = scratch / "trace"
        run(folder, program, arguments, outputs, before=["strace", "-qq", "-o", trace, "-e", "trace=write,writev"])
        writes = [line for line in trace.read_text().splitlines() if "write" in line]
        for n in places(len(writes)):
            to_stderr = " standard error" if f"{' '.join(writes[n - 1].split()[:1])}".startswith("write(2,") else ""
            inject = ["strace", "-qq", "-o", "/dev/null", "-e", "trace=write,writev", "-e", f"inject=write,writev:error=ENOSPC:when={n}"]
            hold(f"{called}, write {n}{to_stderr} fails", *run(folder, program, arguments, outputs, before=inject), good, good_files, old, outputs)

for fault in faults:
    print("FAILED:", fault)
if not traces:
    print("SKIPPED: writes that fail (no strace that works here)")
print(f"{tried} failures injected, {stopped} stopped the program with a code and a message, {len(faults)} faults")
sys.exit(1 if faults or not stopped else 0)
