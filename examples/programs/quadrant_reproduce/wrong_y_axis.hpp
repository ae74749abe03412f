// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "divergence_guard.hpp"
#include "friction_run.hpp"
#include "white_noise.hpp"

#include <optional>
#include <utility>

/// The friction experiment on the y axis with GMS feedforward, 100 mm/s, on a machine that differs from its
/// tables.
namespace thesis {

/// How the machine differs from what its controller believes.
struct difference {
    axis table = y; ///< of the machine's friction
    double level = 1, coulomb = 1,
           breakaway = 1; ///< of friction: all of it, Fc alone, Fs alone, over the table's
    double stiffness = 1, stribeck_velocity = 1, attraction = 1; ///< the same
    double mass = 1, force_constant = 1;                         ///< the same
    double viscous = 0;                                          ///< N s/m, more
    double delay = 0, lag = 0;    ///< s, more: of the command; of the velocity estimate (first order)
    double encoder = 250e-9;      ///< m, its count
    double dac = 0;               ///< V
    double noise = 0, jitter = 0; ///< rms, m of the encoder and s of its sampling
    double cogging = 0;           ///< N, one wave in 32 mm
};

struct reversal_error { // um
    double glitch;      ///< mean of the largest errors after the reversals but the first, as friction_run.hpp
    double between;     ///< largest error half-way between reversals
};
/// Drives that machine along `wanted(t)` for so long [s], from rest where it begins. `tell(t, wanted, at,
/// reading, command)` hears every sample: the axis [m], what its encoder reads [m], what the controller answers
/// [V]; false stops. False when it was stopped, by that or by a clipped command or a box at fault.
template <class Wanted, class Tell>
bool drive_wrong(const difference& d, const Wanted& wanted, double lasts, Tell&& tell) {
    using loop_type = milling_axis<milling_axis_boxes<gms_model::box>>;
    using motor_type = linear_motor<maxwell_slip<4>>;
    auto controller = controller_of<decltype(loop_type::box)>(y);
    controller.friction = gms_model::of(y);
    controller.dac_step = d.dac * 1_V;
    loop_type loop{.box = {controller, period}};
    const double corner = 942.5 / (1 + 942.5 * d.lag);
    loop.box.measured_velocity = {{corner / (2 * pi_) * 1_Hz}, period};

    axis machine = d.table;
    machine.curve.coulomb *= d.level * d.coulomb;
    machine.curve.static_level *= d.level * d.breakaway;
    machine.curve.stribeck_velocity *= d.stribeck_velocity;
    machine.C *= d.attraction;
    for (auto& each : machine.alpha) // shares; only their sum must not pass Fs
        each *= std::min(1.0, d.level * d.breakaway);
    for (auto& each : machine.k) each *= d.stiffness;
    const quantity<si::mass> believed = y.kf / y.B;
    motor_type::parameters p{.mass = d.mass * believed,
                             .force_constant = d.force_constant * y.kf,
                             .friction =
                                 gms<signal::force>(machine, gain_of<signal::force, signal::force>(1.0)),
                             .delay = 0.4_ms + d.delay * 1_s};
    p.friction.curve.viscous += y.A_gms * believed + d.viscous * 1_N / 1_mps;
    motor_type motor{p, period};

    white_noise gauss(1);
    const double T = period.value();
    auto reading = wanted(0).position;
    if (reading.value() != 0) { // else as new
        motor.settle(reading);
        loop.settle(reading);
    }
    const auto samples = static_cast<int>(lasts / T);
    for (int k = 0; k < samples; ++k) {
        const typename loop_type::motion now = wanted(k * T);
        const double at = motor.now().x.value();
        if (motor.faulted() || loop.faulted() || loop.limited()) return false;
        const auto command = loop(now, reading);
        if (!tell(k * T, now, at, reading.value(), command.value())) return false;
        motor(command, d.cogging * std::sin(2 * pi_ * at / 0.032) * 1_N);
        double seen = motor.now().x.value();
        if (d.noise > 0) seen += d.noise * gauss();
        if (d.jitter > 0) seen += d.jitter * gauss() * motor.now().v.value();
        reading = d.encoder * std::round(seen / d.encoder) * 1_m;
    }
    return true;
}

/// Nothing when it was stopped: an error beyond 1 mm or growing, a clipped command, or a box at fault.
inline std::optional<reversal_error> reversals_with(const difference& d) {
    const double amplitude = 0.03, w = 0.1 / amplitude, T = period.value();
    const auto wanted = [&](double t) {
        return axis_motion<>{amplitude * (1 - std::cos(w * t)) * 1_m, amplitude * w * std::sin(w * t) * 1_mps,
                             amplitude * w * w * std::cos(w * t) * 1_mps2};
    };
    divergence_guard runs_away(1000, static_cast<std::size_t>(pi_ / w / T), 3); // a window is one half cycle
    reversal_error found{0, 0};
    double peak = 0;
    int reversals = 0;
    const bool whole = drive_wrong(
        d, wanted, 3 * 2 * pi_ / w, [&](double t, const axis_motion<>& asked, double at, double, double) {
            const double turns = w * t / pi_, error = 1e6 * (asked.position.value() - at);
            if (runs_away(error)) return false;
            const double phase = turns - std::floor(turns);
            if (turns >= 2 && phase < 0.25)
                peak = std::max(peak, std::abs(error));
            else if (peak > 0) {
                found.glitch += std::exchange(peak, 0);
                ++reversals;
            }
            if (turns >= 2 && phase > 0.4 && phase < 0.9)
                found.between = std::max(found.between, std::abs(error));
            return true;
        });
    if (!whole) return std::nullopt;
    found.glitch /= reversals;
    return found;
}

} // namespace thesis
