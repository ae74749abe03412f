#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
# Long: a function for each thing that the pages promise.
"""What the pages promise stands: links and anchors lead somewhere, C++ is text of a file that is
compiled, or compiled by snippets.py, commands have the options that they are shown with, docs/README.md leads to every page, and the
page of every block has its picture, and every other page begins with who needs it.

    python3 tests/docs/check.py [root of the repository]
"""
import re
import sys
from functools import lru_cache
from pathlib import Path
from xml.etree import ElementTree

root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
pages = [root / "README.md", *sorted((root / "docs").rglob("*.md"))]
index = root / "docs" / "README.md"
faults = []


def fault(page, line, text):
    faults.append(f"{page.relative_to(root)}:{line}: {text}")


# --- A page in parts: fenced blocks, and the prose around them with its line numbers kept. ---
fence = re.compile(r"^(\s*)```(\S*)[^\n]*\n(.*?)^\s*```[ \t]*$", re.M | re.S)
code_span = re.compile(r"(`+)(?!`)(.+?)(?<!`)\1(?!`)", re.S)


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def blank(match):
    return re.sub(r"[^\n]", " ", match.group(0))


@lru_cache(maxsize=None)
def prose(page):
    return fence.sub(blank, page.read_text())


# --- 1. Links and anchors. ---
@lru_cache(maxsize=None)
def anchors(page):
    """The names that GitHub gives the headings of a page."""
    found, seen = set(), {}
    for heading in re.findall(r"^#{1,6}[ \t]+(.*?)[ \t#]*$", prose(page), re.M):
        text = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "")
        slug = re.sub(r"[^\w\- ]", "", text.lower()).replace(" ", "-")
        found.add(slug if slug not in seen else f"{slug}-{seen[slug]}")
        seen[slug] = seen.get(slug, 0) + 1
    return found


def links(page):
    text = code_span.sub(blank, prose(page))
    for match in re.finditer(r"\]\(\s*<?([^()\s>]+)>?(?:\s+\"[^\"]*\")?\s*\)", text):
        yield line_of(text, match.start()), match.group(1)


def target_of(page, link):
    path = link.split("#")[0]
    return (page.parent / path).resolve() if path else page


def check_links(page):
    for line, link in links(page):
        if re.match(r"[a-z][a-z+.-]*:", link):
            continue  # another site
        target = target_of(page, link)
        if not target.is_relative_to(root) or not target.exists():
            fault(page, line, f"{link} does not exist")
        elif "#" in link and target.suffix == ".md" and link.split("#")[1] not in anchors(target):
            fault(page, line, f"{link}: no such heading")


# --- 2. Code that is shown is code that is compiled. ---
compiled = re.compile(r"(examples|include|docs/generators)/\S+\.(cpp|hpp|c|h)")
marker = re.compile(r"<!-- from (\S+) -->\n\s*\Z")
fold = "<details><summary>What the block below uses</summary>"
unfolded = re.compile(re.escape(fold) + r"\n\n```cpp\n(?:(?!```).)*```\n\n</details>\n\s*\Z", re.S)
run = re.compile(r"(examples|tests)/python/\S+\.py")  # by tests/python
languages = {"", "cpp", "python", "sh", "json"}


def lines_of(text):
    return [line.strip() for line in text.strip("\n").split("\n")]


