// SPDX-License-Identifier: BSL-1.0
// Effects that no log of a drive with loops of its own can show.
#include "quadrant_gap/trial/population.hpp"

#include <doctest/doctest.h>

using namespace quadrant_gap::trial;

namespace {

/// The motion of a velocity drive under these volts: the reference asks for them, and no loop corrects.
std::vector<double> motion_under(const std::vector<double>& volts, axis_truth a, double period) {
    a = ideal(a);
    a.controller.position_gain = 0;
    std::vector<double> reference{0};
    for (double u : volts) reference.push_back(reference.back() + period * a.drive.velocity_per_V * u);
    auto out = run({a}, {reference}, period, 1)[0].position;
    out.pop_back();
    return out;
}

} // namespace

TEST_CASE("population: what numbers of a drive inside their tolerances do as well is no effect of its machine" *
          doctest::test_suite("all")) {
    // Viscous friction behind a velocity loop without integral: the same volts move the axis as well where the
    // gain is larger by it, and the velocity a volt smaller in that ratio.
    const planned p = plan(20261210, 40, population::velocity_p)[30];
    REQUIRE(p.effects == std::vector<std::string>{"viscous_friction"});
    const drawn_machine m = draw(20261210, 30, p);
    const double gain = m.described[0].drive.velocity_gain, allowed = tolerance_of_gains * gain;
    axis_truth rubs = m.described[0], pulls = rubs;
    rubs.friction.viscous += allowed;
    pulls.drive.velocity_gain += allowed;
    pulls.drive.velocity_per_V *= gain / pulls.drive.velocity_gain;
    const auto volts = run({ideal(rubs)}, m.log_reference, m.period, 1)[0].command;
    const auto apart = [&](const axis_truth& a, const axis_truth& b) {
        return detail::rms_of_difference(motion_under(volts, a, m.period), motion_under(volts, b, m.period));
    };
    CHECK(apart(rubs, pulls) < 1e-4 * apart(rubs, m.described[0])); // what is left is of the fine steps
    // So says the observer who knows every law.
    drawn_machine hides = m;
    hides.log_reference[0].resize(2500);
    CHECK(detail::shows_in_a_log(hides, m.described[0]));
    hides.truth[0] = m.described[0];
    hides.truth[0].friction.viscous += 0.9 * allowed;
    CHECK_FALSE(detail::shows_in_a_log(hides, m.described[0]));
    // A mass inside its tolerance; one outside it shows.
    hides.tolerance.mass = 0.02;
    hides.truth[0] = m.described[0];
    hides.truth[0].mechanics.mass *= 1.018;
    CHECK_FALSE(detail::shows_in_a_log(hides, m.described[0]));
    hides.truth[0].mechanics.mass *= 1.1;
    CHECK(detail::shows_in_a_log(hides, m.described[0]));
    // A constant force, which is where the integral began.
    hides.truth[0] = m.described[0];
    hides.truth[0].mechanics.constant_force = 0.1 * m.described[0].controller.limit;
    CHECK(detail::shows_in_a_log(hides, m.described[0]));
    drawn_machine integrates = hides;
    for (auto* axes : {&integrates.truth, &integrates.described})
        (*axes)[0].drive.velocity_integral = 10 * (*axes)[0].drive.velocity_gain;
    CHECK_FALSE(detail::shows_in_a_log(integrates, integrates.described[0]));
    const auto holds = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [](const auto* e) { return e->name == "constant_force"; });
    };
    CHECK(holds(withheld_from(population::velocity_p)));
    CHECK(holds(withheld_from(population::velocity_pi, logs::measured)));
    CHECK_FALSE(holds(withheld_from(population::velocity_pi)));
    // An excluded process force has no mean: that is a constant force, and its name is no lie.
    const planned removed = plan(20261210, 40, population::velocity_p)[13];
    REQUIRE(removed.effects == std::vector<std::string>{"cutting_force"});
    CHECK(draw(20261210, 13, removed).truth[0].process.mean == 0);
}
