#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Prints a report as `chromium --print-to-pdf` does and looks at the paper: every chart in time has its lines, its
legend has its colours, the title has no folder, no word is cut off, and no page is empty.

print_test.py REPORT.html OUT.pdf     exit code 77 (skipped) without chromium or poppler-utils
"""
import collections
import html
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

DPI = 72
FLAGS = ("--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
         "--disable-component-update --disable-sync --no-pdf-header-footer").split()


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def picture(pdf, page):
    """Width and the pixels of a page, as rows of (r, g, b)."""
    data = subprocess.run(["pdftoppm", "-r", str(DPI), "-f", str(page), "-l", str(page), pdf], check=True,
                          capture_output=True).stdout
    header = re.match(rb"P6\s+(\d+)\s+(\d+)\s+255\s", data)
    width, height = int(header[1]), int(header[2])
    pixels = data[header.end():]
    return [[pixels[3 * (y * width + x):3 * (y * width + x) + 3] for x in range(width)] for y in range(height)]


def coloured(pixel):
    return max(pixel) - min(pixel) > 40


def words_of(pdf):
    """(page, left, top, right, bottom, text) of every word, in points."""
    text = subprocess.run(["pdftotext", "-bbox", pdf, "-"], check=True, capture_output=True, text=True).stdout
    page, out = 0, []
    for line in text.splitlines():
        page += "<page " in line
        word = re.search(r'<word xMin="([\d.]+)" yMin="([\d.]+)" xMax="([\d.]+)" yMax="([\d.]+)">(.*)</word>', line)
        if word:
            out.append((page, *(float(word[k]) for k in range(1, 5)), html.unescape(word[5])))
    return out


def words_of_source(source):
    """What a reader of the report sees as text, but for what paper leaves out and what a chart writes."""
    text = source[source.index("<main"):source.index("</main>")]
    for left_out in (r"<noscript>.*?</noscript>", r'<div class="zoom">.*?</div>', r"<svg.*?</svg>"):
        text = re.sub(left_out, " ", text, flags=re.S)
    return html.unescape(re.sub(r"<[^>]*>", " ", text)).split()


def main():
    report, pdf = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    for program in ("/usr/bin/chromium", "pdftoppm", "pdftotext"):
        if not shutil.which(program):
            print(f"SKIPPED: no {program} (Debian packages chromium, poppler-utils): printing is not tested")
            sys.exit(77)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        subprocess.run(["/usr/bin/chromium", *FLAGS, f"--user-data-dir={profile}", f"--print-to-pdf={pdf}",
                        report.resolve().as_uri()], check=True, capture_output=True, timeout=100)
    source = report.read_text()
    sizes = re.findall(r"^Page +\d+ size: +([\d.]+) x", subprocess.run(
        ["pdfinfo", "-l", "999", pdf], check=True, capture_output=True, text=True).stdout, re.M)
    expected = len(re.findall(r'"kind":"time"', source))
    words = words_of(pdf)
    empty = set(range(1, len(sizes) + 1)) - {w[0] for w in words}
    check(sizes and not empty, f"of {len(sizes)} pages these are empty: {sorted(empty)}")
    lost = collections.Counter(words_of_source(source)) - collections.Counter(w[5] for w in words)
    check(not lost, f"words that are not on paper: {list(lost)[:20]}")
    pages = {}
    charts = [(a, b) for a, b in zip(words, words[1:]) if a[5] == "time" and b[5] == "[s]"]
    check(len(charts) == expected > 0, f"{len(charts)} of {expected} charts in time are on paper")
    for word, unit in charts:
        page = pages.setdefault(word[0], None) or picture(pdf, word[0])
        pages[word[0]] = page
        middle = (word[1] + unit[3]) / 2
        half = min(middle, len(page[0]) - middle) - 90  # the plot reaches nearly to both margins
        rows = page[max(0, int(word[2] - 165)):int(word[2]) - 15]
        columns = range(int(middle - half), int(middle + half))
        drawn = sum(any(coloured(row[x]) for row in rows) for x in columns)
        check(drawn > 0.8 * len(columns), f"page {word[0]}: the chart above y = {word[2]:.0f} has lines in {drawn} of "
                                          f"{len(columns)} columns")
    marks = 0
    for page, left, top, _, bottom, text in words:
        if text in ("before", "after", "logged", "replayed") and page in pages:
            row = [p for y in range(int(top), int(bottom)) for p in pages[page][y][max(0, int(left) - 16):int(left) - 2]]
            marks += any(coloured(p) for p in row)
    check(marks >= expected, f"{marks} coloured marks in the legends of {expected} charts")
    title = re.search(r'<p class="title">(.*?)</p>', source)[1]
    check("/" not in title, f"a folder in the title: {title}")
    print(f"{expected} charts in time and {marks} coloured marks on {max(w[0] for w in words)} pages")


main()
