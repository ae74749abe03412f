#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Commands of the pages work in a clone with nothing beside it.

    python3 tests/docs/commands.py [FOLDER OF PROGRAMS]

1. No page and no header points out of the repository: no ../shared, no gap/FORMAT.md (docs/CONTRIBUTING.md says where further
   records are looked for, and tests skip without them).
2. What a command names of the repository's folders is in the repository.
3. With the folder of quadrant-gap: each block that a comment marks is run, in a copy of the repository's files, line by line with sh -eu:
   <!-- run -->, or <!-- run with log.csv=examples/data/log.csv -->, which puts a file of the repository where the block expects the reader's own.
   build/run holds what examples/run.sh leaves there.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).resolve().parents[2]
programs = Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else None
fence = re.compile(r"^([ \t]*)```(\S*)[^\n]*\n(.*?)^\s*```[ \t]*$", re.M | re.S)
mark = re.compile(r"<!-- run(?: with ([^>]*?))? -->\s*\Z")
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
            if not marked:
                continue
            count += 1
            for given in (marked[1] or "").split():
                there, source = given.split("=")
                (clone / there).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(clone / source, clone / there)
            done = sh(block[3])
            if done.returncode:
                line = text.count("\n", 0, block.start()) + 1
                faults.append(f"{page}:{line}: exit code {done.returncode}: {(done.stderr or done.stdout).strip()[-300:]}")
    return count


files = files_of_clone()
points_out(files)
named_files_exist(files)
ran = run_marked(files) if programs else 0
if programs and ran < 18:
    faults.append(f"only {ran} blocks are marked to be run")
print("\n".join(faults) if faults else f"{len(list(blocks()))} blocks name what is there, {ran} were run in a copy with nothing beside it")
sys.exit(bool(faults))
