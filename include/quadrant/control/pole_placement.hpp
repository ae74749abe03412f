// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "rst.hpp"

#include <array>
#include <cstddef>

namespace quadrant::inline v0 {

/// Where the poles of an `rst` loop shall lie.
struct rst_poles {
    frequency natural;  ///< of the pair that the reference is followed with; > 0, below half the sampling rate
    double damping = 1; ///< of it; > 0
    frequency
        /// of the rest, real and equal: faster removes disturbances faster and passes more noise; > 0
        observer;
};

namespace detail {
/// R, S and the closed loop: a R + b S = observer pair, by the Diophantine equation.
template <std::size_t Integrals, std::size_t A, std::size_t B, class Number> struct placed_rst {
    static_assert(B >= A && A + Integrals >= 1);
    static constexpr std::size_t rest = A + Integrals - 1;
    z_polynomial<rest> observer;
    z_polynomial<A + Integrals + B - 1, Number> closed{}; ///< the poles that are left over are at z = 0
    z_polynomial<B - 1 + Integrals, Number> r;
    z_polynomial<rest, Number> s;

    placed_rst(const sampled_plant<A, B, Number>& plant, const rst_poles& poles, duration period) {
        require_below_nyquist("place_rst.natural", poles.natural, period);
        require_positive("place_rst.damping", poles.damping);
        require_below_nyquist("place_rst.observer", poles.observer, period);
        observer = with_factor<rest>(std::array<double, 1>{1}, -real_pole(poles.observer, period));
        const auto wanted = product(observer, pole_pair(poles.natural, poles.damping, period));
        static_assert(wanted.size() <= std::tuple_size_v<decltype(closed)>);
        for (std::size_t i = 0; i < wanted.size(); ++i) closed[i] = Number(wanted[i]);
        const diophantine<A + Integrals, B, Number> d(with_factor<Integrals>(plant.a, -1), plant.b, closed);
        r = with_factor<Integrals>(d.r, -1);
        r[0] = Number(1); // c[0], but for rounding
        s = d.s;
    }
    /// The polynomials with a T that keeps the sum of S, so that the reference is reached to the last digit.
    template <signal_tag Command, std::size_t Size> auto with(const std::array<Number, Size>& t) const {
        rst_polynomials<B - 1 + Integrals, rest, Size - 1, Command, Number> p;
        using gain = gain_of<Command, signal::position, Number>;
        p.r = r;
        for (std::size_t i = 0; i <= rest; ++i)
            p.feedback[i] = gain::from_value(s[i]), p.recovery[i] = observer[i];
        const Number scale = at_one(s) / at_one(t);
        for (std::size_t i = 0; i < Size; ++i) p.reference[i] = gain::from_value(t[i] * scale);
        return p;
    }
};
} // namespace detail

/// Pole placement: an `rst` that closes the loop with poles where they are asked for, all of them, and follows
/// the reference as the pair alone would, the sampled zeros of the plant kept (they lie near z = -1, where a
/// pole on them would ring).
///   a R + b S = Am Ao,  T = Ao Am(1)/b(1),  W = Ao;  Integrals roots of R at z = 1 hold against a constant force
/// Source: [Astrom1997] ch. 5.
/// A ramp is followed late by 2 damping / w (the trajectory's derivatives are not used): for contours
/// `zero_phase_rst`. Throws in the name of place_rst; "diophantine.b" when the plant has an integral that it
/// cannot hold.
template <std::size_t Integrals = 1, signal_tag Command = signal::voltage, std::size_t A, std::size_t B,
          class Number>
auto place_rst(const sampled_plant<A, B, Number>& plant, const rst_poles& poles, duration period) {
    const detail::placed_rst<Integrals, A, B, Number> d(plant, poles, period);
    z_polynomial<d.rest, Number> t{};
    for (std::size_t i = 0; i <= d.rest; ++i) t[i] = d.observer[i];
    auto p = d.template with<Command>(t);
    const double radius = loop_radius(plant, p);
    require(radius < 1, "place_rst.natural", radius, "must leave the loop stable (largest pole)");
    return p;
}
template <std::size_t Integrals = 1, signal_tag Command, class Number>
auto place_rst(const axis_model<Command, Number>& plant, const rst_poles& poles, duration period) {
    return place_rst<Integrals, Command>(pulse_transfer(plant, period), poles, period);
}
/// The law for that of an `axis_model`.
template <class Real = double, signal_tag Command = signal::voltage>
using pole_placement = rst<2, 2, 2, 0, Real, Command>;

} // namespace quadrant::inline v0
