// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/compose/milling_axis_boxes.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/literals.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

/// The friction experiment of [Jamaludin2008] section 4.2 (Table 4.2): the milling table's axis on Generalized Maxwell-slip
/// friction follows a sinusoid of 30 mm; how far it lags after each reversal without friction feedforward, with the static
/// curve, and with the model that the plant itself has. Ids thesis.friction.<axis>.<none|static|gms> of quadrant-reproduce.
namespace thesis {

using namespace quadrant;
using namespace quadrant::literals;

/// One column of Tables 2.1, 2.2, 3.3, 4.1 and 4.3, in SI but for the names of the thesis.
struct axis {
    const char* name;
    gain_of<signal::acceleration, signal::voltage> B;
    frequency A; ///< A' of Table 4.1: what is linear beside GMS
    gain_of<signal::force, signal::voltage> kf;
    gain_of<signal::voltage, signal::velocity> kp;
    gain_rate_of<signal::voltage, signal::velocity> ki;
    double notch_squared, notch_damping; ///< of s^2 + damping s + squared
    stribeck<>::parameters curve;        ///< eq. (3.5)
    std::array<quantity<si::force>, 4> alpha;
    std::array<gain_rate_of<signal::force, signal::velocity>, 4> k;
    quantity<unit_quotient<si::force, si::time>> C; ///< convention: 1/Vs in SI, read as N/s
    frequency corner;                               ///< of the observer's Q, wc / (2 pi)
};
inline gain_rate_of<signal::force, signal::velocity> newtons_per_um(double k) { return k * 1e6 * 1_N / 1_m; }

inline const axis x{
    .name = "x",
    .B = 4.526_mps2 / 1_V,
    .A = 2.5_Hz,
    .kf = 1450_N / 1_V,
    .kp = 60_V / 1_mps,
    .ki = 450_V / 1_m,
    .notch_squared = 4.3e6,
    .notch_damping = 125.7,
    .curve = {122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps},
    .alpha = {65_N, 55_N, 26_N, 6.5_N},
    .k = {newtons_per_um(61.80), newtons_per_um(9.852), newtons_per_um(4.490), newtons_per_um(0.325)},
    .C = 450_N / 1_s,
    .corner = 60_Hz};
inline const axis y{
    .name = "y",
    .B = 8.916_mps2 / 1_V,
    .A = 0.095_Hz,
    .kf = 1470_N / 1_V,
    .kp = 30_V / 1_mps,
    .ki = 250_V / 1_m,
    .notch_squared = 3.41e6,
    .notch_damping = 314.2,
    .curve = {105_N, 165_N, 1_mmps, 40_N / 1_mps},
    .alpha = {50_N, 20_N, 15_N, 3.4_N},
    .k = {newtons_per_um(99.94), newtons_per_um(1.364), newtons_per_um(1.081), newtons_per_um(0.119)},
    .C = 1000_N / 1_s,
    .corner = 90_Hz};

inline const duration period = 500_us;
constexpr double pi_ = std::numbers::pi;

/// Friction of the plant [N], or against it in volts.
template <signal_tag Out>
typename maxwell_slip<4, signal::velocity, Out>::parameters gms(const axis& a,
                                                                gain_of<Out, signal::force> per_newton) {
    typename maxwell_slip<4, signal::velocity, Out>::parameters p;
    p.curve = {per_newton * a.curve.coulomb, per_newton * a.curve.static_level, a.curve.stribeck_velocity,
               per_newton * a.curve.viscous};
    for (std::size_t i = 0; i < 4; ++i) {
        p.forces[i] = per_newton * a.alpha[i];
        p.stiffness[i] = per_newton * a.k[i];
    }
    p.attraction = per_newton * a.C;
    return p;
}

struct none {
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

struct no_observer {
    using box = absent<signal::position, signal::voltage>;
    static box::parameters of(const axis&) { return {}; }
};
/// On the plant without delay and with the pole that the inverse-model feedforward has, A'.
struct observer {
    using box = disturbance_observer<signal::voltage>;
    static box::parameters of(const axis& a) { return {a.corner, axis_model<signal::voltage>{a.B, a.A}}; }
};

/// What may differ between readings of the experiment.
struct reading {
    double peak_speed = 0.1; ///< m/s; 30 mm in all
    duration delay = 0.4_ms; ///< beside the hold of half a period
    quantity<si::length> encoder = 250_nm;
    std::size_t substeps = 10; ///< of 500 us
    duration preview = 0_s;    ///< of the feedforward
    double cycles = 3;         ///< of the sinusoid
};
struct lag {
    double glitch =
        0; ///< um; largest error in the quarter of a half cycle after a reversal, mean of all but the first
    double worst = 0;      ///< um; the largest of these
    double all = 0;        ///< um; largest error at any time after the first half cycle and a half
    bool diverged = false; ///< error above 1 mm, or a box at fault: no result
};

/// Runs the loop of `milling_axis` on a `linear_motor`; the error is that of the axis, not that of its encoder.
template <class Compensation, class Observer = no_observer> lag run(const axis& a, const reading& how = {}) {
    using boxes = milling_axis_boxes<typename Compensation::box, typename Observer::box>;
    using plant_box = linear_motor<maxwell_slip<4>>;
    const double w0 = std::sqrt(a.notch_squared);
    typename boxes::parameters control{.position_gain = 150.0 / 1_s,
                                       .velocity_gain = a.kp,
                                       .velocity_integral = a.ki,
                                       .estimator_corner = 942.5 / (2 * pi_) * 1_Hz,
                                       .notch = {w0 / (2 * pi_) * 1_Hz, a.notch_damping / w0},
                                       .plant_gain = a.B,
                                       .plant_pole = a.A,
                                       .friction = Compensation::of(a),
                                       .disturbance = Observer::of(a),
                                       .limit = 10_V};
    milling_axis<boxes> loop{.box = {control, period}};
    const quantity<si::mass> mass = a.kf / a.B;
    plant_box::parameters machine{.mass = mass,
                                  .force_constant = a.kf,
                                  .friction = gms<signal::force>(a, gain_of<signal::force, signal::force>(1.0)),
                                  .delay = how.delay,
                                  .encoder_step = how.encoder,
                                  .substeps = how.substeps};
    machine.friction.curve.viscous += a.A * mass; // A' beside sigma
    plant_box plant{machine, period};

    const double amplitude = 0.03, w = how.peak_speed / amplitude, T = period.value();
    const auto motion = [&](double t) { // from rest
        return typename milling_axis<boxes>::motion{amplitude * (1 - std::cos(w * t)) * 1_m,
                                                    amplitude * w * std::sin(w * t) * 1_mps,
                                                    amplitude * w * w * std::cos(w * t) * 1_mps2};
    };
    lag found;
    double peak = 0;
    int reversals = 0;
    quantity<si::length> measured{};
    const auto samples = static_cast<long>(how.cycles * 2 * pi_ / w / T);
    for (long k = 0; k < samples && !found.diverged; ++k) {
        const double t = static_cast<double>(k) * T, turns = w * t / pi_; // reversals so far
        const auto now = motion(t), ahead = motion(t + how.preview.value());
        const double error = 1e6 * std::abs((now.position - plant.now().x).value());
        if (turns >= 1.5) found.all = std::max(found.all, error);
        if (turns >= 2 && turns - std::floor(turns) < 0.25)
            peak = std::max(peak, error);
        else if (peak > 0) {
            found.glitch += peak;
            found.worst = std::max(found.worst, peak);
            peak = 0;
            ++reversals;
        }
        found.diverged = !(error < 1000) || plant.faulted() || loop.faulted();
        measured = plant(loop(now, ahead, measured));
    }
    if (reversals > 0) found.glitch /= reversals;
    return found;
}

} // namespace thesis
