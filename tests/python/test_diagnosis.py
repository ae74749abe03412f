# SPDX-License-Identifier: BSL-1.0
# Long: one package: a case for each call.
"""The package says what the program says, however the log is at hand."""
import ast
import inspect
import json
import os
import pathlib
import subprocess
import threading
import time

import numpy as np
import pandas
import pytest

import quadrant
from conftest import SOURCE


def said(diagnosis):
    """What two diagnoses of one log must agree in: all but the names of files and their digests."""
    return {k: v for k, v in diagnosis.items() if k != "files"}


def test_files_give_the_diagnosis_file_of_the_program_byte_for_byte(found, data, program, tmp_path):
    subprocess.run([program, "diagnose", "--quiet", "--machine", data / "machine.json", "--log", data / "log.csv", "--holdout",
                    data / "holdout.csv", "--json", tmp_path / "d.json", "--report", tmp_path / "r.html"], check=True)
    found.save(tmp_path / "p.json")
    assert (tmp_path / "p.json").read_bytes() == (tmp_path / "d.json").read_bytes()
    assert found.report == (tmp_path / "r.html").read_text()


def test_arrays_and_frames_give_the_answer_of_the_file(found, data, columns):
    machine = json.loads((data / "machine.json").read_text())
    log, holdout = columns("log.csv"), columns("holdout.csv")
    from_arrays = quadrant.diagnose(log, machine, pandas.DataFrame(holdout))
    assert from_arrays.verdict == found.verdict == "explained"
    assert [c["effect"] for c in from_arrays.claims] == [c["effect"] for c in found.claims] == ["stribeck_friction"]
    named = lambda d: json.dumps(said(d.json)).replace(str(data / "log.csv"), "L").replace("table", "L").replace(
        str(data / "holdout.csv"), "H")
    others = [from_arrays]
    if os.environ.get("QUADRANT_TESTS") == "all":
        others.append(quadrant.diagnose(pandas.DataFrame(log), machine, holdout))
    for other in others:
        for a, b in zip(other.causes, found.causes):
            assert a["probability"] == b["probability"] and a["parameters"] == b["parameters"]
    assert len(named(from_arrays)) > 1000


def test_a_structured_array_is_a_log(columns):
    log = columns("holdout.csv")
    table = np.zeros(len(log["t_s"]), dtype=[(name, float) for name in log])
    for name, values in log.items():
        table[name] = values
    read = quadrant.read_log(table)
    assert read.rows == len(table) and read.axes == ["x"]
    assert np.array_equal(read.signals("x")["position"], log["x_pos_m"])


def test_the_practice_logs_have_the_verdicts_of_the_program_from_arrays(program, tmp_path):
    folder = pathlib.Path(os.environ["QUADRANT_SHARED"]) / "gap/practice"
    cases = sorted(folder.glob("*/log.csv"))
    if not cases:
        pytest.skip("no practice logs")
    if os.environ.get("QUADRANT_TESTS") != "all":
        cases = cases[:1]
    for log in cases:
        machine, holdout = log.with_name("machine.json"), log.with_name("holdout.csv")
        out = tmp_path / "d.json"
        words = [program, "diagnose", "--quiet", "--machine", machine, "--log", log, "--json", out]
        subprocess.run(words + (["--holdout", holdout] if holdout.exists() else []), check=True)
        native = json.loads(out.read_text())
        ours = quadrant.diagnose(pandas.read_csv(log), machine, pandas.read_csv(holdout) if holdout.exists() else None)
        assert ours.verdict == native["verdict"], log
        assert [(c["axis"], c["effect"]) for c in ours.causes] == [(c["axis"], c["effect"]) for c in native["causes"]], log


def test_apply_simulate_and_forecast_agree(found, data, columns):
    better = found.apply()
    assert any(c["path"] == "axes.x.plant.static_N" for c in better.changes)
    assert "static_N" in better["axes"]["x"]["plant"]
    before = quadrant.simulate(data / "machine.json", data / "holdout.csv").json["axes"]["x"]["gap"]["force_rms_N"]
    run = quadrant.simulate(better, columns("holdout.csv"))
    after = run.json["axes"]["x"]["gap"]["force_rms_N"]
    assert after < 0.5 * before
    x = run.signals["x"]
    assert set(x) == {"t_s", "force_N", "position_m", "command_V"}
    assert len(x["t_s"]) == len(x["force_N"]) == len(x["position_m"])
    holdout = columns("holdout.csv")
    planned = {"t_s": holdout["t_s"], "x_ref_m": holdout["x_ref_m"]}
    assert abs(found.forecast(planned).shrink("x") - (1 - after / before)) < 0.1
    assert abs(found.forecast(quadrant.read_log(data / "holdout.csv")).shrink("x") - (1 - after / before)) < 0.1
    assert "<worldbody>" in better.mjcf()[0] and "friction-static" in better.linuxcnc()[0]
    assert "x,Coulomb friction," in better.drive_values()[0]
    assert better.corrections(quadrant.read_log(data / "holdout.csv"))[1]


