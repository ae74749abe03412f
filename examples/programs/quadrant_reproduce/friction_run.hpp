// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "thesis.hpp"

#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/observer/maxwell_slip_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

/// The friction experiment of [Jamaludin2008] section 4.2 (Table 4.2): the milling table's axis on Generalized
/// Maxwell-slip friction follows a sinusoid of 30 mm; how far it lags after each reversal without friction
/// feedforward, with the static curve, and with the model that the plant itself has; each without and with the
/// disturbance observer.
namespace thesis {

struct no_friction_model {
    using box = absent<signal::velocity, signal::voltage>;
    static box::parameters of(const axis&) { return {}; }
};
struct static_curve {
    using box = stribeck<signal::velocity, signal::voltage>;
    static box::parameters of(const axis& a) {
        return {a.curve.coulomb / a.kf, a.curve.static_level / a.kf, a.curve.stribeck_velocity,
                a.curve.viscous / a.kf};
    }
};
struct gms_model {
    using box = maxwell_slip<4, signal::velocity, signal::voltage>;
    static box::parameters of(const axis& a) { return gms<signal::voltage>(a, 1.0 / a.kf); }
};

/// The model with a level that it learns from what the observer is left with.
struct learning_model {
    using box = maxwell_slip_observer<4, signal::voltage>;
    static box::parameters of(const axis& a) { return {gms_model::of(a), 500_ms}; }
};

struct no_observer {
    using box = absent<signal::position, signal::voltage>;
    static box::parameters of(const axis&) { return {}; }
};
/// On the plant without delay and with the pole that the inverse-model feedforward has, A'.
struct observer {
    using box = disturbance_observer<signal::voltage>;
    static box::parameters of(const axis& a) { return {a.corner, axis_model<signal::voltage>{a.B, a.A_gms}}; }
};

/// What may differ between readings of the experiment.
struct reading {
    double peak_speed = 0.1; ///< m/s; 30 mm in all
    duration delay = 0.4_ms; ///< beside the hold of half a period
    quantity<si::length> encoder = 250_nm;
    std::size_t substeps = 10; ///< of 500 us
    duration preview = 0_s;    ///< of the feedforward
    double cycles = 3;         ///< of the sinusoid
    double level = 1;          ///< of the machine's friction, over the table's
};

/// The loop of `milling_axis` on a `linear_motor` with the friction of the axis, sample by sample.
template <class Compensation, class Observer = no_observer> class friction_axis {
public:
    using loop = milling_axis<milling_axis_boxes<typename Compensation::box, typename Observer::box>>;
    using motor = linear_motor<maxwell_slip<4>>;
    using motion = typename loop::motion;

    friction_axis(const axis& a, const reading& how)
        : loop_{.box = {controller(a), period}}, motor_(machine(a, how), period) {}

    void step(const motion& now, const motion& ahead) { measured_ = motor_(loop_(now, ahead, measured_)); }

    double position() const { return motor_.now().x.value(); } ///< of the axis, not of its encoder [m]
    double friction() const {                                  ///< what the plant's springs hold [N]
        double sum = 0;
        for (const auto& each : motor_.friction().now().elements) sum += each.force.value();
        return sum;
    }
    /// What its friction box has learned; 1 for one that does not learn.
    double level() const {
        if constexpr (requires { loop_.box.friction.level(); }) return loop_.box.friction.level();
        return 1;
    }
    /// A box at fault, or the amplifier clips: nothing here asks for a tenth of its 10 V but a loop that
    /// swings.
    bool stopped() const { return motor_.faulted() || loop_.faulted() || loop_.limited(); }

private:
    static auto controller(const axis& a) {
        auto p = controller_of<decltype(loop::box)>(a);
        p.friction = Compensation::of(a);
        p.disturbance = Observer::of(a);
        return p;
    }
    static auto machine(const axis& a, const reading& how) {
        const quantity<si::mass> mass = a.kf / a.B;
        motor::parameters p{.mass = mass,
                            .force_constant = a.kf,
                            .friction = gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0)),
                            .delay = how.delay,
                            .encoder_step = how.encoder,
                            .substeps = how.substeps};
        p.friction.curve.viscous += a.A_gms * mass; // A' beside sigma
        p.friction.curve.coulomb *= how.level;
        p.friction.curve.static_level *= how.level;
        return p;
    }

    loop loop_;
    motor motor_;
    quantity<si::length> measured_{};
};

struct lag {
    double glitch =
        0; ///< um; largest error in the quarter of a half cycle after a reversal, mean of all but the first
    double worst = 0;      ///< um; the largest of these
    double all = 0;        ///< um; largest error at any time after the first half cycle and a half
    double level = 1;      ///< of the friction, as learned
    bool diverged = false; ///< error above 1 mm, a box at fault, or the amplifier clipped: no result
};

inline const char* const diverged_note = "diverged: the error passed 1 mm, or the amplifier clipped; no figure";

/// One sample of a run.
struct moment {
    double time, turns; ///< s; reversals so far
    double reference;   ///< m
    double error;       ///< um, reference minus axis
    double friction;    ///< N
    double level;       ///< of the friction, as learned so far
};

/// Runs the experiment; `tell(moment)` hears every sample.
template <class Compensation, class Observer = no_observer, class Tell>
lag run(const axis& a, const reading& how, Tell&& tell) {
    friction_axis<Compensation, Observer> under_test(a, how);
    const double amplitude = 0.03, w = how.peak_speed / amplitude, T = period.value();
    const auto motion = [&](double t) { // from rest
        return typename friction_axis<Compensation, Observer>::motion{
            amplitude * (1 - std::cos(w * t)) * 1_m, amplitude * w * std::sin(w * t) * 1_mps,
            amplitude * w * w * std::cos(w * t) * 1_mps2};
    };
    lag found;
    double peak = 0;
    int reversals = 0;
    const auto samples = static_cast<long>(how.cycles * 2 * pi_ / w / T);
    for (long k = 0; k < samples && !found.diverged; ++k) {
        const double t = static_cast<double>(k) * T, turns = w * t / pi_;
        const auto now = motion(t), ahead = motion(t + how.preview.value());
        const double error = 1e6 * (now.position.value() - under_test.position()), size = std::abs(error);
        tell(moment{t, turns, now.position.value(), error, under_test.friction(), under_test.level()});
        if (turns >= 1.5) found.all = std::max(found.all, size);
        if (turns >= 2 && turns - std::floor(turns) < 0.25)
            peak = std::max(peak, size);
        else if (peak > 0) {
            found.glitch += peak;
            found.worst = std::max(found.worst, peak);
            peak = 0;
            ++reversals;
        }
        found.diverged = !(size < 1000) || under_test.stopped();
        under_test.step(now, ahead);
    }
    if (reversals > 0) found.glitch /= reversals;
    found.level = under_test.level();
    return found;
}
template <class Compensation, class Observer = no_observer> lag run(const axis& a, const reading& how = {}) {
    return run<Compensation, Observer>(a, how, [](const moment&) {});
}

} // namespace thesis
