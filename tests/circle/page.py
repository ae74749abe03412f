#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Opens the page of quadrant-gap circle in headless Chromium: circles are drawn, nothing scrolls sideways, no errors.

page.py PAGE.html --expect-error NAME --shots DIR
"""
import argparse
import pathlib
import sys
import tempfile

for needed in ("/usr/bin/chromium", "/usr/bin/chromedriver"):
    if not pathlib.Path(needed).exists():
        print(f"no {needed}: skipped")
        sys.exit(77)
try:
    import selenium  # noqa: F401
except ImportError:
    print("no python3-selenium: skipped")
    sys.exit(77)
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser_test import check, check_alone, check_console, check_width, shoot, show, start  # noqa: E402

# Of every figure: how wide it is shown, the colours of its runs and how far they reach.
PLOTS = """
return [...document.querySelectorAll('figure')].map(f => {
    const svg = f.querySelector('svg'), box = svg.getBoundingClientRect(), runs = [...svg.querySelectorAll('.run')];
    const texts = [...svg.querySelectorAll('text')].map(t => t.getBoundingClientRect());
    return {caption: f.querySelector('figcaption').textContent, width: box.width, room: f.clientWidth,
            label: svg.getAttribute('aria-label'), colours: runs.map(r => getComputedStyle(r).stroke),
            reach: runs.map(r => r.getBBox().width),
            outside: texts.filter(r => r.left < box.left - 1 || r.right > box.right + 1 || r.top < box.top - 1).length};
});
"""


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--expect-error", required=True)
    parser.add_argument("--shots", type=pathlib.Path, required=True)
    given = parser.parse_args()
    given.shots.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = start(profile)
        try:
            for width in (1280, 360):
                for scheme in ("light", "dark"):
                    where = f"{width} px, {scheme}"
                    show(driver, given.page.resolve().as_uri(), width, scheme)
                    plots = driver.execute_script(PLOTS)
                    check(len(plots) == 2, f"{where}: {len(plots)} plots, not one a feed")
                    for p in plots:
                        check(p["width"] <= p["room"] + 1 and p["width"] > 250, f"{where}: a plot is {p['width']} px wide")
                        check(len(set(p["colours"])) == 2 and "none" not in p["colours"], f"{where}: colours {p['colours']}")
                        check(all(250 < r < 590 for r in p["reach"]), f"{where}: the circles reach over {p['reach']}")
                        check("magnified" in p["caption"] and "magnified" in p["label"], f"{where}: no magnification: {p}")
                        check(not p["outside"], f"{where}: text outside of a plot")
                    check_width(driver, where)
                    shoot(driver, given.shots / f"circle-{width}-{scheme}.png")
            first = driver.execute_script("return document.querySelector('tr[data-error]').dataset.error")
            check(first == given.expect_error, f"the first error is {first}")
            bars = driver.execute_script("return [...document.querySelectorAll('.bar i')].map(i => i.getBoundingClientRect().width)")
            check(bars == sorted(bars, reverse=True) and bars[-1] > 2, f"the bars are {bars} px wide")
            check_alone(driver)
            check_console(driver)
        finally:
            driver.quit()
    print("ok")


if __name__ == "__main__":
    main()
