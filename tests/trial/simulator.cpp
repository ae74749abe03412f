// SPDX-License-Identifier: BSL-1.0
// Long: one simulator: a case for each of its parts.
#include "quadrant_gap/trial/loop.hpp"

#include <doctest/doctest.h>

#include <array>
#include <complex>

using namespace quadrant_gap::trial;

namespace {

constexpr double pi = std::numbers::pi, h = 2e-5;

/// Relative, also of what is small: doctest's Approx never asks for less than its epsilon of 1.
bool near(double value, double wanted, double relative) {
    return std::abs(value - wanted) <= relative * std::abs(wanted);
}

axis_truth free_mass() {
    axis_truth a;
    a.mechanics.mass = 50;
    a.actuator.force_constant = 100;
    a.controller.dac_bits = 0;
    return a;
}

/// Steady friction force at a velocity: the mass is held at it.
double steady_friction(const friction_truth& f, double v) {
    contact c(f, 50);
    double force = 0;
    for (int k = 0; k < 20000; ++k) force = c(v, h, slip_level(f, 0, v, 0));
    return force + viscous_force(f, v);
}

friction_truth every_law(int law) {
    friction_truth f;
    f.law = static_cast<contact_law>(law);
    f.coulomb = 80;
    f.length = 4e-6;
    f.exponent = 1.4;
    f.weights = {0.1, 0.2, 0.3, 0.15, 0.15, 0.1};
    f.ways = {0.3, 0.5, 0.9, 1.4, 2, 3};
    return f;
}

std::complex<double> at_frequency(const std::vector<double>& signal, double hertz, double period) {
    std::complex<double> sum;
    for (std::size_t k = 0; k < signal.size(); ++k)
        sum += signal[k] * std::polar(1.0, -2 * pi * hertz * static_cast<double>(k) * period);
    return sum;
}

} // namespace

TEST_CASE("trial's plant: a mass without friction on a spring keeps its energy") {
    axis_truth a = free_mass();
    a.mechanics.spring = 2000;
    mechanics body(a, 10);
    body.place(0.01, 0);
    const double energy = 0.5 * 2000 * 0.01 * 0.01;
    double period_ends = 0;
    for (int k = 0; k < 250000; ++k) { // five seconds: five periods and a bit
        const double before = body.position();
        body.step(0, k * h, h, 0);
        if (before < 0 && body.position() >= 0) period_ends = k * h;
        const double now =
            0.5 * 50 * body.velocity() * body.velocity() + 1000 * body.position() * body.position();
        REQUIRE(near(now, energy, 1e-3));
    }
    const double period = 2 * pi / std::sqrt(2000.0 / 50); // upward crossings: 3/4, 1 3/4, ... periods
    CHECK(near(period_ends, 4.75 * period, 1e-3));
}

TEST_CASE("trial's plant: the fine steps neither damp nor drive a mode of 140 Hz") {
    axis_truth a = free_mass();
    const double w = 2 * pi * 140;
    a.mechanics.spring = 50 * w * w;
    mechanics body(a, 10);
    body.place(1e-5, 0);
    const double energy = 0.5 * a.mechanics.spring * 1e-10;
    for (int k = 0; k < 50000; ++k) body.step(0, k * h, h, 0);
    const double now = 0.5 * 50 * body.velocity() * body.velocity() +
                       0.5 * a.mechanics.spring * body.position() * body.position();
    CHECK(near(now, energy, 0.02)); // 140 periods; a damping of 1e-4 would take 16 %
}

TEST_CASE("trial's friction: every law slips at the Coulomb level, and asymmetry, Stribeck and drift move it") {
    for (int law = 0; law < 4; ++law) {
        CAPTURE(law);
        friction_truth f = every_law(law);
        CHECK(near(steady_friction(f, 0.1), 80, 1e-6));
        CHECK(near(steady_friction(f, -0.1), -80, 1e-6));
        f.viscous = 200;
        f.coulomb_asymmetry = 0.25;
        CHECK(near(steady_friction(f, 0.1), 80 * 1.25 + 20, 1e-6));
        CHECK(near(steady_friction(f, -0.1), -80 * 0.75 - 20, 1e-6));
    }
    friction_truth f = every_law(0);
    f.level_at_rest = 120;
    f.stribeck_velocity = 0.004;
    CHECK(near(slip_level(f, 0, 0.004, 0), 80 + 40 * std::exp(-1.0), 1e-9));
    f.shape = stribeck_shape::lorentzian;
    CHECK(near(slip_level(f, 0, 0.004, 0), 100, 1e-9));
    f.drift = -0.3;
    f.drift_time = 4;
    CHECK(near(slip_level(f, 0, 1, 4), 80 * (1 - 0.3 * (1 - std::exp(-1.0))), 1e-3));
}

