#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Commands of the pages work in a clone with nothing beside it.

    python3 tests/docs/commands.py [FOLDER OF PROGRAMS]

1. No page and no header points out of the repository: no ../shared, no gap/FORMAT.md (docs/CONTRIBUTING.md says where further
   records are looked for, and tests skip without them).
2. What a command names of the repository's folders is in the repository.
3. With the folder of quadrant-gap: each block that a comment marks is run, in a copy of the repository's files, line by line with sh -eu:
   <!-- run -->, or <!-- run with log.csv=examples/data/log.csv -->, which puts a file of the repository where the block expects the reader's own.
   build/run holds what examples/run.sh leaves there. <!-- run all ... --> is run with QUADRANT_TESTS=all only.
4. A block of commands without such a comment is in the list NOT_RUN below with the reason, and nothing is in that list without one.
   Commands stand in fenced blocks, never in indented ones.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parents[2]
everything = os.environ.get("QUADRANT_TESTS") == "all"
programs = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
fence = re.compile(r"^([ \t]*)```(\S*)[^\n]*\n(.*?)^\s*```[ \t]*$", re.M | re.S)
mark = re.compile(r"<!-- run( all)?(?: with ([^>]*?))? -->\s*\Z")
command = re.compile(r"^(?:\$ )?(?:quadrant-[a-z-]+|(?:/usr/bin/)?python3|sh|cmake|ctest|(?:arm-none-eabi-)?g\+\+|apt(?:-get)?|mpirun|cp|git|"
                     r"halsampler|halrun|linuxcnc|(?:build|venv)/\S+)[ \t]+[\w./<$\"'-]", re.M)
# Blocks that are not run here: page, how a line of the block begins, why.
BUILDS = "builds with CMake for minutes; tests/run.sh builds the same targets"
FOREIGN = "needs a record of others that the repository does not hold; tests/real and tests/acceptance diagnose such records where they are"
DRIVE = "needs a log of the reader's own drive; tests/diagnosis/init_drives.cpp and drive_compensation.cpp simulate one"
HARDWARE = "needs LinuxCNC; tests/linuxcnc/run.sh runs it with QUADRANT_TESTS=all"
INSTALLS = "installs Debian packages as root; tests/run.sh installs the same ones"
NOT_RUN = [
    ("README.md", "sh examples/run.sh", "builds a program for a minute; its diagnosis is run above with the program that is built"),
    ("docs/tutorial_first_diagnosis.md", "sh examples/run.sh", "as in README.md"),
    ("docs/tutorial_first_loop.md", "apt install", INSTALLS),
    ("docs/fleet.md", "mpirun", "needs several hosts; fleet.mpi runs the program with mpirun on this one"),
    ("docs/howto/add_a_block.md", "cmake", BUILDS),
    ("docs/howto/add_a_block.md", "python3 tests/conformance/one.py", "compiles the conformance suite of one block; test_conformance has all"),
    ("docs/howto/add_an_effect.md", "cmake", BUILDS),
    ("docs/howto/analyse_an_axis.md", "quadrant-cnc", "needs a measured response or chirp of an axis; tests/cnc makes both by simulation"),
    ("docs/howto/compare_two_logs.md", "quadrant-gap import record.mat", "needs a Simulink record and a log of the same machine"),
    ("docs/howto/diagnose_a_position_drive.md", "quadrant-gap", DRIVE),
    ("docs/howto/diagnose_a_position_servo.md", "quadrant-gap", DRIVE),
    ("docs/howto/diagnose_a_velocity_drive.md", "quadrant-gap init --out M.json", DRIVE),
    ("docs/howto/diagnose_a_velocity_drive.md", "halsampler", HARDWARE),
    ("docs/howto/import_a_log.md", "$ quadrant-gap import record.mat", "begins in MATLAB; import.mat_file imports such files"),
    ("docs/howto/import_a_log.md", "quadrant-gap import --map examples/import/so101", FOREIGN),
    ("docs/howto/import_a_log.md", "quadrant-gap import --resample --map examples/import/laas", FOREIGN),
    ("docs/howto/import_a_log.md", "quadrant-gap import --map examples/import/dfki", FOREIGN),
    ("docs/howto/import_a_log.md", "quadrant-gap import --map examples/import/halscope", "needs a file of halscope; tests/diagnosis/import.cpp writes one"),
    ("docs/howto/measure_my_loop.md", "cmake", BUILDS),
    ("docs/howto/measure_my_loop.md", "sh benchmarks/bound.sh", "counts the instructions of a program of the reader's own under valgrind"),
    ("docs/howto/measure_my_loop.md", "build/release/examples/quadrant-latency", "answers for this computer, which may be busy: any exit code is right"),
    ("docs/howto/motion_without_a_command.md", "quadrant-gap", "needs a log with two encoders; acceptance.encoders makes them"),
    ("docs/howto/use_from_python.md", "apt-get install", INSTALLS),
    ("docs/howto/use_the_page.md", "sh examples/web/build.sh", "builds with Emscripten for minutes; web.page.build runs it"),
    ("docs/linuxcnc.md", "apt-get install linuxcnc-uspace", HARDWARE),
    ("docs/linuxcnc.md", "apt-get install python3-pyqt5", HARDWARE),
    ("docs/microcontroller.md", "arm-none-eabi-g++", "needs a cross-compiler; microcontroller.qemu compiles the same file"),
    ("docs/microcontroller.md", "apt install", INSTALLS),
    ("docs/real/", "", FOREIGN),
    ("docs/use_in_a_project.md", "cmake", "builds and installs; consume.* do so into a folder of their own"),
]
folders = ("examples", "tests", "benchmarks", "docs", "packaging", "include")
may_point_out = {"docs/CONTRIBUTING.md"}
faults = []


