// SPDX-License-Identifier: BSL-1.0
#include <quadrant/trajectory/corner.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace {
using namespace quadrant;
using namespace quadrant::trajectory;
using path::line;
using path::point;

struct dice {
    std::mt19937_64 bits{20261124};
    double operator()(double low, double high) { return low + (high - low) * (double(bits() >> 11) * 0x1p-53); }
    double decades(double low, double high) { return std::exp((*this)(std::log(low), std::log(high))); }
};
machine_limits machine(dice& roll) {
    const auto of = [&] {
        return motion_limits{quantity<si::velocity>::from_value(roll.decades(0.05, 2)),
                             quantity<si::acceleration>::from_value(roll.decades(0.1, 50)),
                             jerk::from_value(roll.decades(1, 5000))};
    };
    return {{of(), of(), of()}, of()};
}
/// Every axis by itself, as the equations above `corner` have them; curvature is none.
double shortest(point turn, double v, double g2, const plain_limits& within) {
    double longest = 0;
    for (int i = 0; i < 4; ++i) {
        const bounds& b = i < 3 ? within.axis[std::size_t(i)] : within.path;
        const double jump = v * (i < 3 ? std::abs(turn[i]) : magnitude(turn));
        longest = std::max({longest, 2 * jump / b.acceleration, std::sqrt(g2 * jump / b.jerk)});
    }
    return longest;
}
} // namespace

TEST_CASE(
    "corner: between two lines its time is the shortest within every axis' limits, and its highest speed is "
    "bounded by the tolerance, half of a line or the feed") {
    dice roll;
    int wrong_time = 0, outside = 0, too_slow = 0;
    for (int n = 0; n < 1'000'000; ++n) {
        const plain_limits within(machine(roll));
        const double turning = roll.decades(1e-5, std::numbers::pi), up = roll(-0.5, 0.5);
        const point from{-roll.decades(1e-4, 1), 0, 0};
        const double length = roll.decades(1e-4, 1);
        const point to{length * std::cos(turning), length * std::sin(turning), length * up};
        const stretch before(line(from, {}), roll.decades(1e-3, 1), within),
            after(line({}, to), roll.decades(1e-3, 1), within);
        const bool cubic = n % 2 != 0;
        const double tolerance = roll.decades(1e-7, 1e-3), g2 = cubic ? 6 : 4, m = cubic ? 0.075 : 1.0 / 12;
        const corner c(before, after, tolerance,
                       cubic ? profile_kind::cubic_acceleration : profile_kind::trapezoidal_acceleration,
                       within);
        const point turn = after.first_tangent - before.last_tangent;
        const double v = roll.decades(1e-4, 2), tau = shortest(turn, v, g2, within);
        wrong_time += !(std::abs(c.time(v) - tau) <= 1e-12 * tau);

        const double feed = std::min(before.within.velocity, after.within.velocity);
        const double room = 0.5 * std::min(before.length, after.length);
        const auto passes = [&](double speed) {
            const double way = speed * shortest(turn, speed, g2, within);
            return speed <= feed && 0.5 * way <= room && m * way * magnitude(turn) <= tolerance;
        };
        outside +=
            !passes(c.most() * (1 - 1e-9)) || c.leg(c.most()) > room || c.deviation(c.most()) > tolerance;
        too_slow += passes(c.most() * (1 + 1e-9));
    }
    CHECK(wrong_time == 0);
    CHECK(outside == 0);
    CHECK(too_slow == 0);
}
