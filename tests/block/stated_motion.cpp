// SPDX-License-Identifier: BSL-1.0
// Long: a list, a case for each statement.
// As stated.cpp: motions, plants and what observes them.
#include "dice.hpp"

#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/axis_enable.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/observer/matrix.hpp>
#include <quadrant/observer/reduced_order_observer.hpp>
#include <quadrant/path/line.hpp>
#include <quadrant/path/spline.hpp>
#include <quadrant/plant/flexible_modes.hpp>
#include <quadrant/plant/harmonic_series.hpp>
#include <quadrant/plant/sprung_mass.hpp>
#include <quadrant/trajectory/interpolator.hpp>
#include <quadrant/trajectory/profile.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using path::point;
using stated::dice, stated::trials;
auto position_of(double x) { return quantity_of<signal::position>::from_value(x); }
auto velocity_of(double v) { return quantity_of<signal::velocity>::from_value(v); }
auto acceleration_of(double a) { return quantity_of<signal::acceleration>::from_value(a); }
} // namespace

TEST_CASE("profile: jerk is bounded, as speed and acceleration are; the length is exact at its end") {
    using namespace trajectory;
    dice roll;
    double over = 0;
    int not_there = 0, tried = 0;
    while (tried < trials) {
        const bounds within{roll.decades(0.01, 2), roll.decades(0.1, 20), roll.decades(1, 1000)};
        const auto kind =
            tried % 2 != 0 ? profile_kind::cubic_acceleration : profile_kind::trapezoidal_acceleration;
        const double length = roll.decades(1e-5, 1), from = roll.often() ? 0 : roll(0, within.velocity),
                     to = roll.often() ? 0 : roll(0, within.velocity);
        if (!speed_profile::feasible(kind, within, length, from, to)) continue;
        const speed_profile move(kind, within, length, from, to);
        not_there += move.at(move.duration()).s != length || move.at(2 * move.duration()).s != length;
        ++tried;
        for (int k = 0; k < 3; ++k) {
            const path_motion y = move.at(roll(0, move.duration()));
            over = std::max({over, y.v / within.velocity - 1, std::abs(y.a) / within.acceleration - 1,
                             std::abs(y.j) / within.jerk - 1});
        }
    }
    CHECK(tried >= trials);
    CHECK(over < 1e-12);
    CHECK(not_there == 0);
}
TEST_CASE("interpolator: at every stop the motion ends exactly at the end of the piece") {
    using namespace trajectory;
    dice roll;
    int tried = 0;
    int off = 0;
    const motion_limits axis{velocity_of(1), acceleration_of(40), jerk::from_value(20'000)};
    interpolator<4> drive({.limits = {{axis, axis, axis}, axis}}, 2_ms);
    point at;
    drive.settle(at);
    for (; tried < trials; ++tried) {
        const point to{at.x + roll(1e-4, 4e-4), at.y - roll(1e-4, 4e-4), roll(-1e-4, 1e-4)};
        path::move next{path::line(at, to)};
        next.feed = 0.5;
        drive.push(next);
        while (!drive.done()) drive();
        const auto& here = drive.now();
        off += here.axis[0].position.value() != to.x || here.axis[1].position.value() != to.y ||
               here.axis[2].position.value() != to.z || !here.resting;
        at = to;
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
}
TEST_CASE("preview: exact at samples, and between them for a constant jerk") {
    dice roll;
    constexpr double h = 0x1p-10; // whole periods are whole numbers of it
    int off_there = 0;
    double off = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double x0 = roll(-1, 1), v0 = roll(-1, 1), a0 = roll(-10, 10), j = roll(-100, 100),
                     lead = roll(0, 4);
        const bool whole = tried % 2 != 0;
        preview<4> block({duration::from_value(h * (whole ? std::floor(lead) : lead))},
                         duration::from_value(h));
        const auto at = [&](double t) {
            return axis_motion<>{position_of(x0 + t * (v0 + t * (a0 / 2 + t * j / 6))),
                                 velocity_of(v0 + t * (a0 + t * j / 2)), acceleration_of(a0 + t * j)};
        };
        for (int k = 0; k < 6; ++k) {
            const auto y = block(at(h * k));
            if (k < 4) continue;
            if (whole) {
                const auto same = at(h * (k - 4 + int(lead)));
                off_there += y.ahead.position != same.position || y.ahead.velocity != same.velocity ||
                             y.ahead.acceleration != same.acceleration;
            } else {
                const auto same = at(h * (k - 4 + lead));
                off = std::max({off, std::abs((y.ahead.position - same.position).value()),
                                h * std::abs((y.ahead.velocity - same.velocity).value()),
                                h * h * std::abs((y.ahead.acceleration - same.acceleration).value())});
            }
        }
    }
    CHECK(tried >= trials);
    CHECK(off_there == 0);
    CHECK(off < 1e-14);
}
TEST_CASE("axis_enable: a stop's way is v^2/(2 a) exactly") {
    dice roll;
    int tried = 0;
    double off = 0;
    for (; tried < trials; ++tried) {
        const double v = roll(-1, 1), a = roll.decades(10, 200), start = roll(-1, 1);
        axis_enable<> power({velocity_of(1), acceleration_of(a), acceleration_of(2 * a)}, 1_ms);
        power.settle(position_of(start));
        power({.enable = true}, position_of(start));
        const auto from = power({.enable = true}, position_of(start + v * 1e-3));
        auto x = from;
        for (auto y = x; power.on(); x = power.on() ? y : x) y = power({}, from);
        const double speed = (from.value() - start) / 1e-3, way = std::copysign(speed * speed / (2 * a), speed);
        off = std::max(off, std::abs((x - from).value() - way));
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-13);
}
TEST_CASE("sprung_mass, flexible_modes: the step is exact for what is held over it, at any centre: one step is "
          "any two") {
    dice roll;
    int tried = 0;
    double off = 0, off_modes = 0;
    for (; tried < trials; ++tried) {
        const double h = roll.decades(1e-5, 1e-2), centre = roll.decades(1, 2000), zeta = roll(0, 0.99);
        const double before = roll(-1, 1), after = roll(-1, 1),
                     scale = 1 + std::abs(after - before) / (h * centre);
        const sprung_mass<>::parameters p{quantity<si::mass>::from_value(roll(0.1, 10)),
                                          frequency::from_value(centre), zeta};
        const sprung_mass<> whole(p, h), half(p, h / 2);
        sprung_mass<>::state one{roll(-1, 1) / centre, roll(-1, 1)}, two = one;
        whole.advance(one, before, after);
        half.advance(two, before, 0.5 * (before + after));
        half.advance(two, 0.5 * (before + after), after);
        off = std::max({off, std::abs(one.q - two.q) * centre / scale, std::abs(one.w - two.w) / scale});

        const flexible_modes<1>::parameters m{quantity<si::mass>::from_value(1),
                                              {{{frequency::from_value(centre), zeta, roll(-2, 2)}}}};
        flexible_modes<1> once(m, duration::from_value(h)), twice(m, duration::from_value(h / 2));
        const auto bent = quantity_of<signal::force>::from_value(roll(-1, 1)),
                   force = quantity_of<signal::force>::from_value(roll(-1, 1));
        once.settle(bent), twice.settle(bent);
        once(force), twice(force);
        const double y = twice(force).value();
        off_modes = std::max(off_modes, std::abs(once.now().deflection[0].value() - y) * centre * centre);
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
    CHECK(off_modes < 1e-11);
}
TEST_CASE("reduced_order_observer: exact for a constant acceleration") {
    dice roll;
    double off = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double x = roll(-0.1, 0.1), v = roll(-1, 1), a = roll(-10, 10);
        reduced_order_observer<signal::voltage> block(
            {.mass = 1_kg, .force_constant = 1_N / 1_V, .corner = frequency::from_value(roll(100, 490))}, 1_ms);
        block.settle(position_of(x), velocity_of(v)); // without an acceleration: that dies out
        for (int k = 1; k <= 90; ++k) {
            const double t = 1e-3 * k;
            const double y = block(position_of(x + t * (v + t * a / 2)), acceleration_of(a)).value();
            if (k > 80) off = std::max(off, std::abs(y - (v + a * t)));
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
TEST_CASE("spline: exact at both ends, and held there beyond them") {
    dice roll;
    int off = 0, tried = 0;
    double from_knot = 0;
    for (; tried < trials; ++tried) {
        const point from{roll(-1, 1), roll(-1, 1), roll(-1, 1)},
            to{from.x + roll(0.05, 0.2), from.y + roll(-0.02, 0.02), from.z + roll(-0.02, 0.02)};
        const auto tangent = [&] {
            const double a = roll(-0.5, 0.5);
            return point{std::cos(a), std::sin(a), 0};
        };
        const path::spline curve = path::spline::quintic({from, tangent(), {}}, {to, tangent(), {}});
        off += !(curve.position(-roll(0, 1)) == curve.start()) ||
               !(curve.position(curve.length() * roll(1, 3)) == curve.end());
        off += !(curve.start() == from) || !(curve.position(0) == from) ||
               !(curve.position(curve.length()) == curve.end());
        from_knot = std::max(from_knot, distance(curve.end(), to)); // a sum of six coefficients
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
    CHECK(from_knot < 1e-14);
}
TEST_CASE(
    "harmonic_series: far away is as exact as near; circle_of_turns: quarter turns are taken off exactly") {
    dice roll;
    int tried = 0;
    int off = 0, off_quarter = 0;
    for (; tried < trials; ++tried) {
        const double part = std::floor(roll(0, 1024)) / 1024, far = std::floor(roll(-1e9, 1e9));
        const detail::harmonic_series<2, double, double> wave{{roll(-1, 1), roll(-1, 1)},
                                                              {roll(-1, 1), roll(-1, 1)}};
        off += wave(part) != wave(part + far);
        const double t = std::floor(roll(-4096, 4096)) / 16384; // within a quarter turn
        const auto here = circle_of_turns(lanes<2>(std::array{t, t + 0.25})),
                   there = circle_of_turns(lanes<2>(std::array{t + 1, t + 0.5}));
        off_quarter += here.cosine[0] != there.cosine[0] || here.sine[0] != there.sine[0] ||
                       here.sine[1] != here.cosine[0] || there.cosine[1] != -here.cosine[0];
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
    CHECK(off_quarter == 0);
}
TEST_CASE("disturbance_observer: a constant gives exactly zero, wherever the axis stands") {
    dice roll;
    int off = 0;
    int tried = 0;
    while (tried < trials) {
        disturbance_observer<signal::voltage> block(
            {frequency::from_value(roll(5, 200)),
             axis_model<signal::voltage>{
                 quantity<unit_quotient<si::acceleration, signal::voltage::unit>>::from_value(roll(0.1, 10)),
                 roll(0.1, 100) / 1_s}},
            500_us);
        for (int n = 0; n < 100; ++n, ++tried) {
            const auto x = position_of(roll(-1, 1) * roll.decades(1e-6, 10));
            block.settle(x);
            for (int k = 0; k < 3; ++k) off += block(x).value() != 0;
        }
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
}
TEST_CASE("sampled: exact for a held u: one period is any two (kalman, harmonic_force_observer)") {
    dice roll;
    int tried = 0;
    double off = 0;
    for (; tried < trials; ++tried) {
        const matrix<2, 2> f{{{0, 1}, {-roll.decades(1, 1e5), -roll(0, 300)}}};
        const column<2> g{roll(-1, 1), roll(-1, 1)};
        const double T = roll.decades(1e-5, 1e-2), share = roll(0.1, 0.9);
        const auto whole = sampled(f, g, matrix<2, 2>{}, T), first = sampled(f, g, matrix<2, 2>{}, share * T),
                   rest = sampled(f, g, matrix<2, 2>{}, (1 - share) * T);
        const double fast = std::sqrt(-f[1][0]); // in units in which both states are as large
        for (std::size_t i = 0; i < 2; ++i) {
            const double size = i == 0 ? 1 : fast;
            double from_input = rest.from_input[i];
            for (std::size_t j = 0; j < 2; ++j) {
                double step = 0;
                for (std::size_t k = 0; k < 2; ++k) step += rest.step[i][k] * first.step[k][j];
                off = std::max(off, std::abs(step - whole.step[i][j]) / size * (j == 0 ? 1 : fast));
                from_input += rest.step[i][j] * first.from_input[j];
            }
            off = std::max(off, std::abs(from_input - whole.from_input[i]) / size);
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
