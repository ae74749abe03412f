// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/feedforward/inverse_model.hpp>
#include <quadrant/feedforward/preview.hpp>

#include <complex>
#include <cstddef>
#include <numbers>

/// Blocks that take a motion, made ones of one scalar for the cases of this folder: x is fed as position, velocity and
/// acceleration in SI at once.
namespace conformance {

template <class Real> quadrant::axis_motion<Real> as_motion(quadrant::quantity<quadrant::si::length, Real> x) {
    using m = quadrant::axis_motion<Real>;
    return {x, decltype(m::velocity)::from_value(x.value()), decltype(m::acceleration)::from_value(x.value())};
}

/// The position ahead of a preview.
template <std::size_t Capacity, class Real>
struct previewed : quadrant::preview<Capacity, quadrant::axis_motion<Real>> {
    using base = quadrant::preview<Capacity, quadrant::axis_motion<Real>>;
    using input = quadrant::signal::position;
    using output = quadrant::signal::position;
    using value = quadrant::quantity<quadrant::si::length, Real>;
    using base::base;

    value operator()(value x) noexcept { return base::operator()(as_motion(x)).ahead.position; }
    void settle(value x) noexcept { base::settle(as_motion(x)); }
    /// The textbook's Hermite cubic through the samples before and behind.
    std::complex<double> response(quadrant::frequency f) const {
        constexpr double T = 5e-4;
        const double lead = quadrant::detail::plain(this->given().lead), whole = std::floor(lead / T),
                     u = lead / T - whole;
        const auto sample = [&](double n) { return std::polar(1.0, 2 * std::numbers::pi * f.value() * T * n); };
        const double h00 = 2 * u * u * u - 3 * u * u + 1, h10 = u * u * u - 2 * u * u + u, h01 = 1 - h00,
                     h11 = u * u * u - u * u;
        return sample(whole - double(Capacity)) * ((h00 + T * h10) + (h01 + T * h11) * sample(1));
    }
};

/// The command of an inverse model.
template <class Command, class Real> struct inverted : quadrant::inverse_model<Command, Real> {
    using base = quadrant::inverse_model<Command, Real>;
    using input = quadrant::signal::position;
    using base::base;
    using typename base::value;

    value operator()(quadrant::quantity<quadrant::si::length, Real> x) noexcept {
        return base::operator()(as_motion(x));
    }
    void settle(quadrant::quantity<quadrant::si::length, Real> x) noexcept {
        const auto m = as_motion(x);
        base::settle(m.velocity, m.acceleration);
    }
    std::complex<double> response(quadrant::frequency) const {
        const auto& p = this->given();
        return (1 + quadrant::detail::plain(p.damping)) / quadrant::detail::plain(p.gain);
    }
};

} // namespace conformance