def check_snippets(page):
    """C++ is text of a file (<!-- from FILE -->) or compiled by snippets.py, with what is folded away above it."""
    tells_how = re.match(r"docs/(tutorial|howto/|explanation/)", page.relative_to(root).as_posix())
    text, marked, completed = page.read_text(), 0, 0
    for match in fence.finditer(text):
        line, language = line_of(text, match.start()), match.group(2)
        if language not in languages:
            fault(page, line, f"```{language} is none of {', '.join(sorted(languages - {''}))}")
        if language == "" and re.search(r";[ \t]*(//.*)?$", match.group(3), re.M):
            fault(page, line, "this looks like C++: ```cpp, or write it as an equation")
        if language not in ("cpp", "python"):
            continue
        from_file = marker.search(text, 0, match.start())
        if not from_file:
            completed += bool(unfolded.search(text, 0, match.start()))
            if tells_how:
                fault(page, line, "this block needs <!-- from FILE --> above it: a program that a test compiles or runs")
            continue
        marked += 1
        source = root / from_file.group(1)
        known = compiled if language == "cpp" else run
        if not known.fullmatch(from_file.group(1)) or not source.is_file():
            fault(page, line, f"{from_file.group(1)} is no source under examples/, docs/generators/ or include/")
            continue
        shown, there = lines_of(match.group(3)), lines_of(source.read_text())
        if not any(shown) or not any(there[k : k + len(shown)] == shown for k in range(len(there))):
            fault(page, line, f"this block does not stand like that in {from_file.group(1)}")
    for mark, used in (("<!-- from ", marked), (fold, completed)):
        if text.count(mark) != used:
            fault(page, 1, f"{text.count(mark)} marks {mark.strip()}, {used} blocks of code right below one")


# --- 3. Commands have the options that they are shown with. ---
programs = {
    name: root / "examples/programs" / name.replace("-", "_")
    for name in ("quadrant-gap", "quadrant-gap-mpi", "quadrant-cnc", "quadrant-reproduce", "quadrant-latency")
}
shared_options = {"quadrant-gap": ["examples/programs/quadrant_gap/commands.hpp"], "quadrant-gap-mpi": ["examples/programs/quadrant_gap/fleet.cpp"]}


@lru_cache(maxsize=None)
def options(program, subcommand):
    """The options that a program, or one of its subcommands with a source of its own, asks CLI11 for."""
    own = programs[program] / f"{subcommand}.cpp"
    has_its_own = own.is_file() and "add_option" in own.read_text()
    sources = [own] if has_its_own else sorted(programs[program].glob("*.cpp"))
    text = "".join(s.read_text() for s in sources + [root / s for s in shared_options.get(program, [])])
    found = {"--help"}
    for names in re.findall(r"(?:add_option|add_flag|set_version_flag)\(\s*\"([^\"]*)\"", text):
        found.update(n for n in names.split(",") if n.startswith("--"))
    if program == "quadrant-gap" and subcommand == "init":  # its options are a table, with other names for a rotary axis
        table = (root / "include/quadrant/diagnosis/machine_file/init_fields.hpp").read_text()
        for name in re.findall(r"init_field\{\"([\w-]+)\"", table):
            found.update({f"--{name}", "--" + name.replace("mass", "inertia").replace("force-", "torque-")})
    return found


call = re.compile(r"(?<![\w-])(?<!--target )(" + "|".join(sorted(programs, key=len, reverse=True)) + r")(?![\w.-])")


def check_command(page, line, text):
    for part in re.split(r"&&|\|\||[|;]|\s#\s", text):
        match = call.search(part)
        if not match:
            continue
        rest = part[match.end() :]
        words = rest.split()
        subcommand = words[0] if words and re.fullmatch(r"[a-z]+", words[0]) else ""
        for option in re.findall(r"(?<![\w-])(--[A-Za-z][\w-]*)", rest):
            if option not in options(match.group(1), subcommand):
                fault(page, line, f"{match.group(1)} {subcommand} has no option {option}".replace("  ", " "))


def check_commands(page):
    text = page.read_text()
    for match in fence.finditer(text):
        language, first = match.group(2), line_of(text, match.start()) + 1
        if language not in ("", "sh", "bash", "console"):
            continue
        body = match.group(3).replace("\\\n", "  ")
        for number, command in enumerate(body.split("\n")):
            check_command(page, first + number, command)
            for path in re.findall(r"(?:^|\s)((?:examples|include|tests|benchmarks|docs|packaging)/[\w./-]+)", command):
                if language == "sh" and not (root / path).exists():
                    fault(page, first + number, f"{path} does not exist")
    words = prose(page)
    for match in re.finditer(r"^ {4}(\S.*)$", words, re.M):
        check_command(page, line_of(words, match.start()), match.group(1))
    for match in code_span.finditer(words):
        check_command(page, line_of(words, match.start()), match.group(2).replace("\n", " "))


