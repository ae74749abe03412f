# SPDX-License-Identifier: BSL-1.0
"""Why does a servo axis not do what its simulation says?

    import quadrant
    found = quadrant.diagnose("log.csv", "machine.json", holdout="holdout.csv")
    print(found)                         # the words; in a notebook `found` shows the report
    found.apply().save("better.json")    # the machine file with what was found

Logs are files, tables of numpy arrays by column name, or pandas frames; machines are files or dictionaries. Columns and
keys carry their units (docs/formats.md). Blocks to simulate with are in quadrant.blocks.
"""
from __future__ import annotations

from . import blocks
from ._core import BadInput, InvalidParameter, version as __version__
from ._calls import (Comparison, Compensation, Diagnosis, Forecast, Simulation, Trial, apply, compare, compensate, diagnose,
                     forecast, read_diagnosis, simulate, trial, trial_machine)
from ._files import Log, Machine, read_log, read_machine

__all__ = ["BadInput", "Comparison", "Compensation", "Diagnosis", "Forecast", "InvalidParameter", "Log", "Machine",
           "Simulation", "Trial", "__version__", "apply", "blocks", "compare", "compensate", "diagnose", "forecast",
           "read_diagnosis", "read_log", "read_machine", "simulate", "trial", "trial_machine"]
