// SPDX-License-Identifier: BSL-1.0
// The slot `disturbance` of a milling_axis feeds each observer the command that it is made for.
#include <quadrant/base/literals.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/observer/harmonic_force_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <type_traits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration T = 500_us;
using nothing = absent<signal::position, signal::voltage>;
using harmonics = harmonic_force_observer<signal::voltage, 2>;
template <class Observer> using boxes = milling_axis_boxes<absent<signal::velocity, signal::voltage>, Observer>;

/// The y axis of [Jamaludin2008], shaken at 46 and 69 Hz; error in the fourth second, um rms, or -1 where the
/// loop clipped.
template <class Observer> double shaken() {
    typename boxes<Observer>::parameters p{.position_gain = 150.0 / 1_s,
                                           .velocity_gain = 30_V / 1_mps,
                                           .velocity_integral = 250_V / 1_m,
                                           .estimator_corner = 150_Hz,
                                           .notch = {294_Hz, 0.17},
                                           .plant_gain = 8.916_mps2 / 1_V,
                                           .plant_pole = 20_per_s,
                                           .limit = 10_V};
    if constexpr (std::is_same_v<Observer, harmonics>)
        p.disturbance = {
            {8.916_mps2 / 1_V, 20.0 / 1_s}, {46_Hz, 69_Hz}, placed_poles<2>::equal(200.0 / 1_s), 0_ms};
    milling_axis<boxes<Observer>> axis{.box = {p, T}};
    linear_motor<> motor(
        {.mass = 164.9_kg, .force_constant = 1470_N / 1_V, .friction = {.viscous = 3298_N / 1_mps}}, T);
    auto at = motor.now().x;
    double squares = 0;
    for (int k = 0; k < 8000; ++k) {
        const double w = 2 * std::numbers::pi * k * T.value();
        const auto push = (40 * std::sin(46 * w) + 20 * std::cos(69 * w)) * 1_N;
        const auto u = axis({}, at);
        if (axis.limited() || axis.faulted()) return -1;
        at = motor(u, push);
        if (k >= 6000) squares += at.value() * at.value();
    }
    return 1e6 * std::sqrt(squares / 2000);
}
} // namespace

TEST_CASE(
    "milling_axis: a harmonic_force_observer in the slot is fed what acted, and takes its harmonics out") {
    const double alone = shaken<nothing>(), observed = shaken<harmonics>();
    MESSAGE("um rms: " << alone << " without, " << observed << " with the observer");
    CHECK(alone > 0);
    CHECK(observed >= 0);           // it does not diverge
    CHECK(observed < 1e-6 * alone); // a gain without bound at these frequencies
}
