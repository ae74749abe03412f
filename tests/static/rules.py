#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""usage: rules.py ROOT: a refusal that compares a parameter with another value says that value.

"must lie between 0 and half the sampling rate (1000 Hz)", not "must lie below half the sampling rate": the rule is a literal that ends
after the name of the other value, so nothing follows it. Literals are found in include/; a number in the literal is its value.
"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
comparison = re.compile(
    r"(?:\b(?:below|above|beyond|exceed|longer than|more than|fewer than|less than|as many \w+ as|between \S+ and) )"
    r"(?!(?:it|zero|one|two|three|and|or|the threshold)\b)[a-z_].*"
)
literal = re.compile(r'"(must (?:[^"\\]|\\.)*)"((?:\s*"[^"]*")*)(\s*\+)?')
seen, faults = 0, []
for header in sorted((root / "include/quadrant").rglob("*.hpp")):
    if "diagnosis" in header.parts:  # refusals of a file, which say the line
        continue
    text = header.read_text()
    for match in literal.finditer(text):
        seen += 1
        rule = match[1] + "".join(re.findall(r'"([^"]*)"', match[2]))
        found = comparison.search(rule)
        if found and not match[3] and not re.search(r"\d", found[0]):
            line = text.count("\n", 0, match.start()) + 1
            faults.append(f'{header.relative_to(root)}:{line}: "{rule}" does not say the value')
for fault in faults:
    print(fault)
if seen < 100:
    sys.exit(f"only {seen} rules were found")
print(f"{seen} rules, {len(faults)} faults")
sys.exit(1 if faults else 0)
