# SPDX-License-Identifier: BSL-1.0
"""Blocks to simulate and to measure with: the library's own, one sample a step or a whole array at once.

    motor = LinearMotor(period_s=0.0005, mass_kg=340, force_constant_N_per_V=1450, viscous_N_s_per_m=950)
    loop = Cascade(period_s=0.0005, position_gain_per_s=150, velocity_gain_V_s_per_m=60, velocity_filter_Hz=150, limit_V=10)
    run = closed_loop(loop, motor, reference_m)      # {"position_m": ..., "command_V": ...}

Units stand in the names. What no machine could have raises InvalidParameter, and the message names the parameter.
"""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _core
from ._core import Cascade, LinearMotor, LuGre, Stribeck, closed_loop

__all__ = ["Cascade", "Frf", "LinearMotor", "LuGre", "Margins", "Stribeck", "closed_loop", "frf", "margins"]


@dataclass(frozen=True)
class Frf:
    """A frequency response, rising in frequency. `spread`: standard deviation over magnitude, of each part."""
    frequency_Hz: "np.ndarray[Any, np.dtype[np.float64]]"
    value: "np.ndarray[Any, np.dtype[np.complex128]]"
    coherence: "np.ndarray[Any, np.dtype[np.float64]]"
    spread: "np.ndarray[Any, np.dtype[np.float64]]"
    averages: int

    @property
    def magnitude_dB(self) -> "np.ndarray[Any, np.dtype[np.float64]]":
        return 20 * np.log10(np.abs(self.value))

    @property
    def phase_deg(self) -> "np.ndarray[Any, np.dtype[np.float64]]":
        return np.degrees(np.unwrap(np.angle(self.value)))


def frf(input: Any, output: Any, *, period_s: float, samples: int = 2048, overlap: float = 0.5, window: str = "hann",
        remove: str = "mean") -> Frf:
    """Output over input from two records (H1, windows that overlap). window: hann or none; remove: keep, mean or line.

    In a closed loop noise on the output biases H1: measure both against the injected excitation and divide.
    """
    return Frf(*_core.frf(input, output, period_s=period_s, samples=samples, overlap=overlap, window=window, remove=remove))


@dataclass(frozen=True)
class Margins:
    """How far an open loop is from -1. Lists of (margin, frequency_Hz), rising in frequency; the first is the usual one."""
    gain_crossings_dB: list[tuple[float, float]]
    phase_crossings_deg: list[tuple[float, float]]
    modulus: float
    modulus_at_Hz: float
    text: str

    @property
    def gain_dB(self) -> Optional[float]:
        return self.gain_crossings_dB[0][0] if self.gain_crossings_dB else None

    @property
    def phase_deg(self) -> Optional[float]:
        return self.phase_crossings_deg[0][0] if self.phase_crossings_deg else None

    def __str__(self) -> str:
        return self.text


def margins(frequency_Hz: Any, open_loop: Any) -> Margins:
    """Gain, phase and modulus margin of a measured or computed open loop (complex), interpolated between its lines."""
    gain, phase, (modulus, at), text = _core.margins(frequency_Hz, open_loop)
    return Margins(gain, phase, modulus, at, text)
