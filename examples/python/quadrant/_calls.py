# SPDX-License-Identifier: BSL-1.0
# Long: one call after the other, each with its documentation.
"""The calls. Each releases Python's lock while it computes, so that logs can be diagnosed side by side in threads."""
from __future__ import annotations

import hashlib
import html
import inspect
import json
import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Iterable, Mapping, Optional, Union

import numpy as np

from . import _core
from ._files import Log, LogLike, Machine, MachineLike, columns_of, read_log, read_machine, write_whole

Progress = Union[Callable[[str], Any], Callable[[str, float], Any]]
Signals = dict[str, dict[str, "np.ndarray[Any, np.dtype[np.float64]]"]]


def _heard(progress: Optional[Progress]) -> Optional[Callable[[str, float], Any]]:
    """Of a line and a share. A function of a line alone hears the line alone."""
    if progress is None:
        return None
    try:
        inspect.signature(progress).bind("", 0.0)
    except (TypeError, ValueError):  # it takes one, or is of C and does not say
        return lambda line, done: progress(line)  # type: ignore[call-arg, misc]
    return progress  # type: ignore[return-value]


def in_frame(page: str) -> str:
    """A whole page as a notebook shows it: with styles and scripts of its own."""
    return ('<iframe title="quadrant: report" style="width:100%;height:900px;border:0" sandbox="allow-scripts" '
            f'srcdoc="{html.escape(page, quote=True)}"></iframe>')


class Diagnosis:
    """What a diagnosis says. In a notebook it shows as the report; print() gives the words."""

    def __init__(self, core: _core.DiagnosisResult, machine: Optional[Machine], log: Optional[Log]) -> None:
        self._core, self.machine, self.log = core, machine, log
        self.json: dict[str, Any] = json.loads(core.json())

    @property
    def verdict(self) -> str:
        """explained, partly_explained, unexplained, within_tolerance or no_gap."""
        return str(self.json["verdict"])

    @property
    def causes(self) -> list[dict[str, Any]]:
        """Claims and suspects, as the diagnosis file has them; the first explains most."""
        return list(self.json["causes"])

    @property
    def claims(self) -> list[dict[str, Any]]:
        """The causes that are said to be there: alone, or as one of a group, at least as probable as not."""
        return [c for c in self.causes if max(c["probability"], c["group_probability"]) >= 0.5]

    @property
    def sentence(self) -> str:
        return self._core.sentence()

    @property
    def report(self) -> str:
        """One HTML page that needs no network."""
        return self._core.report()

    @property
    def next_motion(self) -> str:
        """The reference of the next experiment (CSV), empty where none is proposed."""
        return self._core.next_motion()

    def summary(self, verbose: bool = False) -> str:
        return self._core.summary(verbose)

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """The diagnosis file (JSON), as `quadrant-gap diagnose --json` writes it."""
        write_whole(path, self._core.json())

    def save_report(self, path: Union[str, "os.PathLike[str]"]) -> None:
        write_whole(path, self.report)

    def apply(self, at_least: float = 0.5) -> Machine:
        """The machine with what was found."""
        return apply(self._described(), self, at_least)

    def forecast(self, motion: LogLike, at_least: float = 0.5) -> "Forecast":
        """How far the gap will shrink on a motion that was not recorded yet."""
        return forecast(self._described(), self, motion, at_least)

    def compensate(self, log: Optional[LogLike] = None, at_least: float = 0.5) -> "Compensation":
        """What feedforwards built from the causes would gain in the controller, on this log or another one."""
        on = log if log is not None else self.log
        if on is None:
            raise TypeError("log: is needed, the diagnosis was read from a file")
        return compensate(self._described(), self, on, at_least)

    def _described(self) -> Machine:
        if self.machine is None:
            raise TypeError("the diagnosis was read from a file: give the machine, quadrant.apply(machine, diagnosis)")
        return self.machine

    def __str__(self) -> str:
        return self.summary()

    def __repr__(self) -> str:
        return f"<quadrant.Diagnosis {self.verdict}: {self.sentence}>"

    def _repr_html_(self) -> str:
        return in_frame(self.report)


