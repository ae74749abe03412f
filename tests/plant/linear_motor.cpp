// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/friction/asymmetric_stribeck.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using motor = linear_motor<>;
using sticking_motor = linear_motor<stribeck<>>;
const auto Ts = 500_us;
constexpr double T = 500e-6;
const auto kf = 1450_N / 1_V;

/// The thesis' x axis; Coulomb friction alone, and with a level that falls.
const motor::parameters x_axis{
    .mass = 340_kg, .force_constant = kf, .friction = {.coulomb = 122_N, .viscous = 850_N / 1_mps}};
const sticking_motor::parameters sticking_axis{
    .mass = 340_kg,
    .force_constant = kf,
    .friction = {
        .coulomb = 122_N, .static_level = 177_N, .stribeck_velocity = 2.2_mmps, .viscous = 850_N / 1_mps}};
/// One kilogram, one newton per volt, nothing else: a double integrator.
motor::parameters integrator(duration delay = 0_s) {
    return {.mass = 1_kg, .force_constant = 1_N / 1_V, .friction = {}, .delay = delay};
}

auto volts(double u) { return quantity<si::electric_potential>::from_value(u); }
auto newtons(double f) { return quantity<si::force>::from_value(f); }
auto metres(double x) { return quantity<si::length>::from_value(x); }
constexpr double bad_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
} // namespace

