// SPDX-License-Identifier: BSL-1.0
// What `compensate` sets in the keys of each kind that has a feedforward makes the axis follow better.
#include "workshop.hpp"

#include <quadrant/diagnosis/compensate.hpp>
#include <quadrant/diagnosis/compensate/compensation_result.hpp>

#include <doctest/doctest.h>

using namespace controllers_workshop;

namespace {

double error_of(const axis_log& log) {
    double sum = 0;
    for (std::size_t k = 100; k < log.position.size(); ++k)
        sum += (log.reference[k] - log.position[k]) * (log.reference[k] - log.position[k]);
    return std::sqrt(sum / static_cast<double>(log.position.size() - 100));
}

/// A machine of one axis under its controller without the feedforward `key`, and its log.
struct bare {
    machine_description file;
    axis_log log;

    bare(std::string_view kind, std::string_view key) {
        file.sample_period_s = machine().sample_period_s;
        file.axes = {axis_of(kind)};
        file.axes[0].name = "x";
        file.axes[0].controller->set(key, 0.0);
        log = logged(file.axes[0], *file.axes[0].controller);
    }
    compensated_axis compensate_for(const char* effect, const char* key, double value) const {
        diagnosis_result d;
        d.verdict = verdict::explained;
        d.axes.resize(1);
        d.axes[0].name = "x";
        cause c;
        c.axis = "x";
        c.effect = effect;
        c.described = true;
        c.probability = c.group_probability = 0.9;
        c.parameters = {{key, {{value, 0.99 * value, 1.01 * value}}}};
        d.causes = {c};
        machine_log whole;
        whole.sample_period_s = file.sample_period_s;
        whole.samples = log.position.size();
        whole.axes = {log};
        return compensate(file, d, whole).axes.at(0);
    }
};

/// Simulates the machine with the keys that were set, and compares the error with that before and with the
/// forecast.
void check(std::string_view kind, const feedforward_key& fed, const char* effect, const char* key,
           double value) {
    CAPTURE(kind);
    const bare before(kind, fed.key);
    const auto result = before.compensate_for(effect, key, value);
    // A kind with a dead band is offered its key beside the feedforward, too.
    const bool banded = !kind_of(*before.file.axes[0].controller).dead_band.empty();
    REQUIRE(result.compensations.size() == (banded ? 2 : 1));
    if (banded) CHECK(result.compensations[1].name == result.compensations[0].name + ", dead band");
    const compensation& set = result.compensations[0];
    REQUIRE(set.keys.size() == 1);
    CHECK(set.keys[0].key == fed.key);
    auto axis = before.file.axes[0];
    axis.controller->set(fed.key, set.keys[0].values[0]);
    const double was = error_of(before.log), is = error_of(logged(axis, *axis.controller));
    // The forecast scores from another row on, which is worth less than a hundredth here.
    CHECK(is >= 0.99 * set.after.rms_m.low);
    CHECK(is <= 1.01 * set.after.rms_m.high);
    if (set.claimed) CHECK(is < was);
}

} // namespace

TEST_CASE("compensate: the viscous feedforward of each kind that has one makes the axis follow better") {
    for (const controller_kind* kind : controller_kinds())
        if (const auto& fed = kind->viscous; !fed.key.empty())
            check(kind->name, fed, "viscous_friction", "viscous_N_s_per_m",
                  axis_of(kind->name).plant.viscous_N_s_per_m);
}

TEST_CASE("compensate: the acceleration feedforward of each kind that has one makes the axis follow better" *
          doctest::test_suite("all")) {
    for (const controller_kind* kind : controller_kinds())
        if (const auto& fed = kind->acceleration; !fed.key.empty())
            check(kind->name, fed, "mass", "mass_kg", axis_of(kind->name).plant.mass_kg);
}

TEST_CASE("compensate: the Coulomb feedforward of each kind that has one makes the axis follow better" *
          doctest::test_suite("all")) {
    for (const controller_kind* kind : controller_kinds())
        if (const auto& fed = kind->coulomb; !fed.key.empty())
            check(kind->name, fed, "coulomb_friction", "coulomb_N", *axis_of(kind->name).plant.coulomb_N);
}
