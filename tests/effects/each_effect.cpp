// SPDX-License-Identifier: BSL-1.0
// Long: a list, a case for each effect.
#include "diagnosis/claims.hpp"
#include "shared.hpp"

#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/which/search.hpp>

using namespace workshop;

// Each effect alone, by a simulator with another friction law: 3 % on what friction hides, 1 % on the rest.
TEST_CASE("diagnose: Coulomb friction that is not modelled") {
    const machine real;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    named(diagnosed(file, real), "coulomb_friction", "coulomb_N", 60, 0.03);
}
TEST_CASE("diagnose: viscous friction that is not as described" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.viscous = 600;
    named(diagnosed(file, real), "viscous_friction", "viscous_N_s_per_m", 600, 0.03);
}
TEST_CASE("diagnose: Stribeck friction that is not modelled" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.excess = 50;
    named(diagnosed(file, real), "stribeck_friction", "stribeck_velocity_m_per_s", 0.004, 0.05);
}
TEST_CASE("diagnose: friction that differs by direction" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.viscous_asymmetry = 0.5;
    named(diagnosed(file, real), "asymmetric_friction", "viscous_asymmetry", 0.5, 0.03);
}
TEST_CASE("diagnose: another mass" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.mass = 225;
    const auto d = diagnosed(file, real);
    named(d, "mass", "mass_kg", 225, 0.02);
    CHECK(d.causes.front().described);
}
TEST_CASE("diagnose: another force constant" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.force_constant = 930;
    named(diagnosed(file, real), "force_constant", "force_constant_N_per_V", 930, 0.03);
}
TEST_CASE("diagnose: a command that acts late" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.delay = 0.0018;
    named(diagnosed(file, real), "time_delay", "delay_s", 0.0018, 0.02);
}
TEST_CASE("diagnose: cogging with two harmonics") {
    machine real;
    const auto file = described(real);
    real.cogging = 15;
    real.cogging_second = 5;
    const auto d = diagnosed(file, real);
    named(d, "cogging", "cogging_period_m", 0.03, 0.01);
    CHECK(near(value_of(d.causes.front(), "cogging_N").value, 15, 0.03));
    CHECK(near(value_of(d.causes.front(), "cogging_phase_rad").value, 0.7, 0.03));
}
TEST_CASE("diagnose: a current loop of first order, not a delay" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.lag = 0.002;
    named(diagnosed(file, real), "actuator_lag", "actuator.lag_s", 0.002, 0.03);
}
TEST_CASE("diagnose: a spring, not a constant force" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.spring = 800;
    named(diagnosed(file, real), "position_spring", "spring_N_per_m", 800, 0.03);
}
TEST_CASE("diagnose: play, not presliding friction" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.backlash = 8e-6;
    named(diagnosed(file, real), "backlash", "backlash_m", 8e-6, 0.1);
}
TEST_CASE("diagnose: friction that gives way by ten micrometres, not play" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.bristle = 1e-5;
    // After a turn, bristles (LuGre) follow the branch of elements of half their length
    // (effect::by_another_law): what is found lies between half and the whole, and a quarter more on either
    // side.
    const auto d = diagnosed(file, real);
    named(d, "presliding_friction", "presliding_length_m", 0.75e-5, 0.5);
    CHECK_FALSE(d.causes.front().described);
}
TEST_CASE("diagnose: friction that varies along the travel, not cogging" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.friction_along = 0.4;
    named(diagnosed(file, real), "position_dependent_friction", "friction_position_amplitude", 0.4, 0.05);
}
TEST_CASE("diagnose: friction that changes while the machine warms up" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.friction_drift = -0.4;
    named(diagnosed(file, real), "friction_drift", "friction_drift", -0.4, 0.1);
}
TEST_CASE("diagnose: friction that grows evenly, and says nothing of where it would end") {
    machine real;
    const auto file = described(real);
    real.friction_drift = 20;
    real.friction_drift_time = 100;
    const auto d = diagnosed(file, real);
    CAPTURE(said(d));
    REQUIRE(claims(d) == std::vector<std::string>{"friction_drift"});
    const double rate = value_of(d.causes.front(), "friction_drift").value /
                        value_of(d.causes.front(), "friction_drift_time_s").value;
    CHECK(rate == doctest::Approx(0.2).epsilon(0.1));
}
TEST_CASE("diagnose: a second mass on a spring" * doctest::test_suite("all")) {
    machine real;
    real.mass = 150;
    real.mode_mass = 30;
    machine whole = real;
    whole.mass = 180;
    named(diagnosed(described(whole), real), "structural_resonance", "mode_frequency_Hz", 70, 0.02);
}
TEST_CASE("diagnose: a force constant that varies along the travel, not cogging" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.ripple = 0.15;
    named(diagnosed(file, real), "force_ripple", "ripple_period_m", 0.024, 0.01);
}
TEST_CASE("diagnose: a drive that clips below the controller's limit" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.drive_limit = 0.8;
    const auto d = diagnosed(file, real);
    named(d, "actuator_saturation", "actuator.drive_limit_V", 0.8, 0.01);
    CHECK_FALSE(d.causes.front().described);
}
TEST_CASE("diagnose: a dead zone of the drive, not Coulomb friction" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.dead_zone = 0.03;
    named(diagnosed(file, real), "actuator_dead_zone", "actuator.dead_zone_V", 0.03, 0.05);
}
// Few losses in a record that hardly changes its command do not earn a claim; they are never called something
// else.
TEST_CASE(
    "diagnose: lost commands take their pulses out of the gap, a delay does not, and nothing else is claimed" *
    doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.loss = 0.1;
    const auto log = run(real);
    const auto record = prepare(log, workshop::period, workshop::count,
                                scales_of(file.axes[0].plant, log, workshop::period, workshop::count));
    const search models(record, file.axes[0], {}, {}, [](const std::string&) {});
    const double before = rms(models.held_out_residual(models.calibrated()));
    candidate losing = models.calibrated();
    losing.fit.plant.loss = real.loss;
    CHECK(rms(models.residual(losing)) < 0.4 * before);
    CHECK(rms(models.held_out_residual(models.with({&suspect::time_delay}))) > 0.95 * before);
    const auto d = diagnose(file, as_log(log));
    CHECK(d.verdict >= verdict::explained);
    for (const auto& name : claims(d)) CHECK(name == "sample_loss");
}
// Slow strokes under tones of 50 to 180 Hz, so that every period has a step that its loss would show.
std::vector<double> shaken(double seconds) {
    constexpr double turn = 2 * std::numbers::pi;
    std::vector<double> out(static_cast<std::size_t>(seconds / workshop::period));
    for (std::size_t k = 0; k < out.size(); ++k) {
        const double t = static_cast<double>(k) * workshop::period;
        out[k] = 0.03 * (1 - std::cos(turn * 0.5 * t));
        for (int i = 0; i < 8; ++i) {
            const double f = 50 * std::pow(1.2, i);
            out[k] += 0.05 / (f * f) * std::sin(turn * f * t + 1.7 * i * i);
        }
        out[k] *= std::min(1.0, t / 0.2);
    }
    return out;
}
TEST_CASE("diagnose: lost commands, few and many, with how many were lost") {
    for (const double p : {0.02, 0.1}) {
        if (p > 0.02 && !all_tests()) continue;
        machine real;
        const auto file = described(real);
        real.loss = p;
        const auto d = diagnose(file, as_log(run(real, 4, 5, shaken(4))));
        CAPTURE(said(d));
        REQUIRE(claims(d) == std::vector<std::string>{"sample_loss"});
        const auto& found = value_of(d.causes.front(), "actuator.loss_probability");
        CAPTURE(found.value);
        CHECK(found.low < p);
        CHECK(found.high > p);
        CHECK(found.high - found.low < 0.5 * p);
    }
}
// In a closed loop the noise of the encoder is in the command and in what the observer has to correct.
TEST_CASE("diagnose: no command is lost under strong noise of the encoder or a command that acts late" *
          doctest::test_suite("all")) {
    for (const double delay : {0.0006, 0.0009}) {
        machine real;
        const auto file = described(real);
        real.noise = 1e-6;
        real.delay = delay;
        const auto log = run(real, 4, 5, shaken(4));
        const auto record = prepare(log, workshop::period, workshop::count,
                                    scales_of(file.axes[0].plant, log, workshop::period, workshop::count));
        const search models(record, file.axes[0], {}, {}, [](const std::string&) {});
        std::vector<double> innovation;
        record.observer.run(models.calibrated().fit.plant, innovation);
        const auto found =
            record.observer.commands_with_loss(models.calibrated().fit.plant, innovation, {.learned = true});
        CHECK(found.told > 1000);
        CHECK(found.gain < 5);
        CHECK(found.probability < 0.001);
    }
}
TEST_CASE("diagnose: a cyclic error of the encoder, not cogging of the same period" *
          doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.cyclic = 1e-6;
    const auto d = diagnosed(file, real);
    named(d, "encoder_cyclic_error", "encoder.cyclic_period_m", 0.0004, 0.01);
    CHECK(d.axes[0].where[0].block == "sensor");
}
TEST_CASE("diagnose: a turning process" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.cutting = 20;
    const auto d = diagnosed(file, real);
    named(d, "cutting_force", "process.fundamental_Hz", 23.3, 0.001);
    CHECK(d.axes[0].where[0].block == "process");
}
TEST_CASE("diagnose: a turning process begins anew in the hold-out log") {
    machine real;
    const auto file = described(real);
    real.cutting = 20;
    axis_log second = run(real, 8.15, 7);
    for (auto* column : {&second.reference, &second.position, &second.command})
        column->erase(column->begin(), column->begin() + 1234);
    const auto log = as_log(run(real)), other = as_log(second);
    const auto d = diagnose(file, log, &other);
    REQUIRE(claims(d) == std::vector<std::string>{"cutting_force"});
    CHECK(d.axes[0].gap_after.force_rms_N < 2 * d.axes[0].gap_after.noise_floor_force_rms_N);
}
TEST_CASE("diagnose: the acceleration of the other axis, on the axis that feels it") {
    machine real, other;
    auto file = described(real);
    auto second = file.axes[0];
    second.name = "y";
    file.axes.push_back(second);
    auto log = as_log(run(other, 8.15, 3));
    log.axes[0].name = "y";
    const auto shaken =
        derivative(derivative(zero_phase(log.axes[0].position, 100, workshop::period), workshop::period),
                   workshop::period);
    real.coupling = 0.05;
    real.other_acceleration = [&](double t) { // y runs one second behind, so that the two motions differ
        const double k = (t - 1) / workshop::period;
        return k > 0 ? shaken[static_cast<std::size_t>(k)] : 0.0;
    };
    auto x = run(real);
    auto& y = log.axes[0];
    for (auto* column : {&y.reference, &y.position, &y.command}) {
        column->insert(column->begin(), 2000, column->front());
        column->resize(x.position.size());
    }
    log.axes.insert(log.axes.begin(), x);
    log.samples = x.position.size();
    const auto d = diagnose(file, log);
    REQUIRE(claims(d) == std::vector<std::string>{"cross_coupling"});
    CHECK(d.causes.front().axis == "x");
    CHECK(near(value_of(d.causes.front(), "coupling").value, 0.05, 0.03));
}

TEST_CASE("diagnose: a single line in time is its own fundamental, not a harmonic of a slower one" *
          doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.cutting = 12;
    real.cutting_second = 0;
    real.cutting_frequency = 71.7;
    named(diagnosed(file, real, strokes), "cutting_force", "process.fundamental_Hz", 71.7, 0.002);
}

// Forces that are in no list: a form over the same quantity predicts better than the nearest name.
const rules one_cause{.most_causes = 1};
TEST_CASE("diagnose: a force with the square of the position is no spring" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.stranger = [](double x, double, double) { return -9000 * x * x; };
    const auto d = diagnose(
        file, as_log(run(real)), nullptr, [](const std::string&) {}, one_cause);
    abstains(d);
    CHECK(d.remaining_structure.find("follows the position") != std::string::npos);
}
TEST_CASE("diagnose: a force that grows with time is no offset" * doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.stranger = [](double, double, double t) { return 30 * t; };
    const auto d = diagnose(
        file, as_log(run(real)), nullptr, [](const std::string&) {}, one_cause);
    abstains(d);
    CHECK(d.remaining_structure.find("follows time") != std::string::npos);
}
