// SPDX-License-Identifier: BSL-1.0
// The plant model, its fit, and the search for what the model lacks.
#include "workshop.hpp"

#include <quadrant/diagnosis/controller/cascade_p_pi.hpp>
#include <quadrant/diagnosis/effect/effects.hpp>
#include <quadrant/diagnosis/fit/spatial_spectrum.hpp>
#include <quadrant/diagnosis/how_far/closed_loop.hpp>
#include <quadrant/diagnosis/how_far/how_far.hpp>
#include <quadrant/diagnosis/where/controller_floor.hpp>
#include <quadrant/diagnosis/where/places.hpp>
#include <quadrant/diagnosis/which/causes.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {
constexpr double two_pi = 2 * std::numbers::pi;
} // namespace

TEST_CASE("joint starts: an effect begins beside another where it was found by itself") {
    const parameter mass{.key = "mass_kg",
                         .of = [](plant_model&p) -> double& { return p.mass; },
                         .start = 134,
                         .low = 10,
                         .high = 900},
        constant{.key = "constant_force_N",
                 .of = [](plant_model&p) -> double& { return p.constant_force; },
                 .start = 0,
                 .low = -600,
                 .high = 600};
    plant_description d;
    d.mass_kg = 134;
    d.force_constant_N_per_V = 1;
    fit_result found{.plant = plant_model(d, workshop::usual.give()), .parameters = {constant, mass}};
    found.plant.mass = 165;
    const std::vector<std::vector<parameter>> starts{{mass}};
    const auto begun = detail::begun_where(found, starts);
    REQUIRE(begun);
    CHECK(begun->front().start == 165);
    found.plant.mass = 1000; // a start stays inside its bounds
    CHECK(detail::begun_where(found, starts)->front().start == 900);
    found.plant.mass = 135; // the start that there is
    CHECK_FALSE(detail::begun_where(found, starts));
    found.plant.mass = 165;
    found.parameters = {constant}; // the fit did not move it
    CHECK_FALSE(detail::begun_where(found, starts));
    CHECK_FALSE(detail::begun_where(found, {}));
}

TEST_CASE("predictor: a right model leaves nothing, a missing force leaves d T^2 / (M (1 - z)^2)") {
    const double period = 0.0005, mass = 100, force = 5;
    plant_description d;
    d.mass_kg = mass;
    d.force_constant_N_per_V = 100;
    d.delay_s = 0.0003;
    d.viscous_N_s_per_m = 40;
    plant_model real(d, workshop::usual.give());
    real.constant_force = force;
    std::vector<double> position, command;
    const auto boxes = axis_parameters(real);
    const plant_axis older(boxes, 0.0003), newer(boxes, period - 0.0003);
    plant_axis::state s;
    for (std::size_t k = 0; k < 6000; ++k) {
        position.push_back(s.x);
        command.push_back(std::sin(0.01 * static_cast<double>(k)));
        older.advance(s, command[k > 0 ? k - 1 : 0], {});
        newer.advance(s, command[k], {});
    }
    const predictor observer{.period = period, .corner_Hz = 60, .position = position, .command = command};
    std::vector<double> e;
    observer.run(real, e);
    CHECK(rms(std::span(e).subspan(1000)) < 1e-12);
    observer.run(plant_model(d, workshop::usual.give()), e);
    const double w = two_pi * observer.corner_Hz;
    const double z = std::exp(-w * period); // at rest L2 e makes up for d T / M in each period
    CHECK(workshop::near(e[5000], force / mass * std::pow(period / (1 - z), 2), 0.005));
}

