// SPDX-License-Identifier: BSL-1.0
#include <doctest/doctest.h>
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/servo_axis.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using axis = servo_axis<>;
constexpr double step = 1e-4, play = 40e-6, mass = 100, motor = 30;

axis::parameters loose_axis() {
    axis::parameters p;
    p.mass = mass;
    p.force_constant = 1;
    p.play = play;
    p.motor_mass = motor;
    return p;
}
double momentum(const axis::state& s) { return motor * s.v + (mass - motor) * s.apart.w; }
double energy(const axis::state& s) { return (motor * s.v * s.v + (mass - motor) * s.apart.w * s.apart.w) / 2; }
} // namespace

TEST_CASE("play_between_masses: a load without friction coasts on when the motor brakes, and meets it at the "
          "other flank with the momentum of both") {
    const axis plant(loose_axis(), step);
    auto s = axis::state::at(0);
    for (int k = 0; k < 2000; ++k) plant.advance(s, 20, {}); // against the forward flank
    REQUIRE(s.apart.flank == 1);
    REQUIRE(s.x - s.load == doctest::Approx(play / 2).epsilon(1e-12));
    const double speed = s.v, before = momentum(s), force = 60;
    int crossed = 0;
    for (; s.apart.flank >= 0 && crossed < 10000; ++crossed) {
        plant.advance(s, -force, {});
        if (s.apart.flank == 0) REQUIRE(s.apart.w == speed); // nothing brakes the load
    }
    // The motor falls back by force t^2 / (2 m) against it.
    CHECK(crossed * step == doctest::Approx(std::sqrt(2 * play * motor / force)).epsilon(0.02));
    CHECK(momentum(s) == doctest::Approx(before - force * crossed * step).epsilon(1e-12));
    CHECK(s.v == doctest::Approx(s.apart.w).epsilon(1e-12));
    CHECK(s.load - s.x == doctest::Approx(play / 2).epsilon(1e-12));
}

TEST_CASE("play_between_masses: a load that friction holds waits while the motor alone crosses") {
    axis::parameters p = loose_axis();
    p.friction.level = 50_N;
    p.friction.weights[0] = 1;
    p.friction.stiffness[0] = gain_of<signal::force, signal::position>::from_value(5e8);
    p.motor_friction = 5;
    const axis plant(p, step);
    auto s = axis::state::at(0);
    for (int k = 0; k < 400; ++k) plant.advance(s, 70, {});
    for (int k = 0; k < 4000; ++k) plant.advance(s, 0, {}); // at rest on the forward flank
    REQUIRE(std::abs(s.v) < 1e-9);
    const double stood = plant.reading(s), force = 20;
    int crossed = 0;
    for (; crossed < 10000 && s.apart.flank >= 0; ++crossed) plant.advance(s, -force, {});
    CHECK(plant.reading(s) == doctest::Approx(stood).epsilon(1e-3)); // but for the last step
    CHECK(crossed * step == doctest::Approx(std::sqrt(2 * play * motor / (force - 5))).epsilon(0.02));
}

TEST_CASE("play_between_masses: forces keep the momentum, contact takes energy and never gives any") {
    const axis plant(loose_axis(), step);
    auto s = axis::state::at(0);
    std::mt19937_64 random{5};
    std::uniform_real_distribution<double> size(-300, 300);
    double given = 0;
    for (int k = 0; k < 40000; ++k) {
        const double force = k % 400 < 200 ? size(random) : 0, held = energy(s);
        given += step * force;
        plant.advance(s, force, {});
        REQUIRE(momentum(s) == doctest::Approx(given).epsilon(1e-9));
        REQUIRE(std::abs(s.x - s.load) <= play / 2 * (1 + 1e-9));
        if (force == 0) REQUIRE(energy(s) <= held * (1 + 1e-12));
    }
}

TEST_CASE("play_between_masses: with friction, drag and a spring no step adds energy either") {
    axis::parameters p = loose_axis();
    p.friction.level = 20_N;
    p.friction.viscous = 30_N / 1_mps;
    p.friction.weights[0] = 1;
    p.motor_friction = 6;
    const axis plant(p, step);
    auto s = axis::state::at(0);
    std::mt19937_64 random{6};
    std::uniform_real_distribution<double> size(-300, 300);
    for (int k = 0; k < 40000; ++k) {
        const double force = k % 400 < 200 ? size(random) : 0, held = energy(s);
        plant.advance(s, force, {});
        if (force == 0) REQUIRE(energy(s) <= held * (1 + 1e-12));
    }
}

