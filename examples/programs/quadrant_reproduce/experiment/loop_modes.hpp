// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "loop_figures.hpp"

#include <quadrant/analysis/modes.hpp>
#include <quadrant/analysis/nyquist.hpp>

#include <algorithm>
#include <unsupported/Eigen/NonLinearOptimization>
#include <unsupported/Eigen/NumericalDiff>
#include <vector>

/// thesis.loop_modes: the measured FRF is not published, margins and bandwidths on it are. What one base mode
/// and one structural mode must be for the model to have them, by least squares within what the thesis says of
/// the modes.
namespace thesis {

/// Published on the measured FRF: Table 2.3 and chapter 2.
struct published_loop {
    loop_figures figures; ///< tracking_ratio_10Hz is not given: NaN
    frequency base;       ///< where the base's anti-resonance and resonance lie
    frequency structural_from, structural_to;
};
constexpr double not_given = std::numeric_limits<double>::quiet_NaN();
inline const published_loop published_x{
    {12.33, 315, 74.5, 65.0, 28.9, 15.1, 100, 68, 21.4, 26.6, not_given, 15}, 47_Hz, 320_Hz, 340_Hz};
inline const published_loop published_y{
    {10.31, 307.6, 73.1, 34.9, 28.8, 16.49, 100.6, 67.18, 22.47, 27.1, not_given, 8}, 44_Hz, 270_Hz, 320_Hz};

struct mode_fit {
    analysis::flexible_axis_model<> plant; ///< G of eq. (2.2) with the base and the structural mode
    loop_figures figures;
    double rms; ///< of the relative distance to what is published
};

namespace detail {

/// Relative distance of ten loop figures and the stiffness to the published ones, by six numbers that run over
/// all reals
/// and stay within bounds: a sine between them.
struct mode_distance {
    using Scalar = double;
    enum { InputsAtCompileTime = Eigen::Dynamic, ValuesAtCompileTime = Eigen::Dynamic };
    using InputType = Eigen::VectorXd;
    using ValueType = Eigen::VectorXd;
    using JacobianType = Eigen::MatrixXd;

    const axis& of;
    const published_loop& wanted;

    int inputs() const { return 6; }
    int values() const { return 11; }

    std::vector<analysis::flexible_mode> modes(const InputType& u) const {
        const auto within = [&](int i, double low, double high) {
            return low + (high - low) * 0.5 * (1 + std::sin(u[i]));
        };
        // Base: the middle of its pair within 3 Hz, at most half as heavy as the slide, damped by bolts and
        // ground.
        const double share = within(2, 0.02, 0.5), middle = within(0, -3, 3) + wanted.base.value();
        const double from = wanted.structural_from.value(), to = wanted.structural_to.value();
        return {{analysis::hertz(middle * std::pow(1 + share, 0.25)),
                 std::exp(within(1, std::log(0.01), std::log(0.2))), share},
                {analysis::hertz(within(3, from, to)), std::exp(within(4, std::log(0.002), std::log(0.1))),
                 within(5, -0.3, 0.3)}};
    }
    analysis::flexible_axis_model<> plant(const InputType& u) const { return {model_of(of), modes(u)}; }

    int operator()(const InputType& u, ValueType& distance) const {
        const loop_figures f = figures_of(loop_around(plant(u), of), of.kf, {0.5_Hz, 900_Hz, 60});
        const loop_figures& p = wanted.figures;
        distance.resize(values());
        int i = 0;
        // A figure that does not exist is as bad as three times its value, which keeps the search going.
        const auto add = [&](double ours, double theirs) {
            distance[i++] = std::isfinite(ours) ? std::clamp(ours / theirs - 1, -3.0, 3.0) : 3.0;
        };
        add(f.velocity_gain_margin, p.velocity_gain_margin);
        add(f.velocity_gain_margin_at, p.velocity_gain_margin_at);
        add(f.velocity_phase_margin, p.velocity_phase_margin);
        add(f.velocity_phase_margin_at, p.velocity_phase_margin_at);
        add(f.velocity_bandwidth, p.velocity_bandwidth);
        add(f.position_gain_margin, p.position_gain_margin);
        add(f.position_gain_margin_at, p.position_gain_margin_at);
        add(f.position_phase_margin, p.position_phase_margin);
        add(f.position_phase_margin_at, p.position_phase_margin_at);
        add(f.position_bandwidth, p.position_bandwidth);
        add(f.min_dynamic_stiffness, p.min_dynamic_stiffness);
        return 0;
    }
};

} // namespace detail

/// Levenberg-Marquardt from 32 starts (margins jump from one crossing to another, so there are several
/// valleys), the best of them. Deterministic, two seconds an axis. The figures hardly know how sharp the
/// structural mode is and where exactly it
/// lies: on y, 302 Hz with a damping of 0.003 is as good as 308 Hz.
inline mode_fit fit_modes_to(const axis& a, const published_loop& wanted) {
    const detail::mode_distance distance{a, wanted};
    Eigen::VectorXd best = Eigen::VectorXd::Zero(6);
    double least = std::numeric_limits<double>::infinity();
    for (unsigned start = 0; start < 32; ++start) {
        const auto sign = [&](unsigned bit) { return start & (1U << bit) ? 1.0 : -1.0; };
        Eigen::VectorXd u(6);
        u << 0, 0.8 * sign(0), 0.65 * sign(1) - 0.15, 0, 0.65 * sign(4) + 0.15,
            sign(2) * (sign(3) > 0 ? 0.1 : 0.6);
        Eigen::NumericalDiff<detail::mode_distance> slope(distance, 1e-10);
        Eigen::LevenbergMarquardt<Eigen::NumericalDiff<detail::mode_distance>> search(slope);
        search.parameters.maxfev = 200;
        search.minimize(u);
        if (search.fnorm < least) least = search.fnorm, best = u;
    }
    const auto plant = distance.plant(best);
    const auto loop = loop_around(plant, a);
    const int unstable =
        analysis::unstable_poles([&](frequency f) { return 1.0 / loop.sensitivity(f) - 1.0; }, servo, 2);
    require(unstable == 0, "fit_modes_to: poles of the loop on the fitted plant right of the axis", unstable,
            "must be none: the loop ran when it was measured");
    return {plant, figures_of(loop, a.kf), least / std::sqrt(double(distance.values()))};
}

/// The modes of an axis, fitted once in a run.
inline const mode_fit& fitted_modes(const axis& a) {
    static const mode_fit of_x = fit_modes_to(x, published_x), of_y = fit_modes_to(y, published_y);
    return &a == &x ? of_x : of_y;
}

} // namespace thesis
