# SPDX-License-Identifier: BSL-1.0
"""The blocks compute what their equations say, by another route."""
import math

import numpy as np
import pytest

import quadrant
from quadrant.blocks import Cascade, LinearMotor, LuGre, Stribeck, closed_loop, frf, margins

T = 0.0005


def test_stribeck_is_the_curve():
    v = np.array([-0.3, -1e-3, 1e-4, 0.002, 0.5])
    curve = Stribeck(period_s=T, coulomb_N=122, static_N=177, stribeck_velocity_m_per_s=0.0022, viscous_N_s_per_m=950)
    expected = np.sign(v) * (122 + 55 * np.exp(-np.abs(v) / 0.0022)) + 950 * v
    assert np.allclose(curve.run(v), expected, rtol=1e-12)
    assert [curve.step(x) for x in v] == list(curve.run(v))


def test_lugre_ends_on_its_sliding_level():
    bristles = LuGre(period_s=T, coulomb_N=100, static_N=140, stribeck_velocity_m_per_s=0.01, stiffness_N_per_m=1e7,
                     damping_N_s_per_m=100, viscous_N_s_per_m=20)
    f = bristles.run(np.full(2000, 0.05))
    assert f[-1] == pytest.approx(100 + 40 * math.exp(-5) + 20 * 0.05, rel=1e-6)
    assert f[0] < f[-1]


def test_a_mass_under_a_constant_force():
    motor = LinearMotor(period_s=T, mass_kg=10, force_constant_N_per_V=20)
    x = motor.run(np.ones(1000))
    t = T * np.arange(1, 1001)
    assert np.allclose(x, 0.5 * 20 / 10 * t**2, rtol=1e-9)
    assert motor.velocity_m_per_s == pytest.approx(2 * 0.5)
    motor.settle(0.1)
    assert motor.position_m == 0.1 and motor.velocity_m_per_s == 0
    held = LinearMotor(period_s=T, mass_kg=10, force_constant_N_per_V=20, coulomb_N=30)
    assert np.all(held.run(np.ones(100)) == 0)
    assert np.all(LinearMotor(period_s=T, mass_kg=10, force_constant_N_per_V=20).run(np.ones(50), np.full(50, -20.0)) == 0)


def test_the_closed_loop_follows_and_every_wire_has_a_unit():
    loop = Cascade(period_s=T, position_gain_per_s=150, velocity_gain_V_s_per_m=60, velocity_integral_V_per_m=450,
                   velocity_filter_Hz=150, acceleration_feedforward_V_s2_per_m=340 / 1450,
                   viscous_feedforward_V_s_per_m=950 / 1450, coulomb_feedforward_V=122 / 1450, notch_Hz=330, notch_width=0.06,
                   limit_V=10, dac_step_V=20 / 65536)
    motor = LinearMotor(period_s=T, mass_kg=340, force_constant_N_per_V=1450, viscous_N_s_per_m=950, coulomb_N=122,
                        static_N=177, stribeck_velocity_m_per_s=0.00222, delay_s=0.0004, limit_V=10, encoder_step_m=250e-9)
    r = 0.03 * (1 - np.cos(3.3333 * T * np.arange(2400)))
    run = closed_loop(loop, motor, r)
    wires = loop.wires()
    assert np.max(np.abs(r - run["position_m"])[100:]) < 5e-6
    # The errors [um] that examples/02_closed_loop.expected prints of the same machine, written in C++.
    error = 1e6 * (r - run["position_m"])
    for k, printed in {100: -1.8, 500: -1.3, 1100: 0.4, 1885: 3.5, 1900: -0.4, 2300: 1.3}.items():
        assert abs(error[k] - printed) < 0.051, k
    assert wires["command_V"] == run["command_V"][-1]
    assert wires["reference_m"] == r[-1]
    assert "reference_velocity_m_per_s" in wires and not loop.faulted and not loop.limited
    again = Cascade(period_s=T, position_gain_per_s=150, velocity_gain_V_s_per_m=60, velocity_filter_Hz=150, limit_V=10)
    u = again.run(r, run["position_m"])
    again.reset()
    assert [again.step(a, b) for a, b in zip(r[:50], run["position_m"][:50])] == list(u[:50])


def test_frf_and_margins_of_a_known_loop():
    """A lag of one sample measured; margins of k / (s (1 + s tau)) against their formulas."""
    rng = np.random.default_rng(1)
    x = rng.standard_normal(60000)
    y = 3 * np.roll(x, 1)
    found = frf(x, y, period_s=T, samples=512)
    inside = (found.frequency_Hz > 10) & (found.frequency_Hz < 900)
    expected = 3 * np.exp(-2j * np.pi * found.frequency_Hz * T)
    assert np.max(np.abs(found.value - expected)[inside]) < 0.05
    assert np.min(found.coherence[inside]) > 0.99 and found.averages > 100
    f = np.logspace(-1, 3, 4000)
    s, k, tau = 2j * np.pi * f, 30.0, 0.01
    m = margins(f, k / (s * (1 + s * tau)))
    w = math.sqrt((-1 + math.sqrt(1 + 4 * (k * tau) ** 2)) / (2 * tau**2))
    assert m.phase_deg == pytest.approx(90 - math.degrees(math.atan(w * tau)), abs=0.01)
    assert m.phase_crossings_deg[0][1] == pytest.approx(w / (2 * math.pi), rel=1e-4)
    assert m.gain_dB is None and 0 < m.modulus < 1 and "phase margin" in str(m)


def test_what_no_machine_could_have_is_refused_by_name():
    with pytest.raises(quadrant.InvalidParameter, match=r"linear_motor\.mass"):
        LinearMotor(period_s=T, mass_kg=-1, force_constant_N_per_V=20)
    with pytest.raises(quadrant.InvalidParameter, match=r"notch\.centre"):
        Cascade(period_s=T, position_gain_per_s=1, velocity_gain_V_s_per_m=1, velocity_filter_Hz=100, limit_V=1, notch_Hz=1200)
    with pytest.raises(TypeError):
        LinearMotor(T, 10, 20)  # by name only: units stand in the names
    with pytest.raises(ValueError, match="one dimension"):
        Stribeck(period_s=T, coulomb_N=1).run(np.ones((2, 2)))
    with pytest.raises(ValueError, match="as long as"):
        frf(np.ones(10), np.ones(9), period_s=T)


def test_nan_holds_the_last_output_and_raises_the_fault():
    curve = Stribeck(period_s=T, coulomb_N=10)
    last = curve.step(1.0)
    assert curve.step(math.nan) == last and curve.faulted
