// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "divergence_guard.hpp"
#include "friction_run.hpp"
#include "measured_axis.hpp"
#include "white_noise.hpp"

#include <quadrant/plant/axis_load.hpp>
#include <quadrant/plant/cogging_force.hpp>

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
/// The encoder of that machine: noisy, jittering, and it counts. It begins at rest and as if on a count.
class wrong_encoder {
public:
    explicit wrong_encoder(const difference& d) : d_(d) {}
    quantity<si::length> reading(quantity<si::length> place, quantity<si::velocity> v) {
        if (std::exchange(first_, false)) return place;
        double seen = place.value();
        if (d_.noise > 0) seen += d_.noise * gauss_();
        if (d_.jitter > 0) seen += d_.jitter * gauss_() * v.value();
        return d_.encoder * std::round(seen / d_.encoder) * 1_m;
    }
    quantity_of<signal::voltage> command(quantity_of<signal::voltage> u) const { return u; }

private:
    difference d_;
    white_noise gauss_{1};
    bool first_ = true;
};

/// Drives that machine along `wanted(t)` for so long [s], from rest where it begins. `tell(t, wanted, at,
/// reading, command)` hears every sample: the axis [m], what its encoder reads [m], what the controller answers
/// [V]; false stops. False when it was stopped, by that or by a clipped command or a box at fault.
template <template <class, class, class> class Axis = measured_axis, class Wanted, class Tell>
bool drive_wrong(const difference& d, const Wanted& wanted, double lasts, Tell&& tell) {
    using boxes = milling_axis_boxes<gms_model::box>;
    using motor_type = linear_motor<maxwell_slip<4>, 32, double, axis_load<cogging_force<>>>;
    auto controller = controller_of<boxes>(y);
    controller.friction = gms_model::of(y);
    controller.dac_step = d.dac * 1_V;

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
                             .delay = 0.4_ms + d.delay * 1_s,
                             .load = {.cogging = {32_mm, {d.cogging * 1_N}, {0.0}}}};
    p.friction.curve.viscous += y.A_gms * believed + d.viscous * 1_N / 1_mps;
    Axis<boxes, motor_type, wrong_encoder> run(controller, p, wrong_encoder(d));
    const double corner = 942.5 / (1 + 942.5 * d.lag);
    run.boxes().measured_velocity = {{corner / (2 * pi_) * 1_Hz}, period};

    const double T = period.value();
    if (const auto from = wanted(0).position; from.value() != 0) run.settle(from); // else as new
    const auto samples = static_cast<int>(lasts / T);
    for (int k = 0; k < samples; ++k) {
        const axis_motion<> now = wanted(k * T);
        const double at = run.now().x.value();
        if (run.stopped()) return false;
        run.step(now);
        if (!tell(k * T, now, at, run.reading().value(), run.command().value())) return false;
    }
    return true;
}

/// Nothing when it was stopped: an error beyond 1 mm or growing, a clipped command, or a box at fault.
template <template <class, class, class> class Axis = measured_axis>
std::optional<reversal_error> reversals_with(const difference& d) {
    const double amplitude = 0.03, w = 0.1 / amplitude, T = period.value();
    const auto wanted = [&](double t) {
        return axis_motion<>{amplitude * (1 - std::cos(w * t)) * 1_m, amplitude * w * std::sin(w * t) * 1_mps,
                             amplitude * w * w * std::cos(w * t) * 1_mps2};
    };
    divergence_guard runs_away(1000, static_cast<std::size_t>(pi_ / w / T), 3); // a window is one half cycle
    reversal_error found{0, 0};
    double peak = 0;
    int reversals = 0;
    const bool whole = drive_wrong<Axis>(
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
