# SPDX-License-Identifier: BSL-1.0
# usage: claims.py ROOT     every sentence above a declaration in a header that says "always", "exact" or "bounded" is held
# by a test of a million random trials that names it, or is no promise: claims.txt says which, line by line
"""claims.txt: HEADER | WORDS OF THE LINE | TEST FILE | WORDS OF ITS CASE, HEADER | WORDS OF THE LINE | no promise | WHY,
or HEADER | WORDS OF THE LINE | fewer trials | WHERE: held by a test that makes fewer, said with their number at the end."""
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

cases = {}
for n, header, words, test, case in entries:
    if n not in used:
        wrong.append(f"claims.txt:{n}: {header} does not say '{words}'")
    if test in ("no promise", "fewer trials"):
        continue
    file = root / test
    if not file.exists():
        wrong.append(f"claims.txt:{n}: no {test}")
        continue
    text = cases.setdefault(test, file.read_text())
    names = ["".join(re.findall(r'"((?:[^"\\]|\\.)*)"', c)) for c in re.findall(r'TEST_CASE\(((?:\s*"(?:[^"\\]|\\.)*")+)', text)]
    if not any(case in name for name in names):
        wrong.append(f"claims.txt:{n}: {test} has no case '{case}'")
    if not re.search(r"1'000'000|stated::trials|\btrials\b", text):
        wrong.append(f"claims.txt:{n}: {test} makes no million trials")

kinds = [test for n, _, _, test, _ in entries if n in used]
print("\n".join(wrong) or f"{len(kinds)} sentences: {kinds.count('no promise')} promise nothing, {kinds.count('fewer trials')} are held by "
      f"fewer than a million trials, {len(kinds) - kinds.count('no promise') - kinds.count('fewer trials')} by a million that name them")
sys.exit(bool(wrong))
