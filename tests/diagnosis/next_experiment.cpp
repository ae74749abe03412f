// SPDX-License-Identifier: BSL-1.0
// Long: one call: a case for each thing that decides the next motion.
#include "claims.hpp"

#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/next/next_experiment.hpp>

using namespace workshop;

namespace {

constexpr double rough = 0.001; ///< sample period where only models meet models [s]

/// A model of the described axis under one name: its own numbers free, the value of the effect as told.
confusable under(const effect& name, const axis_description& axis, const std::vector<parameter>& own) {
    confusable out{.name = &name, .model = {.effects = {&name}}};
    out.model.fit.plant = plant_model(axis, usual.give());
    for (const auto& p : calibration(axis, usual.give()))
        if (std::none_of(own.begin(), own.end(), [&](const auto& q) { return q.key == p.key; }))
            out.model.fit.parameters.push_back(p);
    out.model.fit.parameters.insert(out.model.fit.parameters.end(), own.begin(), own.end());
    auto& x = out.model.fit.x;
    x.resize(static_cast<Eigen::Index>(out.model.fit.parameters.size()));
    for (Eigen::Index i = 0; i < x.size(); ++i) {
        const auto& p = out.model.fit.parameters[static_cast<std::size_t>(i)];
        x[i] = p.to_fit(p.start);
    }
    fitter::put(out.model.fit.plant, out.model.fit.parameters, x);
    return out;
}

double& mass_of(plant_model& p) { return p.mass; }
double& force_constant_of(plant_model& p) { return p.force_constant; }
double& lag_of(plant_model& p) { return p.lag; }
double& delay_of(plant_model& p) { return p.delay; }
double& force_of(plant_model& p) { return p.constant_force; }
double& viscous_asymmetry_of(plant_model& p) { return p.friction.viscous_asymmetry; }
double& coulomb_asymmetry_of(plant_model& p) { return p.friction.coulomb_asymmetry; }

/// A mass 20 % larger than described, or a force constant that much smaller.
std::vector<confusable> mass_or_force_constant(const axis_description& axis) {
    return {under(suspect::mass, axis, {detail::freed("mass_kg", mass_of, 1.2 * axis.plant.mass_kg)}),
            under(suspect::force_constant, axis,
                  {detail::freed("force_constant_N_per_V", force_constant_of,
                                 axis.plant.force_constant_N_per_V / 1.2)})};
}

const planned_motion& named_motion(const std::vector<planned_motion>& motions, const std::string& words) {
    for (const auto& m : motions)
        if (m.words.starts_with(words)) return m;
    FAIL("no motion " << words);
    return motions.front();
}

/// Least gain of both directions.
double separated(const proving_ground& ground, const planned_motion& m, const std::vector<confusable>& names) {
    return std::min(ground.gain(m, names[0], names[1], true), ground.gain(m, names[1], names[0], true));
}

} // namespace

TEST_CASE(
    "next experiment: every motion stays inside the travel, velocity and acceleration that the log showed") {
    struct machine_tool {
        shown_motion shown;
        double sample;
    };
    for (const auto& [shown, sample] :
         {machine_tool{{0.02, 0, 0.12, 0.17, 2.2}, 0.0005}, machine_tool{{0, -0.4, 0.1, 1.2, 15}, 0.00025},
          machine_tool{{1e-5, 0, 1e-4, 1e-3, 0.5}, 0.001}, machine_tool{{0.3, 0, 0.3, 0.1, 0.05}, 0.002}}) {
        const auto motions = standard_motions(shown, sample, usual);
        CHECK(motions.size() >= 8);
        for (const auto& m : motions) {
            CAPTURE(m.words);
            CHECK(m.reference.front() == shown.start);
            CHECK(static_cast<double>(m.reference.size()) * sample < 7);
            const auto [low, high] = std::minmax_element(m.reference.begin(), m.reference.end());
            const double hair = 1e-9 * (shown.high - shown.low);
            CHECK(*low >= shown.low - hair);
            CHECK(*high <= shown.high + hair);
            double velocity = 0, acceleration = 0;
            const auto& r = m.reference;
            for (std::size_t k = 1; k + 1 < r.size(); ++k) {
                velocity = std::max(velocity, std::abs(r[k + 1] - r[k]) / sample);
                acceleration =
                    std::max(acceleration, std::abs(r[k + 1] - 2 * r[k] + r[k - 1]) / (sample * sample));
            }
            CHECK(velocity < 1.001 * shown.velocity);
            CHECK(acceleration < 1.02 * shown.acceleration); // a ramp of few samples
            CHECK(std::abs(r.back() - r[r.size() - 2]) <= shown.acceleration * sample * sample); // ends at rest
        }
    }
    CHECK(standard_motions({}, 0.001, usual).empty()); // a log that stands still
}