TEST_CASE(
    "play_between_masses: cogging pushes the motor, a constant force the load, and friction that has drifted "
    "away brakes neither") {
    axis::parameters p = loose_axis();
    p.cogging.period = 1;
    p.cogging.cosine[0] = 12;
    const axis with_cogging(p, step);
    auto s = axis::state::at(0);
    with_cogging.advance(s, 0, {});
    CHECK(s.v == doctest::Approx(12 * step / motor));
    CHECK(s.apart.w == 0);
    p = loose_axis();
    p.constant = 12;
    const axis with_constant(p, step);
    s = axis::state::at(0);
    with_constant.advance(s, 0, {});
    CHECK(s.v == 0);
    CHECK(s.apart.w == doctest::Approx(12 * step / (mass - motor)));
    p = loose_axis();
    p.friction.level = 50_N;
    p.drift = -1;
    p.drift_time = 1e-3;
    const axis drifted(p, step);
    s = axis::state::at(0, 0.1);
    drifted.advance(s, 0, {.time = 1, .other_acceleration = 0});
    CHECK(s.apart.w == doctest::Approx(0.1));
}

TEST_CASE("play_between_masses: behind an encoder on the motor the reading is the motor's") {
    axis::parameters p = loose_axis();
    p.play = 0;
    p.play_behind = play;
    const axis plant(p, step), before(loose_axis(), step);
    auto s = axis::state::at(0), t = s;
    double apart = 0;
    for (int k = 0; k < 5000; ++k) {
        const double u = 40 * std::sin(0.02 * k);
        plant.advance(s, u, {});
        before.advance(t, u, {});
        REQUIRE(s.x == t.x); // one motion
        REQUIRE(plant.reading(s) == s.x);
        REQUIRE(before.reading(t) == t.load);
        REQUIRE(plant.seen_velocity(s) == s.v);
        REQUIRE(before.seen_velocity(t) == t.apart.w);
        apart = std::max(apart, std::abs(s.x - t.load));
    }
    CHECK(apart == doctest::Approx(play / 2));
}

TEST_CASE("play_between_masses: with the whole mass on the motor's side it is the play operator") {
    axis::parameters p = loose_axis();
    p.motor_mass = mass;
    axis::parameters plain = p;
    plain.motor_mass = std::numeric_limits<double>::infinity();
    const axis one(p, step), other(plain, step);
    auto s = axis::state::at(0), t = s;
    for (int k = 0; k < 5000; ++k) {
        one.advance(s, 40 * std::sin(0.02 * k), {});
        other.advance(t, 40 * std::sin(0.02 * k), {});
        REQUIRE(one.reading(s) == other.reading(t));
    }
}

TEST_CASE("play_between_masses: a lane moves as the axis alone, whatever stands beside it") {
    using four = servo_axis<lanes<4>>;
    std::array<axis::parameters, 4> each;
    each.fill(loose_axis());
    each[1].play = 0;
    each[1].play_behind = 2 * play;
    each[2].motor_mass = std::numeric_limits<double>::infinity();
    each[3].play = 0;
    for (auto& p : each) {
        p.friction.level = 8_N;
        p.friction.weights[0] = 1;
        p.friction.stiffness[0] = gain_of<signal::force, signal::position>::from_value(8e6);
        p.motor_friction = 3;
    }
    const four beside(four::side_by_side(
                          4, [&](std::size_t i) -> const auto& { return each[i]; }),
                      lanes<4>(step));
    auto s = four::state::at(lanes<4>(0));
    std::array<axis::state, 4> alone{};
    for (int k = 0; k < 3000; ++k) {
        const double u = 40 * std::sin(0.02 * k) + 15 * std::sin(0.11 * k);
        beside.advance(s, lanes<4>(u), {});
        const auto seen = beside.reading(s).each();
        for (std::size_t i = 0; i < 4; ++i) {
            const axis plant(each[i], step);
            plant.advance(alone[i], u, {});
            REQUIRE(seen[i] == plant.reading(alone[i]));
        }
    }
}

TEST_CASE("play_between_masses: refuses what no axis can have") {
    axis::parameters p = loose_axis();
    p.motor_mass = 0;
    CHECK_THROWS_WITH(axis(p, step), "play_between_masses.motor_mass = 0: must be above 0");
    p = loose_axis();
    p.motor_friction = -1;
    CHECK_THROWS_WITH(axis(p, step), "play_between_masses.motor_level = -1: must not be below 0");
    p = loose_axis();
    p.play_behind = -1e-6;
    CHECK_THROWS_WITH(axis(p, step), "servo_axis.play_behind = -1e-06: must be finite and not below 0");
}

TEST_CASE("play_between_masses: a command that is no number passes on, for the caller to see") {
    const axis plant(loose_axis(), step);
    auto s = axis::state::at(0);
    plant.advance(s, std::nan(""), {});
    CHECK(std::isnan(s.v));
}
