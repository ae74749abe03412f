#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
"""Opens a report of quadrant-gap in headless Chromium and reads what it shows.

browser_test.py REPORT.html [--expect-verdict V] [--expect-cause EFFECT] --shots DIR
"""
import argparse
import base64
import os
import pathlib
import re
import sys
import tempfile

from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

everything = os.environ.get("QUADRANT_TESTS") == "all"
FLAGS = ("--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
         "--disable-component-update --disable-sync").split()

# Pixels of a figure's first canvas that have a colour: the lines and dots, not the grey grid and text.
COLOURED = """
const canvas = arguments[0].querySelector('canvas');
const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
let n = 0;
for (let k = 0; k < data.length; k += 4)
    if (data[k + 3] > 0 && Math.max(data[k], data[k+1], data[k+2]) - Math.min(data[k], data[k+1], data[k+2]) > 40) ++n;
return n;
"""
LOOPS = """
return [...document.querySelectorAll('svg.loop')].map(svg => {
    const frame = svg.getBoundingClientRect(), inside = (a, b) => a.left > b.left - 1 && a.right < b.right + 1 && a.top > b.top - 1 && a.bottom < b.bottom + 1;
    const boxes = [...svg.querySelectorAll('.box')].map(box => {
        const rect = box.querySelector('rect').getBoundingClientRect(), style = getComputedStyle(box.querySelector('rect'));
        return {name: box.dataset.box, share: parseFloat(box.querySelector('.share')?.textContent), guilty: box.classList.contains('guilty'),
                mark: !!box.querySelector('.mark'), frame: parseFloat(style.strokeWidth),
                fits: [...box.querySelectorAll('text:not(.mark)')].every(t => inside(t.getBoundingClientRect(), rect))};
    });
    const texts = [...svg.querySelectorAll('text')], r = t => t.getBoundingClientRect();
    const labels = [...svg.querySelectorAll('.signal text')], rects = [...svg.querySelectorAll('rect')];
    const cross = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    return {boxes, says: svg.nextElementSibling.textContent, cut: texts.filter(t => !inside(r(t), frame)).map(t => t.textContent),
            covered: labels.filter(t => rects.some(b => cross(r(t), r(b)))).map(t => t.textContent),
            size: Math.min(...texts.map(t => parseFloat(getComputedStyle(t).fontSize) * frame.width / svg.viewBox.baseVal.width))};
});
"""
RANGES = "return graphs[arguments[0]].map(g => g.xAxisRange())"
DOTS = """
return figures.filter(f => chart_of(f).times && chart_of(f).axis == arguments[0]).map(f => f.querySelector('.legend').textContent);
"""
LEGENDS = "return graphs[arguments[0]].map(g => g.graphDiv.closest('figure').querySelector('.legend').textContent)"
# Text that is cut off or runs into the next cell.
OVERFLOWING = """
return [...document.querySelectorAll('h1, h2, h4, p, td, th, dt, dd, li, figcaption, button, .badge')]
    .filter(e => e.clientWidth && e.scrollWidth > e.clientWidth + 1).map(e => e.tagName + ': ' + e.textContent.slice(0, 60));
"""


def start(profile):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for flag in FLAGS + [f"--user-data-dir={profile}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


def show(driver, url, width, scheme):
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": 800, "deviceScaleFactor": 2 if width < 600 else 1,
                            "mobile": width < 600})
    driver.execute_cdp_cmd("Emulation.setTouchEmulationEnabled", {"enabled": width < 600})
    driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
    driver.get(url)


