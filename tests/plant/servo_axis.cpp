// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include <doctest/doctest.h>
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/flexible_modes.hpp>
#include <quadrant/plant/servo_axis.hpp>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using axis = servo_axis<>;
constexpr double step = 2.5e-4;

axis::parameters plain_axis() {
    axis::parameters p;
    p.mass = 100;
    p.force_constant = 50;
    p.friction.viscous = 200_N / 1_mps;
    return p;
}
/// Everything at once, at sizes of a machine tool.
axis::parameters full_axis() {
    axis::parameters p = plain_axis();
    p.dead_zone = 0.02;
    p.limit = 8;
    p.lag = 0.6_ms;
    p.ripple.period = 0.024;
    p.ripple.sine[0] = 0.03;
    p.constant = 4;
    p.spring = 300;
    p.gravity = 9;
    p.gravity_phase = 0.4;
    p.load_friction = 0.15;
    p.coupling = 0.02;
    p.cogging.period = 0.032;
    p.cogging.cosine = {3, 0, 1};
    p.cogging.sine[1] = 2;
    p.process.period = 1 / 83.0;
    p.process.sine[0] = 20;
    p.process_mean = 1;
    p.friction.level = 20_N;
    p.friction.excess = 8_N;
    p.friction.stribeck_velocity = 3_mm / 1_s;
    p.friction.asymmetry = 0.1;
    p.friction.weights[0] = 1;
    p.friction.stiffness[0] = gain_of<signal::force, signal::position>::from_value(2e7);
    p.friction.give[0] = quantity_of<signal::position>::from_value(1e-6);
    p.along.period = 0.1;
    p.along.sine[0] = 0.2;
    p.drift = -0.2;
    p.drift_time = 3;
    p.second.mass = quantity<si::mass>::from_value(15);
    p.second.centre = 60_Hz;
    p.second.damping = 0.03;
    p.play = 8e-6;
    p.cyclic.period = 4e-6;
    p.cyclic.sine[0] = 1e-7;
    return p;
}
double command(int k) { return 3 * std::sin(2e-3 * k) + 0.8 * std::sin(0.11 * k); }
double run(const axis::parameters& p, int rows = 20000) {
    const axis plant(p, step);
    auto s = axis::state::at(0);
    double sum = 0;
    for (int k = 0; k < rows; ++k) {
        plant.advance(s, command(k), {.time = k * step, .other_acceleration = std::cos(3e-3 * k)});
        sum += plant.reading(s) * plant.reading(s);
    }
    return std::sqrt(sum / rows);
}
} // namespace

TEST_CASE("servo_axis: every joint at its neutral value, and at 1e-9 of its size, is the axis without it") {
    const double without = run(plain_axis());
    const axis::parameters full = full_axis();
    const auto small = [&](auto put) {
        axis::parameters p = plain_axis();
        put(p, full, 1e-9);
        CHECK(run(p) == doctest::Approx(without).epsilon(1e-7));
        p = plain_axis();
        put(p, full, 0);
        CHECK(run(p) == doctest::Approx(without).epsilon(1e-14));
        p = plain_axis();
        put(p, full, 1);
        CHECK(run(p) != doctest::Approx(without).epsilon(1e-12)); // it does something at its size
    };
    small([](auto& p, auto& f, double by) { p.dead_zone = by * f.dead_zone; });
    small([](auto& p, auto& f, double by) { p.lag = by * f.lag; });
    small([](auto& p, auto& f, double by) { p.ripple = f.ripple, p.ripple.sine[0] *= by; });
    small([](auto& p, auto& f, double by) { p.constant = by * f.constant; });
    small([](auto& p, auto& f, double by) { p.spring = by * f.spring; });
    small([](auto& p, auto& f, double by) { p.gravity = by * f.gravity, p.gravity_phase = f.gravity_phase; });
    small([](auto& p, auto& f, double by) {
        p.load_friction = by * f.load_friction;
        p.friction.weights = f.friction.weights;
        p.friction.give = f.friction.give;
    });
    small([](auto& p, auto& f, double by) { p.coupling = by * f.coupling; });
    small([](auto& p, auto& f, double by) {
        p.cogging = f.cogging;
        for (double& c : p.cogging.cosine) c *= by;
        for (double& s : p.cogging.sine) s *= by;
    });
    small([](auto& p, auto& f, double by) { p.process = f.process, p.process.sine[0] *= by; });
    small([](auto& p, auto& f, double by) { p.process_mean = by * f.process_mean; });
    small([](auto& p, auto& f, double by) {
        p.friction.level = by * f.friction.level;
        p.friction.weights = f.friction.weights;
        p.friction.stiffness = f.friction.stiffness;
        for (auto& k : p.friction.stiffness) k *= by; // it gives way as far as before
    });
    small([](auto& p, auto& f, double by) { p.second = f.second, p.second.mass = by * f.second.mass; });
    small([](auto& p, auto& f, double by) { p.play = by * f.play; });
    small([](auto& p, auto& f, double by) { p.cyclic = f.cyclic, p.cyclic.sine[0] *= by; });
}

