// SPDX-License-Identifier: BSL-1.0
#include "claims.hpp"

#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/fit/for_machine.hpp>
#include <quadrant/diagnosis/which/axis_case.hpp>

using namespace quadrant::diagnosis;

// A second mass that is a large part of the axis: the axis rings far above the mode's own frequency, that of
// the mass with the axis held.

TEST_CASE("structural_resonance: a large part of the mass on a spring is found with its frequency") {
    struct mode {
        double share, frequency;
    };
    for (const auto& [share, frequency] : {mode{0.3, 60}, mode{0.5, 160}}) {
        workshop::machine real;
        auto file = workshop::described(real); // the whole mass
        const double whole = real.mass;
        real.mode_mass = share * whole;
        real.mass -= real.mode_mass;
        real.mode_frequency = frequency;
        real.mode_damping = 0.015;
        real.control.velocity_gain /= 2;
        real.control.position_gain *= 0.4;
        const auto log = workshop::run(real, workshop::three_strokes);
        const auto& axis = file.axes.front();
        const auto record = for_machine(prepare(log, workshop::period, workshop::count,
                                                scales_of(axis.plant, log, workshop::period, workshop::count)),
                                        axis);
        const search models(record, axis, {}, {}, [](const std::string&) {});
        const plant_model found = models.with({&suspect::structural_resonance}).fit.plant;
        CAPTURE(found.mode.mass / whole);
        CAPTURE(found.mode.frequency_Hz);
        CHECK(workshop::near(found.mode.mass, real.mode_mass, 0.05));
        CHECK(workshop::near(found.mode.frequency_Hz, frequency, 0.02));
    }
}

TEST_CASE("structural_resonance: a mode of half of the mass explains a record of strokes") {
    workshop::machine real;
    real.control.velocity_gain /= 2;
    real.control.position_gain *= 0.4;
    const auto file = workshop::described(real);
    real.mass /= 2;
    real.mode_mass = real.mass;
    real.mode_frequency = 110;
    real.mode_damping = 0.015;
    const auto holdout = workshop::as_log(workshop::run(real, workshop::three_strokes, 7));
    const auto d = diagnose(file, workshop::as_log(workshop::run(real, workshop::strokes)), &holdout);
    CAPTURE(workshop::said(d));
    CHECK(d.verdict == verdict::explained);
    CHECK(workshop::claims(d) == std::vector<std::string>{"structural_resonance"});
}

namespace {

/// The usual machine with a quarter of its mass on a spring, at 5 Hz.
workshop::machine with_slow_mode(double damping) {
    workshop::machine real;
    real.mode_mass = real.mass / 4;
    real.mass -= real.mode_mass;
    real.mode_frequency = 5;
    real.mode_damping = damping;
    return real;
}

/// One whose ring falls to 1/e after 11 s; the record has 8.
diagnosis_result ringing_beyond_its_record(std::function<double(double, double, double)> force = {}) {
    auto real = with_slow_mode(0.003);
    real.stranger = std::move(force);
    return diagnose(workshop::described({}), workshop::as_log(workshop::run(real)));
}

} // namespace

TEST_CASE("structural_resonance: a mode far below the corner that rings for long is found") {
    const auto real = with_slow_mode(0.03);
    const auto file = workshop::described({});
    const auto log = workshop::run(real);
    const auto scales = scales_of(file.axes.front().plant, log, workshop::period, workshop::count);
    REQUIRE(real.mode_frequency < scales.corner_Hz / 8);
    const auto d = diagnose(file, workshop::as_log(log));
    CAPTURE(workshop::said(d));
    CHECK(workshop::claims(d) == std::vector<std::string>{"structural_resonance"});
}

TEST_CASE("structural_resonance: one that rings for longer than the record lasts leaves nothing") {
    const auto d = ringing_beyond_its_record();
    CAPTURE(workshop::said(d));
    CHECK(d.verdict == verdict::explained);
    CHECK(workshop::claims(d) == std::vector<std::string>{"structural_resonance"});
}

TEST_CASE("structural_resonance: beside a force without a name such a one is suspected" *
          doctest::test_suite("all")) {
    const auto d = ringing_beyond_its_record([](double, double, double t) {
        return 40 * std::sin(2 * std::numbers::pi * 1.7 * t + 3 * std::sin(2 * std::numbers::pi * 0.31 * t));
    });
    CAPTURE(workshop::said(d));
    REQUIRE(!d.causes.empty());
    CHECK(d.causes[0].effect == "structural_resonance");
    CHECK(d.causes[0].group_probability < 0.5);
}

TEST_CASE("structural_resonance: one whose frequency is another than described is named, whatever its mass") {
    workshop::machine real;
    real.mode_mass = real.mass / 5;
    real.mass -= real.mode_mass;
    auto described = real;
    described.mass += real.mode_mass;
    auto file = workshop::described(described);
    auto& plant = file.axes.front().plant;
    plant.mode_mass_kg = 0.97 * real.mode_mass;
    plant.mode_frequency_Hz = real.mode_frequency;
    plant.mode_damping = real.mode_damping;
    for (const char* key : {"mode_mass", "mode_frequency", "mode_damping"})
        file.axes.front().tolerance.given[key] = 0.1;
    real.mode_frequency *= 0.6;
    const auto d = diagnose(file, workshop::as_log(workshop::run(real)));
    CAPTURE(workshop::said(d));
    CHECK(workshop::claims(d) == std::vector<std::string>{"structural_resonance"});
}

TEST_CASE("structural_resonance: led along the motion, a second mass needs its share of the force") {
    const workshop::machine real;
    const auto axis = workshop::described(real).axes.front();
    const auto log = workshop::run(real, workshop::three_strokes);
    const auto record = for_machine(prepare(log, workshop::period, workshop::count,
                                            scales_of(axis.plant, log, workshop::period, workshop::count)),
                                    axis);
    const plant_model rigid(axis, record.scale.give());
    plant_model sprung = rigid;
    sprung.mode = {.mass = 0.4 * rigid.mass, .frequency_Hz = 150, .damping = 0.3};
    const auto by = motion_to_lead(record, rigid);
    const std::array plants{rigid, sprung};
    std::array<std::vector<double>, 2> left;
    record.observer.forces_beside(*by, plants, record.command, left);
    auto share = acceleration_of(rigid, by->way, record.period);
    for (std::size_t k = 0; k < share.size(); ++k) {
        share[k] *= sprung.mode.mass * (by->counts[k] ? 1 : 0);
        left[1][k] -= left[0][k];
    }
    CHECK(rms(left[1]) < 0.2 * rms(share)); // the smoothed motion, below 80 Hz, is slow beside the mode
}