TEST_CASE("linear_motor: free motion is the exponential, for 0.4 s at 0.3 V, v to 0.012 mm/s and x to 4 um") {
    // An implicit step of h is late by h/2 in the decay: at most h/(2 tau e) of the final 512 mm/s, 0.0118
    // mm/s.
    auto p = x_axis;
    p.friction.coulomb = 0_N;
    motor m{p, Ts};
    const double f = 0.3 * 1450, tau = 340.0 / 850;
    for (int k = 1; k <= 800; ++k) {
        m(0.3_V);
        const double t = k * T, rise = 1 - std::exp(-t / tau), v = f / 850 * rise;
        const double x = f / 850 * (t - tau * rise);
        CHECK(std::abs(m.now().v.value() - v) < 1.2e-5);
        CHECK(std::abs(m.now().x.value() - x) < 4e-6);
    }
    CHECK(m.now().v > 300_mmps);
}
TEST_CASE("linear_motor: 0.3 V for half a second, then nothing: stops when and where the closed form says, to "
          "1 ms and 10 um") {
    // v' = -(Fc + b v)/M: rests after (M/b) ln(1 + b v0/Fc), having gone (M/b)(v0 - (Fc/b) ln(1 + b v0/Fc))
    for (const std::size_t substeps : {1u, 10u}) {
        auto p = x_axis;
        p.substeps = substeps;
        motor m{p, Ts};
        for (int k = 0; k < 1000; ++k) m(0.3_V);
        const double v0 = m.now().v.value(), x0 = m.now().x.value();
        REQUIRE(v0 > 0.25);
        const double log = std::log(1 + 850 * v0 / 122), time = 0.4 * log, way = 0.4 * (v0 - 122.0 / 850 * log);
        int samples = 0;
        double before = v0;
        while (m.now().v.value() != 0 && samples < 10000) {
            m(0_V);
            ++samples;
            CHECK(m.now().v.value() >= 0); // does not swing through
            CHECK(m.now().v.value() < before);
            before = m.now().v.value();
        }
        CHECK(std::abs(samples * T - time) < (substeps == 1 ? 2e-3 : 1e-3));
        CHECK(std::abs(m.now().x.value() - x0 - way) < (substeps == 1 ? 50e-6 : 10e-6));
        const auto rest = m.now().x;
        for (int k = 0; k < 1000; ++k) {
            m(0_V);
            CHECK(m.now().v == 0_mps);
            CHECK(m.now().x == rest);
        }
    }
}
TEST_CASE("linear_motor: a resting axis below breakaway does not move by one bit in 10 s") {
    sticking_motor m{sticking_axis, Ts};
    m.settle(12.3456789_mm);
    const auto rest = m.now().x;
    bool still = true;
    for (int k = 0; k < 20000; ++k) {
        m(volts(0.999 * 177 / 1450)); // above the slip level all the time
        still = still && m.now().x == rest && m.now().v == 0_mps;
    }
    for (int k = 0; k < 20000; ++k) { // and pulled to and fro, with a disturbance on top
        m(volts((k % 2 == 0 ? 0.6 : -0.6) * 177 / 1450), newtons((k % 3 == 0 ? 0.39 : -0.39) * 177));
        still = still && m.now().x == rest && m.now().v == 0_mps;
    }
    CHECK(still);
}
TEST_CASE("linear_motor: above breakaway it starts, and then goes on below breakaway but above slip") {
    sticking_motor m{sticking_axis, Ts};
    m(volts(1.01 * 177 / 1450));
    CHECK(m.now().v > 0_mps);
    for (int k = 0; k < 400; ++k) m(volts(1.01 * 177 / 1450));
    CHECK(m.now().v > 10_mmps);
    for (int k = 0; k < 8000; ++k) m(volts(150.0 / 1450));                 // ten time constants
    CHECK(m.now().v.value() == doctest::Approx(28.0 / 850).epsilon(1e-4)); // (150 - 122)/b, 33 mm/s
    m.settle(m.now().x);
    m(volts(150.0 / 1450));
    CHECK(m.now().v == 0_mps); // the same force does not start it
}
TEST_CASE("linear_motor: reversed by a constant force it passes through rest once") {
    sticking_motor m{sticking_axis, Ts};
    for (int k = 0; k < 500; ++k) m(0.3_V);
    REQUIRE(m.now().v > 50_mmps);
    int changes = 0;
    auto before = m.now().v;
    for (int k = 0; k < 1000; ++k) {
        m(-0.3_V);
        CHECK(m.now().v <= before);
        changes += (before > 0_mps) != (m.now().v > 0_mps);
        before = m.now().v;
    }
    CHECK(changes == 1);
    CHECK(m.now().v < -50_mmps);
}
TEST_CASE("linear_motor: without drive the energy of the axis never grows, at any sub-step") {
    for (const std::size_t substeps : {1u, 3u, 10u}) {
        auto p = sticking_axis;
        p.substeps = substeps;
        sticking_motor m{p, Ts};
        for (int k = 0; k < 300; ++k) m(0.5_V);
        double before = m.now().v.value();
        for (int k = 0; k < 3000; ++k) {
            m(0_V);
            CHECK(std::abs(m.now().v.value()) <= before);
            before = std::abs(m.now().v.value());
        }
        CHECK(before == 0);
    }
}
TEST_CASE(
    "linear_motor: the error of the sub-steps is of first order: 1, 10 and 100 in the ratio of their lengths") {
    const auto position = [](std::size_t substeps, auto command, duration delay) {
        auto p = sticking_axis;
        p.substeps = substeps;
        p.delay = delay;
        sticking_motor m{p, Ts};
        for (int k = 0; k < 1000; ++k) m(volts(command(2 * 3.141592653589793 * 3 * k * T)));
        return m.now().x.value();
    };
    SUBCASE("in motion: less than 20 um of 60 mm for one sub-step, and the ratio to 5 %") {
        const auto forwards = [](double wt) { return 0.25 + 0.05 * std::sin(wt); };
        const double exact = position(1000, forwards, 1_ms),
                     one = std::abs(position(1, forwards, 1_ms) - exact),
                     ten = std::abs(position(10, forwards, 1_ms) - exact),
                     hundred = std::abs(position(100, forwards, 1_ms) - exact);
        CHECK(exact > 60e-3);
        CHECK(one < 20e-6);
        CHECK(one / ten == doctest::Approx((1 - 1e-3) / (0.1 - 1e-3)).epsilon(0.05));
        CHECK(ten / hundred == doctest::Approx((0.1 - 1e-3) / (0.01 - 1e-3)).epsilon(0.05));
    }
    SUBCASE("with stops, sticks and reversals, of which a sub-step misses up to its length: 20, 2 and 0.4 um") {
        const auto to_and_fro = [](double wt) { return 0.6 * std::sin(wt); };
        const double exact = position(1000, to_and_fro, 0.37_ms);
        CHECK(exact > 20e-3);
        CHECK(std::abs(position(1, to_and_fro, 0.37_ms) - exact) < 20e-6);
        CHECK(std::abs(position(10, to_and_fro, 0.37_ms) - exact) < 2e-6);
        CHECK(std::abs(position(100, to_and_fro, 0.37_ms) - exact) < 0.4e-6);
    }
}
TEST_CASE("linear_motor: a pulse of one period arrives after the delay, whole, part or none; position exact to "
          "rounding") {
    // 1 V for T on 1 kg: v = F T/M from delay + T on, and x(t) = F T/M (t - delay - T/2)
    for (const double delay : {0.0, 0.5e-3, 1e-3, 15.5e-3, 0.2e-3, 0.437e-3, 0.63e-3, 7.777e-3})
        for (const std::size_t substeps : {1u, 7u, 10u}) {
            CAPTURE(delay);
            CAPTURE(substeps);
            auto p = integrator(duration::from_value(delay));
            p.substeps = substeps;
            motor m{p, Ts};
            for (int k = 0; k < 60; ++k) {
                m(k == 0 ? 1_V : 0_V);
                const double t = (k + 1) * T;
                if (t <= delay)
                    CHECK(m.now().x == 0_m);
                else if (t >= delay + T)
                    CHECK(m.now().x.value() == doctest::Approx(T * (t - delay - T / 2)).epsilon(1e-12));
                else // while the command changes: velocity exact, position within the sub-step of the change
                    CHECK(m.now().v.value() == doctest::Approx(t - delay).epsilon(1e-9));
            }
            CHECK(m.now().v.value() == doctest::Approx(T).epsilon(1e-14));
        }
}
TEST_CASE("linear_motor: a delay of a fraction on a border of the sub-steps is exact during the pulse, too") {
    motor m{integrator(0.2_ms), Ts}; // four of ten sub-steps
    m(1_V);
    CHECK(m.now().x.value() == doctest::Approx(0.5 * 0.3e-3 * 0.3e-3).epsilon(1e-12));
    m(0_V);
    CHECK(m.now().x.value() == doctest::Approx(T * (1e-3 - 0.2e-3 - T / 2)).epsilon(1e-12));
}
TEST_CASE("linear_motor: each command is held for one period, no more, no less") {
    motor m{integrator(1_ms), Ts};
    const auto u = [](int k) { return k < 0 ? 0.0 : std::sin(0.7 * k) + 0.2 * (k % 5); };
    double v = 0, x = 0; // the double integrator, sample by sample
    for (int k = 0; k < 500; ++k) {
        m(volts(u(k)));
        const double a = u(k - 2);
        x += v * T + 0.5 * a * T * T;
        v += a * T;
        CHECK(m.now().v.value() == doctest::Approx(v).epsilon(1e-12));
        CHECK(m.now().x.value() == doctest::Approx(x).epsilon(1e-12));
    }
}
TEST_CASE("linear_motor: the reading is that of the next sample: 1 V on 1 kg is 0.125 um after 500 us") {
    motor m{integrator(), Ts};
    CHECK(m(1_V).value() == doctest::Approx(0.125e-6).epsilon(1e-12));
}
TEST_CASE(
    "linear_motor: positive force moves it forwards; an external force is not delayed and needs no amplifier") {
    auto p = x_axis;
    p.delay = 10_ms;
    p.limit = 0.01_V;
    motor late{p, Ts}, direct{x_axis, Ts};
    for (int k = 0; k < 200; ++k) {
        late(0_V, 435_N);
        direct(volts(0.3));
        CHECK(late.now().v.value() == doctest::Approx(direct.now().v.value()).epsilon(1e-12));
    }
    CHECK(late.now().x > 0_m);
    motor held{x_axis, Ts};
    held(0.3_V, -400_N); // 435 - 400 N: held
    CHECK(held.now().x == 0_m);
    held(0_V, -123_N);
    CHECK(held.now().x < 0_m);
}
TEST_CASE("linear_motor: commands beyond the limit are clipped, on both sides, and told") {
    auto p = integrator();
    p.limit = 10_V;
    motor m{p, Ts};
    m(10_V);
    CHECK_FALSE(m.limited());
    m(12_V);
    CHECK(m.limited());
    CHECK(m.now().v.value() == doctest::Approx(20 * T).epsilon(1e-12));
    m(-1e300 * 1_V);
    CHECK(m.limited());
    CHECK(m.now().v.value() == doctest::Approx(10 * T).epsilon(1e-12));
    m(-10_V);
    CHECK_FALSE(m.limited());
    motor free{integrator(), Ts};
    free(1000_V); // limit 0: none
    CHECK_FALSE(free.limited());
    CHECK(free.now().v.value() == doctest::Approx(1000 * T).epsilon(1e-12));
}
TEST_CASE("linear_motor: the DAC rounds to its steps, halves away from zero, behind the limit") {
    auto p = integrator();
    p.dac_step = 0.25_V;
    p.limit = 1.1_V;
    const auto acting = [&](double u) {
        motor m{p, Ts};
        m(volts(u));
        return m.now().v.value() / T;
    };
    CHECK(acting(0.12) == 0);
    CHECK(acting(0.125) == doctest::Approx(0.25).epsilon(1e-12));
    CHECK(acting(-0.125) == doctest::Approx(-0.25).epsilon(1e-12));
    CHECK(acting(0.37) == doctest::Approx(0.25).epsilon(1e-12));
    CHECK(acting(0.38) == doctest::Approx(0.5).epsilon(1e-12));
    CHECK(acting(5) == doctest::Approx(1).epsilon(1e-12)); // 1.1 V is clipped first, then 1 V is nearest
}
TEST_CASE("linear_motor: the encoder counts quarter micrometres, the axis does not") {
    auto p = x_axis;
    p.encoder_step = 250_nm;
    motor coarse{p, Ts}, fine{x_axis, Ts};
    int between = 0;
    for (int k = 0; k < 500; ++k) {
        const double reading = coarse(0.12_V).value(), x = fine(0.12_V).value();
        CHECK(coarse.now().x == fine.now().x); // rounding is of the reading alone
        CHECK(std::abs(reading - x) <= 0.125e-6 * (1 + 1e-9));
        CHECK(std::abs(reading / 250e-9 - std::round(reading / 250e-9)) < 1e-6);
        between += std::abs(reading - x) > 0.05e-6;
    }
    CHECK(between > 100);
    coarse.settle(0.375_um); // 1.5 counts
    CHECK(coarse(0_V).value() == doctest::Approx(0.5e-6).scale(0));
    coarse.settle(-0.375_um);
    CHECK(coarse(0_V).value() == doctest::Approx(-0.5e-6).scale(0));
}
TEST_CASE("linear_motor: settle leaves it at rest with no command pending; reset at zero") {
    auto p = x_axis;
    p.delay = 3.3_ms;
    p.limit = 1_V;
    motor m{p, Ts}, fresh{p, Ts};
    for (int k = 0; k < 100; ++k) m(2_V);
    CHECK(m.limited());
    m.settle(5_mm);
    CHECK_FALSE(m.limited());
    for (int k = 0; k < 20; ++k) CHECK(m(0_V) == 5_mm);
    for (int k = 0; k < 100; ++k) m(0.8_V);
    m.reset();
    for (int k = 0; k < 100; ++k) CHECK(m(0.8_V) == fresh(0.8_V));
}
TEST_CASE("linear_motor: a bad command or force gives the last reading, moves nothing, and is told until reset "
          "or settle") {
    auto p = x_axis;
    p.delay = 0.7_ms;
    p.limit = 1_V;
    for (const double bad : {bad_number, infinite, -infinite})
        for (const bool in_force : {false, true}) {
            motor m{p, Ts};
            for (int k = 0; k < 100; ++k) m(0.5_V);
            const auto last = m(2_V);
            auto twin = m;
            CHECK((in_force ? m(0.5_V, newtons(bad)) : m(volts(bad))) == last);
            CHECK(m.faulted());
            CHECK(m.limited());
            for (int k = 0; k < 100; ++k) CHECK(m(0.1_V) == twin(0.1_V));
            CHECK(m.faulted());
            CHECK_FALSE(twin.faulted());
            m.settle(1_mm);
            CHECK_FALSE(m.faulted());
            m.settle(metres(bad));
            CHECK(m.faulted());
            CHECK(m(0_V) == 1_mm);
            m.reset();
            CHECK_FALSE(m.faulted());
        }
}
TEST_CASE("linear_motor: a motion beyond all numbers is a fault, and the axis stays usable where it was") {
    auto p = x_axis;
    p.delay = 0.7_ms;
    motor m{p, Ts};
    for (int k = 0; k < 100; ++k) m(volts(0.4 + 1e-3 * k));
    const auto last = m(0.5_V);
    auto twin = m;
    CHECK(m(0_V, newtons(std::numeric_limits<double>::max())) == last); // 1e308 N
    CHECK(m.faulted());
    CHECK(m.now().past == twin.now().past);
    for (int k = 0; k < 100; ++k) CHECK(m(0.3_V) == twin(0.3_V));
}
TEST_CASE("linear_motor: copies are independent") {
    motor m{x_axis, Ts};
    for (int k = 0; k < 100; ++k) m(0.5_V);
    motor copy = m;
    for (int k = 0; k < 100; ++k) copy(-0.5_V);
    motor again = m;
    CHECK(m.now().x != copy.now().x);
    for (int k = 0; k < 100; ++k) CHECK(m(0.2_V) == again(0.2_V));
}
TEST_CASE("linear_motor: in float it follows double to 1 um over 10 mm") {
    using rough_motor = linear_motor<coulomb_viscous<signal::velocity, signal::force, float>, 32, float>;
    rough_motor::parameters p{
        .mass = 340_kg, .force_constant = kf, .friction = {122_N, 850_N / 1_mps}, .delay = 0.4_ms};
    rough_motor rough{p, Ts};
    auto q = x_axis;
    q.delay = 0.4_ms;
    motor exact{q, Ts};
    double worst = 0;
    for (int k = 0; k < 500; ++k) {
        const float u = static_cast<float>(0.2 + 0.3 * std::sin(0.02 * k));
        const float x = rough(quantity_of<signal::voltage, float>::from_value(u)).value();
        worst = std::max(worst, std::abs(double(x) - exact(volts(double(u))).value()));
    }
    CHECK(std::abs(exact.now().x.value()) > 10e-3);
    CHECK(worst < 1e-6);
    static_assert(maps<rough_motor, signal::voltage, signal::position>);
}
TEST_CASE("linear_motor: with duals the end position moves with mass, viscous, coulomb, delay as a difference "
          "quotient says") {
    // Starts, stops, sticks and goes back. Central difference at 1e-5: 1e-6 of the largest influence.
    constexpr std::array given{340.0, 850.0, 122.0, 0.41e-3};
    const auto end = []<class Real>(const std::array<Real, 4>& with) {
        using machine = linear_motor<coulomb_viscous<signal::velocity, signal::force, Real>, 32, Real>;
        typename machine::parameters p;
        p.mass = decltype(p.mass)::from_value(with[0]);
        p.force_constant = decltype(p.force_constant)::from_value(Real(1450));
        p.friction.viscous = decltype(p.friction.viscous)::from_value(with[1]);
        p.friction.coulomb = decltype(p.friction.coulomb)::from_value(with[2]);
        p.delay = decltype(p.delay)::from_value(with[3]);
        machine m{p, Ts};
        for (int k = 0; k < 600; ++k)
            m(quantity_of<signal::voltage, Real>::from_value(Real(k < 100 ? 0.4 : k < 350 ? 0.0 : -0.3)));
        return m.now().x.value();
    };
    using D = dual<4>;
    const D x = end(std::array{D::variable(given[0], 0), D::variable(given[1], 1), D::variable(given[2], 2),
                               D::variable(given[3], 3)});
    CHECK(x.value == end(given));
    for (std::size_t i = 0; i < given.size(); ++i) {
        CAPTURE(i);
        auto up = given, down = given;
        up[i] *= 1 + 1e-5, down[i] *= 1 - 1e-5;
        const double quotient = (end(up) - end(down)) / 2e-5; // per relative change: metres
        CHECK(std::abs(quotient) > 1e-6);
        CHECK(x.partial[i] * given[i] == doctest::Approx(quotient).epsilon(1e-6).scale(0));
    }
}
TEST_CASE("linear_motor: refuses what no machine has, in the name of the box that minds") {
    const auto message = [](auto change, duration period = Ts) {
        auto p = x_axis;
        change(p);
        try {
            motor{p, period};
        } catch (const invalid_parameter& e) {
            return std::string(e.what());
        }
        return std::string("taken");
    };
    using P = motor::parameters;
    const auto nothing = [](P&) {};
    CHECK(message([](P& p) { p.mass = 0_kg; }) == "linear_motor.mass = 0 kg: must be finite and above 0");
    CHECK(message([](P& p) { p.force_constant = -1.0 * kf; }) ==
          "linear_motor.force_constant = -1450 N/V: must be finite and above 0");
    CHECK(message([](P& p) { p.friction.coulomb = -1_N; }) ==
          "coulomb_viscous.coulomb = -1 N: must be finite and not below 0");
    CHECK(message([](P& p) { p.delay = -1_s; }) == "linear_motor.delay = -1 s: must be finite and not below 0");
    CHECK(message([](P& p) { p.delay = 16_ms; }) ==
          "linear_motor.delay = 0.016 s: must not be beyond the capacity (31 periods)");
    CHECK(message([](P& p) { p.delay = 15.5_ms; }) == "taken");
    CHECK(message([](P& p) { p.limit = -1_V; }) == "linear_motor.limit = -1 V: must be finite and not below 0");
    CHECK(message([](P& p) { p.dac_step = -1_V; }) ==
          "linear_motor.dac_step = -1 V: must be finite and not below 0");
    CHECK(message([](P& p) { p.encoder_step = -1_m; }) ==
          "linear_motor.encoder_step = -1 m: must be finite and not below 0");
    CHECK(message([](P& p) { p.substeps = 0; }) == "linear_motor.substeps = 0: must lie between 1 and 1000");
    CHECK(message([](P& p) { p.substeps = 1001; }) ==
          "linear_motor.substeps = 1001: must lie between 1 and 1000");
    CHECK(message([](P& p) { p.mass = bad_number * 1_kg; }) ==
          "linear_motor.mass = nan kg: must be finite and above 0");
    CHECK(message(nothing, 0_s) == "linear_motor.period = 0 s: must be finite and above 0");
}

