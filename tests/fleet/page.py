#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Opens the overview of a fleet in headless Chromium: rows are sorted and found, links lead to pages, nothing scrolls sideways.

page.py FLEET.html --shots DIR
"""
import argparse
import pathlib
import sys
import tempfile
import urllib.parse

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser_test import check, check_console, check_width, shoot, show, start  # noqa: E402

ROWS = "return [...document.querySelectorAll('#logs tbody tr')].filter(r => !r.hidden).map(r => r.cells[0].textContent)"
GAPS = "return [...document.querySelectorAll('#logs tbody tr')].map(r => r.cells[5] ? Number(r.cells[5].dataset.value) : null)"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--shots", type=pathlib.Path, required=True)
    given = parser.parse_args()
    given.shots.mkdir(parents=True, exist_ok=True)
    url = given.page.resolve().as_uri()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = start(profile)
        try:
            for width in (1280, 360):
                for scheme in ("light", "dark"):
                    where = f"{width} px, {scheme}"
                    show(driver, url, width, scheme)
                    check_width(driver, where)
                    shoot(driver, given.shots / f"fleet-{width}-{scheme}.png")
            show(driver, url, 1280, "light")
            rows = driver.execute_script(ROWS)
            check(len(rows) == 5, f"five logs were given, {rows} are shown")

            def press(selector):
                driver.execute_script("document.querySelector(arguments[0]).click()", selector)

            press("#logs th:nth-child(6) button")
            gaps = driver.execute_script(GAPS)
            numbers = [g for g in gaps if g is not None]
            check(numbers == sorted(numbers, reverse=True) and len(set(numbers)) > 1, f"not the largest gap first: {gaps}")
            check(gaps[:len(numbers)] == numbers, f"logs without a number are not last: {gaps}")
            press("#logs th:nth-child(6) button")
            check([g for g in driver.execute_script(GAPS) if g is not None] == sorted(numbers), "a second click does not turn it round")
            press("button[data-verdict=failed]")
            failed = driver.execute_script(ROWS)
            check(sorted(failed) == ["alone", "line/broken"], f"of those that failed {failed} are shown")
            press("button[data-verdict=failed]")
            counted = driver.execute_script("return [...document.querySelectorAll('button[data-effect]')].map(b => "
                                            "[b.dataset.effect, Number(b.querySelector('b').textContent)])")
            for effect, n in counted:
                press(f"button[data-effect={effect}]")
                check(len(driver.execute_script(ROWS)) == n, f"{effect} counts {n}, shown are {driver.execute_script(ROWS)}")
                press(f"button[data-effect={effect}]")
            driver.find_element("id", "find").send_keys("a b")
            check(driver.execute_script(ROWS) == ["line/a b"], f"'a b' finds {driver.execute_script(ROWS)}")
            links = driver.execute_script("return [...document.querySelectorAll('#logs a')].map(a => a.href)")
            check(len(links) == 3, f"three logs have pages, there are links {links}")
            for link in links:
                path = pathlib.Path(urllib.parse.unquote(urllib.parse.urlparse(link).path))
                check(path.is_file(), f"{link} leads nowhere")
            check_console(driver)
            print(f"{len(rows)} rows, {len(links)} pages, causes {counted}")
        finally:
            driver.quit()
    print("ok")


if __name__ == "__main__":
    main()