def test_compensate_has_the_keys_of_the_controller(found):
    gained = found.compensate()
    assert gained.controller_patch["axes"]["x"]["controller"]["coulomb_feedforward_V"] > 0
    assert gained.json["axes"]["x"]["compensations"]


def test_compare_names_a_force_that_was_added(data, columns):
    first = {name: values[:4500] for name, values in columns("holdout.csv").items()}
    second = {**first, "x_cmd_V": first["x_cmd_V"] + 0.05}
    found = quadrant.compare(first, second, data / "machine.json", fast=True)
    assert found.likeness == "differ"
    assert [d["effect"] for d in found.differences] == ["constant_force"]


def test_a_diagnosis_can_be_read_again(found, data, tmp_path):
    found.save(tmp_path / "d.json")
    again = quadrant.read_diagnosis(tmp_path / "d.json", data / "machine.json")
    assert again.apply().contents == found.apply().contents
    assert again.verdict == found.verdict


def test_the_notebook_gets_the_report(found):
    shown = found._repr_html_()
    assert shown.startswith("<iframe") and "Stribeck friction" in shown
    assert "<script" not in shown  # escaped: it runs inside the frame only
    assert "Stribeck friction is missing" in str(found)


def test_other_threads_run_during_a_diagnosis(data):
    """With Python's lock held, this thread would not get a turn before the diagnosis ends."""
    log = quadrant.read_log(data / "log.csv")
    done = threading.Event()
    worker = threading.Thread(target=lambda: (quadrant.diagnose(log, data / "machine.json", threads=1, fast=True), done.set()))
    worker.start()
    turns = 0
    while not done.wait(0.01):
        turns += 1
    worker.join()
    assert turns >= 10


def test_progress_is_heard_and_what_it_raises_ends_the_search(data):
    class Enough(Exception):
        pass

    lines = []

    def stop(line):
        lines.append(line)
        if len(lines) == 3:
            raise Enough

    began = time.monotonic()
    with pytest.raises(Enough):
        quadrant.diagnose(data / "log.csv", data / "machine.json", progress=stop)
    assert len(lines) == 3 and time.monotonic() - began < 60


def test_progress_never_falls_and_ends_with_all(data):
    shares = []
    quadrant.diagnose(data / "log.csv", data / "machine.json", progress=lambda line, done: shares.append(done))
    assert shares == sorted(shares) and shares[-1] == 1 and len(set(shares)) > 10


def test_refusals_name_what_is_wrong(data, columns, tmp_path):
    with pytest.raises(quadrant.BadInput, match="column x_pos_m is missing"):
        quadrant.read_log({"t_s": [0, 1, 2], "x_cmd_V": [1, 2, 3]})
    with pytest.raises(quadrant.BadInput, match="column x_pos_m has 2 rows"):
        quadrant.read_log({"t_s": [0, 1, 2], "x_pos_m": [1, 2]})
    with pytest.raises(quadrant.BadInput, match="column x_pos_m: holds what is no number"):
        quadrant.read_log({"t_s": [0, 1], "x_pos_m": ["a", "b"], "x_cmd_V": [0, 1]})
    with pytest.raises(quadrant.BadInput, match="nan"):
        quadrant.read_log({**columns("holdout.csv"), "x_cmd_V": np.full(len(columns("holdout.csv")["t_s"]), np.nan)})
    with pytest.raises(quadrant.BadInput, match="cannot be read"):
        quadrant.diagnose("nowhere.csv", data / "machine.json")
    with pytest.raises(quadrant.BadInput, match="did you mean mass_kg"):
        machine = json.loads((data / "machine.json").read_text())
        machine["axes"]["x"]["plant"]["mas_kg"] = machine["axes"]["x"]["plant"].pop("mass_kg")
        quadrant.read_machine(machine)
    with pytest.raises(TypeError, match="a log is a file"):
        quadrant.read_log(3)
    (tmp_path / "kept.json").write_text("mine")
    with pytest.raises(Exception):
        quadrant.read_machine(data / "log.csv").save(tmp_path / "kept.json")
    assert (tmp_path / "kept.json").read_text() == "mine"


def test_what_is_saved_is_whole_and_destroys_no_link(found, tmp_path):
    (tmp_path / "real.json").write_text("old")
    (tmp_path / "link.json").symlink_to(tmp_path / "real.json")
    found.save(tmp_path / "link.json")
    assert (tmp_path / "link.json").is_symlink() and json.loads((tmp_path / "real.json").read_text())["verdict"] == "explained"
    with pytest.raises(quadrant.BadInput, match="no such folder"):
        found.save_report(tmp_path / "nowhere" / "r.html")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["link.json", "real.json"]


