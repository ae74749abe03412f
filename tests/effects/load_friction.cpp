// SPDX-License-Identifier: BSL-1.0
#include "arm.hpp"

#include <quadrant/diagnosis/apply.hpp>
#include <quadrant/diagnosis/simulate.hpp>

using namespace arms;

namespace {

/// A gear that carries an arm: its file knows the weight, and not that the teeth rub.
const arm geared{.gravity = 3.2, .phase = 0.3, .load_friction = 0.2};

machine_description file_of(const arm& a) {
    auto file = described(a);
    file.axes[0].plant.gravity_torque_Nm = a.gravity * 1.01;
    file.axes[0].plant.gravity_phase_rad = a.phase;
    return file;
}

} // namespace

TEST_CASE("load_friction: it is named with its number, apply writes it, and the corrected machine predicts "
          "other motion") {
    const auto file = file_of(geared);
    const auto d = diagnose(file, run(geared));
    named(d, "load_friction", "load_friction", 0.2, 0.05);
    const auto better = apply(file, d);
    CHECK(*better.axes[0].plant.load_friction == doctest::Approx(0.2).epsilon(0.05));
    arm elsewhere = geared;
    elsewhere.low = -0.8;
    elsewhere.high = 2.6;
    const auto other = run(elsewhere, 7);
    CHECK(simulate(better, other).axes[0].gap.force_rms_N <
          0.3 * simulate(file, other).axes[0].gap.force_rms_N);
}
TEST_CASE("load_friction: an axis whose friction is of the load alone sticks at rest under it") {
    arm real = geared;
    real.coulomb = 0;
    named(diagnose(file_of(real), run(real)), "load_friction", "load_friction", 0.2, 0.05);
}
TEST_CASE("load_friction: more Coulomb friction is not called friction of the load" *
          doctest::test_suite("all")) {
    arm real = geared;
    real.load_friction = 0;
    const auto file = file_of(real);
    real.coulomb = 0.35;
    named(diagnose(file, run(real)), "coulomb_friction", "coulomb_Nm", 0.35, 0.03);
}
TEST_CASE("load_friction: a machine whose file has it is not blamed for it, also with another number inside "
          "the tolerance" *
          doctest::test_suite("all")) {
    auto file = file_of(geared);
    for (const double said_of_it : {0.2, 0.19}) {
        file.axes[0].plant.load_friction = said_of_it;
        file.axes[0].tolerance.given["load_friction"] = 0.1;
        const auto d = diagnose(file, run(geared));
        CAPTURE(said(d));
        CHECK(d.verdict <= verdict::within_tolerance);
    }
}
TEST_CASE("load_friction: a linear axis that lifts a weight has it as well" * doctest::test_suite("all")) {
    machine real;
    real.constant_force = 300;
    real.more_level = [](double motor, double load) { return 0.1 * std::abs(motor - load); };
    auto file = described(real);
    file.axes[0].plant.constant_force_N = 300;
    named(diagnose(file, as_log(run(real, strokes))), "load_friction", "load_friction", 0.1, 0.05);
}
TEST_CASE("load_friction: beside cogging of five harmonics both are found, and no second wave") {
    const arm real{.gravity = 3.2, .load_friction = 0.15, .cogging = 0.8, .pitch = 0.11};
    auto file = described(real);
    file.axes[0].plant.gravity_torque_Nm = 3.2;
    file.axes[0].plant.gravity_phase_rad = 0;
    const auto d = diagnose(file, run(real));
    CAPTURE(said(d));
    auto names = claims(d);
    std::sort(names.begin(), names.end());
    CHECK(names == std::vector<std::string>{"cogging", "load_friction"});
    for (const cause& c : d.causes)
        if (c.effect == "cogging") CHECK(near(value_of(c, "cogging_period_rad").value, 0.11, 0.01));
}
