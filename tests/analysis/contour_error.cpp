// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/contour_error.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
plane_position at(double x_mm, double y_mm) { return {x_mm * 1e-3 * 1_m, y_mm * 1e-3 * 1_m}; }
double mm(displacement d) { return 1e3 * d.value(); }

std::vector<plane_position> sampled_circle(double radius_mm, std::size_t n) {
    std::vector<plane_position> out;
    for (std::size_t i = 0; i <= n; ++i) {
        const double a = 2 * std::numbers::pi * double(i) / double(n);
        out.push_back(at(radius_mm * std::cos(a), radius_mm * std::sin(a)));
    }
    return out;
}
/// A figure of eight, which crosses itself at zero, not where it starts.
plane_position eight(double t) { return at(30 * std::sin(t + 0.7), 15 * std::sin(2 * t + 1.4)); }
} // namespace

TEST_CASE("contour error: of a line, left of the motion positive") {
    const line_path path{at(1, 1), at(4, 5)};
    const auto found = path(at(1 + 3 - 0.8 * 0.02, 1 + 4 + 0.6 * 0.02)); // 20 um to the left of its end
    CHECK(mm(found.error) == doctest::Approx(0.02).epsilon(1e-9));
    CHECK(mm(found.travelled) == doctest::Approx(5).epsilon(1e-9));
    CHECK(mm(path(at(4, 1)).error) == doctest::Approx(-2.4));
    CHECK_THROWS_AS((line_path{at(1, 1), at(1, 1)}(at(0, 0))), invalid_parameter);
}
TEST_CASE("contour error: of a circle, to the left is inside when driven counterclockwise") {
    const circle nominal{1_mm, 2_mm, 30_mm};
    const auto found = circle_path{nominal}(at(1, 2 + 29.99));
    CHECK(mm(found.error) == doctest::Approx(0.01));
    CHECK(mm(found.travelled) == doctest::Approx(30 * std::numbers::pi / 2));
    const auto other = circle_path{nominal, false}(at(1, 2 + 29.99));
    CHECK(mm(other.error) == doctest::Approx(-0.01));
    CHECK(mm(other.travelled) == doctest::Approx(30 * std::numbers::pi * 1.5));
}
TEST_CASE("contour error: a sampled circle is off by no more than s^2/(8 R), whatever the lag along the path") {
    const std::size_t n = 1000;
    const double bound = std::pow(2 * std::numbers::pi * 30 / n, 2) / (8 * 30); // 0.15 um
    sampled_path path(sampled_circle(30, n), 1_mm);
    for (int k = 0; k < 2500; ++k) { // two and a half turns
        const double a = 0.00631 * k, radius = 30 + 0.01 * std::sin(7 * a);
        const auto found = path(at(radius * std::cos(a), radius * std::sin(a)));
        CHECK(std::abs(mm(found.error) - (30 - radius)) < 1.01 * bound);
        const double turned = a - 2 * std::numbers::pi * std::floor(a / (2 * std::numbers::pi));
        CHECK(std::abs(mm(found.travelled) - 30 * turned) < 1e-3);
    }
}
TEST_CASE("contour error: the same as the nearest of a hundred thousand places of a crossing path, and stays "
          "on its branch") {
    std::vector<plane_position> places, fine;
    for (int i = 0; i <= 4000; ++i) places.push_back(eight(2 * std::numbers::pi * i / 4000));
    for (int i = 0; i <= 100000; ++i) fine.push_back(eight(2 * std::numbers::pi * i / 100000));
    sampled_path path(places, 2_mm);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> off(-0.05, 0.05);
    double last = 0;
    for (int k = 0; k <= 600; ++k) {
        const double t = 2 * std::numbers::pi * k / 600;
        const plane_position here{eight(t).x + off(random) * 1e-3 * 1_m, eight(t).y + off(random) * 1e-3 * 1_m};
        const auto found = path(here);
        if (k > 0)
            CHECK(std::abs(std::remainder(mm(found.travelled) - last, mm(path.length()))) <
                  1); // no jump to the other branch
        last = mm(found.travelled);
        double nearest = HUGE_VAL; // of the branch
        for (int i = -2000; i <= 2000; ++i) {
            const plane_position& p =
                fine[std::size_t((100000 + int(std::lround(k * 100000 / 600.)) + i) % 100000)];
            nearest = std::min(nearest, std::hypot(mm(p.x - here.x), mm(p.y - here.y)));
        }
        CHECK(std::abs(std::abs(mm(found.error)) - nearest) < 1.4e-3); // half the gap between two of the many
    }
}
TEST_CASE(
    "contour error: outside of a sharp corner the side is the outside, and beyond an end the distance to it") {
    const std::vector<plane_position> hook{at(0, 0), at(10, 0), at(0, 2)}; // turns left by 169 degrees
    CHECK(mm(sampled_path(hook, 1_mm)(at(11, 0.05)).error) == doctest::Approx(-std::hypot(1, 0.05)));
    CHECK(mm(sampled_path(hook, 1_mm)(at(11, -0.05)).error) == doctest::Approx(-std::hypot(1, 0.05)));
    CHECK(mm(sampled_path(hook, 1_mm)(at(5, 0.1)).error) == doctest::Approx(0.1));
    CHECK(mm(sampled_path(hook, 1_mm)(at(5, -0.1)).error) == doctest::Approx(-0.1));
    CHECK(mm(sampled_path(hook, 1_mm)(at(-3, -4)).error) == doctest::Approx(-5));
}
TEST_CASE("contour error: when the window was left the whole path is searched again") {
    sampled_path path(sampled_circle(30, 1000), 1_mm);
    CHECK(std::abs(mm(path(at(30, 0.1)).error)) < 1e-3);
    CHECK(std::abs(mm(path(at(0, 30.01)).error) + 0.01) < 2e-4); // a quarter of a turn further
    path.reset();
    CHECK(std::abs(mm(path(at(-30.01, 0)).error) + 0.01) < 2e-4);
}
TEST_CASE(
    "estimated contour error: the line is off by t^2/(2 R), the circle of curvature by nothing on a circle") {
    const double R = 30, lag = 1.2, true_error = 0.004;
    for (const double way : {1.0, -1.0}) { // turns left, turns right
        // reference at (R, 0), moving to +y (left turn) or -y; measured behind by lag along the circle, inside
        // by 4 um
        const double a = -way * lag / R, r = R - true_error;
        const plane_position reference = at(R, 0), measured = at(r * std::cos(a), r * std::sin(a));
        const auto line = estimated_contour_error(reference, measured, 0_mps, way * 0.1 * 1_mps);
        const auto curved =
            estimated_contour_error(reference, measured, 0_mps, way * 0.1 * 1_mps, way * 30.0 * 1_mm);
        REQUIRE(line);
        CHECK(mm(*line) - way * true_error ==
              doctest::Approx(way * lag * lag / (2 * R)).epsilon(0.01).scale(0));
        CHECK(mm(*curved) == doctest::Approx(way * true_error).epsilon(1e-6).scale(0));
    }
    CHECK_FALSE(estimated_contour_error(at(0, 0), at(1, 0), 0_mps, 0_mps));
}
TEST_CASE("contour_errors: a log along a path; refuses what is unequal, not finite, no path") {
    const std::vector<displacement> x{0_mm, 1_mm, 2_mm}, y{0_mm, 0.001_mm, -0.002_mm};
    const auto errors = contour_errors(line_path{at(0, 0), at(1, 0)}, x, y);
    CHECK(mm(errors[1]) == doctest::Approx(0.001).scale(0));
    CHECK(mm(errors[2]) == doctest::Approx(-0.002).scale(0));
    CHECK_THROWS_AS(contour_errors(line_path{at(0, 0), at(1, 0)}, x, {0_mm}), invalid_parameter);
    CHECK_THROWS_AS(contour_errors(line_path{at(0, 0), at(1, 0)}, {double(NAN) * 1_m}, {0_mm}),
                    invalid_parameter);
    CHECK_THROWS_AS(sampled_path({at(0, 0)}, 1_mm), invalid_parameter);
    CHECK_THROWS_AS(sampled_path({at(0, 0), at(0, 0)}, 1_mm), invalid_parameter);
    CHECK_THROWS_AS(sampled_path({at(0, 0), at(1, 0)}, 0_mm), invalid_parameter);
}
