// SPDX-License-Identifier: BSL-1.0
#include "claims.hpp"

#include <quadrant/diagnosis/effect/cogging.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/which/calibration.hpp>

using namespace workshop;

namespace {

/// A machine with waves over position, and its file.
machine with_waves() {
    machine real;
    real.cogging = 30;
    real.cogging_second = 18;
    real.cyclic = 4e-6;
    return real;
}
machine_description file_of(const machine& real) {
    machine_description file = described(real);
    axis_description& a = file.axes[0];
    a.plant.cogging_period_m = real.cogging_period;
    a.plant.cogging_N = {real.cogging, real.cogging_second};
    a.plant.cogging_phase_rad = {0.7, 0};
    a.encoder.cyclic_m = real.cyclic;
    a.encoder.cyclic_period_m = real.cyclic_period;
    return file;
}

} // namespace

TEST_CASE(
    "described waves: each component moves inside the tolerance of the size, the period where it has one") {
    const machine_description file = file_of(with_waves());
    axis_description axis = file.axes[0];
    const auto moving = [&](std::string_view key) {
        auto out = calibration(axis, usual.give());
        std::erase_if(out, [&](const parameter& p) { return p.key != key; });
        return out;
    };
    axis.tolerance.given["cogging"] = 0.08;
    const auto components = moving("cogging_N");
    REQUIRE(components.size() == 3); // the second harmonic has no cosine
    plant_model plant(axis, usual.give());
    for (const parameter& p : components) {
        const double value = p.of(plant);
        CHECK(near(p.low, value - 0.08 * std::abs(value), 1e-12));
        CHECK(near(p.high, value + 0.08 * std::abs(value), 1e-12));
        p.of(plant) = p.high;
    }
    CHECK(near(plant.cogging.sizes()[0], 1.08 * 30, 1e-12));
    CHECK(near(plant.cogging.sizes()[1], 1.08 * 18, 1e-12));
    CHECK(moving("encoder.cyclic_m").size() == 1);
    CHECK(moving("cogging_period_m").empty());
    axis.tolerance.given["cogging_period"] = 0.001;
    CHECK(moving("cogging_period_m").size() == 1);
}

TEST_CASE("described waves: sizes inside their tolerances are calibrated, not blamed" *
          doctest::test_suite("all")) {
    machine real = with_waves();
    const machine_description file = file_of(real);
    real.cogging *= 1.04;
    real.cogging_second *= 0.96;
    real.cyclic *= 0.96;
    const auto d = diagnosed(file, real);
    CAPTURE(said(d));
    CHECK(d.verdict <= verdict::within_tolerance);
    REQUIRE(d.axes.size() == 1);
    bool told = false;
    for (const parameter_estimate& p : d.axes[0].calibrated)
        if (p.key == "cogging_N") {
            told = true;
            REQUIRE(p.values.size() == 2);
            CHECK(near(p.values[0].value, real.cogging, 0.01));
            CHECK(near(p.values[1].value, real.cogging_second, 0.01));
        }
    CHECK(told);
}

TEST_CASE("described waves: a size beyond its tolerance is claimed, though its period is the described one") {
    machine real = with_waves();
    const machine_description file = file_of(real);
    real.cogging *= 1.3;
    real.cogging_second *= 1.3;
    named(diagnosed(file, real), "cogging", "cogging_N", real.cogging, 0.03);
}

TEST_CASE("described waves: a machine file holds the tolerance of a size and of a period") {
    const auto m = read_machine(R"({"schema": "quadrant.machine/1", "sample_period_s": 0.001, "axes": {"x": {
        "plant": {"mass_kg": 10, "force_constant_N_per_V": 100, "ripple": 0.05, "ripple_period_m": 0.03},
        "tolerance": {"ripple": 0.2, "ripple_period": 0.01, "backlash": 0.1, "lag": 0.3}}}})",
                                "m.json");
    CHECK(m.axes[0].tolerance.of("ripple") == 0.2);
    CHECK(m.axes[0].tolerance.of("ripple_period") == 0.01);
    for (const std::string& note : m.notes) CHECK(note.find("ripple") == std::string::npos);
}

TEST_CASE("waves: a small fourth harmonic of a cogging is its own, no other wave" *
          doctest::test_suite("all")) {
    machine real;
    const auto file = described(real);
    real.stranger = [](double x, double, double) {
        const double turn = 2 * std::numbers::pi * x / 0.0178;
        return 150 * std::sin(turn) + 30 * std::sin(2 * turn + 1) + 10 * std::sin(3 * turn + 2) +
               4 * std::sin(4 * turn);
    };
    const auto d = diagnosed(file, real);
    CAPTURE(said(d));
    CHECK(claims(d) == std::vector<std::string>{"cogging"});
    REQUIRE(!d.causes.empty());
    for (const parameter_estimate& p : d.causes[0].parameters)
        if (p.key == "cogging_N") {
            REQUIRE(p.values.size() > 3);
            CHECK(near(p.values[3].value, 4, 0.1));
        }
}

TEST_CASE(
    "waves: the fit of a cogging begins with the harmonics that stand above the noise, however small beside "
    "the first") {
    // Four passes over a tenth of a metre.
    axis_record r;
    std::vector<double> x;
    for (int k = 0; k < 4000; ++k) {
        x.push_back(0.05 * (1 - std::cos(2 * std::numbers::pi * k / 2000.0)));
        r.velocity.push_back(50 * std::numbers::pi / 2000 * std::sin(2 * std::numbers::pi * k / 2000.0));
    }
    r.position = x;
    r.period = 0.001;
    r.bandwidth_Hz = 100;
    r.resolution = 1e-6;
    r.scale = {.travel = 0.1, .speed = 0.08, .command = 1, .count = 1e-6, .corner_Hz = 100};
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0, 0.05);
    const auto freed = [&](double fourth) { // numbers of the start at that period
        std::vector<double> residual;
        for (const double at : x) {
            const double turn = 2 * std::numbers::pi * at / 0.011;
            residual.push_back(10 * std::sin(turn) + fourth * std::sin(4 * turn) + noise(random));
        }
        const plant_description described;
        const tolerance_description tolerance;
        plant_model leader;
        leader.force_constant = 100;
        std::size_t of_the_period = 0;
        for (const auto& start : suspect::cogging.starts({described, tolerance, r, leader, residual, residual}))
            if (near(start.front().start, 0.011, 0.02)) of_the_period = start.size();
        return of_the_period;
    };
    CHECK(freed(0) == 1 + 2 * 3);   // the period and three harmonics
    CHECK(freed(0.3) == 1 + 2 * 8); // a thousandth of the first's power
}