TEST_CASE("next experiment: what a log showed is its travel and its peaks, whatever the digits of its column") {
    std::vector<double> reference;
    for (int k = 0; k < 8000; ++k)
        reference.push_back(std::round((0.1 + 0.05 * std::sin(2 * std::numbers::pi * k * 0.0005)) * 1e7) / 1e7);
    const auto shown = shown_by(reference, 0.0005, usual.corner_Hz);
    CHECK(near(shown.low, 0.05, 1e-4));
    CHECK(near(shown.high, 0.15, 1e-4));
    CHECK(near(shown.velocity, 0.05 * 2 * std::numbers::pi, 0.02));
    CHECK(near(shown.acceleration, 0.05 * 4 * std::numbers::pi * std::numbers::pi, 0.05));
}

// Mass against force constant: in opposite ratio they are one model but for the friction, which the owner knows
// to 5 %.
TEST_CASE("next experiment: friction that is known tells mass from force constant in motion, not at rest") {
    auto axis = described(machine{}).axes[0];
    const proving_ground ground(axis, rough, workshop::count, 1e-7, usual);
    auto motions = standard_motions({0, 0, 0.1, 0.2, 2}, rough, usual);
    const auto names = mass_or_force_constant(axis);
    CHECK(separated(ground, named_motion(motions, "strong accelerations"), names) > 50);
    CHECK(separated(ground, {"rest", std::vector<double>(5000, 0.05)}, names) < 5);
    // The same two where nobody knows the friction: one model under two names, on any motion that slips.
    axis.tolerance.given = {{"mass", 0.02}, {"force_constant", 0.02}, {"viscous", 0.6}, {"coulomb", 0.6}};
    const proving_ground free(axis, rough, workshop::count, 1e-7, usual);
    const auto best =
        best_motion(free, detail::motions_for(names, std::move(motions)), mass_or_force_constant(axis));
    CHECK(best.tried == 7);
    CHECK(best.gain < 1);
    CHECK(best.one_way_gain < 1);
}

// A delay turns the phase, a lag of the same length nearly as much below 20 Hz: above 100 Hz they part.
TEST_CASE("next experiment: the multi-sine is found for a lag or a delay, and slow strokes are worth little" *
          doctest::test_suite("all")) {
    const auto axis = described(machine{}).axes[0];
    const double late = 0.001;
    const std::vector<confusable> names{
        under(suspect::actuator_lag, axis,
              {{.key = "actuator.lag_s", .of = lag_of, .start = late, .low = 1e-5, .high = 0.1, .step = 1e-5}}),
        under(suspect::time_delay, axis,
              {{.key = "delay_s",
                .of = delay_of,
                .start = axis.plant.delay_s + late,
                .low = 0,
                .high = 0.01,
                .step = 1e-5}})};
    const proving_ground ground(axis, workshop::period, workshop::count, 1e-7, usual);
    const auto motions = standard_motions({0, 0, 0.12, 0.17, 2.2}, workshop::period, usual);
    const double slow = separated(ground, named_motion(motions, "slow strokes in"), names);
    const auto best = best_motion(ground, motions, names);
    CAPTURE(slow);
    CAPTURE(motions[best.motion].words);
    CHECK(best.gain > 50);
    CHECK(best.gain > 3 * std::max(slow, 1.0));
    CHECK(motions[best.motion].words.starts_with("multi-sine"));
}

// Friction that differs by direction can be a constant force, not the other way round: only its viscous part is
// its own. Since a proposed motion is evaluated in the scales of its own record, the fit of the second name to
// a log of the first stops short here, and the motion is said to decide both ways. This fails as soon as that
// is corrected.
TEST_CASE("next experiment: where one name is a special case of the other, a motion decides one way only" *
          doctest::should_fail()) {
    const auto axis = described(machine{}).axes[0];
    const std::vector<confusable> names{
        under(
            suspect::constant_force, axis,
            {{.key = "constant_force_N", .of = force_of, .start = 8, .low = -1e4, .high = 1e4, .step = 1e-2}}),
        under(suspect::asymmetric_friction, axis,
              {{.key = "viscous_asymmetry",
                .of = viscous_asymmetry_of,
                .start = -0.5,
                .low = -0.95,
                .high = 0.95,
                .step = 1e-3},
               {.key = "coulomb_asymmetry",
                .of = coulomb_asymmetry_of,
                .start = 0,
                .low = -0.95,
                .high = 0.95,
                .step = 1e-3}})};
    const proving_ground ground(axis, rough, workshop::count, 1e-7, usual);
    const auto motions = standard_motions({0, 0, 0.12, 0.17, 2.2}, rough, usual);
    const auto best = best_motion(ground, {named_motion(motions, "slow strokes of")}, names);
    CHECK(best.gain < 1);
    CHECK(best.one_way_gain > 100);
    CHECK(names[best.one_way_truth].name == &suspect::asymmetric_friction);
}

