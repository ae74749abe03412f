// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "draw.hpp"

#include <quadrant/loop/feed_control.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <limits>

/// The axis on which the control laws show what they do: 3 t, B and A of the x axis of a virtual CNC, no
/// friction but the viscous one, 1 ms, an amplifier of 5 V.
namespace block_pictures {

inline const axis_model<s::voltage> trial_model{0.6336_mps2 / 1_V, 2.548 / 1_s};
inline const duration trial_period = 1_ms;

/// That axis under one law.
template <class Law> class trial_axis {
public:
    explicit trial_axis(const typename Law::parameters& p, bool tells = true)
        : control_{.box = {{.law = p, .limit = tells ? 5_V : infinite()}, trial_period}},
          motor_({.mass = 3000_kg,
                  .force_constant = 3000 * 0.6336 * 1_N / 1_V,
                  .friction = {.coulomb = 0_N, .viscous = 3000 * 2.548 * 1_N / 1_mps},
                  .limit = 5_V},
                 trial_period) {}

    /// One sample; the force pushes the axis.
    void step(const axis_motion<>& r, quantity<si::force> push = 0_N) {
        const auto v = motor_.now().v;
        const auto a = (v - before_) / trial_period; // mean of the last period, as an accelerometer reads it
        before_ = v;
        motor_(control_(r, {motor_.now().x, v, a}), push);
    }
    const auto& wire() const { return control_.wire; }
    const Law& law() const { return control_.box.law; }
    double place() const { return motor_.now().x.value(); } ///< [m], of the coming sample

private:
    static quantity<si::electric_potential> infinite() {
        return quantity<si::electric_potential>::from_value(std::numeric_limits<double>::infinity());
    }
    feed_control<feed_control_boxes<Law>> control_;
    linear_motor<> motor_;
    quantity<si::velocity> before_{}; ///< one period ago
};

/// From rest to rest over `length` in `time` without a jump in the acceleration.
inline axis_motion<> smooth_move(double t, double length, double time) {
    constexpr double pi = std::numbers::pi;
    const double u = std::clamp(t / time, 0.0, 1.0), w = 2 * pi / time, on = t > 0 && t < time;
    return {length * (u - std::sin(2 * pi * u) / (2 * pi)) * 1_m,
            on * length / time * (1 - std::cos(w * t)) * 1_mps,
            on * length / time * w * std::sin(w * t) * 1_mps2};
}
inline axis_motion<> at_rest(double x) { return {x * 1_m, 0_mps, 0_mps2}; }

/// What a law is shown by.
struct run {
    double end = 0.5;                               ///< [s]
    axis_motion<> (*reference)(double t) = nullptr; ///< of time [s]
    double force = 0, from = 0;                     ///< [N] that pushes, from then on [s]
};
struct record {
    curve place, error, command; ///< [um], [um], [V] over [ms]
    explicit record(const std::string& name) : place(name), error(name), command(name) {}
};
template <class Law> record ran(const std::string& name, trial_axis<Law> axis, const run& r) {
    record out(name);
    for (int k = 0; 1e-3 * k <= r.end; ++k) {
        const double t = 1e-3 * k;
        axis.step(r.reference(t), (t >= r.from ? r.force : 0.0) * 1_N);
        out.place.add(k, 1e6 * axis.wire().measured.value());
        out.error.add(k, 1e6 * axis.wire().position_error.value());
        out.command.hold(k, 1, axis.wire().command.value());
    }
    return out;
}
inline curve asked(const run& r) {
    curve c("reference", dashed);
    for (int k = 0; 1e-3 * k <= r.end; ++k) c.add(k, 1e6 * r.reference(1e-3 * k).position.value());
    return c;
}

inline axis_motion<> step_50(double t) { return at_rest(t < 0.02 ? 0 : 50e-6); }
inline axis_motion<> move_20(double t) { return smooth_move(t - 0.02, 0.02, 0.3); }
inline const run step_and_push{0.4, step_50, 500, 0.2}, move_and_push{0.5, move_20, 500, 0.4};

} // namespace block_pictures
