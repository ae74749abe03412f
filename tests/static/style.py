#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Style of what people read: width of comments and pages, and words that no engineer outside this project uses in
that sense.

    python3 tests/static/style.py [root of the repository]

1. A comment in a C++ source is at most 112 columns wide, as .clang-format has it for code. Equations, diagrams and
   tables, which are indented by two spaces or more after the slashes, may take 130.
2. The prose of a page is at most 112 columns wide. Tables, headings, code, pictures and what programs write are not
   prose, and a line that has no space to break at (a long link) may be wider.
3. Comments and pages avoid private words, also where a line ends within one; each has the plain one beside it.
   Names in backticks and what is quoted are free.
4. The same words are avoided in the names of test cases, the titles of pictures, and what programs and the writers of
   the docs print or draw.
"""
import re
import subprocess
import sys
from pathlib import Path

root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
PROSE, DRAWN = 112, 130

# Pages that a program or a script writes as a whole.
written = {
    "docs/benchmarks.md",
    "docs/compile_cost.md",
    "docs/explanation/gaps_of_the_sources.md",
    "docs/reproduction.md",
}

# A pattern, what to write instead.
private_words = [
    (r"\bheld against", "compared with, evaluated on"),
    (r"\bholds? (?:them|it) against (?!viscous)", "compare with"),
    (r"\bjudged by\b", "evaluated on, compared with"),
    (r"is pulled (?:by|along)", "is biased by"),
    (r"columns are shaken", "perturbed by"),
    (r"\bshaken by\b", "excited by"),
    (r"stands? upright", "is a column vector"),
    (r"\bstrangers?\b", "outlier"),
    (r"(?:motor|axis) rubs", "has friction"),
    (r"forgets its turns|contact that forgets", "has no memory of reversals"),
    (r"its look says", "its shape identifies"),
    (r"counts slower than the loop answers", "less than one encoder count per response time of the loop"),
    (r"as [A-Z]\w+ has it\b", "follows"),
    (r"\b(?:mend|mends|mended|mending)\b", "correct, fix, repair"),
    (r"\b(?:tells?|told|telling)\b(?: [\w']+){0,4} apart\b", "distinguish"),
    (r"\b(?:is|are|be) told from (?:a|an|it|the|that|noise)\b|\btells? it from\b", "distinguish from"),
    (r"\bcannot (?:be told|tell(?! what))\b", "cannot distinguish, cannot identify"),
    (r"\blimited\(\) tells\b", "reports"),
    (r"worn by", "caused by"),
    (r"\bcan hold no more\b|what one can hold no more", "force beyond an element's limit"),
    (r"\bvelocity that stands\b", "velocity that is constant over the step"),
    (r"\bpresliding way\b|\bmm of way\b|\bmicrometres of way\b", "displacement, travel"),
    (r"\b(?:[Ff]orce|[Ff]riction) over the way\b|\bunit of way\b|\btimes (?:the )?way\b", "displacement, path"),
    (r"\bstep on, J\b|\bJ <=|\bsame J\b", "jump"),
    (r"with far fewer effective samples than rows", "the effective sample size is far smaller than the number of rows"),
    (r"as the others get free", "in the order in which workers become free"),
    (r"while the loop has not the axis", "while another controller drives the axis"),
    (r"\b[Ff]or who\b", "for whoever"),
    (r"\bReturned is\b", "returns"),
    (r"\ba pull as large as the rest\b", "worst case: the whole residual biases this parameter"),
    (r"\bmay also be what the name stands in for\b", "may come from the same unknown cause"),
    (r"\b[Mm]ore of the path known\b", "a longer look-ahead"),
]


def words_in(lines):
    """Private words in numbered lines that belong together: (number, what to say)."""
    text, starts = "", []
    for number, line in lines:
        starts.append((len(text), number))
        text += line.strip() + " "
    text = re.sub(r"(`+)(?!`).+?\1|\"[^\"]{1,200}\"", lambda span: " " * len(span[0]), text)
    for word, better in private_words:
        for found in re.finditer(word, text):
            number = [n for start, n in starts if start <= found.start()][-1]
            yield number, f"'{found[0]}': write {better}"


# --- C++ sources. ---
def comments(text):
    """Number and text of each line with a comment, and the comment, the slashes included."""
    for number, line in enumerate(text.splitlines(), 1):
        found = re.search(r'^(?:[^"]|"(?:[^"\\]|\\.)*")*?(//.*)$', line)
        if found:
            yield number, line, found[1]


def faults_of_source(text):
    block = []
    for number, line, comment in comments(text):
        limit = DRAWN if re.match(r"//[/<!]*(?:  |\t)", comment) else PROSE
        if len(line) > limit and "http" not in comment:
            yield number, f"{len(line)} columns, {limit} at most"
        if block and block[-1][0] != number - 1:
            yield from words_in(block)
            block = []
        block.append((number, comment.lstrip("/<! ")))
    yield from words_in(block)


def faults_of_words(name, text):
    """Names of test cases; in programs and in writers of the docs every string."""
    drawn = name.startswith(("docs/generators/", "examples/programs/", "include/"))
    text = re.sub(r"//[^\n]*|#include[^\n]*", lambda span: " " * len(span[0]), text)
    strings = r'((?:"(?:[^"\\\n]|\\.)*"\s*)+)'
    for found in re.finditer(strings if drawn else rf"TEST_CASE(?:_TEMPLATE)?\(\s*{strings}", text):
        said = re.sub(r'"\s*"', "", found[1]).strip().strip('"')
        yield from words_in([(text.count("\n", 0, found.start()) + 1, said)])


# --- Pages. ---
def parts_of(name, text):
    """Number, line and kind of each line of a page: prose, free (not prose), written (by a program), or blank."""
    ends, item = None, 0  # what ends the part that is not prose; columns that a list indents by
    behind_blank = True
    for number, line in enumerate(text.splitlines(), 1):
        bare = line.strip()
        if name in written or name == "docs/controllers.md" and line.startswith("## `"):
            ends = r"(?!)"
        if ends:
            kind = "free" if ends == "```" else "written"
            ends = None if re.match(ends, bare) else ends
        elif not bare:
            kind = "blank"
        elif bare.startswith("```"):
            kind, ends = "free", "```"
        elif re.match(r"<!-- (?:effects|blocks)\b", bare):
            kind, ends = "written", r"<!-- end of"
        elif bare.startswith("<!--"):
            kind, ends = "free", None if "-->" in bare else r".*-->"
        elif bare[0] in "|#" or re.fullmatch(r"!\[[^\]]*\]\([^)]*\)", bare):
            kind = "free"
        else:
            indent = len(line) - len(line.lstrip())
            marker = re.match(r" *(?:[-*+]|\d+\.) +", line)
            code = behind_blank and indent >= item + 4 and not marker  # a block of code by its indent
            kind = "free" if code else "prose"
            item = len(marker[0]) if marker else 0 if indent == 0 else item
        behind_blank = kind == "blank" or kind == "free" and behind_blank and bare[:1] not in "|#!<`"
        yield number, line, kind


def can_break(line):
    """Whether a line of prose has a space within its width at which it can be broken."""
    whole = re.sub(r"(`+)(?!`).+?\1|\]\([^)]*\)", lambda span: "x" * len(span[0]), line)
    first = re.match(r" *(?:(?:[-*+]|\d+\.) +)?", whole).end()
    return " " in whole[first:PROSE]


def faults_of_page(name, text):
    block = []
    for number, line, kind in parts_of(name, text):
        if kind == "prose" and len(line) > PROSE and can_break(line):
            yield number, f"{len(line)} columns, {PROSE} at most"
        if kind == "blank" or line.lstrip().startswith("|"):
            yield from words_in(block)
            block = []
        block.append((number, re.sub(r"^!\[([^\]]*)\]\(.*", r"\1", line)))
    yield from words_in(block)


# --- What must be found, and what must not. ---
def must_find(found, count):
    found = list(found)
    if len(found) != count:
        sys.exit(f"style.py finds {len(found)} faults where there are {count}: {found}")


wide = "a word " * 20
for page, count in [
    (wide, 1),
    (f"- {wide}\n  {wide}", 2),
    (f"| {wide} |\n\n# {wide}\n\n```\n{wide}\n```\n\n![{wide}](a.svg)\n\n    {wide}", 0),
    (f"<!-- effects: pages -->\n{wide}\n<!-- end of effects -->", 0),
    (f"[x](https://{'long' * 30})", 0),
    (f"Checked by\n`{wide}`.", 0),
    (f"```\n{wide}\n```\n{wide}", 1),
    ("Nothing tells the two\napart.", 1),
    ("Two names, `told apart` in a title.", 0),
]:
    must_find(faults_of_page("docs/a.md", page), count)
for source, count in [
    (f"// {wide}", 1),
    (f"//   {wide[:120]}", 0),
    ("int a; ///< with the key mended", 1),
    ("// Which of two causes it is, a record cannot\n// tell.", 1),
    ('auto a = "mended"; // `mended` is a name', 0),
]:
    must_find(faults_of_source(source), count)
for name, source, count in [
    ("tests/a/a.cpp", 'TEST_CASE("a: two causes are told " // first\n          "apart") { CHECK(a == "mended"); }', 1),
    ("docs/generators/a.cpp", 'svg("force over the " "way"); // mended', 1),
    ("include/quadrant/a.hpp", 'f("mended");', 1),
]:
    must_find(faults_of_words(name, source), count)


def tracked(*patterns):
    done = subprocess.run(["git", "-C", root, "ls-files", *patterns], capture_output=True, text=True)
    names = done.stdout.split() if done.returncode == 0 else []
    return [(n, (root / n).read_text()) for n in names if (root / n).is_file()]


faults = []
for name, text in tracked("*.hpp", "*.cpp", "*.ipp", "*.cc"):
    faults += [f"{name}:{number}: {what}" for found in (faults_of_source(text), faults_of_words(name, text)) for number, what in found]
for name, text in tracked("README.md", "docs/*.md", "docs/**/*.md"):
    for number, what in faults_of_page(name, text):
        if name != "docs/CHANGELOG.md" or "columns" in what:  # it quotes what was
            faults.append(f"{name}:{number}: {what}")
print("\n".join(faults) if faults else "comments and pages keep the style")
sys.exit(bool(faults))