TEST_CASE(
    "servo_axis: the velocity of the load goes to the motor's as the play goes to zero, correction included") {
    axis::parameters p = plain_axis();
    p.play = 1e-9;
    const axis with(p, step), without(plain_axis(), step);
    auto a = axis::state::at(0), b = a;
    for (int k = 0; k < 2000; ++k) {
        with.advance(a, command(k), {});
        without.advance(b, command(k), {});
        a.shift(1e-6 * std::sin(0.3 * k), 1e-3 * std::cos(0.3 * k)); // an observer corrects both
        b.shift(1e-6 * std::sin(0.3 * k), 1e-3 * std::cos(0.3 * k));
        if (k > 0) // before, nothing has crossed the play
            REQUIRE(with.seen_velocity(a) == doctest::Approx(without.seen_velocity(b)).epsilon(1e-3));
    }
}

TEST_CASE("servo_axis: a second mass moves the reading as the mode of flexible_modes does") {
    axis::parameters p;
    p.mass = 100;
    p.force_constant = 1;
    p.second = {quantity<si::mass>::from_value(20), 50_Hz, 0.02};
    const double fine = 2e-5;
    const axis plant(p, fine);
    auto s = axis::state::at(0);
    // Two masses on a spring, both modes exact: the free one at centre sqrt(M / M1), share mass / M1
    // [docs/derivations].
    const double first = 80, whole = 100;
    flexible_modes<1> mode({.mass = quantity<si::mass>::from_value(whole),
                            .modes = {{{quantity<hertz_unit>::from_value(50 * std::sqrt(whole / first)),
                                        0.02 * std::sqrt(whole / first), 20 / first}}}},
                           duration::from_value(fine));
    double x = 0, v = 0, worst = 0, most = 0;
    for (int k = 0; k < 50000; ++k) {
        const double force = 30 * std::sin(2 * std::numbers::pi * 41 * k * fine);
        plant.advance(s, force, {});
        x += fine * (v + 0.5 * fine * force / whole);
        v += fine * force / whole;
        const double y = x + mode(quantity_of<signal::force>::from_value(force)).value();
        worst = std::max(worst, std::abs(plant.reading(s) - y));
        most = std::max(most, std::abs(y));
    }
    CHECK(worst < 2e-3 * most); // the acceleration is that of a whole step
}

TEST_CASE("servo_axis: pushed at random with every joint filled, it gives back less than it got") {
    std::mt19937 random(5);
    std::normal_distribution<double> draw;
    axis::parameters p = full_axis();
    p.process = {};
    p.process_mean = p.coupling = p.constant = 0;
    p.cogging = {};
    p.ripple = {};
    p.lag = 0_s;
    p.dead_zone = 0;
    p.limit = std::numeric_limits<double>::infinity();
    const axis plant(p, step);
    auto s = axis::state::at(0);
    double put_in = 0, u = 0, least = 0;
    for (int k = 0; k < 200000; ++k) {
        if (k % 20 == 0) u = draw(random);
        const double before = s.v;
        plant.advance(s, u, {.time = k * step, .other_acceleration = 0});
        put_in += 0.5 * (before + s.v) * step * p.force_constant * u;
        const double m2 = p.second.mass.value(), w0 = 2 * std::numbers::pi * p.second.centre.value();
        const double stored = 0.5 * (p.mass - m2) * s.v * s.v +
                              0.5 * m2 * (s.v + s.second.w) * (s.v + s.second.w) +
                              0.5 * m2 * w0 * w0 * s.second.q * s.second.q + 0.5 * p.spring * s.x * s.x +
                              p.gravity * (std::cos(p.gravity_phase) - std::cos(s.x - p.gravity_phase));
        least = std::min(least, put_in - stored);
    }
    CHECK(put_in > 0);
    CHECK(least > -0.01 * put_in);
}

