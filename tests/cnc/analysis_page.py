#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The pages of quadrant-cnc analyse and tune, of a machine, of a measured axis, of a chirp log, in a browser: every picture is drawn, nothing leaves its place, nothing is loaded.
analysis_page.py PROGRAM ROOT SCRATCH     exit code 77: no browser"""
import cmath
import math
import os
import pathlib
import subprocess
import sys

try:
    from selenium import webdriver
    from selenium.webdriver.chrome.options import Options
    from selenium.webdriver.chrome.service import Service
except ImportError:
    print("no python3-selenium: skipped")
    sys.exit(77)
if not os.path.exists("/usr/bin/chromium") or not os.path.exists("/usr/bin/chromedriver"):
    print("no chromium: skipped")
    sys.exit(77)

program, root, scratch = sys.argv[1], pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3])
scratch.mkdir(parents=True, exist_ok=True)
mill = root / "examples/programs/quadrant_cnc/mill.json"
rows = []
for k in range(120):  # a double integrator with a mode at 180 Hz
    f = 10 ** (k / 45)
    r = 1j * f / 180
    g = -1.5e-2 / f ** 2 * (1 - 0.5 * r * r / (1 + 0.04 * r + r * r)) * cmath.exp(-2j * math.pi * f * 5e-4)
    rows.append(f"{f},{g.real},{g.imag}\n")
(scratch / "measured.csv").write_text("frequency_Hz,real_m_per_V,imag_m_per_V\n" + "".join(rows))
# What is asked for, its axes, and words that its page must have.
pages = {"analysis": ("analyse", mill, [], 3, 15, ("phase margin",)),
         "measured": ("analyse", mill, ["--axis", "x", "--frf", scratch / "measured.csv"], 1, 7, ("proposed velocity gain", "proposed notch", "Measured response")),
         "chirp": ("analyse", mill, ["--axis", "x", "--chirp", scratch / "chirp.csv"], 1, 8, ("proposed", "averages", "1: all of the position", "measure further up")),
         "tuning": ("tune", mill.with_name("sliding.json"), ["--axis", "x"], 1, 2, ("phase margin", "no rule asks for a change", "(acceptable)", "Tuning of sliding.json"))}
T, x, v, lines = 1e-3, 0.0, 0.0, ["t_s,x_ref_m,x_pos_m,x_cmd_V"]
for k in range(9000):  # a free mass under a PD law with a chirp in its reference
    reference = 4e-5 * math.sin(2 * math.pi * 9 / math.log(400) * (400 ** (k * T / 9) - 1))
    u = 3e4 * (reference - x) - 150 * v
    lines.append(f"{k * T:.6f},{reference:.12f},{x:.12f},{u:.9f}")
    x, v = x + v * T + 0.315 * u * T * T, v + 0.63 * u * T
(scratch / "chirp.csv").write_text("\n".join(lines) + "\n")
for name, (command, machine, asked_for, _, _, _) in pages.items():
    subprocess.run([program, command, "--quiet", "--cnc", machine, "--report", scratch / f"{name}.html", *asked_for], check=True)
options = Options()
for argument in ("--headless=new", "--no-sandbox", "--disable-gpu"):
    options.add_argument(argument)
options.binary_location = "/usr/bin/chromium"
options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
browser = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
bad = []
try:
    for name, (command, _, _, axes, drawn, words) in pages.items():
        for width in (1280, 390):
            for dark in (False, True):
                browser.set_window_size(width, 900)
                browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                        {"features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})
                browser.get((scratch / f"{name}.html").resolve().as_uri())
                shown = browser.execute_script("""
                    const drawn = [...document.querySelectorAll('svg.plane')];
                    const outside = drawn.flatMap(s => [...s.querySelectorAll('text')].filter(t => {
                        const a = t.getBoundingClientRect(), b = s.getBoundingClientRect();
                        return a.left < b.left - 1 || a.right > b.right + 1 || a.top < b.top - 1 || a.bottom > b.bottom + 1; }));
                    return {drawn: drawn.length, lines: drawn.every(s => s.querySelector('polyline.open, polyline.tracking')),
                            small: drawn.filter(s => s.getBoundingClientRect().width < 200).length, outside: outside.map(t => t.textContent),
                            wide: document.documentElement.scrollWidth > innerWidth, axes: document.querySelectorAll('section[data-axis-name]').length,
                            rows: document.querySelectorAll('table.figures tr').length,
                            names: drawn.every(s => s.getAttribute('aria-label')), words: document.body.innerText};""")
                what = f"{name}, {width} px, {'dark' if dark else 'light'}"
                good = (shown["axes"] == axes and shown["drawn"] == drawn and shown["lines"] and shown["names"] and shown["small"] == 0
                        and not shown["wide"] and not shown["outside"] and (command == "tune" or shown["rows"] >= axes * 8)
                        and all(word in shown["words"] for word in words) and "nan" not in shown["words"])
                print("ok  " if good else "BAD ", what, "" if good else {k: v for k, v in shown.items() if k != "words"})
                bad += [] if good else [what]
                if not dark:
                    browser.save_screenshot(str(scratch / f"{name}_{width}.png"))
    said = browser.get_log("browser")
    asked = [e for e in browser.get_log("performance") if "Network.requestWillBeSent" in e["message"] and "file://" not in e["message"]]
    if said or asked:
        bad.append("console or network")
        print("BAD  console or network:", said, asked[:2])
finally:
    browser.quit()
sys.exit(1 if bad else 0)