# --- 4. The index leads to every page. ---
def check_index():
    if not index.is_file():
        return fault(index, 1, "is missing")
    linked = {target_of(index, link) for _, link in links(index)}
    for page in pages[1:]:
        if page != index and page not in linked:
            fault(index, 1, f"does not lead to {page.relative_to(root / 'docs')}")


# --- 5. The page of every block has its picture, and the picture a curve (tests/docs/pictures.sh: it is what the block gives). ---
blocks = root / "docs" / "blocks"
pictures = blocks / "pictures"
most_bytes = 40_000


def longest_curve(drawing):
    """Of the curves in a picture the most points that one has, and how far it reaches on the way [pixels]."""
    best = (0, 0.0)
    for path in drawing.iter("{http://www.w3.org/2000/svg}path"):
        numbers = [float(n) for n in re.findall(r"-?\d+(?:\.\d+)?", path.get("d"))]
        if path.get("fill") == "none" and path.get("stroke-width") and len(numbers) >= 4:
            across, along = numbers[0::2], numbers[1::2]
            best = max(best, (len(across), max(across) - min(across) + max(along) - min(along)))
    return best


def check_picture(page):
    path, text = pictures / f"{page.stem}.svg", page.read_text()
    shown = re.findall(r"^!\[([^\]]+)\]\(pictures/([\w-]+)\.svg\)\n\n(.+)$", text, re.M)
    if [name for _, name, _ in shown] != [page.stem]:
        return fault(page, 1, f"needs one picture, ![what one sees](pictures/{page.stem}.svg), and below it what to look at")
    line = line_of(text, text.index("(pictures/"))
    if not path.is_file():
        return  # a link that leads nowhere, said already
    try:
        drawing = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as error:
        return fault(page, line, f"{path.name} is no XML: {error}")
    if path.stat().st_size > most_bytes:
        fault(page, line, f"{path.name} has {path.stat().st_size} bytes, more than {most_bytes}")
    if drawing.get("aria-label") != shown[0][0]:
        fault(page, line, f"{path.name} calls itself '{drawing.get('aria-label')}'")
    points, reach = longest_curve(drawing)
    if points < 2 or reach < 20:
        fault(page, line, f"{path.name} has no curve")


def check_pictures():
    drawn = {n for s in (root / "docs/generators/block_pictures").glob("*.cpp") for n in re.findall(r'\{"(\w+)", draw_', s.read_text())}
    of_pages = {page.stem for page in blocks.glob("*.md")}
    for name in sorted({path.stem for path in pictures.glob("*")} - of_pages):
        fault(pictures / f"{name}.svg", 1, "is the picture of no block")
    for name in sorted(drawn ^ of_pages):
        fault(blocks / f"{name}.md", 1, "is a page, or a picture of docs/generators/block_pictures, without the other")
    for page in sorted(blocks.glob("*.md")):
        check_picture(page)


# --- 6. The first two lines say who needs a page and what he gets. ---
# The page of a block begins with its header and what the block does.
own_beginning = re.compile(r"docs/blocks/|docs/CHANGELOG\.md|README\.md$")


def check_beginning(page):
    if not own_beginning.search(page.relative_to(root).as_posix()):
        first = re.match(r"# [^\n]*\n\n([^\n]*)", page.read_text())
        if not first or not re.match(r"For |You ", first[1]):
            fault(page, 3, "begin with who needs the page and what he gets: 'For whoever ... You get ...'")


for each in pages:
    check_beginning(each)
    check_links(each)
    check_snippets(each)
    check_commands(each)
check_index()
check_pictures()
print("\n".join(faults) if faults else f"{len(pages)} pages: links, snippets, options, index and pictures stand")
sys.exit(bool(faults))
