#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Every C++ block of the pages that is no text of a compiled file (check.py: <!-- from FILE -->) compiles.

    python3 tests/docs/snippets.py COMPILER OPTION...        e.g. g++ -std=c++20 -Iinclude

All blocks become one source, each a function of its own, parsed once. What a block uses and does not show stands above it, in a
block that a reader unfolds:

    <details><summary>What the block below uses</summary>

    ```cpp
    extern force raw;
    ```

    </details>

Errors name the page and its line. What the pages use everywhere: quadrant, its literals and its
quantities (position, velocity, force, voltage, ...), as docs/use_in_a_project.md says.
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

root = Path(__file__).parents[2]
fence = re.compile(r"^([ \t]*)```cpp[ \t]*\n(.*?)^\s*```[ \t]*$", re.M | re.S)
from_file = re.compile(r"<!-- from \S+ -->\n\s*\Z")
used = re.compile(r"<details><summary>What the block below uses</summary>\n\n```cpp\n((?:(?!```).)*)```\n\n</details>", re.S)

prelude = """#include <quadrant/quadrant.hpp>
using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::quantities;
"""


def blocks():
    for page in [root / "README.md", *sorted((root / "docs").rglob("*.md"))]:
        text = page.read_text()
        above_what = {fold.end(): fold for fold in used.finditer(text)}
        folded = {fold.start(1) for fold in above_what.values()}
        for block in fence.finditer(text):
            if from_file.search(text, 0, block.start()) or block.start(2) in folded:
                continue
            above = above_what.get(len(text[: block.start()].rstrip()))
            line_of = lambda offset: text.count("\n", 0, offset) + 1
            yield page.relative_to(root), (line_of(above.start(1)), above.group(1)) if above else None, (
                line_of(block.start(2)),
                block.group(2),
            )


def placed(page, part, includes):
    """The lines of a part under their place in the page, what they include taken out to the front."""
    line, text = part
    includes += re.findall(r"^\s*(#include .*)$", text, re.M)
    return f'#line {line} "{page}"\n' + re.sub(r"^\s*#include .*$", "", text, flags=re.M)


def source():
    includes, body, count = [], "", 0
    for count, (page, above, shown) in enumerate(blocks(), 1):
        body += f"namespace block_{count} {{\n{placed(page, above, includes) if above else ''}"
        body += f"void shown() {{\n{placed(page, shown, includes)}}}\n}}\n"
    return "\n".join(dict.fromkeys(includes)) + "\n" + prelude + body, count


text, count = source()
with tempfile.NamedTemporaryFile("w", suffix=".cpp") as file:
    file.write(text)
    file.flush()
    warnings = ["-Wall", "-Wextra", "-Werror", "-Wno-unused"]  # a block shows, it does not use
    done = subprocess.run([*sys.argv[1:], *warnings, "-fsyntax-only", file.name], cwd=root)
print(f"{count} blocks compile" if done.returncode == 0 else f"FAILED: not all {count} blocks compile")
sys.exit(done.returncode != 0)
