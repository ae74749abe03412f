// SPDX-License-Identifier: BSL-1.0
#include "workshop.hpp"

#include <quadrant/diagnosis/fit/fit.hpp>
#include <quadrant/diagnosis/fit/record.hpp>

#include <doctest/doctest.h>

using namespace quadrant::diagnosis;

namespace {

struct heavier { // a machine of 225 kg that its file says is 180 kg
    machine_description file = workshop::described({});
    axis_log log; // the record looks into it
    axis_record record;
    plant_model plant;

    heavier() : log(log_of(225)) {
        record = prepare(log, workshop::period, workshop::count,
                         scales_of(file.axes[0].plant, log, workshop::period, workshop::count));
        plant = plant_model(file.axes[0].plant, record.scale.give());
    }
    heavier(const heavier&) = delete;
    heavier& operator=(const heavier&) = delete;

private:
    static axis_log log_of(double mass) {
        workshop::machine real;
        real.mass = mass;
        return workshop::run(real);
    }
};

} // namespace

TEST_CASE("predictor: more plants than a pass holds, with different joints, are as each alone") {
    const heavier machine;
    std::vector<plant_model> plants(2 * predictor::abreast + 3, machine.plant);
    for (std::size_t i = 0; i < plants.size(); ++i) {
        plants[i].mass *= 1 + 0.01 * static_cast<double>(i);
        if (i % 3 == 1) plants[i].backlash = 2e-5;
        if (i % 4 == 2) plants[i].spring = 5e3;
        if (i % 5 == 0) plants[i].friction.coulomb += 20;
    }
    std::vector<std::vector<double>> together(plants.size()), moved(plants.size());
    machine.record.observer.run(plants, together, moved);
    for (std::size_t i = 0; i < plants.size(); ++i) {
        std::vector<double> alone, its_way;
        machine.record.observer.run(plants[i], alone, &its_way);
        double size = 0, way = 0, apart = 0, ways_apart = 0;
        for (std::size_t k = 0; k < alone.size(); ++k) {
            size = std::max(size, std::abs(alone[k]));
            way = std::max(way, std::abs(its_way[k]));
            apart = std::max(apart, std::abs(alone[k] - together[i][k]));
            ways_apart = std::max(ways_apart, std::abs(its_way[k] - moved[i][k]));
        }
        CAPTURE(i);
        CHECK(apart <= 1e-6 * size); // an exponential of lanes is not the C library's to the last bit
        CHECK(ways_apart <= 1e-6 * way);
    }
}

TEST_CASE("fit: behind a step that fails all with more damping are asked for at once, and the first that is "
          "better is taken") {
    const heavier machine;
    const axis_record& record = machine.record;
    const fitter fit(record.observer, record.score);
    const parameter mass{.key = "mass_kg",
                         .of = [](plant_model& m) -> double& { return m.mass; },
                         .start = machine.plant.mass,
                         .low = 50,
                         .high = 500,
                         .logarithmic = true};
    fit_course course(fit, machine.plant, {mass}, 1);
    const std::vector<double> choices(8, 0.0);
    std::vector<plant_model> asked;
    const auto answered = [&] { // the innovations of what the course asks for
        asked.clear();
        course.ask(asked);
        std::vector<std::vector<double>> e(asked.size());
        record.observer.run(asked, e);
        return e;
    };
    const auto spoil = [](std::vector<double>& e) {
        for (double& x : e) x *= 100;
    };
    auto e = answered(); // where it begins, and the slope
    CHECK(course.take(e, choices) == 2);
    e = answered();
    REQUIRE(asked.size() == 1);
    const double whole = asked[0].mass - machine.plant.mass;
    spoil(e[0]);
    CHECK(course.take(e, choices) == 1);
    e = answered();
    REQUIRE(asked.size() == 5);
    double before = std::abs(whole);
    for (const plant_model& p : asked) {
        CHECK(std::abs(p.mass - machine.plant.mass) < before);
        before = std::abs(p.mass - machine.plant.mass);
    }
    const double second = asked[1].mass;
    spoil(e[0]);
    CHECK(course.take(e, choices) == 5);
    CHECK(course.done());
    CHECK(course.result().plant.mass == second);
}
