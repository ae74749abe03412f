// SPDX-License-Identifier: BSL-1.0
// What the simulated loop says against a name that predicts the readings.
#include "claims.hpp"
#include "workshop.hpp"

#include <quadrant/diagnosis/diagnose.hpp>

#include <quadrant/diagnosis/verdict/loop_witness.hpp>

#include <algorithm>
#include <array>
#include <doctest/doctest.h>
#include <limits>
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
TEST_CASE("loop witness: the name with which the loop goes furthest, and none that a later one brings back") {
    using detail::accused_by_loop;
    constexpr double never = std::numeric_limits<double>::infinity();
    const auto far = accused_by_loop(std::array{1.0, 1.3, 900.0}, 1.2);
    REQUIRE(far);
    CHECK(far->which == 1);
    CHECK(far->times == doctest::Approx(900 / 1.3));
    CHECK_FALSE(accused_by_loop(std::array{1.0, 1000.0, 0.5}, 1.2)); // a mode beside a delay that damps it
    const auto a_little = accused_by_loop(std::array{1.0, 1000.0, 1.5}, 1.2);
    REQUIRE(a_little);
    CHECK(a_little->which == 0);
    CHECK(a_little->times == doctest::Approx(1.5));
    CHECK_FALSE(accused_by_loop(std::array{1.0, 1.1, 1.2}, 1.2));
    const auto unstable = accused_by_loop(std::array{1.0, never}, 100);
    REQUIRE(unstable);
    CHECK(unstable->times == never);
    CHECK_FALSE(accused_by_loop(std::array{never, never}, 1.2)); // it never ran
    CHECK_FALSE(accused_by_loop(std::array{1.0}, 1.2));
}
