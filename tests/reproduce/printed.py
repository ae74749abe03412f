#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Every printed number of the three sources stands in docs/reproduction.md with ours beside it, or with the reason why there is none.

printed.py REPRODUCTION.md [SOURCES]

Counts the list: of every number either ours is there, or a reason. Where SOURCES (the folder of the three texts) is there: every
number in the list is in the text of its source letter for letter, every number in the tables of the text is in the list, and every
figure, table and equation of the texts is among the parts.
"""
import pathlib
import re
import sys

SOURCE_FILES = {"[Jamaludin2008]": "000_*.txt", "[Yeung2006]": "001_*.txt", "[LowKeck2003]": "002_*.txt"}
# Numbers of each table, as its rows and columns have them.
CELLS = {
    "[Jamaludin2008]": {"2.1": 6, "2.2": 4, "2.3": 8, "2.4": 2, "2.5": 8, "2.6": 2, "3.1": 10, "3.2": 8, "3.3": 8, "3.4": 8, "3.5": 45,
                        "3.6": 45, "4.1": 8, "4.2": 6, "4.3a": 8, "4.3b": 8, "4.4": 6, "4.5": 10, "4.6": 8, "4.7": 8, "4.8": 4, "4.9": 6,
                        "4.10": 6, "4.11": 18, "5.1": 12, "5.2": 12, "5.3": 9, "5.4": 3, "5.5": 7, "5.6": 3},
    "[Yeung2006]": {"2": 12, "3": 25, "4": 49, "7": 30, "8": 46, "9": 20, "10": 12, "11": 24, "12": 24},
}
# Where the numbers of a table stand in the text: from its caption to a word that begins what follows.
ENDS = {"4.2": "In feedforward friction", "4.4": "The GMS friction model", "4.6": "The inverse model-based", "4.7": "The gain margin and the phase margin of both",
        "4.8": "The disturbance observer improves", "4.9": "A combination of GMS", "4.10": "Next, circular tests", "5.1": "Next, circular tests",
        "5.2": "Finally, the cutting", "5.3": "The estimator is able", "5.4": "The repetitive controller", "5.6": "5.6 Summary",
        "2.3": "The magnitudes of the gain", "2.5": "The gain and phase margins", "3.5": "Table 3.6. Y-axis", "3.6": "A comparison between"}
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")


def rows(path):
    """Of the last part: (source, place, what, origin, printed, ours, where)."""
    source = None
    for line in pathlib.Path(path).read_text(encoding="utf-8").split("## Every printed number")[-1].splitlines():
        if line.startswith("### "):
            source = line.split()[1]
        cells = [c.strip() for c in re.split(r"(?<!\\)\|", line)[1:-1]]
        if source and len(cells) == 7 and cells[0] not in ("place", "---"):
            yield source, cells[0], cells[1], cells[2], cells[3], cells[4], cells[6]


def count_faults(listed):
    tables = {}
    for source, place, what, origin, printed, ours, where in listed:
        if ours == "-" and not where.startswith("cannot be computed: "):
            yield f"{source} {place}, {what}: {printed} has no figure of ours and no reason"
        if where.startswith("cannot be computed: ") and len(where) < 40:
            yield f"{source} {place}, {what}: the reason is short: {where}"
        if place.startswith("Table "):
            key = source, place[6:]
            tables[key] = tables.get(key, 0) + 1
    for source, cells in CELLS.items():
        for table, wanted in cells.items():
            if tables.get((source, table), 0) != wanted:
                yield f"{source} Table {table}: {tables.get((source, table), 0)} numbers in the list, {wanted} in the table"


def numbers_named(text, what):
    """Of "Figs. 2.7 to 2.10 and B.1" or "eqs. (2.3-2.21)": every number, as (letter or chapter, number)."""
    found = set()
    for begin, end in re.findall(what, text):
        chapter, first = begin.split(".")
        last = int(end.split(".")[1]) if end else int(first)
        found |= {(chapter, number) for number in range(int(first), last + 1)}
    return found


def section_of(path, source):
    """The parts of one source."""
    listed = pathlib.Path(path).read_text(encoding="utf-8").split("## Every part of the sources")[1].split("\n## ")[0]
    return next(each for each in listed.split("\n### ") if each.startswith(source))


def parts_of(path, source):
    """The places of the parts of one source, a line each."""
    return "\n".join(line.split("|")[1] for line in section_of(path, source).splitlines() if line.startswith("| "))


def without_others(parts):
    """Numbers of figures alone: no equations, sections and tables."""
    return re.sub(r"\([^)]*\)|(?:[Ss]ection|Tables?) [\d.]+(?:, \d+)*", "", parts)


def part_faults(path, folder):
    """Every figure, table and equation that the texts number is a part in the list."""
    wanted, listed = set(), set()
    for source, pattern in SOURCE_FILES.items():
        text, parts = text_of(folder, pattern), parts_of(path, source)
        if not text:
            continue
        add = lambda to, kind, numbers: to.update((source, kind, *each) for each in numbers)
        if source == "[Jamaludin2008]":
            add(wanted, "figure", numbers_named(text, r"Fig(?:ure|\.) ?([1-5B-D]\.\d+)()\b"))
            add(wanted, "table", numbers_named(text, r"Table ([1-5]\.\d+)()\b"))
            add(wanted, "equation", numbers_named(text, r"\(([2-5]\.\d+)()\)"))
            add(listed, "figure", numbers_named(without_others(parts), r"([1-5B-D]\.\d+)(?: to ([1-5B-D]\.\d+))?"))
            add(listed, "table", numbers_named(parts, r"Table ([1-5]\.\d+)()"))
            add(listed, "equation", numbers_named(parts, r"\(([2-5]\.\d+)(?:-([2-5]\.\d+))?\)"))
            continue
        one = lambda found: {("", n) for begin, end in found for n in range(int(begin), int(end or begin) + 1)}
        add(wanted, "figure", one(re.findall(r"Fig\. ?(\d+)()\b", text)))
        add(wanted, "equation", one(re.findall(r"\((\d{1,2})()\)", text)))
        add(wanted, "table", one(re.findall(r"Table (\d+)()\b", text)))
        add(listed, "figure", one(re.findall(r"(\d+)(?: to (\d+))?", without_others(parts))))
        add(listed, "equation", one(re.findall(r"\((\d+)(?:-(\d+))?\)", parts)))
        tables = " ".join(re.findall(r"Tables? ([\d, ]+)", parts))
        add(listed, "table", one(re.findall(r"(\d+)()", tables)))
    for source, kind, chapter, number in sorted(wanted - listed):
        yield f"{source}: {kind} {chapter}{'.' * bool(chapter)}{number} is not among the parts"
    if len(wanted) < 250:
        yield f"only {len(wanted)} figures, tables and equations found in the texts"


def loop_faults(path):
    """Every experiment says whether it runs through xy_loop, and why not."""
    text = pathlib.Path(path).read_text(encoding="utf-8")
    table = lambda head: [line.split("|")[1].strip() for line in text.split(head)[1].split("\n\n")[0].splitlines()[2:]]
    experiments, said = table("| experiment | figures |"), table("| experiment | runs |")
    if experiments != said:
        yield f"xy_loop: {len(said)} lines for {len(experiments)} experiments"


def file_faults(path):
    """Every header and page that a part names is in the repository."""
    root = pathlib.Path(__file__).resolve().parent.parent.parent
    for source in SOURCE_FILES:
        for name in re.findall(r"\b[a-z_]+/[a-z_]+\.(?:hpp|md)\b", section_of(path, source)):
            if not (root / name).exists() and not (root / "include" / "quadrant" / name).exists():
                yield f"{source}: {name} is not in the repository"


def text_of(folder, pattern):
    found = list(pathlib.Path(folder).glob(pattern))
    if not found:
        return None
    text = found[0].read_text(encoding="utf-8").replace("−", "-")
    text = re.sub(r"(?<=\d),(?=\d{3}\b)", "", text)  # 50,000
    # The Virtual CNC's text has K for a minus before a digit, and !10K4 for a power.
    text = re.sub(r"!10K(\d+)", r"e-\1", text)
    return re.sub(r"\bK(?=\d)", "-", text)


def text_faults(listed, folder):
    texts = {source: text_of(folder, pattern) for source, pattern in SOURCE_FILES.items()}
    for source, place, what, _, printed, _, _ in listed:
        number = printed.split(" ")[0]
        if texts[source] and number and number not in texts[source]:
            yield f"{source} {place}, {what}: {number} is not in the text"
    cnc = texts["[Yeung2006]"] or ""
    in_contours = {p.split(" ")[0] for s, place, _, _, p, _, _ in listed if place in ("Table 11", "Table 12")}
    for line in re.findall(r"^\s*(?:PID|SMC)((?: \d+\.\d+){4})\s*$", cnc, re.M):
        for number in line.split():
            if number not in in_contours:
                yield f"Tables 11 and 12: {number} of the text is not in the list"
    thesis = texts["[Jamaludin2008]"]
    if not thesis:
        return
    for table, end in ENDS.items():
        listed_here = {p.split(" ")[0] for s, place, _, _, p, _, _ in listed if s == "[Jamaludin2008]" and place == f"Table {table}"}
        start = thesis.index(f"Table {table}. ")
        stop = thesis.find(end, start)
        if stop < 0:
            yield f"Table {table}: its end '{end}' is not in the text"
            continue
        block = thesis[start:stop].split("\n")
        for cell in block[1:]:  # the caption's own numbers are in its first line
            for number in re.findall(r"(?<![\w.])\d+\.?\d*(?= ?(?:dB|Hz|deg|µm|um|%|$))", cell.strip()):
                index = table in ("3.5", "3.6") and number.isdigit() and int(number) <= 15  # of the harmonic
                if number.rstrip(".") not in listed_here and not index and not re.fullmatch(r"\d\d\d?", number):  # page numbers
                    yield f"Table {table}: {number} of the text is not in the list ({cell.strip()})"


def main():
    listed = list(rows(sys.argv[1]))
    faults = list(count_faults(listed))
    missing = [line for line in pathlib.Path(sys.argv[1]).read_text(encoding="utf-8").splitlines() if "| missing |" in line]
    faults += [f"missing: {line}" for line in missing]
    faults += list(loop_faults(sys.argv[1])) + list(file_faults(sys.argv[1]))
    cannot = sum(1 for row in listed if row[6].startswith("cannot"))
    if f"- cannot be computed: {cannot}, each" not in pathlib.Path(sys.argv[1]).read_text(encoding="utf-8"):
        faults.append(f"the headline does not say that {cannot} numbers cannot be computed")
    whole = len(sys.argv) > 2 and pathlib.Path(sys.argv[2]).is_dir()
    if whole:
        faults += text_faults(listed, sys.argv[2])
        faults += part_faults(sys.argv[1], sys.argv[2])
    for fault in faults[:40]:
        print("FAILED:", fault)
    print(f"{len(listed)} printed numbers, {len(listed) - cannot} with ours beside, {cannot} with a reason; "
          f"{'compared with the texts; ' if whole else ''}{len(faults)} faults")
    sys.exit(bool(faults) or len(listed) < 600)


if __name__ == "__main__":
    main()
