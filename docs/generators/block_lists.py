#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: block_lists.py [ROOT] [--check]: writes what follows from headers and lists.

1. The includes of include/quadrant/quadrant.hpp: every header of the first table in docs/public_headers.md, but those that the
   page excepts.
2. The list of blocks in docs/README.md: every page of docs/blocks, under the folder of its header.
3. The type of each block with its template arguments, under the include on its page: as its header declares it.

With --check it writes nothing and fails when one of them is stale. It fails, too, when a public header has a block without a page.
"""
import pathlib
import re
import sys
import textwrap

check = "--check" in sys.argv
arguments = [a for a in sys.argv[1:] if a != "--check"]
root = pathlib.Path(arguments[0] if arguments else pathlib.Path(__file__).parents[2]).resolve()
include, docs = root / "include/quadrant", root / "docs"
faults = []

# Folders of headers, in the order of the list, and what a reader calls them.
titles = {
    "filter": "Filters and differentiators",
    "control": "Control laws, limits, supervision",
    "friction": "Friction",
    "memory": "Delay and memory",
    "observer": "Observers",
    "feedforward": "Feedforward",
    "plant": "Simulated machines",
    "drive": "Drives with loops of their own",
    "sensor": "Sensors",
    "process": "Cutting",
    "loop": "Loops, and what joins boxes",
    "block": "Loops, and what joins boxes",
    "trajectory": "Trajectory",
    "analysis": "Beside the loop",
}
# Not in quadrant.hpp: these folders, headers for lanes, and what allocates. docs/public_headers.md says the same.
left_out = re.compile(
    r"(analysis|drive)/|quadrant\.hpp$|base/(lanes|select)\.hpp|\w+/\w*(_lanes|_in_step|velocity_pair)\.hpp|path/(cl_reader|gcode_reader|spline_path)\.hpp"
)
# Rooms of blocks; the parts of other blocks in them, which those pages describe.
rooms = ("filter", "control", "friction", "memory", "observer", "feedforward", "plant", "drive", "sensor", "process")
parts = {"friction/maxwell_slip_lanes.hpp", "friction/presliding.hpp", "memory/repetitive_in_step.hpp", "plant/axis_load.hpp"}


def arguments_of(declared):
    """The template arguments of a declaration as a user writes them: names, and what stands for one that is left out."""
    out, depth, one = [], 0, ""
    for c in declared + ",":
        depth += (c in "<(") - (c in ">)")
        if c == "," and depth == 0:
            kind, _, default = one.partition("=")
            name = kind.split()[-1] + ("..." if "..." in kind else "")
            out.append(name + (" = " + default.replace("typename ", "").strip() if default else ""))
            one = ""
        else:
            one += c
    return ", ".join(out)


def with_type(page, header):
    """The text of a page with the type of its block, where that is a template; `header`: the page's line that includes it."""
    declared = re.search(rf"^template <([^;{{}}]*?)>\s+(?:requires[^;{{}}]*?\s)?(?:class|struct) {page.stem}\b", (include / header["path"]).read_text(), re.M)
    line = textwrap.fill(f"`{page.stem}<{arguments_of(' '.join(declared[1].split()))}>`", 112) + "\n\n" if declared else ""
    return re.sub(rf"(?<=^{re.escape(header[0])}\n\n)(?:`{page.stem}<[^`]*>`\n\n)?", lambda _: line, page.read_text(), count=1, flags=re.M)


def put(file, new):
    if file.read_text() == new:
        return
    if check:
        faults.append(f"{file.relative_to(root)} is stale: python3 docs/generators/block_lists.py")
    else:
        file.write_text(new)
        print(f"{file.relative_to(root)}: written")


tables = (docs / "public_headers.md").read_text().split("\n## The diagnosis")[0]
public = []
for room, names in re.findall(r"^\| `quadrant/([a-z_/]*)` \| \w+ \| (.*) \|$", tables, re.M):
    public += [f"{room}{name}.hpp" for name in re.findall(r"`([a-z_0-9/]+)`", names)]

everything = include / "quadrant.hpp"
lines = [f'#include "{header}"' for header in sorted(public) if not left_out.match(header)]
put(everything, re.sub(r'(?:#include "[^"]+"\n)+', "\n".join(lines) + "\n", everything.read_text(), count=1))

listed = {}
for page in sorted((docs / "blocks").glob("*.md")):
    found = re.search(r"^`#include <quadrant/(?P<path>(?P<folder>\w+)/\w+\.hpp)>`$", page.read_text(), re.M)
    if not found or found["folder"] not in titles:
        faults.append(f"{page.relative_to(root)}: its third line is `#include <quadrant/FOLDER/NAME.hpp>`")
    else:
        listed.setdefault(titles[found["folder"]], []).append(f"[{page.stem}](blocks/{page.name})")
        put(page, with_type(page, found))
text = ""
for title in dict.fromkeys(titles.values()):
    if title in listed:
        text += textwrap.fill(f"- {title}: " + ", ".join(listed[title]), 112, subsequent_indent="  ", break_on_hyphens=False) + "\n"
index = docs / "README.md"
put(index, re.sub(r"(<!-- blocks -->\n).*(<!-- end of blocks -->)", rf"\g<1>{text}\g<2>", index.read_text(), flags=re.S))

for header in public:
    steps = "operator()(" in (include / header).read_text() and "void reset(" in (include / header).read_text()
    if header.split("/")[0] in rooms and steps and header not in parts and not (docs / "blocks" / f"{pathlib.Path(header).stem}.md").is_file():
        faults.append(f"{header} has a block without a page: docs/blocks/{pathlib.Path(header).stem}.md")

print("\n".join(faults) or f"{len(lines)} includes, {sum(map(len, listed.values()))} pages of blocks")
sys.exit(bool(faults))