TEST_CASE("plant model: moves as the library's linear motor does, and sticks") {
    namespace q = quadrant;
    plant_description d;
    d.mass_kg = 200;
    d.force_constant_N_per_V = 1000;
    d.viscous_N_s_per_m = 300;
    d.coulomb_N = 60;
    d.static_N = 90;
    d.stribeck_velocity_m_per_s = 0.003;
    const plant_model model(d, workshop::usual.give());
    q::linear_motor<q::stribeck<>> motor{
        {.mass = q::quantity<q::si::mass>::from_value(200),
         .force_constant = q::gain_of<q::signal::force, q::signal::voltage>::from_value(1000),
         .friction = {.coulomb = q::quantity<q::si::force>::from_value(60),
                      .static_level = q::quantity<q::si::force>::from_value(90),
                      .stribeck_velocity = q::quantity<q::si::velocity>::from_value(0.003),
                      .viscous = q::gain_of<q::signal::force, q::signal::velocity>::from_value(300)},
         .substeps = 20},
        q::duration::from_value(0.0005)};
    const plant_axis axis(axis_parameters(model), 0.0005 / 20);
    plant_axis::state s;
    for (int k = 0; k < 4000; ++k) {
        const double u = 0.2 * std::sin(0.004 * k);
        motor(q::quantity<q::si::electric_potential>::from_value(u));
        for (int i = 0; i < 20; ++i) axis.advance(s, u, {});
    }
    // 65 mm of motion; two contacts that give and break away otherwise differ by 50 um behind four reversals.
    CHECK(std::abs(s.x - motor.now().x.value()) < 1e-4);
    s = {};
    for (int k = 0; k < 40000; ++k)
        axis.advance(s, 0.085 * std::min(1.0, k / 20000.0), {}); // up to 85 N, below the 90 N that break away
    CHECK(std::abs(s.v) < 1e-9);
    CHECK(s.x < 3e-7);
}

TEST_CASE("calibration: a constant force and the asymmetries of friction move inside their tolerances, of "
          "either sign; "
          "what the file does not describe stays") {
    axis_description axis;
    axis.plant.mass_kg = 10;
    const auto moving = [&](std::string_view key) {
        std::optional<parameter> out;
        for (parameter& p : calibration(axis, workshop::usual.give()))
            if (p.key == key) out = std::move(p);
        return out;
    };
    CHECK_FALSE(moving("constant_force_N"));
    for (const double sign : {-1, 1}) {
        axis.plant.constant_force_N = sign * 4;
        axis.plant.coulomb_N = 5;
        axis.plant.coulomb_asymmetry = sign * 0.2;
        axis.plant.viscous_asymmetry = sign * 0.1;
        for (const auto& described : {std::pair{"constant_force_N", 4.0}, std::pair{"coulomb_asymmetry", 0.2},
                                      std::pair{"viscous_asymmetry", 0.1}}) {
            const char* const key = described.first;
            const double value = described.second;
            CAPTURE(key);
            const auto p = moving(key);
            REQUIRE(p);
            plant_model plant(axis, workshop::usual.give());
            CHECK(workshop::near(p->of(plant), sign * value, 1e-12));
            CHECK(workshop::near(p->low, sign * value - 0.05 * value, 1e-12)); // no tolerance is given
            CHECK(workshop::near(p->high, sign * value + 0.05 * value, 1e-12));
            CHECK(workshop::near(p->from_fit(p->expected), sign * value, 1e-12));
            CHECK(p->spread > 0);
        }
    }
}

TEST_CASE(
    "calibration: a contact described as giving way stays as described, one that gives way a little may move") {
    plant_description d;
    d.mass_kg = 200;
    d.coulomb_N = 60;
    const auto calibrated = [&] { // the machine file as calibration begins with it
        plant_model plant(d, workshop::usual.give());
        bool moves = false;
        axis_description axis;
        axis.plant = d;
        for (const parameter& p : calibration(axis, workshop::usual.give())) {
            p.of(plant) = p.start;
            moves |= p.key == "presliding_length_m";
        }
        return std::pair(plant.friction.contact, moves);
    };
    CHECK(calibrated().second);
    d.presliding_length_m = 1e-5;
    CHECK(workshop::near(calibrated().first.way_to_63_percent(), 1e-5, 1e-9));
    CHECK_FALSE(calibrated().second);
    d.presliding_length_m.reset();
    for (double stiffness : {60 / 1e-6, 60 / 1e-5}) { // one element: of 1 um, of 10 um
        d.gms_weights = {1};
        d.gms_stiffness_N_per_m = {stiffness};
        const auto [contact, moves] = calibrated();
        CHECK(workshop::near(contact.lengths()[0], 60 / stiffness, 1e-9));
        CHECK(moves == (60 / stiffness < 2e-6));
    }
    d.gms_weights = {0.5, 0.5};
    d.gms_stiffness_N_per_m = {3e7, 3e6};
    const auto [contact, moves] = calibrated();
    CHECK(workshop::near(contact.lengths()[0], 1e-6, 1e-9));
    CHECK(workshop::near(contact.lengths()[1], 1e-5, 1e-9));
    CHECK_FALSE(moves);
    d.coulomb_N = 0; // nothing gives way, and no length comes of it
    CHECK(calibrated().first.length > 0);
}

