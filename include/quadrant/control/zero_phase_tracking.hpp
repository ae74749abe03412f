// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "pole_placement.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// Zero phase error tracking: the same feedback, and a reference polynomial that cancels all poles of the loop
/// and the phase of its zeros, from the reference B periods ahead. No zero is cancelled.
///   T = a-closed(z^-1) b(z) / b(1)^2:  x/x_ref = |b|^2 / b(1)^2, real at all frequencies; of a rigid axis cos^2(pi f T) nearly
/// Source: [Tomizuka1987], with all zeros on the side that is not cancelled.
/// The feedback around it does not see the reference at all while the plant is as believed: it holds against
/// disturbances.
template <std::size_t Integrals = 1, signal_tag Command = signal::voltage, std::size_t A, std::size_t B,
          class Number>
auto zero_phase_rst(const sampled_plant<A, B, Number>& plant, const rst_poles& poles, duration period) {
    const detail::placed_rst<Integrals, A, B, Number> d(plant, poles, period);
    std::array<Number, B> reversed{};
    for (std::size_t i = 0; i < B; ++i) reversed[i] = plant.b[B - i];
    auto p = d.template with<Command>(detail::product(reversed, d.closed));
    const double radius = loop_radius(plant, p);
    require(radius < 1, "place_rst.natural", radius, "must leave the loop stable (largest pole)");
    return p;
}
template <std::size_t Integrals = 1, signal_tag Command, class Number>
auto zero_phase_rst(const axis_model<Command, Number>& plant, const rst_poles& poles, duration period) {
    return zero_phase_rst<Integrals, Command>(pulse_transfer(plant, period), poles, period);
}
/// The law for that of an `axis_model`; it previews two periods.
template <class Real = double, signal_tag Command = signal::voltage>
using zero_phase_tracking = rst<2, 2, 5, 2, Real, Command>;

} // namespace quadrant::inline v0