def shoot(driver, path):
    size = driver.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {
        "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}})
    path.write_bytes(base64.b64decode(shot["data"]))


def texts(driver, selector):
    return [e.text.replace("\n", " | ") for e in driver.find_elements("css selector", selector)]


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def check_charts(driver, where):
    figures = driver.find_elements("css selector", "figure[data-chart]")
    for figure in figures:
        title = figure.find_element("css selector", "h4").text
        pixels = driver.execute_script(COLOURED, figure)
        check(pixels > 300, f"{where}: chart '{title}' is blank ({pixels} coloured pixels)")
        check(figure.find_element("css selector", "[role=img]").get_attribute("aria-label"), f"'{title}' has no text")
    return len(figures)


def check_loops(driver, where):
    """The loop as boxes: all five, nothing cut or covered, letters that can be read, and the guilty marked without colour too."""
    loops = driver.execute_script(LOOPS)
    for loop in loops:
        names = [box["name"] for box in loop["boxes"]]
        check(names == ["controller", "actuator", "mechanics", "sensor", "process"], f"{where}: the loop shows {names}")
        check(not loop["cut"] and not loop["covered"], f"{where}: in the loop {loop['cut']} cut, {loop['covered']} covered")
        check(loop["size"] >= 10, f"{where}: letters of {loop['size']:.1f} px in the loop")
        for box in loop["boxes"]:
            check(box["fits"], f"{where}: the text of {box['name']} leaves its box")
            check(box["guilty"] == ((box["share"] or 0) >= 20), f"{where}: {box}")
            check(box["mark"] == box["guilty"] and (box["frame"] > 2) == box["guilty"], f"{where}: marked by colour alone: {box}")
            check(not box["guilty"] or box["name"] in loop["says"], f"{where}: '{loop['says']}' does not name {box['name']}")
    return len(loops)


def check_zoom(driver):
    """Drags over the first chart of each axis: it and the charts linked to it show that part, the button shows all."""
    for axis in driver.execute_script("return Object.keys(graphs)"):
        whole = driver.execute_script(RANGES, axis)
        plot = driver.execute_script("return graphs[arguments[0]][0].canvas_", axis)
        driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", plot)
        width = plot.size["width"]
        ActionChains(driver, duration=50).move_to_element_with_offset(plot, int(-0.2 * width), -40).click_and_hold() \
            .move_by_offset(int(0.2 * width), 0).release().perform()
        zoomed = driver.execute_script(RANGES, axis)
        print(f"axis {axis}: dragging shows {zoomed[0][0]:.2f} to {zoomed[0][1]:.2f} s of {whole[0][1]:.2f} s "
              f"in {len(zoomed)} charts")
        for before, after in zip(whole, zoomed):
            check(after[1] - after[0] < 0.5 * (before[1] - before[0]), f"a chart of axis {axis} did not zoom: {zoomed}")
            check(after == zoomed[0], f"the charts of axis {axis} show different times: {zoomed}")
        stills = driver.execute_script(DOTS, axis)
        check(all("dots of" in text for text in stills), f"the charts over velocity and position do not follow: {stills}")
        ActionChains(driver, duration=50).move_to_element(plot).perform()
        for legend in driver.execute_script(LEGENDS, axis):
            print(f"  under the pointer: {legend}")
            check(legend.endswith(" s"), f"no value is shown under the pointer, only '{legend}'")
            check(not re.search(r"spikes up to \S+ go", legend), f"spikes have no unit: '{legend}'")
        driver.execute_script("document.querySelector(`button[data-axis='${arguments[0]}']`).click()", axis)
        check(driver.execute_script(RANGES, axis) == whole, "the button does not show the whole record")


def check_pinch(driver):
    """One finger scrolls the page, two zoom."""
    plot = driver.execute_script("return graphs[0][0].canvas_")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", plot)
    box = driver.execute_script("const r = arguments[0].getBoundingClientRect(); return [r.left + r.width / 2, r.top + r.height / 3]", plot)

    def touch(kind, *xs, dy=0):
        points = [{"x": box[0] + x, "y": box[1] + dy, "id": k} for k, x in enumerate(xs)]
        driver.execute_cdp_cmd("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})

    whole, top = driver.execute_script(RANGES, 0), driver.execute_script("return scrollY")
    touch("touchStart", 0)
    for dy in (-10, -30, -60, -90):
        touch("touchMove", 0, dy=dy)
    touch("touchEnd")
    driver.execute_async_script("setTimeout(arguments[0], 300)")
    check(driver.execute_script(RANGES, 0) == whole, "one finger zooms")
    moved = driver.execute_script("return scrollY") - top
    check(moved > 20, f"one finger on a chart does not scroll the page ({moved} px)")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", plot)
    touch("touchStart", -20, 20)
    for x in (30, 45, 60, 80):
        touch("touchMove", -x, x)
    touch("touchEnd")
    zoomed = driver.execute_script(RANGES, 0)
    check(zoomed[0][1] - zoomed[0][0] < 0.5 * (whole[0][1] - whole[0][0]), f"two fingers do not zoom: {zoomed}")
    check(all(abs(z[0] - zoomed[0][0]) < 1e-6 for z in zoomed), f"the linked charts do not follow the fingers: {zoomed}")
    print(f"phone: one finger scrolls {moved:.0f} px, two show {zoomed[0][0]:.2f} to {zoomed[0][1]:.2f} s")


def check_width(driver, where):
    """Nothing scrolls sideways, no text leaves its box."""
    page, seen = driver.execute_script("const d = document.documentElement; return [d.scrollWidth, d.clientWidth]")
    check(page <= seen, f"{where}: the page is {page} px wide, {seen} px are seen")
    check(not (cut := driver.execute_script(OVERFLOWING)), f"{where}: text overflows: {cut}")


def check_alone(driver):
    """The page is one file."""
    loaded = driver.execute_script(
        "return performance.getEntriesByType('resource').map(e => e.name).filter(n => !n.startsWith('data:'))")
    check(not loaded, f"the page loads {loaded}")


def check_console(driver):
    # Chromium notes so when our finger moves while it still scrolls, on a busy machine: not the page's doing.
    errors = [e["message"] for e in driver.get_log("browser") if e["level"] in ("SEVERE", "WARNING")
              and "Ignored attempt to cancel a touch" not in e["message"]]
    check(not errors, f"the console says {errors}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("report", type=pathlib.Path)
    parser.add_argument("--expect-verdict")
    parser.add_argument("--expect-cause")
    parser.add_argument("--shots", type=pathlib.Path, required=True)
    given = parser.parse_args()
    given.shots.mkdir(parents=True, exist_ok=True)
    url = given.report.resolve().as_uri()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        driver = start(profile)
        try:
            for width in (1280, 360):
                for scheme in ("light", "dark") if everything else ("light" if width > 600 else "dark",):
                    where = f"{width} px, {scheme}"
                    show(driver, url, width, scheme)
                    n = check_charts(driver, where)
                    loops = check_loops(driver, where)
                    check_width(driver, where)
                    shoot(driver, given.shots / f"{given.report.stem}-{width}-{scheme}.png")
                    print(f"{where}: {n} charts and {loops} loops drawn, no horizontal scroll")
            if driver.execute_script("return Object.keys(graphs).length"):
                check_pinch(driver)

            show(driver, url, 1280, "light")
            badge = driver.find_element("css selector", "header .badge")
            verdict = badge.get_attribute("class").split()[-1]
            print(f"verdict: {verdict}: {driver.find_element('css selector', 'h1').text}")
            check(given.expect_verdict in (None, verdict), f"verdict is {verdict}, not {given.expect_verdict}")
            for selector in ("svg title", "table.gap tr", "#causes tr", "#remaining p", "#next p", "dl.shares dt", "#notes li", "#files dd"):
                for text in texts(driver, selector) if selector != "svg title" else \
                        [e.get_attribute("textContent") for e in driver.find_elements("css selector", selector)]:
                    print(f"{selector}: {text}")
            effects = [e.get_attribute("data-effect") for e in driver.find_elements("css selector", "#causes tr[data-effect]")]
            check(given.expect_cause in (None, *effects[:1]), f"the first cause is {effects[:1]}, not {given.expect_cause}")
            check_zoom(driver)
            check_alone(driver)
            pdf = driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})
            (given.shots / f"{given.report.stem}.pdf").write_bytes(base64.b64decode(pdf["data"]))
            check_console(driver)
        finally:
            driver.quit()
    print("ok")


if __name__ == "__main__":
    main()
