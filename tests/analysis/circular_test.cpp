// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/circular_test.hpp>
#include <quadrant/analysis/quadrant_glitch.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const circle nominal{10_mm, -5_mm, 30_mm};
const double rate = 100.0 / 30; // 100 mm/s on 30 mm, rad/s
/// A circle with the deviation dev(angle in degrees, seconds) in micrometres, from `start` degrees over `turn`
/// degrees.
template <class F> circular_path run(F dev, double start = 37, double turn = 400, bool plus = true) {
    circular_path p{{}, {}, 0.5_ms};
    const double sign = plus ? 1 : -1;
    for (int k = 0;; ++k) {
        const double t = k * 0.5e-3, travelled = rate * t * 180 / std::numbers::pi;
        if (travelled > turn) return p;
        const double degrees = start + sign * travelled, a = degrees * std::numbers::pi / 180;
        const double r = 30e-3 + 1e-6 * dev(degrees, t);
        p.x.push_back(nominal.x + r * std::cos(a) * 1_m);
        p.y.push_back(nominal.y + r * std::sin(a) * 1_m);
    }
}
double um(displacement l) { return l.value() * 1e6; }
double bump(double degrees, double at, double width) { // height one, full width at half height
    double d = std::remainder(degrees - at, 360.0) / (0.5 * width);
    return std::exp(-std::log(2.0) * d * d);
}
} // namespace

