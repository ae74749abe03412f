// SPDX-License-Identifier: BSL-1.0
// How does the peak tracking error move with two gains? The loop itself answers, run once with a number that
// carries its derivatives.
//
//   reference --> cascade<..., dual<2>> --> linear_motor<..., dual<2>> --+     position_gain = dual::variable(150, 0)
//                    ^                                                   |     velocity_gain = dual::variable(60, 1)
//                    +---------------------------------------------------+
//
// Source: forward differentiation by dual numbers, quadrant/base/dual.hpp; axis of [Jamaludin2008] with
// friction.
// You should see: both derivatives are those of a central difference of two more runs each, and both gains
// help: one per cent of velocity gain is worth twice one per cent of position gain.
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/loop/cascade_p_pi.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <cmath>
#include <cstdio>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const duration period = 500_us;

/// Any quantity in another number type.
template <class Real, class Unit> quantity<Unit, Real> in(quantity<Unit> q) {
    return quantity<Unit, Real>::from_value(Real(q.value()));
}

/// Peak error [um] of a sinusoid of 30 mm, 100 mm/s, without friction feedforward. Real is double or dual<2>.
template <class Real> Real peak_error(Real position_gain, Real velocity_gain) {
    using boxes = cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity, Real>,
                                     notch<signal::voltage, Real>>;
    using machine = linear_motor<coulomb_viscous<signal::velocity, signal::force, Real>, 4, Real>;
    using position = quantity_of<signal::position, Real>;

    typename boxes::parameters tuning;
    tuning.position_gain = position_gain / in<Real>(1_s);
    tuning.velocity_gain = velocity_gain * in<Real>(1_V / 1_mps);
    tuning.velocity_integral = in<Real>(450_V / 1_m);
    tuning.estimator.corner = in<Real>(150_Hz);
    tuning.acceleration_feedforward = in<Real>(340_kg / (1450_N / 1_V));
    tuning.viscous_feedforward = in<Real>(850_N / 1_mps / (1450_N / 1_V));
    tuning.notch.centre = in<Real>(330_Hz);
    tuning.limit = in<Real>(10_V);
    typename machine::parameters table;
    table.mass = in<Real>(340_kg);
    table.force_constant = in<Real>(1450_N / 1_V);
    table.friction = {in<Real>(122_N), in<Real>(850_N / 1_mps)};
    table.delay = in<Real>(0.4_ms);

    cascade<boxes> axis{.box = {tuning, period}};
    machine motor{table, period};
    position reading{};
    Real peak = 0;
    for (int k = 0; k < 4000; ++k) {
        const double reference = 0.030 * (1 - std::cos(3.3333 * k * period.value()));
        reading = motor(axis(position::from_value(Real(reference)), reading));
        using std::abs;
        const Real error = abs(axis.wire.position_error.value());
        if (k > 1000 && error > peak) peak = error; // after the start
    }
    return peak * Real(1e6);
}
} // namespace

int main() {
    using number = dual<2>;
    const number peak = peak_error(number::variable(150, 0), number::variable(60, 1));
    const double by_position = (peak_error(150.01, 60.0) - peak_error(149.99, 60.0)) / 0.02;
    const double by_velocity = (peak_error(150.0, 60.01) - peak_error(150.0, 59.99)) / 0.02;

    std::printf("peak error %.2f um\n", peak.value);
    std::printf("                  one run of dual<2>   difference of two runs\n");
    std::printf("by position gain  %7.3f um s           %7.3f um s\n", peak.partial[0], by_position);
    std::printf("by velocity gain  %7.3f um m/(V s)     %7.3f um m/(V s)\n", peak.partial[1], by_velocity);
}
