// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/control/axis_enable.hpp>
#include <quadrant/control/axis_law.hpp>
#include <quadrant/control/following_error.hpp>
#include <quadrant/control/gain_schedule.hpp>
#include <quadrant/feedforward/inverse_model.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/loop/gantry_pair.hpp>

#include <complex>
#include <cstddef>
#include <numbers>

/// Blocks that take a motion, made ones of one scalar for the cases of this folder: x is fed as position,
/// velocity and acceleration in SI at once.
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
        constexpr double period = 5e-4;
        const double lead = quadrant::detail::plain(this->given().lead), whole = std::floor(lead / period),
                     u = lead / period - whole;
        const auto sample = [&](double n) {
            return std::polar(1.0, 2 * std::numbers::pi * f.value() * period * n);
        };
        const double h00 = 2 * u * u * u - 3 * u * u + 1, h10 = u * u * u - 2 * u * u + u, h01 = 1 - h00,
                     h11 = u * u * u - u * u;
        return sample(whole - double(Capacity)) * ((h00 + period * h10) + (h01 + period * h11) * sample(1));
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
        return (1 + quadrant::detail::plain(p.viscous_rate)) / quadrant::detail::plain(p.gain);
    }
};

/// An axis that is on.
template <class Real> struct enabled : quadrant::axis_enable<Real> {
    using base = quadrant::axis_enable<Real>;
    using base::base;
    using typename base::value;

    value operator()(value x) noexcept { return base::operator()({.enable = true}, x); }
    std::complex<double> response(quadrant::frequency) const { return 1; }
};

/// The share of the window, x for error and speed.
template <class Real> struct watched : quadrant::following_error<Real> {
    using base = quadrant::following_error<Real>;
    using base::base;
    using typename base::argument;
    using typename base::value;

    value operator()(argument x) noexcept { return base::operator()(x, as_motion(x).velocity); }
    void settle(argument x) noexcept { base::settle(x, as_motion(x).velocity); }
};

/// x with a gain that depends on x.
template <class Real>
struct scheduled : quadrant::gain_schedule<quadrant::signal::position, quadrant::signal::position,
                                           quadrant::signal::velocity, 3, Real> {
    using base = quadrant::gain_schedule<quadrant::signal::position, quadrant::signal::position,
                                         quadrant::signal::velocity, 3, Real>;
    using base::base;
    using typename base::argument;
    using typename base::value;

    value operator()(argument x) noexcept { return base::operator()(x, x); }
    void settle(argument x) noexcept { base::settle(x, x); }
};

/// The mean of a beam with its ends at x and x/2.
template <class Real> struct paired : quadrant::gantry_pair<quadrant::signal::force, Real> {
    using base = quadrant::gantry_pair<quadrant::signal::force, Real>;
    using input = quadrant::signal::position;
    using output = quadrant::signal::position;
    using value = typename base::position;
    using base::base;

    value operator()(value x) noexcept { return base::operator()(x, Real(0.5) * x).mean; }
    void settle(value x) noexcept { base::settle(x, Real(0.5) * x); }
    std::complex<double> response(quadrant::frequency) const {
        return 0.5 + 0.5 * quadrant::detail::plain(this->given().share);
    }
};

/// Any control law (`axis_law`): the trajectory is x in all three, the encoder says x/4, the tachometer -x/2.
template <class Law> struct law_on : Law {
    using input = quadrant::signal::position;
    using position = quadrant::quantity<quadrant::si::length, quadrant::real_of<Law>>;
    using velocity = quadrant::quantity<quadrant::si::velocity, quadrant::real_of<Law>>;
    using Law::Law;
    using typename Law::value;

    value operator()(position x) noexcept {
        using Real = quadrant::real_of<Law>;
        const auto m = as_motion(x);
        const auto v = velocity::from_value(Real(-0.5) * x.value());
        if constexpr (requires(Law & l) { l(m, x, v, m.acceleration); })
            return Law::operator()(m, Real(0.25) * x, v, Real(-0.75) * m.acceleration);
        else
            return Law::operator()(m, Real(0.25) * x, v);
    }
    void settle(value u) noexcept { Law::settle(position(), u); }
    std::complex<double> response(quadrant::frequency f) const requires requires(const Law& l) {
        l.Law::response(f);
    }
    {
        const quadrant::law_response r = Law::response(f);
        return r.to_position + r.to_velocity + r.to_acceleration - 0.25 * r.from_position +
               0.5 * r.from_velocity + 0.75 * r.from_acceleration;
    }
};

} // namespace conformance
