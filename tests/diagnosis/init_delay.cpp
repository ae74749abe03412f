// SPDX-License-Identifier: BSL-1.0
#include <quadrant/diagnosis/init.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant::diagnosis;

TEST_CASE("init: the command of a row acts after its delay, and until the next row") {
    constexpr double period = 2e-3, mass = 2, viscous = 3;
    for (const double delay : {0.0, 2e-3}) {
        machine_log log;
        log.file = "log.csv";
        log.sample_period_s = period;
        log.samples = 4000;
        axis_log x;
        x.name = "x";
        x.command_unit = "N";
        double at = 0, speed = 0;
        for (std::size_t k = 0; k < log.samples; ++k) {
            const double t = static_cast<double>(k) * period;
            x.command.push_back(30 * std::sin(25 * t) + 20 * std::sin(9 * t + 1));
            x.position.push_back(at);
            const auto late = static_cast<std::size_t>(delay / period);
            const double force = k < late ? 0 : x.command[k - late];
            for (int i = 0; i < 20; ++i) { // constant over the row, in fine steps
                const double h = period / 20, before = speed;
                speed += h * (force - viscous * speed) / mass;
                at += h * (before + speed) / 2;
            }
        }
        x.reference = x.position;
        log.axes.push_back(x);
        init_request r;
        r.from_log = true;
        r.values["delay"][""] = delay;
        CAPTURE(delay);
        const auto plant = init_machine(r, &log).machine["axes"]["x"]["plant"];
        CHECK(plant["mass_kg"].get<double>() == doctest::Approx(mass).epsilon(0.01));
        CHECK(plant["viscous_N_s_per_m"].get<double>() == doctest::Approx(viscous).epsilon(0.02));
        if (delay > 0) continue;
        // What was measured behind the amplifier acts at its row.
        for (std::size_t k = 0; k < log.samples; ++k) {
            const double t = (static_cast<double>(k)) * period;
            log.axes[0].command[k] =
                30 * std::sin(25 * (t - period / 2)) + 20 * std::sin(9 * (t - period / 2) + 1);
        }
        r.command_is = command_origin::measured;
        const auto measured = init_machine(r, &log).machine["axes"]["x"]["plant"];
        CHECK(measured["viscous_N_s_per_m"].get<double>() == doctest::Approx(viscous).epsilon(0.02));
    }
}