TEST_CASE("trial's friction: loaded for the first time, every law carries 63 % of its level at its length") {
    for (int law = 0; law < 4; ++law) {
        CAPTURE(law);
        friction_truth f = every_law(law);
        f.damping = 0;
        contact c(f, 50);
        double force = 0;
        for (int k = 0; k < 4000; ++k) force = c(4e-6 / 4000 / h, h, 80);
        CHECK(near(force, 80 * (1 - std::exp(-1.0)), 2e-3));
    }
}

TEST_CASE("trial's friction: a closed path in displacement costs work, whatever the law") {
    for (int law = 0; law < 4; ++law) {
        CAPTURE(law);
        friction_truth f = every_law(law);
        f.damping = 0;
        contact c(f, 50);
        double work = 0;
        for (int k = 0; k < 40000; ++k) { // four times there and back over 20 lengths
            const double v = 8e-5 / 5000 / h * ((k / 5000) % 2 == 0 ? 1 : -1);
            work += c(v, h, 80) * v * h;
        }
        CHECK(work > 0.7 * 80 * 8 * 8e-5);
        CHECK(work < 80 * 8 * 8e-5);
    }
}

TEST_CASE("trial's actuator: a command acts after the delay, to a fraction of a fine step") {
    actuator_truth a;
    a.delay = 0.00123456;
    actuator drive(a, 0.0005, dice(1));
    drive.command(0);
    double area = 0;
    for (int k = 0; k < 200; ++k) { // 4 ms; the step is given at 0.5 ms
        if (k == 25) drive.command(1);
        if (k > 25 && k % 25 == 0) drive.command(1);
        area += drive.acting(k * h, h) * h;
    }
    CHECK(near(area, 0.004 - 0.0005 - 0.00123456, 1e-6));
}

TEST_CASE("trial's actuator: lag, dead zone, drive limit and ripple as docs/formats.md has them") {
    actuator_truth a;
    a.lag = 0.002;
    actuator slow(a, 0.0005, dice(1));
    double last = 0;
    for (int k = 0; k < 100; ++k) {
        if (k % 25 == 0) slow.command(3);
        last = slow.acting(k * h, h);
    }
    CHECK(near(last, 3 * (1 - std::exp(-(99.5 * h) / 0.002)), 1e-4));

    a = {};
    a.dead_zone = 0.2;
    a.drive_limit = 4;
    a.force_constant = 100;
    a.ripple = {0.02, {0.1}, {0}};
    for (const auto& [given, acts] : {std::pair{0.1, 0.0}, {1.0, 0.8}, {-1.0, -0.8}, {9.0, 4.0}}) {
        actuator drive(a, 0.0005, dice(1));
        drive.command(given);
        CHECK(std::abs(drive.acting(0, h) - acts) < 1e-12);
    }
    CHECK(near(actuator(a, 0.0005, dice(1)).force(2, 0.005), 220, 1e-9));
}

TEST_CASE("trial's actuator: a lost sample keeps the command before it, as often as asked") {
    actuator_truth a;
    a.loss = 0.2;
    actuator drive(a, 0.0005, dice(3));
    int lost = 0;
    for (int k = 0; k < 5000; ++k) {
        drive.command(k);
        lost += drive.acting(k * 0.0005, h) < k - 0.5;
    }
    CHECK(near(lost, 1000, 0.1));
}

TEST_CASE("trial's mode: still at the anti-resonance, largest at the resonance above it") {
    axis_truth a = free_mass();
    a.mechanics.mode_mass = 10; // of 50
    a.mechanics.mode_frequency = 40;
    a.mechanics.mode_damping = 0.002;
    const auto swing = [&](double hertz) { // of the carrier, over what the whole mass would do
        mechanics body(a, 10);
        std::vector<double> x;
        for (int k = 0; k < 500000; ++k) {
            body.step(std::sin(2 * pi * hertz * k * h), k * h, h, 0);
            if (k >= 250000) x.push_back(body.acceleration());
        }
        return std::abs(at_frequency(x, hertz, h)) / (static_cast<double>(x.size()) / 2) * 50;
    };
    CHECK(near(swing(4), 1, 0.02));
    CHECK(swing(40) < 0.05);
    const double resonance = 40 * std::sqrt(50.0 / 40.0);
    CHECK(swing(resonance) > 10);
    CHECK(swing(resonance) > swing(resonance * 1.02));
    CHECK(swing(resonance) > swing(resonance * 0.98));
}

