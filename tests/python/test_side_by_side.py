# SPDX-License-Identifier: BSL-1.0
"""What docs/howto/use_from_python.md shows, as it is shown."""
from concurrent.futures import ThreadPoolExecutor

import numpy as np

import quadrant
from quadrant.blocks import Cascade, LinearMotor, closed_loop


def test_logs_side_by_side(data):
    machine = data / "machine.json"
    logs = [data / "holdout.csv", data / "holdout.csv"]
    with ThreadPoolExecutor() as pool:
        found = list(pool.map(lambda log: quadrant.diagnose(log, machine, threads=1), logs))
    assert found[0].json == found[1].json


def test_a_loop_in_a_few_lines():
    reference_m = 0.03 * (1 - np.cos(np.linspace(0, 6, 4000)))
    motor = LinearMotor(period_s=0.0005, mass_kg=340, force_constant_N_per_V=1450, viscous_N_s_per_m=950, coulomb_N=122)
    loop = Cascade(period_s=0.0005, position_gain_per_s=150, velocity_gain_V_s_per_m=60, velocity_integral_V_per_m=450,
                   velocity_filter_Hz=150, limit_V=10)
    run = closed_loop(loop, motor, reference_m)
    assert np.sqrt(np.mean((run["position_m"] - reference_m) ** 2)) < 1e-3
