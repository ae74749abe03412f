// SPDX-License-Identifier: BSL-1.0
#include <doctest/doctest.h>
#include <quadrant/base/lanes.hpp>
#include <quadrant/drive/position_loop.hpp>
#include <quadrant/drive/position_servo.hpp>
#include <quadrant/drive/set_point_line.hpp>

#include <vector>

using namespace quadrant;

TEST_CASE("set_point_line: held set-points are steps, linear ones come one period late, cubic ones two") {
    for (const auto kind : {interpolation::hold, interpolation::linear, interpolation::cubic}) {
        const set_point_line<> line(kind);
        auto s = set_point_line<>::state::at(0);
        for (int k = 0; k < 8; ++k) line.arrive(s, 3.0 * k); // a ramp of 3 a period
        const double late = kind == interpolation::hold ? 0 : kind == interpolation::linear ? 1 : 2;
        for (double p : {0.0, 0.25, 0.9}) {
            const double along = kind == interpolation::hold ? 0 : p;
            CHECK(line(s, p) == doctest::Approx(3 * (7 - late + along)));
            CHECK(line.slope(s, p) == doctest::Approx(kind == interpolation::hold ? 0 : 3));
            CHECK(line.velocity(s, p) == doctest::Approx(3)); // what a feedforward takes, held or not
        }
    }
}
TEST_CASE("set_point_line: the cubic has no step of position or velocity where a set-point arrives") {
    const set_point_line<> line(interpolation::cubic);
    auto s = set_point_line<>::state::at(1);
    for (double x : {1.0, 4.0, -2.0, 0.5}) line.arrive(s, x);
    const double end = line(s, 1), slope = line.slope(s, 1);
    line.arrive(s, 7);
    CHECK(line(s, 0) == doctest::Approx(end));
    CHECK(line.slope(s, 0) == doctest::Approx(slope));
}
TEST_CASE("velocity_loop: P and I act on the velocity error, and both stop at the limit") {
    const double h = 1e-4;
    const velocity_loop<> p({.gain = 50}, h);
    velocity_loop<>::state s;
    CHECK(p(s, 0.3, 0.1) == doctest::Approx(10));
    const velocity_loop<> pi({.gain = 50, .integral = 1000, .limit = 40}, h);
    auto t = velocity_loop<>::state::at(0);
    for (int k = 0; k < 100; ++k) pi(t, 0.3, 0.1); // 10 ms of 0.2 m/s
    CHECK(t.integral == doctest::Approx(1000 * 0.2 * 0.01));
    double force = 0;
    for (int k = 0; k < 10000; ++k) force = pi(t, 0.3, 0.1);
    CHECK(force == 40);
    CHECK(t.integral == 40);
}
TEST_CASE("velocity_loop: its filter passes 1 - 1/e after its time constant") {
    const double h = 1e-5, corner = 100, tau = 1 / (2 * std::numbers::pi * corner);
    const velocity_loop<> loop({.gain = 1, .filter_Hz = corner}, h);
    velocity_loop<>::state s;
    for (int k = 0; k < static_cast<int>(tau / h); ++k) loop(s, 0, 1);
    CHECK(s.filtered == doctest::Approx(1 - std::exp(-1)).epsilon(0.01));
}
TEST_CASE("velocity_loop: behind its filter a ramp is late by the time constant, however long the step is") {
    const double corner = 100, tau = 1 / (2 * std::numbers::pi * corner), slope = 3;
    for (const double h : {0.1 * tau, tau, 3 * tau}) {
        const velocity_loop<> loop({.gain = 2, .filter_Hz = corner}, h);
        velocity_loop<>::state s;
        double force = 0, v = 0;
        for (int k = 0; k < 400; ++k) {
            v = slope * h * (k + 0.5); // in the middle of the step, where its mean is
            force = loop(s, 0, v);
        }
        CHECK(force == doctest::Approx(-2 * (v - slope * tau)).epsilon(1e-9));
    }
}
TEST_CASE("position_loop: asks for the velocity of its position error and of the set-points") {
    const position_loop<> loop({.gain = 20, .velocity_feedforward = 0.5, .velocity = {.gain = 10}}, 1e-3);
    position_loop<>::state s;
    CHECK(loop(s, 1.0, 0.4, 0.9, 0.3) == doctest::Approx(10 * (20 * 0.1 + 0.5 * 0.4 - 0.3)));
}
TEST_CASE(
    "position_servo: duty of its error, least and largest duty, and a set-point that is followed at a rate") {
    const double h = 1e-3;
    const position_servo<> servo({.gain = 2, .minimum = 0.05, .maximum = 0.8}, h);
    auto s = position_servo<>::state::at(0);
    CHECK(servo(s, 0.1, 0) == doctest::Approx(0.25));
    CHECK(servo(s, -0.1, 0) == doctest::Approx(-0.25));
    CHECK(servo(s, 0.1, 0.1) == 0);
    CHECK(servo(s, 3, 0) == 0.8);
    const position_servo<> slow({.gain = 1, .rate = 0.5}, h);
    auto t = position_servo<>::state::at(0);
    for (int k = 0; k < 100; ++k) slow(t, 1, 0);
    CHECK(t.followed == doctest::Approx(0.05));
}
TEST_CASE("drives: what no drive has is refused by name") {
    CHECK_THROWS_WITH(position_servo<>({.gain = 0}, 1e-3),
                      "position_servo.gain = 0: must be finite and above 0");
    CHECK_THROWS_WITH(velocity_loop<>({.gain = -1}, 1e-3),
                      "velocity_loop.gain = -1: must be finite and not below 0");
    CHECK_THROWS_WITH(position_loop<>({.gain = 1, .velocity = {.limit = 0}}, 1e-3),
                      "velocity_loop.limit = 0: must be above 0 (infinite: no limit)");
}
TEST_CASE("drives: a step that no clock has is refused by name") {
    CHECK_THROWS_WITH(position_servo<>({}, 0), "position_servo.step = 0: must be finite and above 0");
    CHECK_THROWS_WITH(velocity_loop<>({.gain = 1}, -1e-3),
                      "velocity_loop.step = -0.001: must be finite and above 0");
    CHECK_THROWS_WITH(position_loop<>({.gain = 1}, std::numeric_limits<double>::infinity()),
                      "position_loop.step = inf: must be finite and above 0");
}
TEST_CASE("drives: four abreast in lanes are four alone, to the last bit") {
    using four = lanes<4>;
    const double h = 1e-3;
    typename position_loop<four>::parameters p;
    typename position_servo<four>::parameters q;
    for (std::size_t i = 0; i < 4; ++i) {
        const auto n = static_cast<double>(i + 1);
        set_lane(p.gain, i, 10 * n);
        set_lane(p.velocity.gain, i, 50 * n);
        set_lane(p.velocity.integral, i, 200 * n);
        set_lane(p.velocity.filter_Hz, i, 40 * n);
        set_lane(p.velocity.limit, i, 3 * n);
        set_lane(q.gain, i, n);
        set_lane(q.rate, i, 0.2 * n);
    }
    const position_loop<four> loop(p, four(h));
    const position_servo<four> servo(q, four(h));
    position_loop<four>::state s;
    auto t = position_servo<four>::state::at(four(0.0));
    std::array<std::vector<double>, 4> forces, duties;
    const auto asked = [&](int k) { return 0.05 * std::sin(0.1 * k); };
    for (int k = 0; k < 200; ++k) {
        const auto f = loop(s, four(asked(k)), four(0.0), four(0.01), four(0.002 * k)).each();
        const auto d = servo(t, four(asked(k)), four(0.01)).each();
        for (std::size_t i = 0; i < 4; ++i) {
            forces[i].push_back(f[i]);
            duties[i].push_back(d[i]);
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const position_loop<> alone({.gain = lane(p.gain, i),
                                     .velocity = {.gain = lane(p.velocity.gain, i),
                                                  .integral = lane(p.velocity.integral, i),
                                                  .filter_Hz = lane(p.velocity.filter_Hz, i),
                                                  .limit = lane(p.velocity.limit, i)}},
                                    h);
        const position_servo<> one({.gain = lane(q.gain, i), .rate = lane(q.rate, i)}, h);
        position_loop<>::state own;
        auto follower = position_servo<>::state::at(0);
        for (int k = 0; k < 200; ++k) {
            CHECK(alone(own, asked(k), 0, 0.01, 0.002 * k) == forces[i][static_cast<std::size_t>(k)]);
            CHECK(one(follower, asked(k), 0.01) == duties[i][static_cast<std::size_t>(k)]);
        }
    }
}
