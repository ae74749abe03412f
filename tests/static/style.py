#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Style of what people read: width of code comments, and words that no engineer outside this project uses in that sense.

    python3 tests/static/style.py [root of the repository]

1. A comment in a C++ source is at most 112 columns wide, as .clang-format has it for code. Equations, diagrams and tables, which are
   indented by two spaces or more after the slashes, may take 130.
2. Comments and pages avoid private words; each has the plain one beside it.
"""
import re
import subprocess
import sys
from pathlib import Path

root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
PROSE, DRAWN = 112, 130

# A pattern, what to write instead.
private_words = [
    (r"held against", "compared with, evaluated on"),
    (r"\bholds? them against|\bhold it against", "compare with"),
    (r"is pulled (?:by|along)", "is biased by"),
    (r"columns are shaken", "perturbed by"),
    (r"stands? upright", "is a column vector"),
    (r"\bstrangers?\b", "outlier"),
    (r"(?:motor|axis) rubs", "has friction"),
    (r"forgets its turns", "has no memory of reversals"),
    (r"its look says", "its shape identifies"),
    (r"counts slower than the loop answers", "less than one encoder count per response time of the loop"),
    (r"as [A-Z]\w+ has it\b", "follows"),
    (r"to be mended\b|would be mended", "to be corrected"),
    (r"worn by", "caused by"),
    (r"what one can hold no more", "force beyond an element's limit"),
    (r"with far fewer effective samples than rows", "the effective sample size is far smaller than the number of rows"),
    (r"as the others get free", "in the order in which workers become free"),
    (r"while the loop has not the axis", "while another controller drives the axis"),
]
# In pages only: comments of the diagnosis still have them.
private_words_of_pages = private_words + [
    (r"\b(?:mend|mends|mended|mending)\b", "correct, fix, repair"),
    (r"\btold apart\b", "distinguished"),
    (r"\bshaken by\b", "excited by"),
    (r"\b[Ff]or who\b", "for whoever"),
    (r"\bcan hold no more\b", "force beyond an element's limit"),
]


def tracked(*patterns):
    done = subprocess.run(["git", "-C", root, "ls-files", *patterns], capture_output=True, text=True)
    names = done.stdout.split() if done.returncode == 0 else []
    return [root / n for n in names if (root / n).is_file()]


def comments(path):
    """Number and text of each line of a comment, the slashes included."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        found = re.search(r'^(?:[^"]|"(?:[^"\\]|\\.)*")*?(//.*)$', line)
        if found:
            yield number, line, found[1]


faults = []
for path in tracked("*.hpp", "*.cpp", "*.ipp", "*.cc"):
    for number, line, comment in comments(path):
        drawn = re.match(r"//[/<!]*(?:  |\t)", comment)
        limit = DRAWN if drawn else PROSE
        if len(line) > limit and "http" not in comment:
            faults.append(f"{path.relative_to(root)}:{number}: {len(line)} columns, {limit} at most")
        for word, better in private_words:
            if re.search(word, comment):
                faults.append(f"{path.relative_to(root)}:{number}: '{re.search(word, comment)[0]}': write {better}")
for path in tracked("README.md", "docs/*.md", "docs/**/*.md"):
    if path.name == "CHANGELOG.md":
        continue
    for number, line in enumerate(path.read_text().splitlines(), 1):
        for word, better in private_words_of_pages:
            if re.search(word, line):
                faults.append(f"{path.relative_to(root)}:{number}: '{re.search(word, line)[0]}': write {better}")
print("\n".join(faults) if faults else "comments and pages keep the style")
sys.exit(bool(faults))