def files_of_clone():
    listed = subprocess.run(["git", "-C", root, "ls-files", "-co", "--exclude-standard"], capture_output=True, text=True)
    if listed.returncode == 0:
        return [f for f in listed.stdout.splitlines() if (root / f).is_file()]
    return [str(p.relative_to(root)) for p in root.rglob("*") if p.is_file() and "build" not in p.relative_to(root).parts[:1]]


def pages():
    return [root / "README.md", *sorted((root / "docs").rglob("*.md"))]


def blocks():
    for page in pages():
        text = page.read_text()
        for block in fence.finditer(text):
            if block[2] in ("", "sh"):
                yield page.relative_to(root), text, block


def points_out(files):
    for name in files:
        if name == "docs/CHANGELOG.md" or name in may_point_out or not name.endswith((".md", ".hpp", ".ipp")):
            continue
        if not name.startswith(("README", "docs/", "include/")):
            continue
        for number, line in enumerate((root / name).read_text().splitlines(), 1):
            if re.search(r"\.\./shared|gap/FORMAT|gap/check\.py", line):
                faults.append(f"{name}:{number}: points at what a clone has not got: {line.strip()[:90]}")


def named_files_exist(files):
    known = set(files) | {str(p) for f in files for p in Path(f).parents}
    for page, text, block in blocks():
        for path in re.findall(r"(?<![\w./-])((?:%s)/[\w./-]*\w)" % "|".join(folders), block[3]):
            if path not in known and not path.startswith("docs/schema"):
                line = text.count("\n", 0, block.start()) + 1
                faults.append(f"{page}:{line}: a command names {path}, which is not in the repository")


def all_are_explained():
    """Each block of commands is marked to be run or in NOT_RUN; its number and that of the second kind."""
    count, used = 0, {}
    for page, text, block in blocks():
        lines = re.sub(rf"^{block[1]}", "", block[3], flags=re.M)
        if not command.search(lines) or mark.search(text, 0, block.start()):
            count += bool(command.search(lines))
            continue
        count += 1
        why = [n for n, (of, begins, _) in enumerate(NOT_RUN)
               if str(page).startswith(of) and any(line.startswith(begins) for line in lines.splitlines())]
        if not why:
            line = text.count("\n", 0, block.start()) + 1
            faults.append(f"{page}:{line}: commands that nothing runs, and NOT_RUN says not why: {lines.splitlines()[0][:90]}")
        used.update(dict.fromkeys(why, True))
    faults.extend(f"NOT_RUN: {of}: {begins}: no such block" for n, (of, begins, _) in enumerate(NOT_RUN) if n not in used)
    for page in pages():
        text = fence.sub(lambda m: "\n" * m[0].count("\n"), page.read_text())
        for number, line in enumerate(text.splitlines(), 1):
            if line.startswith("    ") and command.match(line.strip()):
                faults.append(f"{page.relative_to(root)}:{number}: a command in an indented block, which nothing runs: {line.strip()[:90]}")
    return count, sum(1 for page, text, block in blocks() if mark.search(text, 0, block.start()))


def run_marked(files):
    count = 0
    with tempfile.TemporaryDirectory() as folder:
        clone = Path(folder) / "alone" / "clone"
        for name in files:
            (clone / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(root / name, clone / name)
        (clone / "build/run/examples").mkdir(parents=True)
        (clone / "build/run/examples/quadrant-gap").symlink_to(programs / "quadrant-gap")
        environment = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}"}
        environment.pop("QUADRANT_SHARED", None)

        def sh(commands):
            return subprocess.run(["sh", "-euc", commands], cwd=clone, env=environment, capture_output=True, text=True, timeout=300)

        first = re.search(r"^set -- (diagnose .*?)\n(?=echo)", (root / "examples/run.sh").read_text(), re.M | re.S)[1]
        done = sh(f'build=build/run data=examples/data; set -- {first}\nquadrant-gap "$@"')
        if done.returncode:
            faults.append(f"examples/run.sh: {done.stderr.strip()[-300:]}")
        for page, text, block in blocks():
            marked = mark.search(text, 0, block.start())
            if not marked or marked[1] and not everything:
                continue
            count += 1
            for given in (marked[2] or "").split():
                there, source = given.split("=")
                (clone / there).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(clone / source, clone / there)
            done = sh(re.sub(rf"^{block[1]}", "", block[3], flags=re.M))
            if done.returncode:
                line = text.count("\n", 0, block.start()) + 1
                faults.append(f"{page}:{line}: exit code {done.returncode}: {(done.stderr or done.stdout).strip()[-300:]}")
    return count


files = files_of_clone()
points_out(files)
named_files_exist(files)
commands, marked = all_are_explained()
ran = run_marked(files) if programs else 0
if programs and (ran < 23 or everything and ran < marked):
    faults.append(f"only {ran} of {marked} blocks that are marked to be run were run")
print("\n".join(faults) if faults else f"{commands} blocks of commands: {marked} are marked to be run, {ran} of them were, in a copy with "
      f"nothing beside it; {commands - marked} have a reason")
sys.exit(bool(faults))
