// SPDX-License-Identifier: BSL-1.0
// A drive whose loops are closed on the model, one by one and side by side in lanes.
#include <doctest/doctest.h>
#include <quadrant/diagnosis/fit/both_motions.hpp>
#include <quadrant/diagnosis/fit/record.hpp>

#include <numbers>

using namespace quadrant::diagnosis;

namespace {

constexpr double period = 0.005;

/// A servo with an arm: 7.5 g m^2, Coulomb friction that grows with the load, gravity.
plant_model arm() {
    plant_description d;
    d.mass_kg = 0.0075;
    d.force_constant_N_per_V = 0.12;
    d.viscous_N_s_per_m = 0.04;
    d.coulomb_N = 0.01;
    plant_model p(d, 1e-4);
    p.gravity.torque = 0.48;
    p.friction.load = 0.25;
    p.drive.kind = drive_kind::position_servo;
    p.drive.duty_gain = 1.2;
    p.drive.supply = 7.4;
    p.drive.delay = 0.002;
    return p;
}
driven_motion asked(std::size_t rows) {
    driven_motion m;
    m.period = period;
    for (std::size_t k = 0; k < rows; ++k)
        m.set_point.push_back(0.6 * std::sin(2 * std::numbers::pi * 0.7 * period * static_cast<double>(k)));
    m.position.assign(rows, 0.0);
    m.velocity.assign(rows, 0.0);
    return m;
}
std::vector<double> path(const plant_model& p, const driven_motion& m) {
    std::vector<double> out(m.set_point.size());
    run_closed(p, m, period, 0, {}, [&](std::size_t k, double reading, const auto&) { out[k] = reading; });
    return out;
}

} // namespace

TEST_CASE("closed drive: a proportional servo under gravity stays behind by what its duty needs") {
    plant_model p = arm();
    p.friction = {};
    p.friction.viscous_slope = 0.04;
    driven_motion m = asked(1200);
    for (double& r : m.set_point) r = 0.5;
    const double q = path(p, m).back(), stiffness = 1.2 * 7.4 * 0.12;
    CHECK(stiffness * (0.5 - q) == doctest::Approx(0.48 * std::sin(q)).epsilon(1e-3));
}
TEST_CASE("closed drive: a profile velocity holds a servo back") {
    plant_model p = arm();
    p.friction = {};
    p.friction.viscous_slope = 0.04;
    p.gravity.torque = 0;
    p.drive.rate_limit = 0.2; // [rad/s]
    driven_motion m = asked(600);
    for (double& r : m.set_point) r = 1;
    m.set_point[0] = 0;
    const auto x = path(p, m);
    // The arm has swung out by then.
    CHECK((x[599] - x[499]) / (100 * period) == doctest::Approx(0.2).epsilon(1e-3));
}
TEST_CASE("a profile velocity is replayed, and closed on an axis, without being early by a part of a step") {
    plant_model p = arm();
    p.friction = {};
    p.gravity.torque = 0;
    p.mass = 1e9; // stands still
    p.drive.delay = 0;
    p.drive.rate_limit = 0.2; // [rad/s]
    driven_motion m = asked(100);
    m.set_point.assign(100, 1.0);
    m.set_point[0] = 0;
    m.find_velocity();
    const auto given = m.given(p.drive);
    const auto command = run_closed(p, m, period, 0, {}, [](std::size_t, double, const auto&) {});
    for (const std::size_t k : {std::size_t{1}, std::size_t{10}, std::size_t{99}}) {
        const double duty = 1.2 * 0.2 * period * (static_cast<double>(k) - 0.5); // mean over the row
        CHECK(given[k] == doctest::Approx(duty).epsilon(1e-6));
        CHECK(command[k] == doctest::Approx(7.4 * duty).epsilon(1e-6));
    }
}
TEST_CASE("closed drive: what its velocity loop remembers takes a constant force over") {
    plant_description d;
    d.mass_kg = 100;
    d.force_constant_N_per_V = 1;
    plant_model p(d, 1e-6);
    p.constant_force = 30;
    p.drive.kind = drive_kind::position;
    p.drive.velocity_gain = 25000;
    p.drive.velocity_integral = 1.2e6;
    p.drive.position_gain = 40;
    driven_motion m = asked(400);
    for (double& r : m.set_point) r = 0.01;
    CHECK(path(p, m).back() == doctest::Approx(0.01).epsilon(1e-6));
}
TEST_CASE("closed drive: it gives nothing where it is switched off, by its log and by its model") {
    plant_model p = arm();
    p.gravity.torque = 0;
    driven_motion m = asked(400);
    m.off.assign(400, 1);
    for (double x : path(p, m)) CHECK(x == 0);
    m.off.clear();
    p.drive.off_from = 0;
    p.drive.off_until = 1; // [s]
    const auto x = path(p, m);
    CHECK(x[199] == 0);
    CHECK(std::abs(x[399]) > 0.1);
}
TEST_CASE("closed drive: plants side by side go the ways that they go alone") {
    const driven_motion m = asked(600);
    std::vector<plant_model> plants(7, arm());
    plants[1].force_constant *= 0.6;
    plants[2].gravity.torque *= 1.5;
    plants[3].friction.load = 0;
    plants[4].drive.delay = 0.004;
    plants[5].drive.minimum_duty = 0.02;
    plants[6].drive.off_from = 1;
    plants[6].drive.off_until = 1.5;
    predictor by{.period = period, .corner_Hz = 5, .position = m.position, .command = m.set_point};
    by.drive = &m;
    by.closed = 0.0;
    std::vector<std::vector<double>> e(plants.size());
    by.run(plants, e);
    for (std::size_t i = 0; i < plants.size(); ++i) {
        CAPTURE(i);
        const auto alone = path(plants[i], m);
        double away = 0, farthest = 0;
        for (std::size_t k = 0; k < alone.size(); ++k) {
            away = std::max(away, std::abs(m.position[k] - e[i][k] - alone[k]));
            farthest = std::max(farthest, std::abs(alone[k]));
        }
        CHECK(farthest > 0.1);
        CHECK(away < 1e-9); // lanes have their own exponential and sine
    }
}
TEST_CASE("memory of a signal: one row of white noise, two time constants of a decaying correlation squared") {
    std::vector<double> white(20000), slow(20000);
    std::uint64_t state = 1;
    double x = 0;
    for (std::size_t k = 0; k < white.size(); ++k) {
        state = state * 6364136223846793005U + 1442695040888963407U;
        white[k] = static_cast<double>(state >> 11) * 0x1p-53 - 0.5;
        slow[k] = x = 0.95 * x + white[k];
    }
    CHECK(rows_of_memory(white) == doctest::Approx(1).epsilon(0.05));
    // sum of 0.95^(2 |lag|) over all lags: (1 + 0.9025) / (1 - 0.9025)
    CHECK(rows_of_memory(slow) == doctest::Approx(19.5).epsilon(0.2));
}

