# SPDX-License-Identifier: BSL-1.0
import os
import pathlib

import numpy as np
import pytest

import quadrant

SOURCE = pathlib.Path(os.environ["QUADRANT_SOURCE"])


@pytest.fixture(scope="session")
def data():
    return SOURCE / "examples/data"


@pytest.fixture(scope="session")
def found(data):
    """The shipped log, diagnosed from its files."""
    return quadrant.diagnose(data / "log.csv", data / "machine.json", holdout=data / "holdout.csv")


@pytest.fixture(scope="session")
def columns(data):
    """Of a log file, its columns as arrays."""
    def read(name):
        with open(data / name) as file:
            names = file.readline().strip().split(",")
        return dict(zip(names, np.loadtxt(data / name, delimiter=",", skiprows=1).T))
    return read


@pytest.fixture(scope="session")
def program():
    return os.environ["QUADRANT_GAP"]
