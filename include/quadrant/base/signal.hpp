// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "units.hpp"

#include <concepts>
#include <type_traits>

namespace quadrant::inline v0 {

/// What a wire carries. Blocks are templates over these tags, not over quantity types, so that the compiler
/// prints `block<signal::velocity, signal::force>` and a log header knows the unit.
namespace signal {
/// Place of an axis [m]; differences and errors of places too.
struct position {
    using unit = si::length;
    static constexpr const char* text = "m";
};
/// Speed of an axis [m/s].
struct velocity {
    using unit = si::velocity;
    static constexpr const char* text = "m/s";
};
/// Acceleration of an axis [m/s^2].
struct acceleration {
    using unit = si::acceleration;
    static constexpr const char* text = "m/s^2";
};
/// Force along an axis [N].
struct force {
    using unit = si::force;
    static constexpr const char* text = "N";
};
/// Torque of a screw or rotary axis [N m].
struct torque { // the radian is a unit of its own: N m/rad
    using unit = si::torque;
    static constexpr const char* text = "N m";
};
/// Speed of a screw or rotary axis [rad/s].
struct angular_velocity {
    using unit = si::angular_velocity;
    static constexpr const char* text = "rad/s";
};
/// Command to an amplifier [V].
struct voltage {
    using unit = si::electric_potential;
    static constexpr const char* text = "V";
};
/// Current of a motor [A], or a command for it.
struct current {
    using unit = si::current;
    static constexpr const char* text = "A";
};
/// What has no unit [1].
struct number {
    using unit = si::dimensionless;
    static constexpr const char* text = "1";
};
} // namespace signal

/// A tag that names a unit; add your own beside the stock ones.
template <class S>
concept signal_tag = requires {
    typename S::unit;
    { S::text } -> std::convertible_to<const char*>;
};

template <signal_tag Signal, class Real = double> using quantity_of = quantity<typename Signal::unit, Real>;

/// Short names for what travels on wires, for `using namespace quadrant::quantities`: force f = 3_N.
namespace quantities {
using position = quantity_of<signal::position>;         ///< [m]
using velocity = quantity_of<signal::velocity>;         ///< [m/s]
using acceleration = quantity_of<signal::acceleration>; ///< [m/s^2]
using force = quantity_of<signal::force>;               ///< [N]
using torque = quantity_of<signal::torque>;             ///< [N m]
using voltage = quantity_of<signal::voltage>;           ///< [V]
using current = quantity_of<signal::current>;           ///< [A]
} // namespace quantities

/// Gain from In to Out, and the same per second (integral gain).
template <signal_tag Out, signal_tag In, class Real = double>
using gain_of = quantity<unit_quotient<typename Out::unit, typename In::unit>, Real>;
template <signal_tag Out, signal_tag In, class Real = double>
using gain_rate_of =
    quantity<unit_quotient<unit_quotient<typename Out::unit, typename In::unit>, si::time>, Real>;

/// What parameters are given in: double for a loop that runs in double or float (a coefficient is designed in
/// double and rounded once), the number type itself for a dual, so that a loop can be differentiated by them.
template <class Real> using parameter_real = std::conditional_t<std::floating_point<Real>, double, Real>;

/// A parameter as the step uses it: the same unit, rounded once to the number type of the loop.
template <class Real, class Unit, class Number>
constexpr quantity<Unit, Real> in_real(const quantity<Unit, Number>& q) {
    return quantity<Unit, Real>::from_value(Real(q.value()));
}

/// Out is In per second: what a differentiator may map.
template <class Out, class In>
concept rate_of = signal_tag<Out> && signal_tag<In> &&
    std::same_as<typename Out::unit, unit_quotient<typename In::unit, si::time>>;

} // namespace quadrant::inline v0