TEST_CASE("linear_motor: on a friction by direction a resting axis is held by one level forward and by another "
          "backward, and goes on at one speed forward and at another backward") {
    using law = asymmetric_stribeck<signal::velocity, signal::force>;
    using two_sided = linear_motor<law>;
    const law::parameters friction{
        {170_N, 120_N, 2_mmps, 2_mmps}, {110_N, 80_N, 3_mmps, 5_mmps}, 950_N / 1_mps};
    const two_sided::parameters p{.mass = 340_kg, .force_constant = 1000_N / 1_V, .friction = friction};
    const auto after_2_s = [&](double newtons) {
        two_sided m{p, 500_us};
        for (int k = 0; k < 4000; ++k) m(quantity<si::electric_potential>::from_value(newtons / 1000));
        return m.now().v.value();
    };
    CHECK(after_2_s(169.9) == 0);
    CHECK(after_2_s(170.1) > 0);
    CHECK(after_2_s(-109.9) == 0);
    CHECK(after_2_s(-110.1) < 0);
    // 300 N in the end: what friction leaves over is carried by the viscous part; the levels have built up by
    // then.
    const double settled = 1 - std::exp(-2 * 950.0 / 340);
    CHECK(after_2_s(300) == doctest::Approx((300 - 120) / 950.0 * settled).epsilon(2e-3));
    CHECK(after_2_s(-300) == doctest::Approx(-(300 - 80) / 950.0 * settled).epsilon(2e-3));
}