TEST_CASE("next experiment: a model against itself is worth nothing") {
    const auto axis = described(machine{}).axes[0];
    const proving_ground ground(axis, rough, workshop::count, 1e-7, usual);
    auto names = mass_or_force_constant(axis);
    names[1] = names[0];
    const auto motions = standard_motions({0, 0, 0.1, 0.2, 2}, rough, usual);
    CHECK(std::abs(separated(ground, named_motion(motions, "strong accelerations"), names)) < 0.5);
}

TEST_CASE("next experiment: the other name is fitted again, else the separation is overstated") {
    const auto axis = described(machine{}).axes[0];
    const proving_ground ground(axis, rough, workshop::count, 1e-7, usual);
    const auto motions = standard_motions({0, 0, 0.1, 0.2, 2}, rough, usual);
    const auto names = mass_or_force_constant(axis);
    auto wrong = names[0]; // the truth's own name with a value that no machine has
    wrong.model.fit.x[static_cast<Eigen::Index>(wrong.model.fit.x.size() - 1)] += std::log(1.3);
    CHECK(std::abs(ground.gain(named_motion(motions, "strokes of up to"), names[0], wrong, false)) < 2);
}

TEST_CASE("next experiment: a record is a log of the machine: noise, steps of the encoder, and the "
          "controller's command") {
    const auto axis = described(machine{}).axes[0];
    const double noise = 3e-7; // what the loop makes of it stays below the friction
    const proving_ground ground(axis, workshop::period, workshop::count, noise, usual);
    const planned_motion m{"rest", std::vector<double>(4000, 0.05)};
    const auto log = ground.record(plant_model(axis, usual.give()), m);
    REQUIRE(log.position.size() == 4000);
    double mean = 0, square = 0; // from 0.5 s on
    for (std::size_t k = 1000; k < 4000; ++k) {
        mean += (log.position[k] - 0.05) / 3000;
        square += std::pow(log.position[k] - 0.05, 2) / 3000;
        CHECK(std::abs(std::remainder(log.position[k], workshop::count)) < 1e-12);
    }
    const double seen = std::sqrt(square - mean * mean);
    CAPTURE(seen);
    CHECK(near(seen, noise, 0.1));
    const auto again = replay_controller(*axis.controller, axis.actuator, workshop::period, log.reference,
                                         log.position, log.command);
    double difference = 0;
    for (std::size_t k = 1000; k < again.size(); ++k)
        difference = std::max(difference, std::abs(again[k] - log.command[k]));
    CHECK(difference < 2 * workshop::dac);
}

// Swings of one frequency under noise: a lag and a delay are one signal. The machine is that of the other
// simulator. Since slow means are judged, the log itself separates lag and delay by 18.7 where 15 decides, and
// the strokes that are then
// proposed keep 6 of the 54 that were forecast: the forecast is too high there. This fails as soon as that is
// corrected.
TEST_CASE("diagnose: the next experiment names what the log could not, by at least the gain that was forecast" *
          doctest::test_suite("all") * doctest::should_fail()) {
    machine real;
    auto file = described(real);
    file.excluded_effects = {"stribeck_friction",
                             "presliding_friction",
                             "position_dependent_friction",
                             "friction_drift",
                             "backlash",
                             "structural_resonance",
                             "cogging",
                             "force_ripple",
                             "encoder_cyclic_error",
                             "cutting_force",
                             "sample_loss"}; // time
    real.lag = 0.001;
    real.noise = 5e-7;
    std::vector<double> swings;
    for (int k = 0; k < 5000; ++k)
        swings.push_back(
            0.02 * (1 - std::cos(2 * std::numbers::pi * std::max(0.0, 2 * (k - 200) * workshop::period))));
    const auto before = diagnose(file, as_log(run(real, 2.5, 3, swings)));
    REQUIRE(!before.causes.empty());
    CHECK(before.causes[0].group_probability > 0.9);
    CHECK(before.causes[0].probability < 0.8);
    const experiment& next = before.next;
    REQUIRE(next.separates.size() == 2);
    CHECK(next.axis == "x");
    CHECK(next.gain_of_log < 15);
    CHECK(next.expected_gain > 30);
    CHECK(next.motion.starts_with("multi-sine"));

    const auto seconds = static_cast<double>(next.reference.size()) * workshop::period;
    const auto log = run(real, seconds, 4, next.reference);
    const auto after = diagnose(file, as_log(log));
    named(after, "actuator_lag", "actuator.lag_s", 0.001, 0.1);
    CHECK(after.causes[0].confusable_with.empty());
    const auto record = prepare(log, workshop::period, workshop::count,
                                scales_of(file.axes[0].plant, log, workshop::period, workshop::count));
    const search models(record, file.axes[0], {}, {}, [](const std::string&) {});
    const double kept = models.with({&suspect::actuator_lag}).total - models.with({&suspect::time_delay}).total;
    CAPTURE(next.expected_gain);
    CHECK(kept > 0.7 * next.expected_gain);
}
