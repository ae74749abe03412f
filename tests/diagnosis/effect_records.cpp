// SPDX-License-Identifier: BSL-1.0
#include "quadrant/diagnosis/effect/described_numbers.hpp"
#include "quadrant/diagnosis/effect/effect.hpp"
#include "quadrant/diagnosis/model/plant_axis.hpp"
#include "quadrant/diagnosis/model/plant_model.hpp"

#include <algorithm>
#include <doctest/doctest.h>

#include <set>

using namespace quadrant::diagnosis;

TEST_CASE("key_unit: a key is split before its unit, and the unit is written as in a text") {
    struct row {
        const char *key, *stem, *unit;
    };
    for (const row& r :
         {row{"stribeck_velocity_m_per_s", "stribeck_velocity", "m/s"},
          row{"acceleration_feedforward_V_s2_per_m", "acceleration_feedforward", "V s²/m"},
          row{"quadratic_Nm_s2_per_rad2", "quadratic", "N m s²/rad²"}, row{"inertia_kg_m2", "inertia", "kg m²"},
          row{"position_gain_per_s", "position_gain", "1/s"}, row{"encoder.cyclic_m", "encoder.cyclic", "m"},
          row{"process.force_N", "process.force", "N"}, row{"travel_per_turn_m", "travel_per_turn", "m"},
          row{"friction_drift", "friction_drift", ""}, row{"m", "m", ""}}) {
        CAPTURE(r.key);
        CHECK(parts_of(r.key).stem == r.stem);
        CHECK(unit_text(parts_of(r.key).unit) == r.unit);
    }
}

TEST_CASE("effects: every record says what pages and files need, and no name or key stands in two of them") {
    std::set<std::string_view> names, keys, tolerances;
    for (const effect* e : every_effect()) {
        CAPTURE(e->name);
        CHECK(names.insert(e->name).second);
        CHECK(!e->label.empty());
        CHECK(!e->exciting_motion.empty());
        CHECK(!e->shows.empty());
        CHECK(e->remedy.ends_with('.'));
        CHECK(!e->prior.reason.empty());
        CHECK(e->prior.odds > 0);
        CHECK((e->starts == nullptr) == (e->read == nullptr));
        // The trial's machines of this simulator have one encoder, and what happens in a log is no number of a
        // machine.
        const bool in_trials = e->name != "added_command" && e->name != "drive_dropout" &&
                               e->name != "missed_steps" && e->box != "transmission";
        CHECK((e->trial.into != nullptr) == in_trials);
        CHECK((e->trial.low < e->trial.high) == in_trials);
        for (const auto other : e->equivalent) CHECK((other.empty() || effect_named(other) != nullptr));
        for (const auto inside : e->ends_inside)
            CHECK((inside.empty() || std::any_of(e->keys.begin(), e->keys.end(),
                                                 [&](const machine_key& k) { return k.name == inside; })));
        for (const machine_key& k : e->keys) {
            CAPTURE(k.name);
            CHECK(keys.insert(k.name).second);
            CHECK(!k.meaning.empty());
            // A drive has one position gain: in 1/s, or as a duty. A play is known as well on either side.
            const bool first = k.tolerance && tolerances.insert(k.tolerance_name()).second;
            CHECK((!k.tolerance || first || k.name == "drive.position_gain_per_m" || k.key() == "backlash_m"));
            CHECK(key_named(k.name_for(axis_kind::rotary)) == &k);
            if (e->law) CHECK(e->law->index_of(k.name) < e->law->count());
        }
    }
}

// A spring about a zero of its own is a spring and a constant force: a key of another record.
TEST_CASE("effects: what an effect reads from a fitted model are keys of the records") {
    const plant_model plant;
    for (const effect* e : every_effect()) {
        if (!e->read || e->keys.empty())
            continue; // without a key it happened in one record, and has words of its own
        CAPTURE(e->name);
        for (const key_value& found : e->read(plant)) {
            CAPTURE(found.key);
            CHECK(key_named(found.key) != nullptr);
        }
    }
}

TEST_CASE("effects: a key without member and law is kept under its name, whatever its box") {
    constexpr machine_key arm{.name = "payload.arm_m", .same_when_rotary = true},
        errors{.name = "transmission.pitch_error_m", .shape = key_shape::harmonics};
    const effect payload{.name = "arm_length", .keys = {arm, errors}};
    CHECK(arm.box() == "payload");
    CHECK(arm.key_for(axis_kind::rotary) == "arm_m");
    CHECK(errors.key_for(axis_kind::rotary) == "pitch_error_rad");
    axis_description axis;
    CHECK(numbers_of(axis, arm, payload).empty());
    put_numbers(axis, arm, payload, {0.18});
    put_numbers(axis, errors, payload, {2e-6, 1e-6});
    CHECK(numbers_of(axis, arm, payload) == std::vector<double>{0.18});
    CHECK(numbers_of(axis, errors, payload) == std::vector<double>{2e-6, 1e-6});
    CHECK(axis.numbers.size() == 2);
}

TEST_CASE("effects: behind closed loops what resists is searched up to what the motor can move") {
    plant_description described;
    described.mass_kg = 0.0075;
    described.force_constant_N_per_V = 0.12;
    const plant_model leader(described, 1e-4);
    axis_record record;
    std::vector<double> position, residual, innovation(100);
    for (int k = 0; k < 100; ++k) {
        position.push_back(std::sin(0.1 * k));
        record.velocity.push_back(std::cos(0.1 * k));
        // Of a friction that holds the arm next to nothing is seen.
        residual.push_back(1e-3 * (record.velocity.back() + position.back()));
    }
    record.position = position;
    record.scale.command = 7.4;
    record.scale.speed = 2;
    record.score.skip = 0;
    const tolerance_description tolerance;
    const screening look{described, tolerance, record, leader, residual, innovation};
    const double force = look.force_scale();
    const std::vector<std::pair<std::string, double>> moved{{"coulomb_friction", force},
                                                            {"viscous_friction", force / 2},
                                                            {"gravity", force},
                                                            {"quadratic_drag", force / 4}};
    for (const auto& of : moved) {
        INFO(of.first);
        const auto most = [&, e = effect_named(of.first)] { return e->starts(look).front().front().high; };
        record.observer.closed.reset();
        const double usual = most();
        record.observer.closed = 0.0;
        CHECK(most() == doctest::Approx(of.second).epsilon(1e-9));
        CHECK(most() > 2 * usual);
    }
}
TEST_CASE("plant_model: a search may take the mass below its mode's part, and the axis can still be made") {
    plant_description d;
    d.mass_kg = 100;
    d.force_constant_N_per_V = 1;
    plant_model p(d, 1e-6);
    p.mode.mass = 20;
    CHECK(p.second_mass() == 20);
    p.mass = 10;
    CHECK(p.second_mass() == doctest::Approx(9.5));
    CHECK_NOTHROW(axis_parameters(p));
    CHECK(axis_parameters(p).second.mass.value() == doctest::Approx(9.5));
}