def read_diagnosis(diagnosis: Union[str, "os.PathLike[str]", Mapping[str, Any]], machine: Optional[MachineLike] = None,
                   log: Optional[LogLike] = None) -> Diagnosis:
    """A diagnosis file again. Its report has no charts: the signals are not in the file."""
    if isinstance(diagnosis, Mapping):
        text, name = json.dumps(diagnosis), "diagnosis"
    else:
        text, name = Path(diagnosis).read_text(encoding="utf-8"), str(diagnosis)
    return Diagnosis(_core.read_diagnosis(text, name), read_machine(machine) if machine is not None else None,
                     read_log(log) if log is not None else None)


def diagnose(log: LogLike, machine: MachineLike, holdout: Optional[LogLike] = None, *, fast: bool = False, threads: int = 0,
             seconds: float = 0, progress: Optional[Progress] = None) -> Diagnosis:
    """Names the effect that the simulation lacks, how sure that is, and how far the gap shrinks with it.

    holdout: a log of another motion of the same machine, to judge the forecast on. fast: fewer models tried. threads: at
    most; 0: as many as there are cores; the answer is the same. seconds: end the search after this time; 0: as long as it
    takes. progress: gets a short line of what is being tried and, if it takes two, the share of the work that is done, 0 to 1.
    """
    described, record = read_machine(machine), read_log(log)
    second = read_log(holdout) if holdout is not None else None
    core = _core.diagnose(described.text, described.name, record._core, second._core if second else None, fast, threads,
                          seconds, _heard(progress))
    core.digests(hashlib.sha256(described.text.encode()).hexdigest() if described._text is not None else "",
                 record._sha256, second._sha256 if second else "")
    return Diagnosis(core, described, record)


def apply(machine: MachineLike, diagnosis: Diagnosis, at_least: float = 0.5) -> Machine:
    """The machine with the causes that are at least so probable; `changes` and `notes` say what was done."""
    described = read_machine(machine)
    text, changes, notes = _core.apply(described.text, described.name, diagnosis._core, at_least)
    out = Machine({}, described.name, text)
    out.changes = [dict(zip(("path", "before", "after", "reason"), c)) for c in changes]
    out.notes = notes
    return out


@dataclass(frozen=True)
class Simulation:
    """A log as a machine file predicts it: gaps in `json`, arrays with their units in the names in `signals`."""
    json: dict[str, Any]
    signals: Signals
    report: str
    summary: str

    def __str__(self) -> str:
        return self.summary

    def _repr_html_(self) -> str:
        return in_frame(self.report)


def simulate(machine: MachineLike, log: LogLike) -> Simulation:
    """Predicts a log from a machine: residual force, and the closed loop where a controller is described."""
    described = read_machine(machine)
    text, signals, report, summary = _core.simulate(described.text, described.name, read_log(log)._core)
    return Simulation(json.loads(text), signals, report, summary)


@dataclass(frozen=True)
class Forecast:
    """The gap to expect on another motion, before and after, axis by axis."""
    json: dict[str, Any]

    def shrink(self, axis: str) -> float:
        """1 - after/before in force."""
        return float(self.json["axes"][axis]["shrink"])


def forecast(machine: MachineLike, diagnosis: Diagnosis, motion: LogLike, at_least: float = 0.5) -> Forecast:
    """How far the gap will shrink on a motion of which the reference is known: t_s and x_ref_m are enough."""
    described = read_machine(machine)
    if isinstance(motion, Log):
        planned = _core.motion_of(motion._core)
    elif isinstance(motion, (str, os.PathLike)):
        planned = _core.read_motion(Path(motion).read_bytes(), str(motion))
    else:
        planned = _core.read_motion(_core.csv_of(columns_of(motion)).encode(), "motion")
    return Forecast(json.loads(_core.forecast(described.text, described.name, diagnosis._core, planned, at_least)))


@dataclass(frozen=True)
class Compensation:
    """What feedforwards would gain, and the controller's keys that gain as a merge patch to the machine file."""
    json: dict[str, Any]
    controller_patch: dict[str, Any]


