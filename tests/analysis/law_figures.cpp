// SPDX-License-Identifier: BSL-1.0
// Steps, margins and standard contours for any law of a feed drive.
#include "quadrant_reproduce/virtual_cnc.hpp"

#include <quadrant/analysis/contour_run.hpp>
#include <quadrant/analysis/law_figures.hpp>
#include <quadrant/analysis/standard_contours.hpp>
#include <quadrant/control/generalized_predictive.hpp>
#include <quadrant/control/pole_placement.hpp>
#include <quadrant/control/state_feedback.hpp>
#include <quadrant/control/zero_phase_tracking.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <deque>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;
namespace an = quadrant::analysis;

namespace {
const quadrant::axis_model<signal::voltage> plant = vcnc::model(vcnc::x_axis);
const an::sampled_axis<> axis{plant, 1_ms};
an::sampled_axis<> stronger(double by) { return {{plant.gain * by, plant.viscous_rate}, 1_ms}; }
an::contour_options limits() {
    const auto free = trajectory::motion_limits{};
    return {.limits = {{free, free, free}, {0.2_mps, 2_mps2, 50.0 * 1_mps2 / 1_s}}};
}
constexpr auto feed = 0.2_mps;
} // namespace

TEST_CASE("reference_step: a pair of damping 0.5 overshoots by exp(-pi/sqrt(3)), at pi/(w sqrt(3)/2)") {
    const pole_placement<> law{place_rst(plant, {.natural = 10_Hz, .damping = 0.5, .observer = 30_Hz}, 1_ms),
                               1_ms};
    const auto y = an::reference_step(law, axis, 1_mm);
    const double w = 2 * std::numbers::pi * 10;
    CHECK(std::abs(y.overshoot - std::exp(-std::numbers::pi / std::sqrt(3))) < 2e-3);
    // The hold and the zero of the plant make it half a period and half a period later.
    CHECK(std::abs(y.peak_time.value() - 1e-3 - 2 * std::numbers::pi / (w * std::sqrt(3))) < 1e-3);
    REQUIRE(y.settling);
    double last = 0; // when 1 - x = e^{-w t/2} (cos a + sin a/sqrt(3)), a = w t sqrt(3)/2, was last beyond 2 %
    for (double t = 0; t < 0.5; t += 1e-5) {
        const double a = w * t * std::sqrt(3) / 2;
        if (std::abs(std::exp(-w * t / 2) * (std::cos(a) + std::sin(a) / std::sqrt(3))) > 0.02) last = t;
    }
    CHECK(std::abs(y.settling->value() - 1e-3 - last) < 1.5e-3);
    REQUIRE(y.rise);
    CHECK(std::abs(y.rise->value() - 1.638 / w) < 1.5e-3); // tables of the second-order step, damping 0.5
    CHECK(std::abs(y.rest.value()) < 1e-9);
}
TEST_CASE("disturbance_step: without an integral what is left is the force over the gain, and it does not "
          "count as settled") {
    auto p = vcnc::pid_of(vcnc::x_axis);
    p.integral_gain = {};
    const auto y = an::disturbance_step(pid<>{p, 1_ms}, axis, 1_V);
    CHECK(y.rest.value() == doctest::Approx(1 / 70e3).epsilon(1e-6).scale(0));
    CHECK_FALSE(y.settling);
    const auto held = an::disturbance_step(pid<>{vcnc::pid_of(vcnc::x_axis), 1_ms}, axis, 1_V, {.lasts = 2_s});
    CHECK(held.settling);
    CHECK(held.peak < y.peak);
}
TEST_CASE(
    "step tests: a limit slows the step, and the law is told: at most the way of the limit's acceleration") {
    const state_feedback<> law{
        place_state_feedback(plant, {.natural = 20_Hz, .encoder_noise = 0.35_um}, 10_V, 1_ms), 1_ms};
    const auto y = an::reference_step(law, axis, 5_mm, {.limit = 2_V});
    for (std::size_t k = 0; k < 40; ++k) {
        const double t = 1e-3 * double(k);
        CHECK(y.response[k].value() <= plant.gain.value() * 2 * t * t / 2 + 1e-12);
    }
    CHECK(y.settling);
    CHECK(y.overshoot < 0.5);
}
TEST_CASE(
    "step tests: a law with preview is told in time: with zero phase the middle of the step is at sample 0") {
    const zero_phase_tracking<> law{zero_phase_rst(plant, {.natural = 20_Hz, .observer = 30_Hz}, 1_ms), 1_ms};
    const auto y = an::reference_step(law, axis, 1_mm);
    // |b|^2/b(1)^2 is a filter of three weights around now: 1/4, 1/2, 1/4 for a zero at -1.
    CHECK(y.response[0].value() == doctest::Approx(0.75e-3).epsilon(1e-3).scale(0));
    CHECK(y.response[1].value() == doctest::Approx(1e-3).epsilon(1e-9).scale(0));
}
TEST_CASE_TEMPLATE("analysed: gain margins are where the simulated loop stops settling", Law, pid<>,
                   sliding_mode<>, generalized_predictive_law<20>) {
    const auto law = [] {
        if constexpr (std::same_as<Law, pid<>>)
            return Law{vcnc::pid_of(vcnc::x_axis), 1_ms};
        else if constexpr (std::same_as<Law, sliding_mode<>>)
            return Law{vcnc::sliding_mode_of(vcnc::x_axis), 1_ms};
        else
            return Law{generalized_predictive<20, 2>(plant, predictive_costs<>{1e-5 * 1_m / 1_V}, 1_ms), 1_ms};
    }();
    const auto figures = an::analysed(an::law_loop{law, axis});
    CHECK(figures.settles);
    const auto settles = [&](double by) {
        return an::disturbance_step(law, stronger(by), 1_V, {.lasts = 4_s}).settling.has_value();
    };
    REQUIRE(figures.gain_rise);
    const double most = std::pow(10, *figures.gain_rise / 20);
    CHECK(settles(0.98 * most));
    CHECK_FALSE(settles(1.02 * most));
    CHECK_FALSE(an::analysed(an::law_loop{law, stronger(1.02 * most)}).settles);
    REQUIRE(figures.gain_fall); // two integrators, no more: below it the phase has nothing left
    const double least = std::pow(10, -*figures.gain_fall / 20);
    CHECK_FALSE(settles(0.9 * least));
    CHECK(settles(1.3 * least));
    CHECK(figures.sensitivity_peak > 1);
    CHECK(figures.bandwidth);
}
TEST_CASE("analysed: the least stiffness is the ratio of a sine of the command to the motion that it makes") {
    const an::law_loop loop{sliding_mode<>{vcnc::sliding_mode_of(vcnc::x_axis), 1_ms}, axis};
    const auto figures = an::analysed(loop);
    for (const double factor : {0.7, 0.9, 1.1, 1.4})
        CHECK(std::abs(loop.disturbance(factor * figures.softest.at)) < 1 / figures.softest.value);
    CHECK(std::abs(loop.disturbance(figures.softest.at)) * figures.softest.value == doctest::Approx(1));
}
TEST_CASE("designed laws: margins and bandwidths as the docs have them") {
    const auto x = [](const auto& law) { return an::analysed(an::law_loop{law, axis}); };
    const auto gpc = x(generalized_predictive_law<20>{
        generalized_predictive<20, 2>(plant, predictive_costs<>{1e-5 * 1_m / 1_V}, 1_ms), 1_ms});
    CHECK(std::abs(gpc.phase->value - 32) < 0.5);
    CHECK(std::abs(gpc.bandwidth->value() - 57) < 0.7);
    const auto states = x(state_feedback<>{
        place_state_feedback(plant, {.natural = 25_Hz, .encoder_noise = 0.35_um}, 10_V, 1_ms), 1_ms});
    CHECK(std::abs(states.phase->value - 36) < 0.7);
    CHECK(std::abs(states.bandwidth->value() - 37) < 0.7);
}
TEST_CASE(
    "standard contours: closed, of the length that they should have, and the butterfly lies on its equation") {
    const auto length = [](const std::vector<quadrant::path::move>& moves) {
        double sum = 0;
        for (std::size_t i = 0; i < moves.size(); ++i) {
            sum += moves[i].path.length();
            CHECK(distance(moves[i].path.end(), moves[(i + 1) % moves.size()].path.start()) < 1e-12);
        }
        return sum;
    };
    CHECK(length(an::circle_contour(50_mm, feed)) == doctest::Approx(0.1 * std::numbers::pi));
    CHECK(length(an::diamond_contour(50_mm, feed)) == doctest::Approx(0.2));
    CHECK(length(an::square_contour(50_mm, feed)) == doctest::Approx(0.2));
    const auto butterfly = an::butterfly_contour(10_mm, feed);
    CHECK(length(butterfly) > 0.3);
    double off = 0;
    for (const quadrant::path::move& m : butterfly) {
        const quadrant::path::point p = m.path.position(0.5 * m.path.length());
        const double t = std::atan2(p.x, p.y);
        double least = HUGE_VAL; // r may be below zero: the same ray from the other side
        for (const double angle : {t, t + std::numbers::pi})
            least = std::min(least,
                             std::abs(std::abs(0.01 * (std::exp(std::cos(angle)) - 2 * std::cos(4 * angle))) -
                                      std::hypot(p.x, p.y)));
        off = std::max(off, least);
    }
    CHECK(off < 2e-6);
}
TEST_CASE(
    "drive_contour: a table that is where it should be has no error; one that is shifted has that error") {
    for (const auto& moves : {an::circle_contour(50_mm, feed), an::diamond_contour(50_mm, feed, 50_um),
                              an::square_contour(50_mm, feed), an::butterfly_contour(5_mm, feed)}) {
        auto how = limits();
        for (auto& each : how.limits.axis) each = {0.2_mps, 2_mps2, 50.0 * 1_mps2 / 1_s};
        const auto exact = an::drive_contour(
            moves,
            [](const auto& x, const auto& y) {
                return an::plane_position{x.position, y.position};
            },
            how, 1_ms);
        const bool rounded = moves.front().tolerance > 0;
        CHECK(exact.x.most.value() == 0);
        CHECK(exact.contour.most.value() < (rounded ? 50.1e-6 : 1e-10 / (8 * 0.005 / 55))); // s^2/(8 R)
        if (rounded) CHECK(exact.contour.most.value() > 1e-6);
        const auto shifted = an::drive_contour(
            moves,
            [](const auto& x, const auto& y) {
                return an::plane_position{x.position + 10_um, y.position};
            },
            how, 1_ms);
        CHECK(shifted.x.most.value() == doctest::Approx(10e-6).epsilon(1e-6).scale(0));
        if (!rounded) CHECK(shifted.contour.most.value() == doctest::Approx(10e-6).epsilon(0.02).scale(0));
        CHECK(shifted.estimated.most <= 10.001_um);
        CHECK(shifted.x.rms.value() == doctest::Approx(10e-6).epsilon(1e-6).scale(0));
        CHECK(shifted.y.most.value() < 1e-15);
    }
}
TEST_CASE("drive_contour: an axis that is late by n periods is inside the circle by half the square of its way "
          "over R; "
          "told of it as a preview it is not") {
    const auto late = [](std::size_t n, std::size_t lead) {
        std::deque<an::plane_position> past;
        auto how = limits();
        how.lead = lead;
        return an::drive_contour(
            an::circle_contour(50_mm, feed),
            [&](const auto& x, const auto& y) {
                if (past.empty()) past.assign(n, {x.position, y.position});
                past.push_back({x.position, y.position});
                const auto now = past.front();
                past.pop_front();
                return now;
            },
            how, 1_ms);
    };
    const auto f = late(10, 0); // 2 mm behind, on the path
    CHECK(std::hypot(f.x_error[800].value(), f.y_error[800].value()) ==
          doctest::Approx(2e-3).epsilon(1e-3).scale(0));
    CHECK(f.contour.most.value() < 1e-9);
    // Estimated: 2 mm along the tangent are t^2/(2R) off the circle.
    CHECK(f.estimated.most.value() == doctest::Approx(2e-3 * 2e-3 / 2 / 0.05).epsilon(0.01).scale(0));
    CHECK(late(10, 10).x.most.value() < 1e-15);
}
TEST_CASE("drive_contour: the diamond of the virtual machine gives the errors of its own trajectory") {
    using servo = vcnc::servo<sliding_mode<>>;
    const auto make = [](const vcnc::axis& a, std::uint64_t seed) {
        return servo(a, vcnc::sliding_mode_of(a), 0_m, seed);
    };
    servo x = make(vcnc::x_axis, 2), y = make(vcnc::y_axis, 3), x2 = x, y2 = y;
    double own = 0, own_y = 0;
    x.settle(vcnc::diamond::at(0).x.position), y.settle(vcnc::diamond::at(0).y.position);
    for (int k = 0; k < vcnc::diamond::samples(); ++k) {
        const auto r = vcnc::diamond::at(k);
        own = std::max(own, std::abs(r.x.position.value() - x.place()));
        own_y = std::max(own_y, std::abs(r.y.position.value() - y.place()));
        x.step(r.x), y.step(r.y);
    }
    x2.settle(vcnc::diamond::at(0).x.position), y2.settle(vcnc::diamond::at(0).y.position);
    const auto f = an::drive_contour(
        an::diamond_contour(50_mm, feed),
        [&](const auto& rx, const auto& ry) {
            const an::plane_position now{x2.place() * 1_m, y2.place() * 1_m};
            x2.step(rx), y2.step(ry);
            return now;
        },
        limits(), 1_ms);
    CHECK(std::abs(f.duration.value() - 4 * 0.39) < 4e-3);
    CHECK(std::abs(f.x.most.value() / own - 1) < 0.1);
    CHECK(std::abs(f.y.most.value() / own_y - 1) < 0.1);
    CHECK(f.contour.most > 2_um);
    CHECK(f.contour.most < f.x.most + f.y.most);
}
