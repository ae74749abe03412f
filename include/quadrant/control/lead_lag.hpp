// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "rst.hpp"

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>

namespace quadrant::inline v0 {

/// What a lead-lag compensator shall make of the open loop.
struct lead_lag_loop {
    frequency crossover;      ///< where its gain is one; > 0, below half the sampling rate
    double phase_margin = 45; ///< there, in degrees; 0 ... 90
    double integral = 0.1;    ///< corner of the lag, as a share of the crossover; > 0
};

/// Lead-lag compensation as an `rst` with T = S: a lead that gives the open loop its phase margin, and a lag
/// whose corner is at zero (an integral), so that a constant force leaves no error.
///   C = K (1 + s/wz)/(1 + s/wp) (s + wi)/s,  wz = wc sqrt(q), wp = wc/sqrt(q), sin(lead) = (1 - q)/(1 + q),  |C G| = 1 at wc
/// bilinear with the crossover kept (pre-warp), on the axis behind its hold: crossover and phase margin are
/// exact.
/// Source: [Franklin1998] ch. 7 (lead and lag compensation).
/// Range: the lead needed must lie between 0 and 75 degrees: else lower crossover, margin or integral. T = S: a
/// step of the reference is answered by K wp/wz of it at once; a ramp leaves no error, an acceleration a/(K wi
/// B) nearly. Throws "design_lead_lag.<field> = ...: must ..."; a loop that is not stable is refused.
template <signal_tag Command = signal::voltage, std::size_t A, std::size_t B>
auto design_lead_lag(const sampled_plant<A, B>& plant, const lead_lag_loop& wanted, duration period) {
    require_below_nyquist("design_lead_lag.crossover", wanted.crossover, period);
    require(wanted.phase_margin > 0 && wanted.phase_margin < 90, "design_lead_lag.phase_margin",
            detail::in_unit(wanted.phase_margin, " degrees"), "must lie between 0 and 90 degrees");
    require_positive("design_lead_lag.integral", wanted.integral);
    const double wc = 2 * std::numbers::pi * wanted.crossover.value(), wi = wanted.integral * wc;
    const auto back = std::polar(1.0, -wc * period.value());
    const std::complex<double> axis = detail::polynomial(plant.b, back) / detail::polynomial(plant.a, back);
    constexpr double degree = std::numbers::pi / 180;
    const double lag = std::atan(wanted.integral),
                 lead =
                     std::remainder(wanted.phase_margin * degree - std::arg(-axis) + lag, 2 * std::numbers::pi);
    require(lead > 0 && lead < 75 * degree, "design_lead_lag.phase_margin",
            detail::in_unit(lead / degree, " degrees"),
            "must need a lead between 0 and 75 degrees at this crossover (needs)");
    const double q = (1 - std::sin(lead)) / (1 + std::sin(lead)), wz = wc * std::sqrt(q),
                 wp = wc / std::sqrt(q);
    const auto d = bilinear(continuous<2>{{wi, 1 + wi / wz, 1 / wz}, {0, 1, 1 / wp}}, period, wanted.crossover);
    const double gain =
        1 / std::abs(axis * detail::polynomial(d.numerator, back) / detail::polynomial(d.denominator, back));

    rst_polynomials<2, 2, 2, Command> p;
    const double pole = d.denominator[2] / d.denominator[0]; // the other one is 1
    p.r = detail::with_factor<1>(std::array<double, 2>{1, -pole}, -1);
    for (std::size_t i = 0; i < 3; ++i)
        p.feedback[i] = p.reference[i] =
            decltype(p.feedback)::value_type::from_value(gain * d.numerator[i] / d.denominator[0]);
    const double radius = loop_radius(plant, p);
    require(radius < 1, "design_lead_lag.crossover", radius, "must leave the loop stable (largest pole)");
    return p;
}
template <signal_tag Command>
auto design_lead_lag(const axis_model<Command>& plant, const lead_lag_loop& wanted, duration period) {
    return design_lead_lag<Command>(pulse_transfer(plant, period), wanted, period);
}
/// Lead-lag as a law, for any plant.
template <class Real = double, signal_tag Command = signal::voltage>
using lead_lag = rst<2, 2, 2, 0, Real, Command>;

} // namespace quadrant::inline v0
