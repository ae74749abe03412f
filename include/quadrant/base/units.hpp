// SPDX-License-Identifier: BSL-1.0
#pragma once
// First: compilers list candidates in the order of the headers, and those of a quantity say most.
#include <boost/units/quantity.hpp>

#include <boost/units/base_dimension.hpp>
#include <boost/units/base_unit.hpp>
#include <boost/units/make_system.hpp>
#include <boost/units/systems/si/acceleration.hpp>
#include <boost/units/systems/si/angular_velocity.hpp>
#include <boost/units/systems/si/current.hpp>
#include <boost/units/systems/si/dimensionless.hpp>
#include <boost/units/systems/si/electric_potential.hpp>
#include <boost/units/systems/si/force.hpp>
#include <boost/units/systems/si/frequency.hpp>
#include <boost/units/systems/si/length.hpp>
#include <boost/units/systems/si/mass.hpp>
#include <boost/units/systems/si/moment_of_inertia.hpp>
#include <boost/units/systems/si/plane_angle.hpp>
#include <boost/units/systems/si/time.hpp>
#include <boost/units/systems/si/torque.hpp>
#include <boost/units/systems/si/velocity.hpp>

/// Physical quantities, SI throughout. A frequency [Hz] counts periods; a rate [1/s] is what a gain between a
/// position and a velocity is. 25 Hz are a rate of 2 pi 25 1/s, so the two are different types, and neither
/// converts to the other but by name: `rate_of_corner(25_Hz)`.
namespace quadrant::inline v0 {

namespace si = boost::units::si;
/// A number with its unit, checked when it is compiled and free when it runs.
template <class Unit, class Real = double> using quantity = boost::units::quantity<Unit, Real>;

/// A time [s]; periods, delays.
using duration = quantity<si::time>;
/// Per second: the gain of a position loop, the viscous rate of a plant, one over a time constant.
using per_second = quantity<si::frequency>;

/// A dimension of its own, so that a frequency is not the rate that it would be without the 2 pi.
struct frequency_dimension : boost::units::base_dimension<frequency_dimension, 7301> {};
/// One period a second.
struct hertz_base_unit : boost::units::base_unit<hertz_base_unit, frequency_dimension::dimension_type, 7302> {};
/// Periods of a sine, or turns, per second.
using hertz_unit =
    boost::units::unit<frequency_dimension::dimension_type, boost::units::make_system<hertz_base_unit>::type>;
/// In hertz: periods of a sine per second.
using frequency = quantity<hertz_unit>;

/// The frequency of what repeats after `period`.
template <class Real> constexpr quantity<hertz_unit, Real> once_per(const quantity<si::time, Real>& period) {
    return quantity<hertz_unit, Real>::from_value(Real(1) / period.value());
}
/// The time of one period of f.
template <class Real> constexpr quantity<si::time, Real> period_of(const quantity<hertz_unit, Real>& f) {
    return quantity<si::time, Real>::from_value(Real(1) / f.value());
}
/// 2 pi f: the gain [1/s] of a loop that is to be fast up to f, the pole [1/s] of a corner at f.
template <class Real>
constexpr quantity<si::frequency, Real> rate_of_corner(const quantity<hertz_unit, Real>& f) {
    return quantity<si::frequency, Real>::from_value(Real(2 * 3.14159265358979323846) * f.value());
}
/// The way back: where the corner of a pole [1/s] lies.
template <class Real>
constexpr quantity<hertz_unit, Real> corner_of_rate(const quantity<si::frequency, Real>& pole) {
    return quantity<hertz_unit, Real>::from_value(pole.value() / Real(2 * 3.14159265358979323846));
}

/// The unit of A over B.
template <class A, class B> using unit_quotient = typename boost::units::divide_typeof_helper<A, B>::type;
/// The unit of A times B.
template <class A, class B> using unit_product = typename boost::units::multiply_typeof_helper<A, B>::type;

} // namespace quadrant::inline v0
