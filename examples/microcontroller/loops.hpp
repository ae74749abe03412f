// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/memory/repetitive.hpp>
#include <quadrant/observer/disturbance_observer.hpp>

/// What this machine's axes are made of: three loops to choose from, from small to large. Real is float where
/// the processor has no double.
namespace loops {
using namespace quadrant;
using namespace quadrant::literals;

/// P, PI, notch, feedforward of the plant.
template <class Real> struct plain {
    using boxes = milling_axis_boxes<absent<signal::velocity, signal::voltage, Real>,
                                     absent<signal::position, signal::voltage, Real>,
                                     absent<signal::position, signal::position, Real>, Real>;
    static void machine(typename boxes::parameters& p) {
        p.plant_gain = 4.526_mps2 / 1_V;
        p.plant_pole = 28.57 / 1_s;
        p.dac_step = 20_V / 65536.0;
    }
};

/// And friction fed forward, and a disturbance observer.
template <class Real, class Memory = absent<signal::position, signal::position, Real>> struct with_observer {
    using friction = maxwell_slip<4, signal::velocity, signal::voltage, Real>;
    using observer = disturbance_observer<signal::voltage, signal::position, 2, 0, 2, 0, Real>;
    using boxes = milling_axis_boxes<friction, observer, Memory, Real>;
    static void machine(typename boxes::parameters& p) {
        p.plant_gain = 4.526_mps2 / 1_V;
        p.plant_pole = 28.57 / 1_s;
        p.dac_step = 20_V / 65536.0;
        p.friction = {.curve = {0.084_V, 0.122_V, 22_mmps, 0.586_V / 1_mps},
                      .weights = {0.25, 0.25, 0.25, 0.25},
                      .forces = {},
                      .stiffness = {3500_V / 1_m, 900_V / 1_m, 250_V / 1_m, 70_V / 1_m},
                      .attraction = 27_V / 1_s};
        p.disturbance = {60_Hz, axis_model<signal::voltage>{p.plant_gain, p.plant_pole}};
    }
};

/// And a memory of the last two cycles of 236 ms. Q, 61 taps: a triangle, first zero at 65 Hz. L, the lag of
/// the position loop turned round, 1 + s / position_gain.
template <class Real> struct with_memory {
    using base = with_observer<Real, repetitive<signal::position, 512, 2, 90, 61, Real>>;
    using boxes = typename base::boxes;
    static void machine(typename boxes::parameters& p) {
        base::machine(p);
        p.memory = {.cycle = 236_ms, .weights = {2, -1}, .ahead = 2};
        const double lag = 1 / (150 * 500e-6);
        p.memory.learning[0] = 1 + lag;
        p.memory.learning[1] = -lag;
        for (int i = -30; i <= 30; ++i)
            p.memory.smoothing[std::size_t(i + 30)] = (31 - (i < 0 ? -i : i)) / 961.0;
    }
};

} // namespace loops