namespace {

/// What a log of this plant on a sine of this frequency holds.
axis_log logged(const plant_model& p, double frequency_Hz, std::size_t rows) {
    driven_motion m = asked(rows);
    axis_log out;
    for (std::size_t k = 0; k < rows; ++k)
        m.set_point[k] =
            0.5 + 0.6 * std::sin(2 * std::numbers::pi * frequency_Hz * period * static_cast<double>(k));
    m.position.assign(rows, 0.5);
    out.kind = axis_kind::rotary;
    out.reference = m.set_point;
    out.position.resize(rows);
    run_closed(p, m, period, 0, {},
               [&](std::size_t k, double reading, const auto&) { out.position[k] = reading; });
    out.command_unit.clear();
    return out;
}
axis_description servo_of(const plant_model& p) {
    axis_description a;
    a.kind = axis_kind::rotary;
    a.plant.mass_kg = p.mass;
    a.plant.force_constant_N_per_V = p.force_constant;
    a.drive.kind = drive_kind::position_servo;
    a.drive.position_gain_per_m = p.drive.duty_gain;
    a.drive.supply_V = p.drive.supply;
    return a;
}

} // namespace

TEST_CASE("both motions: the second log begins anew behind rows that say nothing, and a model goes both ways") {
    plant_model p = arm();
    p.friction.drift_rate = -0.4; // warm in both of them after the same time
    p.friction.drift_time = 1.5;
    p.drive.clock_slip = 2e-3; // its clock is a row off after 500
    const axis_log first = logged(p, 0.7, 400), second = logged(p, 1.1, 300);
    const auto both = both_motions(servo_of(p), first, second, period);
    REQUIRE(both);
    REQUIRE(both->drive->begins.size() == 1);
    const std::size_t from = both->drive->begins[0].row;
    CHECK(from == 430);
    CHECK(both->position.size() == 730);
    for (std::size_t k = 0; k < both->position.size(); ++k) CHECK(both->left_out[k] == (k >= 400 && k < from));
    CHECK(both->position[from] == second.position[0]);
    std::vector<double> e;
    predictor by{.period = period, .corner_Hz = 5, .position = both->position, .command = both->command};
    by.drive = both->drive.get();
    by.closed = 0.0;
    by.run(p, e);
    const auto most = [&](std::size_t begin, std::size_t end) {
        double out = 0;
        for (std::size_t k = begin; k < end; ++k) out = std::max(out, std::abs(e[k]));
        return out;
    };
    CHECK(most(0, 400) < 1e-9);
    CHECK(most(from, 730) < 1e-2);  // of 600 mrad: the velocity at the begin is a difference of three rows
    CHECK(most(670, 730) < 1e-4);   // and is forgotten
    CHECK(std::abs(e[415]) > 0.05); // the motion between is none of the machine's
    const auto again = path(p, *both->drive);
    for (std::size_t k = 670; k < 730; ++k) CHECK(std::abs(again[k] - second.position[k - from]) < 1e-4);
}
TEST_CASE("both motions: logs of different columns stay apart") {
    const plant_model p = arm();
    const axis_log first = logged(p, 0.7, 400);
    axis_log second = first;
    second.duty.assign(400, 0.0);
    CHECK_FALSE(both_motions(servo_of(p), first, second, period));
}
TEST_CASE(
    "a servo that rests most of the time: what it gives otherwise than measured carries the rounding of the "
    "position, which does not show there") {
    constexpr double count = 1e-3;
    const plant_model p = arm();
    axis_log log = logged(p, 0.7, 1000);
    for (std::size_t k = 300; k < 1000; ++k) log.reference[k] = log.position[k] = log.position[299];
    log.duty.assign(1000, 0.0);
    for (std::size_t k = 1; k < 1000; ++k) { // read as rows begin, with the set-point of the row before
        log.duty[k] = p.drive.duty_gain * (log.reference[k - 1] - log.position[k]);
        log.position[k] = count * std::round(log.position[k] / count);
    }
    log.duty_step = 1e-5;
    axis_description servo = servo_of(p);
    servo.encoder.resolution_m = count;
    const axis_log ready = detail::with_drive(servo, log, period);
    CHECK(ready.drive->to_position == doctest::Approx(1 / p.drive.duty_gain).epsilon(0.2));
}
