// SPDX-License-Identifier: BSL-1.0
// LuGre friction of a simulated stage found from its encoder and its command: static map, then the bristles.
#include <quadrant/analysis/fit_lugre.hpp>
#include <quadrant/analysis/fit_stribeck.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/predictive.hpp>
#include <quadrant/observer/kalman.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const auto T = 2_ms;
const auto kf = 40_N / 1_V;
const lugre<>::parameters truth{
    {8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, 1.5e6 * 1_N / 1_m, 3000_N / 1_mps, 10_mmps};

struct gains {
    predictive_weights<> weights;
    quantity<si::force> drift;
};
const gains stiff{bryson_weights(5_um, 4_mmps, 0.02_V), 60_N}; // a slow axis must not jerk
/// The counts of the encoder must not shake the axis: the simulation has none.
const gains soft{bryson_weights(30_um, 10_mmps, 0.01_V), 5_N};

/// The loop on a stage with this friction, along reference(t), from `place` on.
template <class Reference>
test_run<> follow(const gains& g, const lugre<>::parameters& friction, quantity<si::mass> mass,
                  quantity<si::length> encoder, quantity<si::length> place, const Reference& reference,
                  std::size_t samples) {
    linear_motor<lugre<>> motor(
        {.mass = mass, .force_constant = kf, .friction = friction, .encoder_step = encoder, .substeps = 10}, T);
    predictive<> law({.plant = {40.0 / 6.2 * 1_mps2 / 1_V, 2.4 / 1_s}, .weights = g.weights}, T);
    kalman<signal::voltage> speed({6.2_kg, kf, 15_N / 1_mps, 0.29_um, g.drift}, T);
    motor.settle(place), law.settle(place, 0_V), speed.settle(place);
    auto measured = place;
    quantity<si::electric_potential> u{};
    test_run<> log;
    for (std::size_t k = 0; k < samples; ++k) {
        log.position.push_back(measured);
        const auto v = speed(measured, u);
        const auto [x, dx] = reference(double(k + 10) * T.value());
        u = law({place + x * 1_m, dx * 1_mps, {}}, speed.position(), v);
        log.command.push_back(u);
        measured = motor(u);
    }
    return log;
}
struct place_and_speed {
    double x, v;
};
/// Through the presliding displacement and beyond it: 30 um at 3 Hz and 10 um at 40 Hz.
place_and_speed shake(double t) {
    const double a = 2 * std::numbers::pi * 3, b = 2 * std::numbers::pi * 40;
    return {30e-6 * std::sin(a * t) + 10e-6 * std::sin(b * t),
            30e-6 * a * std::cos(a * t) + 10e-6 * b * std::cos(b * t)};
}

template <class Make> std::string refused(Make&& make) {
    try {
        make();
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return {};
}
using commands = std::vector<quantity_of<signal::voltage>>;
} // namespace

TEST_CASE("fit_lugre: static curve and bristles of a stage with a 1 um encoder lie in their intervals, mass 1 "
          "% off") {
    std::vector<test_run<>> slow;
    for (const double v : {0.5e-3, 1e-3, 2e-3, 3.5e-3, 6e-3, 10e-3, 20e-3, 40e-3})
        for (const double way : {1.0, -1.0}) {
            const auto ramp = [&](double t) { return place_and_speed{way * v * t, way * v}; };
            slow.push_back(follow(stiff, truth, 6_kg, 1_um, 0_m, ramp, 1500));
        }
    const auto curve = fit_stribeck(map_friction(slow, T, kf), 2);
    REQUIRE(curve.limits.empty());
    CHECK(curve.coulomb.holds(8_N));
    CHECK(curve.stribeck_velocity->holds(5_mmps));
    CHECK(curve.viscous.holds(15_N / 1_mps));
    // Between two counts a slow axis creeps: 0.3 % low, a little outside of the interval.
    CHECK(std::abs(curve.static_level->value.value() - 12) < 0.06);

    constexpr std::size_t samples = 1200, first = 200;
    std::vector<commands> recorded;
    for (std::size_t r = 0; r < 6; ++r)
        recorded.push_back(follow(soft, truth, 6_kg, 1_um, double(r) * 1.23_um, shake, samples).command);
    lugre<>::parameters last{};
    commands same; // every run was asked to do the same
    const auto simulate = [&](const lugre<>::parameters& friction, std::size_t) {
        if (friction.stiffness != last.stiffness || friction.damping != last.damping)
            same = follow(soft, last = friction, 6.06_kg, 0_m, 0_m, shake, samples).command;
        return same;
    };
    const auto found = fit_lugre<signal::voltage>(
        recorded, simulate, {curve.parameters(), 1e6 * 1_N / 1_m, 1000_N / 1_mps, 10_mmps}, first);
    CHECK(found.converged);
    CHECK(found.stiffness.holds(truth.stiffness));
    CHECK(found.stiffness.high < 1.03 * found.stiffness.low);
    CHECK(found.damping.holds(truth.damping));
    CHECK(found.damping.low > 1500_N / 1_mps);
    CHECK(found.damping.high < 4500_N / 1_mps);
}

TEST_CASE("check_passivity: names rule and figures, and offers a damping that falls just early enough") {
    auto p = truth;
    p.damping = 2985_N / 1_mps, p.damping_velocity = {};
    const auto found = check_passivity(p);
    CHECK_FALSE(found.passive);
    CHECK(found.warning.find("viscous >= damping (Fs - Fc)/Fc = 1492.5 N s/m and has 15; passive with "
                             "damping_velocity = ") != std::string::npos);
    CHECK(lugre<>::passive(found.falling));
    auto later = found.falling;
    later.damping_velocity *= 1.05;
    CHECK_FALSE(lugre<>::passive(later));
    p.damping = 29_N / 1_mps; // 29 4/8 < 15
    CHECK(check_passivity(p).passive);
    CHECK(check_passivity(p).warning.empty());
}

TEST_CASE("fit_lugre: refuses too few runs, a start of 0, and what makes no difference to the command") {
    const auto silent = [](const lugre<>::parameters&, std::size_t) { return commands(10); };
    CHECK(refused([&] { fit_lugre<signal::voltage>(std::vector(2, commands(10)), silent, truth); }) ==
          "fit_lugre.runs = 2: must be 3 or more");
    auto bare = truth;
    bare.damping = {};
    CHECK(refused([&] { fit_lugre<signal::voltage>(std::vector(3, commands(10)), silent, bare); }) ==
          "fit_lugre.start.damping = 0 N s/m: must be finite and above 0");
    CHECK(refused([&] {
              fit_lugre<signal::voltage>(std::vector(3, commands(10)), silent, truth);
          }).find("have to make a difference to the command") != std::string::npos);
    CHECK(refused([&] { fit_lugre<signal::voltage>(std::vector(3, commands(11)), silent, truth); }) ==
          "fit_lugre.simulate (samples) = 10: must be as many as were recorded");
}
