# SPDX-License-Identifier: BSL-1.0
"""What goes in: logs and machines, however they are at hand."""
from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import Any, Mapping, Optional, Union

import numpy as np

from . import _core

Table = Mapping[str, Any]
LogLike = Union["Log", str, "os.PathLike[str]", Table, Any]
MachineLike = Union["Machine", str, "os.PathLike[str]", Mapping[str, Any]]


def write_whole(path: Union[str, "os.PathLike[str]"], text: str) -> None:
    """A reader sees the old file or the new one; a link stays a link, a device is written to."""
    _core.write(os.fspath(path), text)


def columns_of(table: Any) -> list[tuple[str, "np.ndarray[Any, np.dtype[np.float64]]"]]:
    """The columns of a frame, a structured array or a mapping, as doubles. Text is refused with its column's name."""
    if isinstance(table, np.ndarray) and table.dtype.names:
        named = [(name, table[name]) for name in table.dtype.names]
    elif isinstance(table, Mapping):
        named = list(table.items())
    elif hasattr(table, "columns") and hasattr(table, "__getitem__"):  # a frame of pandas, or what is like it
        named = [(name, table[name]) for name in table.columns]
    else:
        raise TypeError(f"a log is a file, a mapping of columns, a structured array or a frame, not {type(table).__name__}")
    out = []
    for name, values in named:
        try:
            out.append((str(name), np.ascontiguousarray(values, dtype=np.float64)))
        except (TypeError, ValueError) as fault:
            raise _core.BadInput(f"log: column {name}: holds what is no number ({fault})") from None
    return out


class Log:
    """A servo log that was read: rows on an even clock, axis by axis."""

    def __init__(self, core: _core.Log, sha256: str = "") -> None:
        self._core, self._sha256 = core, sha256

    @property
    def file(self) -> str:
        return self._core.file

    @property
    def rows(self) -> int:
        return self._core.rows

    @property
    def sample_period_s(self) -> float:
        return self._core.sample_period_s

    @property
    def axes(self) -> list[str]:
        return self._core.axes

    @property
    def notes(self) -> list[str]:
        """What was left out or resampled when the log was read."""
        return self._core.notes

    def signals(self, axis: str) -> dict[str, "np.ndarray[Any, np.dtype[np.float64]]"]:
        """Position, command and reference of an axis, in the units of its columns."""
        return self._core.signals(axis)

    def __repr__(self) -> str:
        return f"<quadrant.Log {self.file}: {self.rows} rows, one every {self.sample_period_s:g} s, axes {', '.join(self.axes)}>"


def read_log(log: LogLike, *, map: Union[None, str, "os.PathLike[str]", Mapping[str, Any]] = None,
             name: Optional[str] = None, resample: bool = False) -> Log:
    """A log from a file (CSV, MAT-file), a mapping of columns, a structured array or a frame.

    map: an import map (a file, or its contents) for columns with other names; files only. resample: put stamps that jitter
    onto an even clock.
    """
    if isinstance(log, Log):
        return log
    if isinstance(log, (str, os.PathLike)):
        path = Path(log)
        try:
            data = path.read_bytes()
        except OSError as fault:
            raise _core.BadInput(f"{path}: cannot be read: {fault.strerror}") from None
        called, digest = name or str(path), hashlib.sha256(data).hexdigest()
        if map is None:
            return Log(_core.read_log(data, called), digest)
        if isinstance(map, Mapping):
            text, map_name = json.dumps(map), "map"
        else:
            text, map_name = Path(map).read_text(encoding="utf-8"), str(map)
        return Log(_core.map_log(text, map_name, [(data, called)], resample), digest)
    if map is not None:
        raise TypeError("map: is for files; name the columns of a table instead")
    text = _core.csv_of(columns_of(log))
    return Log(_core.read_log(text.encode(), name or "table"))


class Machine:
    """A machine file: what the simulation believes. `machine["axes"]["x"]["plant"]["mass_kg"]` reads and writes it."""

    def __init__(self, contents: Mapping[str, Any], name: str = "machine", text: Optional[str] = None) -> None:
        self.contents: dict[str, Any] = json.loads(text) if text is not None else json.loads(json.dumps(contents))
        self.name = name
        self.changes: list[dict[str, str]] = []  # what apply() changed: path, before, after, reason
        self.notes: list[str] = []
        self._text, self._of = text, json.dumps(self.contents)
        _core.check_machine(self.text, name)

    @property
    def text(self) -> str:
        """As JSON; the file's own bytes where nothing was changed."""
        if self._text is not None and json.dumps(self.contents) == self._of:
            return self._text
        return json.dumps(self.contents, indent=2) + "\n"

    def __getitem__(self, key: str) -> Any:
        return self.contents[key]

    def __setitem__(self, key: str, value: Any) -> None:
        self.contents[key] = value

    @property
    def axes(self) -> list[str]:
        return list(self.contents["axes"])

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        write_whole(path, self.text)

    def mjcf(self) -> tuple[str, list[str]]:
        """The plant as a MuJoCo model, and what MuJoCo cannot hold."""
        return _core.mjcf(self.text, self.name)

    def linuxcnc(self) -> tuple[str, list[str]]:
        """Lines for the INI and the HAL file of LinuxCNC, and what they cannot hold."""
        return _core.linuxcnc(self.text, self.name)

    def drive_values(self) -> tuple[str, list[str]]:
        """Values for the parameters of a drive (CSV)."""
        return _core.drive_values(self.text, self.name)

    def corrections(self, log: Optional[Log] = None) -> tuple[str, list[str]]:
        """Corrections of command and position over the position (CSV), where the log went; else over one period."""
        return _core.corrections(self.text, self.name, log._core if log is not None else None)

    def __repr__(self) -> str:
        return f"<quadrant.Machine {self.name}: axes {', '.join(self.axes)}>"


def read_machine(machine: MachineLike) -> Machine:
    """A machine from a file or from a dictionary with the keys of one (docs/formats.md)."""
    if isinstance(machine, Machine):
        return machine
    if isinstance(machine, Mapping):
        return Machine(machine)
    path = Path(machine)
    try:
        data = path.read_bytes()
    except OSError as fault:
        raise _core.BadInput(f"{path}: cannot be read: {fault.strerror}") from None
    text = data.decode("utf-8-sig", errors="replace")
    _core.check_machine(text, str(path))
    return Machine({}, str(path), text)