TEST_CASE("fit: bounds hold, and a value beyond them is found once it is free") {
    workshop::machine real;
    const auto file = workshop::described(real);
    real.mass = 225;
    const auto log = workshop::run(real);
    const auto record = prepare(log, workshop::period, workshop::count,
                                scales_of(file.axes[0].plant, log, workshop::period, workshop::count));
    const search models(record, file.axes[0], {}, {}, [](const std::string&) {});
    CHECK(models.calibrated().fit.plant.mass <= 180 * 1.012 * 1.02 * (1 + 1e-9));
    CHECK(models.with({&suspect::mass}).fit.plant.mass == doctest::Approx(225).epsilon(0.02));
}

TEST_CASE("diagnose: a value that stopped at the end of its range is marked, one inside is not") {
    candidate c;
    c.fit.parameters = {{.key = "mass_kg", .low = 1, .high = 4, .logarithmic = true},
                        {.key = "spring_N_per_m", .low = 0, .high = 10}};
    c.fit.x = Eigen::Vector2d(std::log(4.0), 5);
    std::vector<parameter_estimate> found{{"mass_kg", {{4, 3, 5}}}, {"spring_N_per_m", {{5, 4, 6}}}};
    mark_bounds(c, found);
    CHECK(found[0].on_bound);
    CHECK_FALSE(found[1].on_bound);
    c.fit.x[1] = 0;
    mark_bounds(c, found);
    CHECK(found[1].on_bound);
}

TEST_CASE("doubt_by_loop: claims with which the loop goes further from the log are suspects") {
    const auto left = [](std::vector<double> said, const std::vector<double>& errors) {
        std::vector<cause> causes(said.size());
        for (std::size_t i = 0; i < said.size(); ++i)
            causes[i].probability = causes[i].group_probability = said[i];
        doubt_by_loop(causes, errors);
        for (std::size_t i = 0; i < said.size(); ++i) {
            CHECK(causes[i].probability == causes[i].group_probability);
            said[i] = causes[i].probability;
        }
        return said;
    };
    using probabilities = std::vector<double>;
    CHECK(left({0.9}, {1, 0.1}) == probabilities{0.9});
    CHECK(left({0.9}, {1, 1.05}) == probabilities{0.9}); // no clear difference
    CHECK(left({0.9}, {1, 1.2}) == probabilities{0.4});
    CHECK(left({0.9, 0.8}, {1, 1.5, 0.1}) == probabilities{0.9, 0.8}); // both together correct it
    CHECK(left({0.9, 0.8}, {1, 0.1, 0.2}) == probabilities{0.9, 0.4});
    CHECK(left({0.9, 0.1}, {1, 0.1, 0.2}) == probabilities{0.9, 0.1}); // only a suspect
    CHECK(left({0.9}, {}) == probabilities{0.9});                      // no loop
}

TEST_CASE("search: a law holds another in its place, beside the same names") {
    const auto with = [](std::vector<const effect*> some) { return candidate{.effects = std::move(some)}; };
    const effect *cutting = effect_named("cutting_force"), *constant = effect_named("constant_force"),
                 *coulomb = effect_named("coulomb_friction");
    CHECK(search::holds(with({cutting}), with({constant})));
    CHECK(search::holds(with({coulomb, cutting}), with({constant, coulomb})));
    CHECK_FALSE(search::holds(with({constant}), with({cutting})));
    CHECK_FALSE(search::holds(with({cutting}), with({coulomb})));
    CHECK_FALSE(search::holds(with({cutting}), with({cutting})));
    CHECK_FALSE(search::holds(with({cutting, coulomb}), with({constant})));
    CHECK_FALSE(search::holds(with({cutting, constant}), with({cutting, coulomb})));
}