TEST_CASE("trial's backlash: the load rests until the play is crossed, and follows by half of it") {
    axis_truth a = free_mass();
    a.mechanics.backlash = 2e-4;
    mechanics body(a, 1);
    body.place(0, 0.01);
    double still_until = 0;
    for (int k = 0; k < 5000; ++k) {
        body.step(0, k * h, h, 0);
        if (body.seen() == 0) still_until = body.position();
    }
    CHECK(near(still_until, 1e-4, 0.01));
    CHECK(near(body.position() - body.seen(), 1e-4, 1e-6));
}

TEST_CASE("trial's loop: without friction the integral carries a constant force, and the axis comes home") {
    axis_truth a = free_mass();
    a.controller.position_gain = 40;
    a.controller.velocity_gain = 75; // 150 rad/s
    a.controller.integral = 600;
    a.controller.filter_Hz = 200;
    a.mechanics.constant_force = -120;
    const std::vector<double> rest(8000, 0.0);
    const auto out = run({a}, {rest}, 0.0005, 1);
    CHECK(std::abs(out[0].position.back()) < 1e-6);
    CHECK(near(out[0].command.back(), 1.2, 1e-4));
}

TEST_CASE("trial's loop: coupling passes the other axis' acceleration on, and nothing else") {
    axis_truth a = free_mass(), b = free_mass();
    b.name = std::string("y"); // GCC 12 warns falsely of the literal
    for (axis_truth* axis : {&a, &b}) {
        axis->controller.position_gain = 40;
        axis->controller.velocity_gain = 75;
        axis->controller.filter_Hz = 200;
    }
    a.mechanics.coupling = 0.2;
    std::vector<double> rest(6000, 0.0), moves(6000);
    for (std::size_t k = 0; k < moves.size(); ++k)
        moves[k] = 0.01 * std::sin(2 * pi * 3 * static_cast<double>(k) * 0.0005);
    const auto out = run({a, b}, {rest, moves}, 0.0005, 1);
    const auto loose = run({free_mass(), b}, {rest, moves}, 0.0005, 1);
    const double wanted = 0.2 * std::abs(at_frequency(out[1].command, 3, 0.0005));
    CHECK(near(std::abs(at_frequency(out[0].command, 3, 0.0005)), wanted, 0.1));
    CHECK(std::abs(at_frequency(loose[0].command, 3, 0.0005)) == 0);
}

TEST_CASE("trial's encoder: counts, and noise of the size asked for") {
    encoder_truth e;
    e.resolution = 1e-6;
    encoder coarse(e, dice(1));
    CHECK(near(coarse(3.4e-6), 3e-6, 1e-9));
    e = {0, 1e-7, 0.9, {}};
    encoder noisy(e, dice(2));
    double sum = 0;
    for (int k = 0; k < 50000; ++k) sum += std::pow(noisy(0), 2);
    CHECK(near(std::sqrt(sum / 50000), 1e-7, 0.03));
}

TEST_CASE("trial's controller: both velocity estimators see a ramp's velocity") {
    controller_truth c;
    c.velocity_gain = 1;
    c.filter_Hz = 100;
    c.velocity_feedforward = 0;
    c.dac_bits = 0;
    for (const bool mean : {false, true}) {
        c.two_sample_mean = mean;
        cascade control(c, 0.001);
        double u = 0;
        for (int k = 0; k < 500; ++k) u = control(0.02 * k * 0.001, 0.02 * k * 0.001);
        CHECK(near(u, -0.02, 1e-9));
    }
}

