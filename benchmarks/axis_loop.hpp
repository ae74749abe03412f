// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "hand_written_axis.h"

#include <quadrant/base/literals.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <vector>

/// The x axis of the milling table under its cascade, closed loop, twice: with the blocks, and by hand.
/// Everything is inlined into `step` and `step` into nothing (a servo interrupt), so that the same work stands
/// behind the same border.
namespace axis_loop {

using namespace quadrant;
using namespace quadrant::literals;

// One sub-step a period: the machine is needed to close the loop, the controller is what is measured.
using boxes =
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;
using controller = cascade<boxes>;
using machine = linear_motor<coulomb_viscous<>, hand_capacity>;

constexpr duration period = 500_us;
constexpr std::size_t samples = 20'000;

inline const boxes::parameters tuning{.position_gain = 150.0 / 1_s,
                                      .velocity_gain = 60_V / 1_mps,
                                      .velocity_integral = 450_V / 1_m,
                                      .estimator = {.corner = 150_Hz},
                                      .velocity_feedforward = 1,
                                      .acceleration_feedforward = 0.2345_V / 1_mps2,
                                      .viscous_feedforward = 0.586_V / 1_mps,
                                      .coulomb_feedforward = 0.05_V,
                                      .notch = {.centre = 330_Hz, .width = 0.06},
                                      .limit = 10_V,
                                      .dac_step = 20_V / 65536.0};
inline const machine::parameters table{.mass = 340_kg,
                                       .force_constant = 1450_N / 1_V,
                                       .friction = {.coulomb = 122_N, .viscous = 850_N / 1_mps},
                                       .delay = 400_us,
                                       .limit = 9_V, // the drive clips before the controller does
                                       .dac_step = {},
                                       .encoder_step = 250_nm,
                                       .substeps = 1};
inline const hand_parameters by_hand{.period = 0.0005,
                                     .position_gain = 150,
                                     .velocity_feedforward = 1,
                                     .velocity_gain = 60,
                                     .velocity_integral = 450,
                                     .estimator_corner = 150,
                                     .acceleration_feedforward = 0.2345,
                                     .viscous_feedforward = 0.586,
                                     .coulomb_feedforward = 0.05,
                                     .notch_frequency = 330,
                                     .notch_damping = 0.06,
                                     .limit = 10,
                                     .dac_step = 20 / 65536.0,
                                     .mass = 340,
                                     .force_constant = 1450,
                                     .viscous = 850,
                                     .coulomb = 122,
                                     .delay = 0.0004,
                                     .drive_limit = 9,
                                     .encoder_step = 250e-9,
                                     .substeps = 1};

/// 30 mm at up to 100 mm/s, begun at rest.
inline std::vector<double> sine() {
    std::vector<double> r(samples);
    for (std::size_t k = 0; k < samples; ++k)
        r[k] = 0.015 * (1 - std::cos(2 * std::numbers::pi * 1.06 * static_cast<double>(k) * 0.0005));
    return r;
}
/// Parked: the same, then at rest where it ends, for as long as it takes for what dies out, and `samples` more.
constexpr std::size_t rested = samples + 32'000;
inline std::vector<double> standing() {
    std::vector<double> r = sine();
    r.resize(rested + samples, r.back());
    return r;
}
/// Turning round every ten samples, on 20 um.
inline std::vector<double> reversing() {
    std::vector<double> r(samples);
    for (std::size_t k = 0; k < samples; ++k)
        r[k] = 10e-6 * std::sin(std::numbers::pi * static_cast<double>(k) / 10);
    return r;
}
/// The same with steps that drive the amplifier into its limit, a lost encoder line (NaN) and a value that
/// overflows
/// in the gains: every branch of the policy.
inline std::vector<double> rough() {
    std::vector<double> r = sine();
    for (std::size_t k = 4000; k < 5000; ++k) r[k] += 0.01;
    for (std::size_t k = 6000; k < 6003; ++k) r[k] = std::numeric_limits<double>::quiet_NaN();
    r[9000] = std::numeric_limits<double>::infinity();
    r[12000] = 1e306;
    return r;
}

struct typed_loop {
    controller control{.box = {tuning, period}};
    machine motor{table, period};
    quantity_of<signal::position> reading{};

    [[gnu::noinline, gnu::flatten]] double step(double r) {
        const auto u = control(quantity_of<signal::position>::from_value(r), reading);
        reading = motor(u);
        return u.value();
    }
    double position() const { return reading.value(); }
    /// Bits: controller and machine limited, integral restrained, controller and machine faulted.
    int flags() const {
        return control.limited() | motor.limited() << 1 | control.box.velocity_loop.limited() << 2 |
               control.faulted() << 3 | motor.faulted() << 4;
    }
};

template <bool Checked> struct hand_loop {
    hand_controller control;
    hand_machine motor;
    double reading = 0;

    hand_loop() { hand_design(&by_hand, &control, &motor); }
    [[gnu::noinline, gnu::flatten]] double step(double r) {
        const double u = hand_control<Checked>(&control, r, reading);
        reading = hand_move<Checked>(&motor, u);
        return u;
    }
    double position() const { return reading; }
    int flags() const {
        return control.limited | motor.limited << 1 | control.integral_limited << 2 |
               hand_faulted(&control) << 3 | motor.fault << 4;
    }
};

/// One pass over the reference; the sum stands for a consumer of the command.
template <class Loop> double run(Loop& loop, const double* reference, std::size_t n) {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) sum += loop.step(reference[k]);
    return sum;
}

/// True when both loops give the same bits and the same flags at every sample.
template <class A, class B> bool same(const std::vector<double>& reference, const char* name) {
    A a;
    B b;
    for (std::size_t k = 0; k < reference.size(); ++k) {
        const double ua = a.step(reference[k]), ub = b.step(reference[k]);
        if (std::bit_cast<std::uint64_t>(ua) == std::bit_cast<std::uint64_t>(ub) &&
            std::bit_cast<std::uint64_t>(a.position()) == std::bit_cast<std::uint64_t>(b.position()) &&
            a.flags() == b.flags())
            continue;
        std::fprintf(stderr,
                     "%s: sample %zu: commands %.17g and %.17g, positions %.17g and %.17g, flags %d and %d\n",
                     name, k, ua, ub, a.position(), b.position(), a.flags(), b.flags());
        return false;
    }
    return true;
}

/// The three loops are one loop: checked before anything is measured.
inline bool comparable() {
    return same<typed_loop, hand_loop<true>>(sine(), "typed, by hand") &&
           same<typed_loop, hand_loop<true>>(rough(), "typed, by hand, rough reference") &&
           same<typed_loop, hand_loop<true>>(reversing(), "typed, by hand, turning round") &&
           same<typed_loop, hand_loop<false>>(sine(), "typed, by hand, unchecked");
}

} // namespace axis_loop
