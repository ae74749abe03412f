#!/usr/bin/python3
# SPDX-License-Identifier: BSL-1.0
# Long: one browser for all that a person does on the page, step after step.
"""Opens the built page from disk in headless Chromium and uses it as a person would.

page_test.py QUADRANT.html quadrant-gap SOURCE_DIR --shots DIR [--axe axe.min.js]
The practice logs are dropped by verdicts.py. Times are those of the clock, less what the browser's threads waited for a core:
nothing, on a computer that does nothing else. They are never less than what the threads ran.
"""
import argparse
import gzip
import json
import pathlib
import subprocess
import sys
import tempfile
import time

for folder in ("report", "diagnosis"):
    sys.path.insert(0, str(pathlib.Path(__file__).parent.parent / folder))
import mat_file_test  # noqa: E402
from browser_test import OVERFLOWING, check, shoot, show  # noqa: E402
from selenium import webdriver  # noqa: E402
from selenium.webdriver.chrome.options import Options  # noqa: E402
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.keys import Keys  # noqa: E402
from browser_test import FLAGS  # noqa: E402

TO_FIND_A_FILE_S = 3  # which a person takes from an open page to a dropped file; the page gets ready meanwhile
PAGE_BYTES, FIRST_VERDICT_S, SLIDER_MS, SLIDER_ROWS = 1_500_000, 10, 100, 28_000
DROP = """
const data = new DataTransfer();
data.items.add(new File([arguments[1]], arguments[0]));
document.getElementById('drop').dispatchEvent(new DragEvent('drop', {dataTransfer: data, bubbles: true, cancelable: true}));
"""


def net_log(profile):
    return pathlib.Path(profile) / "net.json"


