// SPDX-License-Identifier: BSL-1.0
// Into a program that has only doubles: one line per axis and sample, metres in, volts out.
// You should see: both axes within 10 um of a circle of 30 mm, and the message for a parameter that cannot be.
#include <quadrant/quadrant.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace quadrant;

namespace {
using boxes =
    cascade_p_pi_boxes<filtered_derivative<signal::position, signal::velocity>, notch<signal::voltage>>;
const double period = 500e-6;

boxes::parameters tuning(double notch_hz) {
    return {.position_gain = in_si(150),
            .velocity_gain = in_si(60),
            .velocity_integral = in_si(450),
            .estimator = {.corner = in_si(150)},
            .acceleration_feedforward = in_si(0.2345),
            .viscous_feedforward = in_si(0.586),
            .coulomb_feedforward = in_si(0.084),
            .notch = {.centre = in_si(notch_hz), .width = 0.06},
            .limit = in_si(10)};
}
} // namespace

int main() {
    cascade<boxes> x{.box = {tuning(330), in_si(period)}}, y{.box = {tuning(380), in_si(period)}};
    const linear_motor<>::parameters table{.mass = in_si(340),
                                           .force_constant = in_si(1450),
                                           .friction = {.coulomb = in_si(122), .viscous = in_si(850)},
                                           .delay = in_si(400e-6)};
    linear_motor<> motor_x(table, in_si(period)), motor_y(table, in_si(period));

    double at_x = 0, at_y = 0, worst = 0;
    for (int k = 0; k < 8000; ++k) {
        const double angle = 2 * pi * 0.5 * k * period, r_x = 0.03 * (1 - std::cos(angle)),
                     r_y = 0.03 * std::sin(angle);
        if (k > 4000) worst = std::max({worst, std::abs(r_x - at_x), std::abs(r_y - at_y)});
        const double u_x = step_in_si(x, r_x, at_x); // the whole axis
        const double u_y = step_in_si(y, r_y, at_y);
        at_x = step_in_si(motor_x, u_x);
        at_y = step_in_si(motor_y, u_y);
    }
    std::printf("worst of both axes: %.0f um\n", 1e6 * worst);

    // For parameters that a user typed: no exception, the reason as text.
    const auto asked = make<cascade<boxes>>(tuning(1200), in_si(period));
    char why[120];
    asked.why().write(why, sizeof why);
    std::printf("%s\n", asked ? "made" : why);
}
