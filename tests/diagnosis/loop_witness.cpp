// SPDX-License-Identifier: BSL-1.0
// What the simulated loop says against a name that predicts the readings.
#include "claims.hpp"
#include "workshop.hpp"

#include <quadrant/diagnosis/diagnose.hpp>

#include <algorithm>
#include <doctest/doctest.h>
#include <string>

using namespace workshop;

namespace {

void is_told_with_friction(double cogging, double period, double coulomb) {
    machine real;
    real.cogging = cogging;
    real.cogging_period = period;
    real.coulomb = coulomb;
    auto file = described(real);
    file.axes[0].plant.coulomb_N.reset();
    const auto d = diagnose(file, as_log(run(real)));
    CHECK(claims(d) == std::vector<std::string>{"cogging", "coulomb_friction"});
    REQUIRE(d.causes.size() >= 2);
    CHECK(near(value_of(d.causes[0], "cogging_N").value, cogging, 0.02));
    CHECK(near(value_of(d.causes[1], "coulomb_N").value, coulomb, 0.03));
    CHECK(d.axes[0].gap_after.position_rms_m < 0.1 * d.axes[0].gap.position_rms_m);
    const bool is_said = std::any_of(d.notes.begin(), d.notes.end(), [](const std::string& n) {
        return n.find("the simulated loop does not follow with it") != n.npos;
    });
    CHECK(is_said);
}

} // namespace

TEST_CASE("diagnose: a cogging larger than the friction beside it is no motor that ignores its command") {
    is_told_with_friction(300, 0.03, 60);
}
TEST_CASE("diagnose: nor is a cogging of two kilonewtons with a period of 12 mm" * doctest::test_suite("all")) {
    is_told_with_friction(2000, 0.012, 200);
}