TEST_CASE("trial's controller: the notch is deepest where it is put, and leaves rest alone") {
    controller_truth c;
    c.velocity_gain = 1;
    c.position_gain = 1;
    c.filter_Hz = 1e-9; // no velocity: the reference goes straight through
    c.velocity_feedforward = 0;
    c.dac_bits = 0;
    c.notch_Hz = 120;
    c.notch_damping = 0.2;
    const auto gain = [&](double hertz) {
        cascade control(c, 0.0005);
        std::vector<double> u;
        for (int k = 0; k < 12000; ++k) {
            const double value = control(std::sin(2 * pi * hertz * k * 0.0005), 0);
            if (k >= 8000) u.push_back(value);
        }
        return std::abs(at_frequency(u, hertz, 0.0005)) / 2000;
    };
    CHECK(gain(120) < 1e-3);
    CHECK(near(gain(5), 1, 1e-3));
    // (s^2 + w^2) / (s^2 + damping w s + w^2) at the frequency that the bilinear form, true at 120 Hz, maps 150
    // Hz to
    const double w = 2 * pi * 120, s = w * std::tan(pi * 150 * 0.0005) / std::tan(pi * 120 * 0.0005);
    const std::complex<double> wanted = (w * w - s * s) / std::complex<double>(w * w - s * s, 0.2 * w * s);
    CHECK(near(gain(150), std::abs(wanted), 1e-3));
}

namespace {

using quadrant::diagnosis::joint;
using quadrant::diagnosis::own_law;

/// A constant at a joint.
constexpr own_law constant_at(joint where) {
    return {.name = "constant",
            .joins = where,
            .numbers = {{{.key = "size"}}},
            .law = [](const auto&, const auto& number, auto&) { return number[0]; }};
}
constexpr std::array constants{constant_at(joint::command),      constant_at(joint::motor_gain),
                               constant_at(joint::force),        constant_at(joint::friction),
                               constant_at(joint::transmission), constant_at(joint::reading)};

/// Last reading of a mass of 50 kg without a controller, 100 N/V, after 0.1 s with these constants at these
/// joints.
double reading_with(const std::vector<std::pair<joint, double>>& added, double coulomb = 0) {
    axis_truth a = free_mass();
    a.friction.coulomb = coulomb;
    for (const auto& [where, size] : added)
        a.laws.push_back({&constants[static_cast<std::size_t>(where)], {size}});
    return run({a}, {std::vector<double>(201, 0.0)}, 0.0005, 1)[0].position.back();
}

} // namespace

TEST_CASE("trial's drive: its current is that of the moment at which a row begins, or the mean over the row") {
    constexpr double period = 1e-3, answer = 2.8e-3; // mass over gain
    axis_truth a = free_mass();
    a.actuator.force_constant = 10;
    a.drive.kind = drive_truth::drive_kind::velocity;
    a.drive.velocity_per_V = 1;
    a.drive.velocity_gain = a.mechanics.mass / answer;
    a.drive.delay = 4e-4;
    a.drive.tapped = true;
    std::vector<double> ramp(12);
    for (std::size_t k = 0; k < ramp.size(); ++k)
        ramp[k] = 0.1 * period * std::max(0.0, static_cast<double>(k) - 2);
    const double first = 0.1 * a.drive.velocity_gain / a.actuator.force_constant; // when the set-point arrives
    for (const bool mean : {false, true}) {
        a.drive.tap_is_mean = mean;
        const auto out = run({a}, {ramp}, period, 1)[0];
        for (std::size_t k = 3; k < 10; ++k) {
            const double since = static_cast<double>(k - 2) * period - a.drive.delay;
            const double at = first * std::exp(-since / answer),
                         over = at * answer / period * (1 - std::exp(-period / answer));
            CHECK(near(out.current[k], mean ? over : at, 1e-3));
        }
    }
}

TEST_CASE("trial's plant: the law of an effect acts at its joint") {
    const double way = 0.5 * 0.1 * 0.1; // of 1 m/s^2
    CHECK(near(reading_with({{joint::force, 50}}), way, 1e-3));
    CHECK(near(reading_with({{joint::command, 0.5}}), way, 1e-3));
    CHECK(near(reading_with({{joint::command, 0.5}, {joint::motor_gain, 1}}), 2 * way, 1e-3));
    CHECK(near(reading_with({{joint::reading, 1e-3}}), 1e-3, 1e-9));
    CHECK(near(reading_with({{joint::transmission, 1e-3}}), 1e-3, 1e-9));
    CHECK(reading_with({{joint::force, 50}}, 40) > 0.1 * way);
    CHECK(reading_with({{joint::force, 50}, {joint::friction, 1}}, 40) < 0.01 * way); // 80 N hold 50 N
}
