# SPDX-License-Identifier: BSL-1.0
# usage: claims.py ROOT     every sentence above a declaration in a header that says "always", "exact" or "bounded" is held
# by a test of a million random trials that names it, or is no promise: claims.txt says which, line by line
"""claims.txt: HEADER | WORDS OF THE LINE | TEST FILE | WORDS OF ITS CASE, or HEADER | WORDS OF THE LINE | no promise | WHY.
A case counts its trials one by one (++tried) and ends with CHECK(tried >= trials). How many that are stands in
tests/block/dice.hpp: a million with QUADRANT_TESTS=all, at least a hundred thousand by default."""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
include = root / "include/quadrant"
word = re.compile(r"\b(always|exact|exactly|bounded)\b", re.IGNORECASE)
wrong = []

entries = []
for n, line in enumerate((root / "tests/static/claims.txt").read_text().splitlines(), 1):
    if not line or line.startswith("#"):
        continue
    fields = [field.strip() for field in line.split(" | ")]
    if len(fields) != 4:
        wrong.append(f"claims.txt:{n}: not four fields")
        continue
    entries.append((n, *fields))

used = set()
for header in sorted(include.rglob("*.hpp")):
    name = header.relative_to(include).as_posix()
    if name.startswith("diagnosis/"):
        continue
    for n, line in enumerate(header.read_text().splitlines(), 1):
        comment = line[line.find("///"):] if "///" in line else ""
        if not word.search(comment):
            continue
        found = [e for e in entries if e[1] == name and e[2] in comment]
        if not found:
            wrong.append(f"{name}:{n}: no test is named for: {comment.strip('/< ')}")
        used.update(e[0] for e in found)

made = re.search(r"const int trials = \[\] \{.*?== \"all\" \? ([\d']+) : ([\d']+);\n\}\(\);",
                 (root / "tests/block/dice.hpp").read_text(), re.DOTALL)
with_all, by_default = (int(n.replace("'", "")) for n in made.groups()) if made else (0, 0)
if with_all < 1_000_000:
    wrong.append("tests/block/dice.hpp: trials with QUADRANT_TESTS=all are no million")
if by_default < 100_000:
    wrong.append("tests/block/dice.hpp: trials by default are no hundred thousand")


def of_file(path):
    """Name and body of each case."""
    pieces = re.split(r"^TEST_CASE\(", path.read_text(), flags=re.MULTILINE)[1:]
    heads = [re.match(r'(?:\s*"(?:[^"\\]|\\.)*")+', piece).group(0) for piece in pieces]
    return [("".join(re.findall(r'"((?:[^"\\]|\\.)*)"', head)), piece) for head, piece in zip(heads, pieces)]


def uncounted(body):
    """Why a case is not known to make a million trials; empty where it is."""
    counters = set(re.findall(r"\b(tried\w*)\b", body))
    if not counters:
        return "counts no trials"
    for counter in sorted(counters):
        if not re.search(rf"CHECK\({counter} >= trials\);", body):
            return f"does not end with CHECK({counter} >= trials)"
        if not re.search(rf"\+\+{counter}\b", body) or re.search(rf"\b{counter} ([+*-]?=) (?!0\b)", body):
            return f"does not count {counter} one by one from 0"
    if re.search(r"\btrials\s*[*/]|\b(?:int|auto)\s+trials\b", body):
        return "takes another number of trials"
    return ""


cases = {}
for n, header, words, test, case in entries:
    if n not in used:
        wrong.append(f"claims.txt:{n}: {header} does not say '{words}'")
    if test == "no promise":
        continue
    file = root / test
    if not file.exists():
        wrong.append(f"claims.txt:{n}: no {test}")
        continue
    if test not in cases:
        cases[test] = of_file(file)
    bodies = [body for name, body in cases[test] if case in name]
    if len(bodies) != 1:
        wrong.append(f"claims.txt:{n}: {test} has {len(bodies)} cases '{case}'")
    elif uncounted(bodies[0]):
        wrong.append(f"claims.txt:{n}: {test}, '{case}': {uncounted(bodies[0])}")

kinds = [test for n, _, _, test, _ in entries if n in used]
promising = len(kinds) - kinds.count("no promise")
print("\n".join(wrong) or f"{len(kinds)} sentences: {kinds.count('no promise')} promise nothing, {promising} are held by counted "
      f"trials that name them: {by_default} by default, {with_all} with QUADRANT_TESTS=all")
sys.exit(bool(wrong))
