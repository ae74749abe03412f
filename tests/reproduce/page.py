#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Opens the page of quadrant-reproduce in headless Chromium: every picture is there, nothing scrolls sideways, no errors.

page.py PAGE.html --shots DIR
"""
import argparse
import base64
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser_test import check, check_alone, check_console, check_width, shoot, show, start  # noqa: E402

# Of every figure: its title, how wide its SVG is shown and how wide the figure, how many curves have a colour of the page,
# the smallest text [px], pairs of texts over each other, and text outside of the frame.
PICTURES = """
return [...document.querySelectorAll('figure')].map(f => {
    const svg = f.querySelector('svg'), box = svg && svg.getBoundingClientRect();
    if (!svg) return {title: f.querySelector('h4').textContent, text: f.textContent};
    const curves = [...svg.querySelectorAll('path, use')].filter(
        e => /var\\(--line/.test(e.getAttribute('stroke') || e.getAttribute('color') || ''));
    const texts = [...svg.querySelectorAll('text')].filter(t => t.textContent.trim());
    const boxes = texts.map(t => t.getBoundingClientRect()), em = box.width / svg.viewBox.baseVal.width;
    const shared = (a, b, low, high) => Math.min(a[high], b[high]) - Math.max(a[low], b[low]);
    const over = boxes.flatMap((a, i) => boxes.slice(i + 1).filter(
        b => shared(a, b, 'left', 'right') > 2 * em && shared(a, b, 'top', 'bottom') > 7 * em));
    return {over: over.length,
        title: f.querySelector('h4').textContent, width: box.width, height: box.height, room: f.clientWidth, label: svg.getAttribute('aria-label'),
        curves: curves.length, unresolved: curves.filter(e => !/rgb/.test(getComputedStyle(e).stroke)).length,
        least: Math.min(...texts.map(t => parseFloat(getComputedStyle(t).fontSize) * box.width / svg.viewBox.baseVal.width)),
        outside: texts.map(t => [t.textContent, t.getBoundingClientRect()]).filter(
            ([, r]) => r.left < box.left - 1 || r.right > box.right + 1 || r.top < box.top - 1 || r.bottom > box.bottom + 1).map(([t]) => t),
    };
});
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--shots", type=pathlib.Path, required=True)
    given = parser.parse_args()
    given.shots.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = start(profile)
        try:
            for width in (1280, 390):
                for scheme in ("light", "dark"):
                    where = f"{width} px, {scheme}"
                    show(driver, given.page.resolve().as_uri(), width, scheme)
                    pictures = driver.execute_script(PICTURES)
                    check(len(pictures) >= 60, f"{where}: only {len(pictures)} pictures")
                    for p in pictures:
                        check("label" in p, f"{where}: '{p['title']}' was not drawn: {p.get('text')}")
                        check(p["curves"] > 0 and not p["unresolved"], f"{where}: '{p['title']}' has {p['curves']} curves")
                        check(p["height"] > 150 and p["width"] <= p["room"] + 1, f"{where}: '{p['title']}': {p}")
                        check(p["least"] > 7.5, f"{where}: '{p['title']}' has text of {p['least']:.1f} px")
                        check(not p["over"], f"{where}: '{p['title']}': {p['over']} pairs of texts over each other")
                        check(not p["outside"], f"{where}: '{p['title']}': outside of it {p['outside']}")
                    check_width(driver, where)
                    twice = driver.execute_script(
                        "const ids = [...document.querySelectorAll('[id]')].map(e => e.id); return ids.filter((e, k) => ids.indexOf(e) !== k)")
                    check(not twice, f"{where}: ids that are there twice: {twice[:5]}")
                    if (width, scheme) != (1280, "dark"):
                        shoot(driver, given.shots / f"{given.page.stem}-{width}-{scheme}.png")
                    print(f"{where}: {len(pictures)} pictures, no horizontal scroll")
            rows = driver.execute_script("return document.querySelectorAll('tr[data-id]').length")
            check(rows >= 300, f"only {rows} rows")
            printed = driver.execute_script("return document.querySelectorAll('#printed tr[data-printed]').length")
            check(printed >= 600, f"only {printed} printed numbers")
            check_alone(driver)
            pdf = driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})
            (given.shots / f"{given.page.stem}.pdf").write_bytes(base64.b64decode(pdf["data"]))
            check_console(driver)
        finally:
            driver.quit()
    print("ok")


if __name__ == "__main__":
    main()