def compensate(machine: MachineLike, diagnosis: Diagnosis, log: LogLike, at_least: float = 0.5) -> Compensation:
    described = read_machine(machine)
    text, patch = _core.compensate(described.text, described.name, diagnosis._core, read_log(log)._core, at_least)
    return Compensation(json.loads(text), json.loads(patch))


class Comparison:
    """What differs between two logs."""

    def __init__(self, core: _core.ComparisonResult) -> None:
        self._core = core
        self.json: dict[str, Any] = json.loads(core.json())

    @property
    def likeness(self) -> str:
        return str(self.json["likeness"])

    @property
    def differences(self) -> list[dict[str, Any]]:
        return list(self.json["differences"])

    @property
    def report(self) -> str:
        return self._core.report()

    def __str__(self) -> str:
        return self._core.summary()

    def __repr__(self) -> str:
        return f"<quadrant.Comparison {self.likeness}: {self._core.sentence()}>"

    def _repr_html_(self) -> str:
        return in_frame(self.report)


def compare(first: LogLike, second: LogLike, machine: Optional[MachineLike] = None, *, fast: bool = False, threads: int = 0,
            progress: Optional[Progress] = None) -> Comparison:
    """Names what differs between two logs; without a machine, the first log describes its own."""
    described = read_machine(machine) if machine is not None else None
    return Comparison(_core.compare(read_log(first)._core, read_log(second)._core, described.text if described else "",
                                    described.name if described else "", fast, threads, _heard(progress)))


@dataclass(frozen=True)
class Trial:
    """A trial's figures: shares with intervals, false blame, calibration. print() gives them as words."""
    json: dict[str, Any]
    summary: str
    cases: list[dict[str, Any]]

    def __str__(self) -> str:
        return self.summary


def trial_machine(index: int, *, seed: int = 1, machines: int = 200, population: str = "current",
                  logs: str = "plain") -> tuple[Machine, Log, Log, dict[str, Any]]:
    """A machine of the trial: as it is described, its log, its hold-out log, and the truth."""
    machine, log, holdout, truth = _core.trial_machine(seed, machines, index, population, logs)
    return (Machine({}, f"machine {index}", machine), Log(_core.read_log(log.encode(), "log.csv")),
            Log(_core.read_log(holdout.encode(), "holdout.csv")), json.loads(truth))


def trial(machines: int = 20, *, seed: int = 1, only: Optional[Iterable[int]] = None, population: str = "current",
          logs: str = "plain", jobs: Optional[int] = None, diagnosis: Optional[Callable[[Log, Machine, Log], Diagnosis]] = None,
          progress: Optional[Progress] = None) -> Trial:
    """Draws machines with effects at random, by a simulator that shares nothing with the diagnosis, and judges what is said.

    jobs: machines at a time. diagnosis: what is judged, instead of quadrant.diagnose. The program's `trial` does the same
    with a process for each machine, and with forecasts.
    """
    chosen = list(range(machines)) if only is None else list(only)
    ask = diagnosis or (lambda log, machine, holdout: diagnose(log, machine, holdout, threads=1))

    def one(index: int) -> tuple[str, str, bool, str]:
        machine, log, holdout, truth = trial_machine(index, seed=seed, machines=machines, population=population, logs=logs)
        try:
            said = json.dumps(ask(log, machine, holdout).json)
        except _core.BadInput:
            said = "null"
        hidden = json.dumps(truth)
        return (hidden, said, *_core.trial_judge(hidden, said))

    answers, heard = [], _heard(progress)
    with ThreadPoolExecutor(jobs or os.cpu_count() or 1) as pool:
        for index, answer in zip(chosen, pool.map(one, chosen)):
            answers.append(answer)
            if heard:
                heard(f"{len(answers)} of {len(chosen)}: machine {index} {'right' if answer[2] else 'NOT RIGHT'}: {answer[3]}",
                      len(answers) / len(chosen))
    figures, words = _core.trial_tally([(truth, said) for truth, said, _, _ in answers])
    cases = [{"index": i, "right": right, "said": said, "truth": json.loads(truth)}
             for i, (truth, _, right, said) in zip(chosen, answers)]
    return Trial(json.loads(figures), words, cases)