TEST_CASE("circular_test: a true circle has no error, whichever way and wherever it starts") {
    for (const bool plus : {true, false})
        for (const double start : {0.0, 37.0, 90.0, 181.0}) {
            const auto r = circular_test(run([](double, double) { return 0.0; }, start, 400, plus), {nominal});
            CHECK(r.counterclockwise == plus);
            CHECK(um(r.circular_error) < 1e-6);
            CHECK(std::abs(um(r.radial_max)) < 1e-6);
            CHECK(r.spikes.size() >= 3); // a reversal on the cut is in no whole window
        }
}
TEST_CASE("circular_test: a circle too large or off its centre is a radial deviation, no circular error") {
    const auto large = circular_test(run([](double, double) { return 7.0; }), {nominal});
    CHECK(um(large.circular_error) < 1e-6);
    CHECK(um(large.radial_max) == doctest::Approx(7));
    CHECK(um(large.radial_min) == doctest::Approx(7));
    CHECK(um(large.radial_rms) == doctest::Approx(7));
    auto shifted = run([](double, double) { return 0.0; });
    for (auto& x : shifted.x) x += 20_um;
    const auto r = circular_test(shifted, {nominal});
    CHECK(um(r.fitted.x - nominal.x) == doctest::Approx(20).epsilon(1e-6));
    CHECK(um(r.radial_max) == doctest::Approx(20).epsilon(1e-3));
    CHECK(um(r.radial_min) == doctest::Approx(-20).epsilon(1e-3));
    CHECK(um(r.circular_error) < 1e-3);
    CHECK(um(circular_test(shifted, {.nominal = nominal, .fitted_centre = true}).radial_max) < 1e-3);
}
TEST_CASE(
    "circular_test: an ellipse of +-4 um has a circular error of 8 um, bidirectional with its mirror 8 too") {
    const auto ellipse = [](double a, double) { return 4 * std::cos(2 * a * std::numbers::pi / 180); };
    const auto r = circular_test(run(ellipse), {nominal});
    CHECK(um(r.circular_error) == doctest::Approx(8).epsilon(1e-3));
    CHECK(um(r.circular_error_fitted) == doctest::Approx(8).epsilon(1e-3));
    CHECK(um(bidirectional_error(run(ellipse), run(ellipse, 10, 380, false), nominal)) ==
          doctest::Approx(8).epsilon(1e-3));
    // as wide again, but one way round only: 3 um between the two runs add to it
    const auto lifted = [&](double a, double t) { return ellipse(a, t) + 3; };
    CHECK(um(bidirectional_error(run(ellipse), run(lifted, 10, 380, false), nominal)) ==
          doctest::Approx(11).epsilon(1e-3));
}
TEST_CASE("circular_test: the least zone is below the least-squares one for a one-sided spike") {
    const auto spike = [](double a, double) { return 10 * bump(a, 92, 6); };
    const auto r = circular_test(run(spike), {nominal});
    CHECK(um(r.circular_error_fitted) > 9.9);
    CHECK(um(r.circular_error) < um(r.circular_error_fitted));
    CHECK(um(r.circular_error) ==
          doctest::Approx(10).epsilon(0.01)); // a spike narrow against the turn: all of it
}
TEST_CASE("circular_test: three-lobed form error: least zone by hand") {
    // r = cos 3a about its own centre has range 2, and no shift of the centre makes it less (equioscillates six
    // times)
    const auto lobes = [](double a, double) { return std::cos(3 * a * std::numbers::pi / 180); };
    CHECK(um(circular_test(run(lobes), {nominal}).circular_error) == doctest::Approx(2).epsilon(1e-3));
}
TEST_CASE("circular_test: spikes have the height, width and time that were put in, over an ellipse and noise") {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.1);
    const double degrees_per_second = rate * 180 / std::numbers::pi; // 191
    for (const bool plus : {true, false}) {
        const double late = plus ? 3.0 : -3.0; // after the reversal: 3 degrees on, 15.7 ms
        const auto dev = [&](double a, double) {
            return 5 * bump(a, 0 + late, 8) + 9 * bump(a, 90 + late, 8) + 5 * bump(a, 180 + late, 8) -
                   2 * bump(a, 270 - late, 4) + 3 * std::sin(2 * a * std::numbers::pi / 180) + noise(random);
        };
        const auto r = circular_test(run(dev, 45, 362, plus), {nominal});
        REQUIRE(r.spikes.size() == 4);
        for (const auto& s : r.spikes) {
            CAPTURE(s.angle);
            const double height = s.angle == 90 ? 9 : s.angle == 270 ? -2 : 5, sign = s.angle == 270 ? -1 : 1;
            CHECK(s.visible);
            CHECK(std::abs(um(s.height) - height) < 0.5); // [um]: largest of many noisy samples
            // three sigma of noise may put the peak wherever the bump is above 94 % (85 % of the small one):
            // 1.2 degrees
            CHECK(std::abs(s.offset.value() - sign * 3 / degrees_per_second) < 1.2 / degrees_per_second);
            CHECK(std::abs(s.width.value() - (s.angle == 270 ? 4 : 8) / degrees_per_second) < 4e-3);
        }
        CHECK(um(r.noise) == doctest::Approx(0.1).epsilon(0.1).scale(0));
    }
    const auto quiet = circular_test(run([&](double, double) { return noise(random); }, 45), {nominal});
    CHECK(quiet.spikes.size() == 4);
    for (const auto& s : quiet.spikes) {
        CHECK(std::abs(um(s.height)) < 0.5);
        CHECK_FALSE(s.visible);
    }
}
TEST_CASE("circular_test: refuses what is no circle") {
    const auto flat = [](double, double) { return 0.0; };
    CHECK_THROWS_AS(circular_test(run(flat, 0, 300), {nominal}), invalid_parameter);
    CHECK_THROWS_AS(circular_test(run(flat), {{0_m, 0_m, 10_mm}}), invalid_parameter);
    CHECK_THROWS_AS(circular_test(run(flat), {.nominal = nominal, .search = 50}), invalid_parameter);
    CHECK_THROWS_AS(bidirectional_error(run(flat), run(flat), nominal), invalid_parameter);
    auto broken = run(flat);
    broken.x.pop_back();
    CHECK_THROWS_AS(circular_test(broken, {nominal}), invalid_parameter);
    broken = run(flat);
    broken.x[7] = std::nan("") * 1_m;
    CHECK_THROWS_AS(circular_test(broken, {nominal}), invalid_parameter);
}
TEST_CASE("quadrant_glitch: the peak after each reversal of a sine, signed, with its delay") {
    std::vector<displacement> reference, position;
    for (int k = 0; k < 10000; ++k) { // 5 s at 0.53 Hz: reversals at 0.4717, 1.4151 s, ...
        const double t = k * 0.5e-3, w = 2 * std::numbers::pi * 0.53;
        reference.push_back(std::sin(w * t) * 30_mm);
        const double since = std::fmod(t + 0.5 / 0.53 - 0.25 / 0.53, 0.5 / 0.53);
        const double side = std::cos(w * t) > 0 ? 1 : -1;
        const double error = side * 8e-6 * (since / 0.02) * std::exp(1 - since / 0.02); // peak 8 um after 20 ms
        position.push_back(reference.back() - error * 1_m);
    }
    const auto all = quadrant_glitches(reference, position, 0.5_ms, {.window = 200_ms, .settle = 1_s});
    REQUIRE(all.size() == 4); // 1.415, 2.358, 3.302, 4.245 s
    for (const auto& g : all) {
        CHECK(std::abs(g.peak.value()) == doctest::Approx(8e-6).epsilon(1e-3).scale(0));
        CHECK((g.peak > 0_m) == (g.direction > 0));
        CHECK(std::abs(g.delay.value() - 0.02) <= 0.5e-3);
    }
    CHECK(all[0].at.value() == doctest::Approx(1.4151).epsilon(1e-3));
    CHECK(largest_glitch(all).value() == doctest::Approx(8e-6).epsilon(1e-3).scale(0));
    CHECK(largest_glitch({}) == 0_m);
}
TEST_CASE("quadrant_glitch: what follows the next reversal is not counted to the one before") {
    std::vector<displacement> reference, position;
    for (int k = 0; k < 500; ++k) { // reverses every 100 samples, with one micrometre more of error each time
        const int leg = k / 100;
        reference.push_back(double(leg % 2 == 0 ? k % 100 : 100 - k % 100) * 1_mm);
        const int before = std::max(0, k - 1) / 100; // at the reversal itself still the old one
        position.push_back(reference.back() - double(before) * 1_um);
    }
    const auto all = quadrant_glitches(reference, position, 1_ms, {.window = 150_ms});
    REQUIRE(all.size() == 3); // the window of the fourth was not recorded
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(all[i].at.value() == doctest::Approx(0.1 * double(i + 1)));
        CHECK(um(all[i].peak) == doctest::Approx(double(i + 1)));
    }
}
TEST_CASE("quadrant_glitch: a rest is no reversal by itself, one way only has none") {
    std::vector<displacement> there_rest_on, there_rest_back;
    for (int k = 0; k < 300; ++k) {
        const double ramp = std::min(k, 100);
        there_rest_on.push_back((ramp + std::max(0, k - 200)) * 1_um);
        there_rest_back.push_back((ramp - std::max(0, k - 200)) * 1_um);
    }
    CHECK(quadrant_glitches(there_rest_on, there_rest_on, 1_ms, {.window = 20_ms}).empty());
    std::vector<displacement> starts(50, 0_um); // from rest
    for (int k = 0; k < 100; ++k) starts.push_back(-double(k) * 1_um);
    CHECK(quadrant_glitches(starts, starts, 1_ms, {.window = 20_ms}).empty());
    const auto back = quadrant_glitches(there_rest_back, there_rest_back, 1_ms, {.window = 20_ms});
    REQUIRE(back.size() == 1);
    CHECK(back[0].at.value() == doctest::Approx(0.2));
    CHECK(back[0].direction == -1);
    CHECK_THROWS_AS(quadrant_glitches(there_rest_back, {}, 1_ms, {.window = 20_ms}), invalid_parameter);
    CHECK_THROWS_AS(quadrant_glitches(there_rest_back, there_rest_back, 1_ms, {.window = 0_ms}),
                    invalid_parameter);
}
