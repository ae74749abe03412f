// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/analysis/loop.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/observer/disturbance_observer.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

/// The milling table of [Jamaludin2008] as its tables print it, and what every experiment makes of them.
namespace thesis {

using namespace quadrant;
using namespace quadrant::literals;

/// One axis: eq. (2.2), Table 2.2, eq. (3.5), Tables 4.1 and 4.3; in SI but for the names of the thesis.
struct axis {
    const char* name;
    gain_of<signal::acceleration, signal::voltage> B;
    per_second A;     ///< of eq. (2.2), friction in it
    per_second A_gms; ///< A' of Table 4.1: what is linear beside GMS
    duration delay;   ///< Td of eq. (2.2)
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
    .A = 28.57_per_s,
    .A_gms = 2.5_per_s,
    .delay = 0.65_ms,
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
    .A = 20_per_s,
    .A_gms = 0.095_per_s,
    .delay = 0.65_ms,
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
/// The y axis with the friction of Table 4.3b, adjusted on the machine.
inline const axis y_adjusted = [] {
    axis a = y;
    a.alpha = {57_N, 26.5_N, 15_N, 3.4_N};
    a.k = {newtons_per_um(110), newtons_per_um(2), newtons_per_um(1.5), newtons_per_um(0.119)};
    return a;
}();

inline const duration period = 500_us;
inline const per_second position_gain = 150.0 / 1_s; ///< kv
constexpr double pi_ = std::numbers::pi;
inline const frequency estimator_corner = 942.5 / (2 * pi_) * 1_Hz; ///< of Vest

inline notch<signal::velocity>::parameters notch_of(const axis& a) {
    const double w0 = std::sqrt(a.notch_squared);
    return {w0 / (2 * pi_) * 1_Hz, a.notch_damping / w0};
}

/// G(s) of eq. (2.2).
inline analysis::rigid_axis_model<> model_of(const axis& a) { return {a.A, a.B, a.delay}; }

/// The cascade of eqs. (2.22) to (2.34) around a plant: G, or a measured response.
template <analysis::frequency_response Plant> auto loop_around(const Plant& plant, const axis& a) {
    const auto n = notch_of(a);
    return analysis::p_pi_loop{plant, analysis::pi_model<>{a.kp, a.ki},
                               analysis::in_series{analysis::derivative_model{estimator_corner},
                                                   analysis::notch_model{n.centre, n.width}},
                               position_gain};
}

/// The controller that all simulations have; friction, observer and memory are for the caller to fill in.
template <class Boxes> typename Boxes::parameters controller_of(const axis& a) {
    return {.position_gain = position_gain,
            .velocity_gain = a.kp,
            .velocity_integral = a.ki,
            .estimator_corner = estimator_corner,
            .notch = notch_of(a),
            .plant_gain = a.B,
            .plant_pole = a.A_gms,
            .limit = 10_V};
}

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

} // namespace thesis