def test_parquet_and_hdf5_files_are_logs():
    tables = SOURCE / "tests/diagnosis/tables"
    for name in ("snappy.parquet", "packed.h5", "level73.mat"):
        assert quadrant.read_log(tables / name).rows == 400
    with pytest.raises(quadrant.BadInput, match="zstd"):
        quadrant.read_log(tables / "zstd.parquet")


def test_foreign_columns_by_an_import_map():
    folder = SOURCE / "examples/import"
    log = quadrant.read_log(folder / "odrive.csv", map=folder / "odrive.map.json")
    assert log.axes == ["c"] and log.rows > 100
    guessed = quadrant.read_log(folder / "odrive.csv")
    assert guessed.axes == ["axis0"] and guessed.rows == log.rows
    with pytest.raises(quadrant.BadInput, match="halsampler, which does not say"):
        quadrant.read_log(folder / "halsampler.txt")


@pytest.mark.skipif(os.environ.get("QUADRANT_TESTS") != "all", reason="with QUADRANT_TESTS=all: 12 of the 30 s of these tests")
def test_a_trial_of_two_machines():
    t = quadrant.trial(3, seed=1, only=[0, 1], jobs=2)
    assert [c["index"] for c in t.cases] == [0, 1]
    assert "Right answers" in str(t) and t.json["calibration"]["causes"] >= 0
    blind = quadrant.trial(3, seed=1, only=[0, 1], diagnosis=lambda log, machine, holdout: quadrant.read_diagnosis(
        {"schema": "quadrant.diagnosis/1", "verdict": "no_gap", "axes": {}, "causes": [], "remaining":
         {"share_of_gap_unexplained": 0, "structure": ""}, "next_experiment": {"motion": "", "separates": [], "expected_gain": 0}}))
    assert sum(c["right"] for c in blind.cases) <= sum(c["right"] for c in t.cases)


def test_the_hints_are_of_what_is_there():
    """Every name of the compiled part stands in its .pyi with the same arguments, and nothing else does."""
    core = quadrant._core
    folder = pathlib.Path(quadrant.__file__).parent
    assert (folder / "py.typed").exists()
    tree = ast.parse((folder / "_core.pyi").read_text())

    def arguments(f):
        a = f.args
        return [x.arg for x in a.posonlyargs + a.args + a.kwonlyargs if x.arg != "self"]

    def real(f):
        signature = f.__doc__.splitlines()[0]
        inside = signature[signature.index("(") + 1:signature.rindex(") ->")]
        depth, words, word = 0, [], ""
        for c in inside:
            depth += (c in "[(") - (c in "])")
            if c == "," and depth == 0:
                words.append(word)
                word = ""
            else:
                word += c
        words.append(word)
        return [w.split(":")[0].strip() for w in words if w.strip() and w.strip() != "*" and w.split(":")[0].strip() != "self"]

    hinted = {n.name: n for n in tree.body if isinstance(n, (ast.FunctionDef, ast.ClassDef))}
    there = {n: o for n, o in vars(core).items() if not n.startswith("__") and n != "version"}
    assert set(hinted) == set(there)
    for name, node in hinted.items():
        if isinstance(node, ast.FunctionDef):
            assert arguments(node) == real(there[name]), name
            continue
        members = {n.name: n for n in node.body if isinstance(n, ast.FunctionDef)}
        if not issubclass(there[name], Exception):
            public = {n for n in vars(there[name]) if not n.startswith("_")} | ({"__init__"} & set(members))
            assert set(members) == public, name
        for member, f in members.items():
            if not f.decorator_list:
                assert arguments(f) == real(getattr(there[name], member)), (name, member)
    for module in (quadrant._calls, quadrant._files, quadrant.blocks):
        for name, f in inspect.getmembers(module, inspect.isfunction):
            if f.__module__ == module.__name__:
                assert "return" in f.__annotations__, (module.__name__, name)


def test_the_example_runs(data, tmp_path):
    for file in ("log.csv", "holdout.csv", "machine.json"):
        (tmp_path / file).symlink_to(data / file)
    text = (SOURCE / "examples/python/example.py").read_text()
    assert sum(1 for line in text.splitlines() if line and not line.startswith("#")) == 5
    here = os.getcwd()
    os.chdir(tmp_path)
    try:
        exec(compile(text, "example.py", "exec"), {})
    finally:
        os.chdir(here)
    assert "static_N" in (tmp_path / "better.json").read_text()
    assert "</html>" in (tmp_path / "report.html").read_text()
