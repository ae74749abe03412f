// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <boost/units/quantity.hpp>
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

/// Physical quantities, SI throughout. `frequency` is in hertz everywhere, never in rad/s: that is an angular
/// velocity.
namespace quadrant {

namespace si = boost::units::si;
/// A number with its unit, checked when it is compiled and free when it runs.
template <class Unit, class Real = double> using quantity = boost::units::quantity<Unit, Real>;

/// A time [s]; periods, delays.
using duration = quantity<si::time>;
/// In hertz: periods of a sine per second.
using frequency = quantity<si::frequency>;

/// The unit of A over B.
template <class A, class B> using unit_quotient = typename boost::units::divide_typeof_helper<A, B>::type;
/// The unit of A times B.
template <class A, class B> using unit_product = typename boost::units::multiply_typeof_helper<A, B>::type;

} // namespace quadrant
