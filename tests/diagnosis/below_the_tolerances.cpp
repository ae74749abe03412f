// SPDX-License-Identifier: BSL-1.0
#include "claims.hpp"

#include <quadrant/diagnosis/which/like_friction.hpp>

using namespace workshop;

// What tolerances and laws of friction are wrong by excuses a rest that has no name. An effect that is surely
// there, and whose force no law of friction makes, is named though it is small beside them.

namespace {

diagnosis_result with_holdout(const machine& real, const machine_description& file) {
    const auto other = as_log(run(real, three_strokes, 7));
    return diagnose(file, as_log(run(real)), &other);
}
/// What is claimed of a machine that its file describes but for what was changed.
std::vector<std::string> claimed_of(void (*change)(machine&)) {
    machine real;
    const auto file = described(real);
    change(real);
    return claims(with_holdout(real, file));
}

} // namespace

TEST_CASE("below the tolerances: forces that no law of friction makes are named" * doctest::test_suite("all")) {
    using names = std::vector<std::string>;
    CHECK(claimed_of([](machine& m) { m.ripple = 0.02; }) == names{"force_ripple"});
    CHECK(claimed_of([](machine& m) { m.cutting = 4; }) == names{"cutting_force"});
    CHECK(claimed_of([](machine& m) { m.cogging = 2; }) == names{"cogging"});
    CHECK(claimed_of([](machine& m) { m.friction_along = 0.05; }) == names{"position_dependent_friction"});
}

TEST_CASE("below the tolerances: a friction of another law is no cause" * doctest::test_suite("all")) {
    for (const double share : {0.02, 0.04}) {
        machine real;
        const auto file = described(real);
        // Less friction the faster, by up to that share; a hump at 50 mm/s.
        const bool hump = share < 0.03;
        real.stranger = [=](double, double v, double) {
            return hump ? -share * 60 * (v / 0.05) * std::exp(1 - std::abs(v) / 0.05)
                        : share * 60 * std::tanh(v / 1e-4) * std::abs(v) / 0.3;
        };
        const auto d = with_holdout(real, file);
        CAPTURE(said(d));
        CHECK(d.verdict <= verdict::within_tolerance);
    }
}

TEST_CASE("below the tolerances: a suspect that nobody is told of takes nothing off") {
    machine real;
    const auto file = described(real);
    auto calibrated_alone = file;
    for (const effect* e : every_effect()) calibrated_alone.excluded_effects.emplace_back(e->name);
    real.backlash = 1e-6;
    const auto d = diagnosed(file, real);
    CAPTURE(said(d));
    REQUIRE(d.verdict == verdict::within_tolerance);
    REQUIRE(!d.axes[0].calibrated_with_suspects.empty());
    const auto left = [](const diagnosis_result& x) { return x.axes[0].gap_after.force_rms_N; };
    CHECK(left(d) == doctest::Approx(left(diagnosed(calibrated_alone, real))).epsilon(0.01));
}

TEST_CASE("below the tolerances: what is left beside friction") {
    // Strokes of a fifth of a metre, as a cosine: the same speeds and ways in both directions.
    axis_record r;
    std::vector<double> x, friction, along;
    for (int k = 0; k < 8000; ++k) {
        const double turn = 2 * std::numbers::pi * k / 4000.0;
        x.push_back(0.1 * (1 - std::cos(turn)));
        r.velocity.push_back(0.1 * 2 * std::numbers::pi * std::sin(turn));
        r.acceleration.push_back(std::cos(turn));
        friction.push_back(-(5 + 2 * std::exp(-std::abs(r.velocity.back()) / 0.1)) *
                           (std::sin(turn) < 0 ? -1 : 1));
        along.push_back(std::sin(2 * std::numbers::pi * x.back() / 0.013));
    }
    r.position = x;
    r.scale = {.travel = 0.2, .speed = 0.63, .command = 1, .count = 1e-6, .corner_Hz = 50};
    r.resolution = 1e-6;
    const auto left = [&](const std::vector<double>& force) {
        const double energy = rms(detail::beside_friction(r, force));
        return energy * energy / (rms(force) * rms(force));
    };
    CHECK(left(friction) < 0.01);
    CHECK(left(along) > 0.5);
}
