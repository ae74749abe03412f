#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: public_headers.py ROOT: docs/public_headers.md lists what a user may include; the rest of include/ is detail.

Every listed header is there and is listed once. Listed is what the numbered examples include, what a page for users names with
its folder, and what has a page in docs/blocks. Pages for contributors (CONTRIBUTING.md, howto/add_...) and the tables of costs may
name detail; the page of an effect says where its law stands.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
include = root / "include" / "quadrant"
docs = root / "docs"
page = docs / "public_headers.md"
words = ("steady", "open")
faults, listed = [], {}

for number, line in enumerate(page.read_text().splitlines(), 1):
    row = re.match(r"\| `quadrant/([a-z_/]*)` \| (\w+) \| (.*) \|$", line)
    if not row:
        continue
    room, word, names = row.groups()
    if word not in words:
        faults.append(f"{page}:{number}: `{word}` is none of {', '.join(words)}")
    for name in re.findall(r"`([a-z_0-9/]+)`", names):
        header = f"{room}{name}.hpp"
        if header in listed:
            faults.append(f"{page}:{number}: {header} is listed twice")
        elif not (include / header).is_file():
            faults.append(f"{page}:{number}: there is no {header}")
        listed[header] = word
if len(listed) < 100:
    faults.append(f"{page}: only {len(listed)} headers were read from its tables")

for example in sorted((root / "examples").glob("[0-9][0-9]_*.cpp")):
    for header in re.findall(r"#include <quadrant/([^>]+)>", example.read_text()):
        if header not in listed:
            faults.append(f"{example}: includes {header}, which {page.name} does not list")

for_contributors = re.compile(r"(CONTRIBUTING|CHANGELOG|compile_cost|benchmarks|public_headers|howto/add_\w+|effects/\w+)\.md$")
for text in [root / "README.md", *sorted(docs.rglob("*.md"))]:
    if for_contributors.search(str(text)):
        continue
    for number, line in enumerate(text.read_text().splitlines(), 1):
        for header in re.findall(r"quadrant/([a-z_0-9/]+\.hpp)", line):
            if header not in listed:
                faults.append(f"{text}:{number}: names {header}, which {page.name} does not list")

there = {header.stem: header.relative_to(include).as_posix() for header in include.rglob("*.hpp")
         if "diagnosis" not in header.relative_to(include).parts}
for block in sorted((docs / "blocks").glob("*.md")):
    header = there.get(block.stem)
    if header and header not in listed:
        faults.append(f"{block}: {header} has a page and is not listed in {page.name}")

print("\n".join(faults) or f"{len(listed)} public headers")
sys.exit(bool(faults))