def start(profile):
    options = Options()
    options.binary_location = "/usr/bin/chromium"
    for flag in FLAGS + [f"--user-data-dir={profile}", f"--log-net-log={net_log(profile)}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)


class Stopwatch:
    """What the browser's threads ran and what they waited for a core (/proc/*/schedstat), and the clock."""

    def __init__(self, driver):
        self.driver, self.before, self.began = driver, self.threads(driver), time.monotonic()

    @staticmethod
    def threads(driver):
        """(ran, waited) in seconds of every thread of the browser."""
        children, out = {}, {}
        for stat in pathlib.Path("/proc").glob("[0-9]*/stat"):
            try:
                children.setdefault(int(stat.read_text().rpartition(")")[2].split()[1]), []).append(int(stat.parent.name))
            except OSError:
                pass  # it has ended
        processes = [driver.service.process.pid]
        for process in processes:
            processes += children.get(process, [])
            for task in pathlib.Path(f"/proc/{process}/task").glob("*/schedstat"):
                try:
                    out[task.parent.name] = [1e-9 * int(n) for n in task.read_text().split()[:2]]
                except OSError:
                    pass
        return out

    def read(self):
        """Seconds: by the clock, waited for a core by all threads, run by all threads, run by the busiest one."""
        clock = time.monotonic() - self.began
        spent = [[b - a for a, b in zip(self.before.get(thread, (0, 0)), now)] for thread, now in self.threads(self.driver).items()]
        ran, waited = zip(*spent)
        return clock, sum(waited), sum(ran), max(ran)


def wait(condition, seconds, what):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        if condition():
            return
        time.sleep(0.05)
    check(False, f"{what} within {seconds} s")


def element(driver, selector):
    return driver.find_element("css selector", selector)


def give(driver, *files):
    element(driver, "#files").send_keys("\n".join(str(f) for f in files))


def verdict_or_fault(driver):
    faults = [e.text for e in driver.find_elements("css selector", "#start .fault") if e.text]
    return faults or element(driver, "#verdict").is_displayed()


def open_page(driver, page, width=1200, scheme="light"):
    show(driver, page.resolve().as_uri(), width, scheme)


def no_requests(profile):
    """Whatever a page, its worker or its frames sent, by the browser's log of its network; `not an origin` is the
    browser itself. Asked after the browser has ended."""
    events, end = None, time.monotonic() + 20
    while events is None and time.monotonic() < end:
        try:
            events = json.loads(net_log(profile).read_text())["events"]
        except (OSError, ValueError):
            time.sleep(0.2)
    check(events, "the browser wrote no log of its network")
    sent = sorted({e["params"]["url"] for e in events if e.get("params", {}).get("initiator", "not an origin") != "not an origin"})
    check(not sent, f"requests: {sent}")
    print("requests to a network: none")


def diagnosis_of(driver):
    return json.loads(driver.execute_script("return result.diagnosis"))


def claims(diagnosis):
    return diagnosis["verdict"], [(c["axis"], c["effect"]) for c in diagnosis["causes"]
                                  if max(c["probability"], c["group_probability"]) >= 0.5]


def native(program, folder, files, work):
    out = work / "native.json"
    command = [program, "diagnose", "--machine", folder / "machine.json", "--log", folder / "log.csv",
               "--json", out, "--quiet"]
    if "holdout.csv" in files:
        command += ["--holdout", folder / "holdout.csv"]
    subprocess.run([str(c) for c in command], check=True)
    return json.loads(out.read_text())


def fits(driver, where):
    wide = driver.execute_script("return document.documentElement.scrollWidth - document.documentElement.clientWidth")
    check(wide <= 0, f"{where}: the page is {wide} px wider than the screen")
    over = [t for t in driver.execute_script(OVERFLOWING) if "Which column" not in t]
    check(not over, f"{where}: text runs over: {over}")


def errors_of(driver):
    return [e["message"] for e in driver.get_log("browser") if e["level"] == "SEVERE"]


def shipped_log(driver, page, program, data, shots, work):
    open_page(driver, page)
    time.sleep(TO_FIND_A_FILE_S)
    watch = Stopwatch(driver)
    give(driver, data / "machine.json", data / "log.csv", data / "holdout.csv")
    wait(lambda: verdict_or_fault(driver), 120, "a verdict")
    clock, waited, ran, _ = watch.read()
    # What a user sees is the clock; beside other load it says more than the page takes.
    took = min(clock, max(ran, clock - waited))
    print(f"first verdict after {clock:.1f} s, of which {waited:.1f} s waited; {ran:.1f} s of processor time")
    check(took < FIRST_VERDICT_S, f"first verdict after {took:.1f} s")
    found = diagnosis_of(driver)
    files = ["machine.json", "log.csv", "holdout.csv"]
    expected = native(program, data, files, work)
    check(claims(found) == claims(expected), f"the page says {claims(found)}, the program {claims(expected)}")
    check(element(driver, "#sentence").text.startswith("Stribeck friction is missing"), element(driver, "#sentence").text)
    check([f["sha256"] for f in found["files"].values()] == [f["sha256"] for f in expected["files"].values()],
          "the digests of the files differ")
    print("shipped log: the program's verdict")
    wait(lambda: element(driver, "#took").text, 10, "what-if")
    report = element(driver, "#report")
    driver.switch_to.frame(report)
    check("Stribeck friction is missing" in element(driver, "h1").text, "the report is in the page")
    wait(lambda: driver.execute_script("return document.querySelectorAll('figure .plot canvas').length") > 5, 5, "charts")
    driver.switch_to.default_content()
    check(report.size["height"] > 1500, "the report is shown whole")
    what_if(driver, expected)
    saved_for_others(driver, program, data, work)
    compensation(driver, program, data, work)
    shoot(driver, shots / "web_1200.png")
    check(not errors_of(driver), f"errors in the page: {errors_of(driver)}")


def what_if(driver, expected):
    def gap(column):
        return driver.execute_script(f"return [...document.querySelectorAll('#gaps td.{column}')].map(e => e.textContent)")
    before, with_cause = gap("was"), gap("now")
    check(before != with_cause, "the cause changes the gap")
    sliders = driver.find_elements("css selector", "#knobs input[type=range]")
    check(len(sliders) == sum(len(p) for c in expected["causes"] for p in [c["parameters"]]), "a slider for every value")
    times = []
    for step in range(12):
        driver.execute_script("document.getElementById('took').textContent = ''")
        watch = Stopwatch(driver)
        sliders[0].send_keys(Keys.ARROW_LEFT if step % 2 else Keys.ARROW_RIGHT)
        wait(lambda: element(driver, "#took").text, 20, "an answer to the slider")
        _, waited, _, worker = watch.read()
        shown = int(element(driver, "#took").text.split()[2])  # by the page's clock
        times.append(round(min(shown, max(1000 * worker, shown - 1000 * waited))))
    rows = driver.execute_script("return dropped.get(the('log').value).rows")
    slow = sorted(times)[-2]  # one of the twelve may meet another program
    print(f"sliders: {slow} ms for {rows} rows (of {times})")
    check(rows >= SLIDER_ROWS, f"only {rows} rows")
    check(slow <= SLIDER_MS, f"a slider takes {slow} ms")
    for tick in driver.find_elements("css selector", "#knobs input[type=checkbox]"):
        tick.click()
    wait(lambda: gap("now") == before, 5, "without cause and calibration the gap of the machine file")
    element(driver, "#as-found").click()
    wait(lambda: gap("now") == with_cause, 5, "the values found again")
    saved = json.loads(driver.execute_script("return shown.machine_text"))
    value = expected["causes"][0]["parameters"]["static_N"]["value"]
    check(abs(saved["axes"]["x"]["plant"]["static_N"] / value - 1) < 1e-6, "the machine file holds the cause")


def saved_for_others(driver, program, data, work):
    """What is saved for other programs is what `quadrant-gap export` writes of the same machine file."""
    driver.execute_script("window.files = []; save = (name, text) => files.push([name, text])")
    machine, log = work / "as_set.json", data / "log.csv"
    machine.write_text(driver.execute_script("return shown.machine_text"))
    for button in driver.find_elements("css selector", "#save-as button"):
        kind = button.get_attribute("data-as")
        before = driver.execute_script("return files.length")
        button.click()
        wait(lambda: driver.execute_script("return files.length") > before, 10, f"a file for {kind}")
        name, text = driver.execute_script("return files.at(-1)")
        out = work / name
        subprocess.run([program, "export", "--quiet", "--machine", str(machine), f"--{kind}", str(out)] +
                       (["--log", str(log)] if kind == "compensation" else []), check=True)
        mine, other = text.splitlines(), out.read_text().splitlines()
        check(len(mine) == len(other) and sum(a != b for a, b in zip(mine, other)) <= 1, f"{kind}: {text} is not {out.read_text()}")
    check("is saved" in element(driver, "#saved").text, "what was saved is told")
    print("saved for other programs: as the program writes it")


def compensation(driver, program, data, work):
    """The switch: the forecasts of `quadrant-gap compensate`, follow a slider; what is saved has the controller's key."""
    def forecast():
        return json.loads(driver.execute_script("return gains.forecast"))["axes"]["x"]

    def answered():
        wait(lambda: element(driver, "#forecast-took").text, 20, "a forecast")
    check(not element(driver, "#compensation").is_displayed(), "no compensation before it is asked for")
    element(driver, "#compensated").click()
    answered()
    out = work / "compensation.json"
    subprocess.run([program, "compensate", "--quiet", "--machine", str(data / "machine.json"), "--log", str(data / "log.csv"),
                    "--diagnosis", str(work / "native.json"), "--json", str(out)], check=True)
    expected, found = json.loads(out.read_text())["axes"]["x"]["compensations"], forecast()["compensations"]
    check([c["name"] for c in found] == [c["name"] for c in expected], f"compensations: {[c['name'] for c in found]}")
    for mine, other in zip(found, expected):
        apart = abs(mine["after"]["rms_m"]["value"] / other["after"]["rms_m"]["value"] - 1)
        check(apart < 0.01, f"{mine['name']}: the page forecasts {mine['after']['rms_m']}, the program {other['after']['rms_m']}")
    rows = driver.find_elements("css selector", "#gains tbody tr")
    check(len(rows) == 1 + len(expected), f"{len(rows)} rows of tracking errors")
    check(len(driver.find_elements("css selector", "#gains canvas")) == 1, "a curve of the tracking error")
    controller = json.loads(driver.execute_script("return gains.machine_text"))["axes"]["x"]["controller"]
    check(abs(controller["coulomb_feedforward_V"] / expected[0]["controller"]["coulomb_feedforward_V"] - 1) < 0.01,
          "the saved machine file has the feedforward")
    before = forecast()["compensations"][-1]["settings"]
    driver.execute_script("document.getElementById('forecast-took').textContent = ''")
    element(driver, "#knobs input[type=range]").send_keys(Keys.ARROW_RIGHT * 5)
    answered()
    wait(lambda: forecast()["compensations"][-1]["settings"] != before, 10, "the feedforward follows the slider")
    element(driver, "#knobs input[type=checkbox]").click()
    wait(lambda: "No cause that is switched on has a feedforward" in element(driver, "#gains").text, 10, "nothing to compensate")
    check(not element(driver, "#save-compensated").is_enabled(), "nothing to save")
    element(driver, "#as-found").click()
    wait(lambda: driver.find_elements("css selector", "#gains canvas"), 10, "the values found again")
    print("compensation: forecasts as the program's")


def narrow_and_dark(driver, page, data, shots):
    open_page(driver, page, 390, "dark")
    shoot(driver, shots / "web_390_empty.png")
    give(driver, data / "machine.json", data / "log.csv")
    wait(lambda: verdict_or_fault(driver) and element(driver, "#took").text, 60, "a verdict at 390 px")
    element(driver, "#compensated").click()
    wait(lambda: element(driver, "#forecast-took").text, 20, "a forecast at 390 px")
    fits(driver, "390 px, dark")
    beyond = driver.execute_script("const t = document.querySelector('#gains .wide'); return t.scrollWidth - t.clientWidth")
    check(beyond <= 0, f"390 px: the table of tracking errors is {beyond} px wider than its place")
    time.sleep(0.5)
    shoot(driver, shots / "web_390_dark.png")
    check(driver.execute_script("return getComputedStyle(document.body).backgroundColor") == "rgb(17, 22, 28)", "dark")


def without_a_machine(driver, page, data, shots):
    open_page(driver, page)
    give(driver, data / "log.csv")
    wait(lambda: driver.find_elements("css selector", "#machine input"), 10, "the form")
    check("missing" in element(driver, "#machine .fault").text, "the form says what is missing")
    check(not element(driver, "#go").is_enabled(), "nothing can be diagnosed yet")
    plant = json.loads((data / "machine.json").read_text())["axes"]["x"]["plant"]
    for option, key in (("mass", "mass_kg"), ("force-constant", "force_constant_N_per_V")):
        element(driver, f"input[data-option={option}]").send_keys(str(plant[key]) + Keys.TAB)
    wait(lambda: element(driver, "#go").is_enabled(), 5, "enough for a diagnosis")
    resolution = element(driver, "input[data-option=resolution]").get_attribute("placeholder")
    check(float(resolution) > 0, "the log's resolution stands in the form")
    shoot(driver, shots / "web_form.png")
    element(driver, "#go").click()
    wait(lambda: element(driver, "#cancel").is_displayed(), 5, "cancel")
    wait(lambda: " %" in element(driver, "#progress").text and "reading" not in element(driver, "#progress").text, 20, "progress")
    check(element(driver, "#share").is_displayed(), "a bar beside the words")
    element(driver, "#cancel").click()
    wait(lambda: element(driver, "#progress").text == "Cancelled.", 5, "cancelled")
    driver.execute_script("""
        window.heard = [];
        new MutationObserver(() => heard.push([the('share').value, the('progress').textContent]))
            .observe(the('progress'), {childList: true, characterData: true, subtree: true});""")
    element(driver, "#go").click()
    wait(lambda: verdict_or_fault(driver), 60, "a verdict after a cancelled one")
    shares, words = zip(*driver.execute_script("return heard.filter(([, words]) => words.includes(' %'))"))
    check(len(shares) > 10 and list(shares) == sorted(shares) and shares[-1] == 1, f"shares of the work: {shares}")
    check(any(" s left: x: trying " in w for w in words), f"the time that is left, and what is tried: {words}")
    check(not element(driver, "#share").is_displayed(), "no bar when all is done")
    check(element(driver, "#verdict").is_displayed(), element(driver, "#start .fault").text)


def serious(driver, axe, where):
    """What axe-core calls serious or critical in the document at hand."""
    driver.execute_script(axe)
    driver.set_script_timeout(120)
    found = driver.execute_async_script("const done = arguments[0]; axe.run(document, {iframes: false}).then(r => done(r.violations))")
    bad = [f"{v['id']}: {v['help']} ({v['nodes'][0]['html'][:120]})" for v in found if v["impact"] in ("serious", "critical")]
    check(not bad, f"{where}: {len(bad)} serious findings of axe-core: {'; '.join(bad)}")


def accessible(driver, page, data, axe):
    if not axe:
        print("SKIPPED: accessibility (no --axe: npm is not there, or gave nothing)")
        return
    source = axe.read_text()
    for scheme in ("light", "dark"):
        open_page(driver, page, 1200, scheme)
        element(driver, "#gallery summary").click()
        serious(driver, source, f"empty page, {scheme}")
        give(driver, data / "log.csv")
        wait(lambda: driver.find_elements("css selector", "#machine input"), 20, "the form")
        serious(driver, source, f"the form, {scheme}")
        give(driver, data / "machine.json")
        wait(lambda: verdict_or_fault(driver) and element(driver, "#took").text, 120, "a verdict")
        serious(driver, source, f"verdict and sliders, {scheme}")
        driver.switch_to.frame(element(driver, "#report"))
        serious(driver, source, f"the report, {scheme}")
        driver.switch_to.default_content()
    print("accessibility: no serious finding of axe-core")


def differences(comparison):
    return comparison["likeness"], [(d["axis"], d["effect"], d["found_in"]) for d in comparison["differences"]]


def compare_two(driver, page, program, data, shots, work):
    """Both logs dropped: the same machine is alike; with a constant added to its command it differs by a force."""
    leaning, out = work / "leaning.csv", work / "compared.json"
    header, *rows = [line.split(",") for line in (data / "holdout.csv").read_text().split()]
    at = header.index("x_cmd_V")
    for row in rows:
        row[at] = f"{float(row[at]) + 0.05:.6f}"
    leaning.write_text("\n".join(",".join(row) for row in [header, *rows]) + "\n")
    for other, machine in ((data / "holdout.csv", [data / "machine.json"]), (leaning, [data / "machine.json"]), (leaning, [])):
        open_page(driver, page)
        give(driver, data / "log.csv", other)
        wait(lambda: element(driver, "#start").is_displayed(), 20, "two logs")
        driver.execute_script("for (const id of ['beside']) { the(id).value = arguments[0]; the(id).dispatchEvent(new Event('change')); }",
                              other.name)
        if machine:
            give(driver, *machine)
            wait(lambda: driver.execute_script("return running"), 20, "the comparison begins")
        else:
            check(element(driver, "#go").is_enabled(), "no machine file is needed")
            element(driver, "#go").click()
        wait(lambda: not driver.execute_script("return running") and verdict_or_fault(driver), 240, "a comparison")
        check(element(driver, "#verdict").is_displayed(), element(driver, "#start .fault").text)
        check(not element(driver, "#what-if").is_displayed(), "no sliders for a comparison")
        command = [program, "compare", data / "log.csv", other, "--json", out, "--quiet"] + (["--machine", *machine] if machine else [])
        subprocess.run([str(c) for c in command], check=True)
        expected, found = json.loads(out.read_text()), diagnosis_of(driver)
        check(differences(found) == differences(expected), f"the page says {differences(found)}, the program {differences(expected)}")
        named = [d["effect"] for d in found["differences"]]
        check(named == (["constant_force"] if other == leaning else []), f"{other.name}: {named}")
        print(f"compared with {other.name}, {'a' if machine else 'no'} machine file: {found['likeness']} {named}, as the program")
        if other == leaning and machine:
            shoot(driver, shots / "web_compare.png")
    check(not errors_of(driver), f"errors in the page: {errors_of(driver)}")


def gallery(driver, page, shots):
    open_page(driver, page)
    element(driver, "#gallery summary").click()
    pictures = driver.find_elements("css selector", "#gallery img")
    check(len(pictures) == 10, f"{len(pictures)} pictures in the gallery")
    wait(lambda: all(driver.execute_script("arguments[0].scrollIntoView(); return arguments[0].complete && arguments[0].naturalWidth > 0", p)
                     for p in pictures), 10, "the pictures of the gallery")
    check(all(p.get_attribute("alt") for p in pictures), "a picture without words")
    shoot(driver, shots / "web_gallery.png")


def mat_files(driver, page, work):
    """A MAT-file is read like its table; a damaged one is refused with its byte."""
    variables = mat_file_test.record()
    for name, contents, words in (("log.mat", mat_file_test.mat(variables, packed=True), "log: 400 rows, one every 1 ms, axis x"),
                                  ("cut.mat", mat_file_test.mat(variables)[:-100], "an element of"),
                                  ("hdf5.mat", mat_file_test.mat([], text=b"MATLAB 7.3 MAT-file", version=0x0200), "save(..., '-v7')")):
        open_page(driver, page)
        (work / name).write_bytes(contents)
        give(driver, work / name)
        wait(lambda: words in element(driver, "#dropped").text, 10, f"{name}: {words}")
    tables = pathlib.Path(__file__).parent.parent / "diagnosis/tables"
    for name, words in (("snappy.parquet", "log: 400 rows, one every 1 ms, axis x"), ("gzip.parquet", "log: 400 rows, one every 1 ms, axis x"),
                        ("packed.h5", "log: 400 rows, one every 1 ms, axis x"), ("level73.mat", "log: 400 rows, one every 1 ms, axis x"),
                        ("zstd.parquet", "is compressed with zstd"), ("latest.h5", "libver='earliest'")):
        open_page(driver, page)
        give(driver, tables / name)
        wait(lambda: words in element(driver, "#dropped").text, 10, f"{name}: {words}")
    print("MAT-files, Parquet and HDF5: read, and refused with what to do")


def other_columns(driver, page, root, shots):
    open_page(driver, page)
    give(driver, root / "examples/import/odrive.csv", root / "examples/import/odrive.map.json")
    wait(lambda: "rows, one every" in element(driver, "#dropped").text, 10, "a log through a map")
    open_page(driver, page)
    driver.execute_script(DROP, "odrive.csv", (root / "examples/import/odrive.csv").read_text())
    wait(lambda: "rows, one every" in element(driver, "#dropped").text and "as ODrive writes it" in element(driver, "#dropped").text,
         10, "ODrive's columns by their names")
    open_page(driver, page)
    driver.execute_script(DROP, "scope.csv", (root / "examples/import/twincat_scope.csv").read_text())
    wait(lambda: element(driver, "#columns").is_displayed(), 10, "the table of columns")
    assert "TwinCAT Scope" in element(driver, "#columns-why").text
    uses = {"column 1": ("time", "ms"), "MAIN.AxisY.NcToPlc.SetPos": ("reference", "mm"),
            "MAIN.AxisY.NcToPlc.ActPos": ("position", "mm"), "MAIN.nTorqueY": ("command", "A")}
    for row in driver.find_elements("css selector", "#columns tbody tr"):
        (role, unit), selects = uses[element(row, "th").text], row.find_elements("css selector", "select")
        if role != "command":
            assert selects[0].get_attribute("value") == role, element(row, "th").text
        for select, value in zip(selects, (role, unit)):
            driver.execute_script("arguments[0].value = arguments[1]", select, value)
    shoot(driver, shots / "web_columns.png")
    element(driver, "#columns-use").click()
    wait(lambda: "rows, one every" in element(driver, "#dropped").text, 10,
         f"a log through columns by hand ({element(driver, '#columns .fault').text})")
    open_page(driver, page)
    driver.execute_script(DROP, "bad.json", '{"schema": "quadrant.machine/1"}')
    wait(lambda: "sample_period_s" in element(driver, "#dropped").text, 10, "why a file cannot be read")
    driver.execute_script(DROP, "ms.csv", "t_ms;x_ref_mm;x_pos_mm;x_cmd_V\n" + "\n".join(
        f"{k};{str(0.1 * (k % 40))};{str(0.1 * (k % 40))};{k % 3}" for k in range(400)).replace(".", ","))
    wait(lambda: "400 rows, one every 1 ms" in element(driver, "#dropped").text, 10, "units by the columns' names")


def main():
    parse = argparse.ArgumentParser()
    parse.add_argument("page", type=pathlib.Path)
    parse.add_argument("program")
    parse.add_argument("source", type=pathlib.Path)
    parse.add_argument("--shots", type=pathlib.Path, required=True)
    parse.add_argument("--axe", type=pathlib.Path)
    given = parse.parse_args()
    given.shots.mkdir(parents=True, exist_ok=True)
    size = len(gzip.compress(given.page.read_bytes(), 9))
    print(f"the page: {size} bytes gzipped")
    check(size <= PAGE_BYTES, f"the page is {size} bytes gzipped")
    data = given.source.resolve() / "examples/data"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile, tempfile.TemporaryDirectory() as work:
        driver = start(profile)
        try:
            shipped_log(driver, given.page, given.program, data, given.shots, pathlib.Path(work))
            narrow_and_dark(driver, given.page, data, given.shots)
            without_a_machine(driver, given.page, data, given.shots)
            other_columns(driver, given.page, given.source.resolve(), given.shots)
            mat_files(driver, given.page, pathlib.Path(work))
            compare_two(driver, given.page, given.program, data, given.shots, pathlib.Path(work))
            gallery(driver, given.page, given.shots)
            accessible(driver, given.page, data, given.axe)
        finally:
            driver.quit()
        no_requests(profile)
    print("passed")


main()
