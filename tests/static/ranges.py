#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: ranges.py ROOT: the range of a parameter is what its check in the header says, wherever else it is written.

A block checks each parameter when it is made: require_positive("notch.width", ...). That is the range. The cell "range, default"
of its page in docs/blocks has to say it, and the comment beside the field of the header must say no other. A default in the
header (width = 0.1) is the default of the page, where the page has one.
"""
import collections
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parents[2]).resolve()
include = root / "include/quadrant"
POSITIVE, NOT_NEGATIVE = r"(?<![-\d.])0 <(?!=)|> 0(?!\d|\.\d)", r"(?<![-\d.])0 <=|>= 0(?!\d|\.\d)|(?<![-\d.])0 \.\.\."
SAYS = {
    "require_positive": POSITIVE,
    "require_not_negative": NOT_NEGATIVE,
    "require_below_nyquist": r"half the sampling rate",
    "require_share": r"-1 < .* < 1",
}
CONTRADICTS = {"require_positive": NOT_NEGATIVE, "require_not_negative": POSITIVE}
NUMBER = r"-?\d+(?:\.\d+)?(?:e-?\d+)?"


def rows(page):
    """Cells "range, default" of a page by the parameter's name."""
    found, wanted = {}, False
    for line in page.read_text().splitlines():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(cells) >= 2 and re.match(r"range\b", cells[-1]):
            wanted = True
        elif not cells:
            wanted = False
        elif wanted:
            found.update((name, cells[-1]) for name in re.findall(r"`([a-z_0-9.]+)`", cells[0]))
    return found


def field(text, name):
    """What stands in the header behind a field of struct parameters: its default (or None) and its comment."""
    for body in re.findall(r"struct parameters \{\n(.*?)\n {4}\};", text, re.S):
        found = re.search(rf"[\s>]{name}(?:\{{\}}| = ([^;,]+))?(?:;|,)[^\n]*?(?:///<([^\n]*(?:\n\s*///<[^\n]*)*))?(?:\n|$)", body)
        if found:
            return found[1], found[2] or ""
    return None, ""


checks = collections.defaultdict(set)
texts = {}
for header in sorted(include.rglob("*.hpp")):
    if "diagnosis" in header.parts:
        continue
    text = header.read_text()
    for check, block, name in re.findall(r'\b(require_\w+)(?:<\w+>)?\(\s*"([a-z_0-9]+)\.([a-z_0-9.]+)"', text):
        if check in SAYS:
            checks[block, name].add(check)
            texts[block] = text

faults, compared, defaults = [], 0, 0
for (block, name), required in sorted(checks.items()):
    page = root / "docs/blocks" / f"{block}.md"
    cell = rows(page).get(name) if page.exists() else None
    default, comment = field(texts[block], name)
    for check in required:
        if check in CONTRADICTS and not re.search(SAYS[check], comment) and re.search(CONTRADICTS[check], comment):
            faults.append(f"{block}.{name}: checked by {check}, but its comment says '{comment.strip()}'")
        if cell is not None:
            compared += 1
            if not re.search(SAYS[check], cell):
                faults.append(f"docs/blocks/{block}.md: {name} is checked by {check}, but its cell says '{cell}'")
    value = re.fullmatch(rf"({NUMBER})", (default or "").strip())
    said = re.search(rf"\bdefault ({NUMBER})|({NUMBER}) \(default\)", cell or "")
    if value and said:
        defaults += 1
        if float(value[1]) != float(said[1] or said[2]):
            faults.append(f"docs/blocks/{block}.md: default of {name} is {value[1]}, but its cell says '{cell}'")
print("\n".join(faults) or f"{compared} ranges of pages are those that are checked, {defaults} defaults those of the headers")
if compared < 100 or defaults < 2:
    sys.exit(f"only {compared} ranges and {defaults} defaults were compared")
sys.exit(bool(faults))