TEST_CASE("servo_axis: lanes are axes of their own, neutral joints beside filled ones") {
    using four = lanes<4>;
    std::array<axis::parameters, 4> each{plain_axis(), full_axis(), full_axis(), plain_axis()};
    each[2].play = 0;
    each[2].second.mass = {};
    each[1].friction.shape = 1.7;
    each[2].friction.excess = 0_N;
    each[3].friction.level = 10_N;
    for (std::size_t i = 0; i < 4; ++i) { // presliding friction of four springs with a finite attraction
        each[3].friction.weights[i] = 0.25;
        each[3].friction.stiffness[i] =
            gain_of<signal::force, signal::position>::from_value(1e6 / std::pow(3.0, static_cast<double>(i)));
    }
    each[3].friction.attraction = quantity<unit_quotient<si::force, si::time>>::from_value(500);
    using axes = servo_axis<four>;
    const axes together(axes::side_by_side(
                            4, [&](std::size_t i) -> const auto& { return each[i]; }),
                        four(step));
    auto s = axes::state::at(four(0));
    std::vector<axis> alone;
    std::vector<axis::state> t(4, axis::state::at(0));
    for (const auto& p : each) alone.emplace_back(p, step);
    for (int k = 0; k < 20000; ++k) {
        together.advance(s, four(command(k)), {.time = four(k * step), .other_acceleration = four(0.5)});
        for (std::size_t i = 0; i < 4; ++i) {
            alone[i].advance(t[i], command(k), {.time = k * step, .other_acceleration = 0.5});
            REQUIRE(together.reading(s)[i] ==
                    doctest::Approx(alone[i].reading(t[i])).epsilon(1e-9)); // sines and exponentials are others
        }
    }
}

TEST_CASE("servo_axis: what no axis has is refused by name") {
    auto p = plain_axis();
    p.mass = 0;
    CHECK_THROWS_WITH(axis(p, step), "servo_axis.mass = 0: must be finite and above 0");
    p = full_axis();
    p.second.mass = quantity<si::mass>::from_value(200);
    CHECK_THROWS_WITH(axis(p, step),
                      "servo_axis.second.mass = 200 kg: must lie below the mass, of which it is a part (100)");
    p = full_axis();
    p.play = -1e-6;
    CHECK_THROWS_WITH(axis(p, step), "servo_axis.play = -1e-06: must be finite and not below 0");
    CHECK_THROWS_WITH(axis(plain_axis(), 0), "servo_axis.step = 0: must be finite and above 0");
}

TEST_CASE("servo_axis: a weight that hangs swings about its phase with the period of a pendulum") {
    axis::parameters p;
    p.mass = 0.2;
    p.gravity = 3;
    p.gravity_phase = 0.5;
    const double fine = 1e-4;
    const axis arm(p, fine);
    auto s = axis::state::at(0.51);
    int turns = 0;
    double last = 0, before = s.x;
    for (int k = 1; turns < 10; ++k) {
        arm.advance(s, 0, {});
        if (before > 0.5 && s.x <= 0.5) ++turns, last = k * fine;
        before = s.x;
    }
    CHECK(last / 9.25 == // let go at a quarter
          doctest::Approx(2 * std::numbers::pi * std::sqrt(p.mass / p.gravity)).epsilon(1e-3));
}

TEST_CASE("servo_axis: an arm in a gear that rubs is lifted by what carries weight, friction and the friction "
          "of both") {
    axis::parameters p;
    p.mass = 0.2;
    p.gravity = 3; // level at a quarter of a turn
    p.load_friction = 0.1;
    p.friction.level = 0.2_N;
    p.friction.weights[0] = 1;
    p.friction.stiffness[0] = gain_of<signal::force, signal::position>::from_value(0.2 / 1e-5);
    p.friction.give[0] = quantity_of<signal::position>::from_value(1e-5);
    const axis arm(p, step);
    const auto moved = [&](double torque) {
        auto s = axis::state::at(std::numbers::pi / 2);
        for (int k = 0; k < 1600; ++k) // slowly: a push at once would stretch the contact twice as far
            arm.advance(s, p.gravity + (torque - p.gravity) * std::min(1.0, k / 800.0), {});
        return s.x - std::numbers::pi / 2;
    };
    // It lifts where u = G + Fc + k (u + G), and sinks where u = G - Fc - k (u + G).
    const double lifts = (3 + 0.2 + 0.1 * 3) / 0.9, sinks = (3 - 0.2 - 0.1 * 3) / 1.1;
    CHECK(std::abs(moved(lifts - 0.02)) < 1e-4);
    CHECK(moved(lifts + 0.02) > 1e-4);
    CHECK(std::abs(moved(sinks + 0.02)) < 1e-4);
    CHECK(moved(sinks - 0.02) < -1e-4);
}
