// SPDX-License-Identifier: BSL-1.0
// Long: every segment under the same checks, then each kind by hand.
#include <quadrant/path/arc_fit.hpp>
#include <quadrant/path/move.hpp>
#include <quadrant/path/spline_path.hpp>

#include <doctest/doctest.h>

#include <random>
#include <type_traits>

using namespace quadrant;
using namespace quadrant::path;

namespace {
constexpr double pi_ = std::numbers::pi;

/// Length of the curve as a chain of n chords, with the h^2 term taken out (Richardson).
template <class Curve> double chained(const Curve& curve, double from, double to, int n) {
    const auto chain = [&](int m) {
        double sum = 0;
        for (int i = 0; i < m; ++i)
            sum += distance(curve(from + (to - from) * i / m), curve(from + (to - from) * (i + 1) / m));
        return sum;
    };
    return (4 * chain(2 * n) - chain(n)) / 3;
}
/// Cubic Bezier piece by de Casteljau: another route to the same polynomial.
point casteljau(std::array<point, 4> p, double u) {
    for (std::size_t left = 3; left > 0; --left)
        for (std::size_t i = 0; i < left; ++i) p[i] = (1 - u) * p[i] + u * p[i + 1];
    return p[0];
}
spline from_bezier(const std::array<point, 4>& p) {
    return spline(
        {p[0], 3 * (p[1] - p[0]), 3 * (p[0] - 2 * p[1] + p[2]), p[3] - p[0] + 3 * (p[1] - p[2]), {}, {}});
}
spline_knot on_circle(double radius, double angle) {
    const point out{std::cos(angle), std::sin(angle), 0};
    return {radius * out, {-out.y, out.x, 0}, (-1 / radius) * out};
}
std::vector<segment> examples() {
    const spline bent = from_bezier({point{0, 0, 0}, {0.02, 0.01, 0}, {0.03, 0.04, 0.01}, {0.01, 0.06, 0.02}});
    return {line({0.01, -0.02, 0.03}, {0.04, 0.02, 0.03}), arc({0.05, 0, 0}, {0.01, 0.03, 0}, 2.2),
            arc({0.05, 0, 0.01}, {0.01, 0.03, 0}, -7.5, -0.02), bent.part(0.1, 0.4),
            spline::quintic(on_circle(0.05, 0.3), on_circle(0.05, 1.1))};
}
} // namespace

static_assert(std::is_trivially_copyable_v<segment> &&
              std::is_trivially_copyable_v<move>); // so nothing is on a heap
static_assert(
    noexcept(std::declval<segment>().position(0.)) && noexcept(std::declval<segment>().curvature(0.)));

TEST_CASE("segment: the tangent is the derivative of the position, the curvature that of the tangent") {
    for (const segment& piece : examples()) {
        const double L = piece.length(), h = 1e-4 * L;
        // A spline keeps to its length within its feed fluctuation, 1e-5 here; the rest is exact.
        const double off = std::holds_alternative<spline>(piece.shape()) ? 1e-5 : 1e-8;
        if (const auto* s = std::get_if<spline>(&piece.shape())) REQUIRE(s->feed_fluctuation() < off);
        for (double s = 0.03 * L; s < L; s += 0.09 * L) {
            const point slope = (piece.position(s + h) - piece.position(s - h)) / (2 * h);
            const point bend = (piece.tangent(s + h) - piece.tangent(s - h)) / (2 * h);
            CHECK(magnitude(piece.tangent(s)) == doctest::Approx(1).epsilon(1e-12));
            CHECK(distance(slope, piece.tangent(s)) < off + 1e-6);
            CHECK(distance(bend, piece.curvature(s)) * L <
                  (off + 1e-6) * (1 + magnitude(piece.curvature(s)) * L));
            CHECK(std::abs(dot(piece.curvature(s), piece.tangent(s))) * L < 1e-12);
        }
    }
}
TEST_CASE("segment: the length is that of a fine chain of chords") {
    for (const segment& piece : examples()) {
        const double L = piece.length();
        const double chain = chained([&](double s) { return piece.position(s); }, 0, L, 2000);
        CHECK(std::abs(chain / L - 1) < 1e-9);
    }
}
TEST_CASE("segment: beyond its ends it stays where they are") {
    for (const segment& piece : examples()) {
        const double L = piece.length();
        CHECK(piece.position(-1) == piece.start());
        CHECK(piece.position(0) == piece.start());
        CHECK(piece.position(L) == piece.end());
        CHECK(piece.position(L + 1) == piece.end());
        CHECK(piece.tangent(L + 1) == piece.tangent(L));
    }
}
TEST_CASE("line: a third of the way from one place to the other") {
    const line l({0.001, 0.002, 0.003}, {0.004, 0.006, 0.003}); // 3, 4, 5 mm
    CHECK(l.length() == doctest::Approx(0.005).epsilon(1e-12));
    CHECK(distance(l.position(0.0025), {0.0025, 0.004, 0.003}) < 1e-15);
    CHECK_THROWS_AS(line({1, 1, 1}, {1, 1, 1}), invalid_parameter);
    CHECK_THROWS_AS(line({1, 1, 1}, {1, 1, std::nan("")}), invalid_parameter);
}
TEST_CASE("arc: a quarter, a full circle and a helix by hand") {
    const arc quarter({0.05, 0, 0}, {}, pi_ / 2);
    CHECK(quarter.length() == doctest::Approx(0.05 * pi_ / 2).epsilon(1e-12));
    CHECK(distance(quarter.end(), {0, 0.05, 0}) < 1e-16);
    CHECK(distance(quarter.tangent(0), {0, 1, 0}) < 1e-15);
    CHECK(distance(quarter.curvature(0), {-20, 0, 0}) < 1e-12);

    const arc circle({0, 0.05, 0}, {}, -2 * pi_);
    CHECK(distance(circle.position(circle.length() / 4), {0.05, 0, 0}) < 1e-16); // clockwise from the top
    CHECK(distance(circle.end(), circle.start()) < 1e-16);

    const arc helix({0.03, 0, 0}, {}, 4 * pi_, 0.01); // two turns, 5 mm each
    const double turn = std::hypot(0.03 * 2 * pi_, 0.005);
    CHECK(helix.length() == doctest::Approx(2 * turn).epsilon(1e-12));
    CHECK(distance(helix.position(turn), {0.03, 0, 0.005}) < 1e-15);
    const double c = 0.005 / (2 * pi_); // curvature of a helix: R/(R^2 + c^2)
    CHECK(magnitude(helix.curvature(0.1)) == doctest::Approx(0.03 / (0.03 * 0.03 + c * c)).epsilon(1e-12));
    CHECK_THROWS_AS(arc({1, 2, 0}, {1, 2, 0}, 1), invalid_parameter);
    CHECK_THROWS_AS(arc({1, 2, 0}, {1, 1, 0}, 0), invalid_parameter);
    CHECK_THROWS_AS(arc({1, 2, 0}, {1, 1, 0}, 1, INFINITY), invalid_parameter);
}
TEST_CASE("arc from centre and end: it ends there, the sense as asked, and any arc comes back") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> somewhere(-0.1, 0.1), angle(0.05, 6.2);
    for (int k = 0; k < 2000; ++k) {
        const point centre{somewhere(random), somewhere(random)},
            start{somewhere(random), somewhere(random), 0.01};
        if (distance({start.x, start.y}, centre) < 1e-3) continue;
        const double sweep = (k % 2 != 0 ? 1 : -1) * angle(random);
        point end = arc(start, centre, sweep, 0.002).end();
        end += point{1e-6 * somewhere(random), 1e-6 * somewhere(random), 0}; // up to 0.1 um, as decimals round
        const auto again = arc_about(start, end, centre, sweep < 0);
        REQUIRE(again);
        CHECK(distance(again->end(), end) < 1e-15);
        CHECK(std::abs(again->sweep() - sweep) < 1e-2);
        const auto by_radius =
            arc_centre(start, end, std::abs(sweep) > pi_ ? -again->radius() : again->radius(), sweep < 0);
        REQUIRE(by_radius);
        // Near a half circle the centre depends on the radius as a square root does.
        CHECK(distance(*by_radius, {again->centre().x, again->centre().y}) < 1e-8);
    }
    CHECK_FALSE(arc_about({0.01, 0, 0}, {0, 0.0100101, 0}, {}, false));
    CHECK(arc_about({0.01, 0, 0}, {0, 0.0100099, 0}, {}, false)); // the tolerance is 10 um
    CHECK_FALSE(arc_centre({0, 0, 0}, {0.01, 0, 0}, 0.00498, false));
}
TEST_CASE("spline: a Bezier curve, by de Casteljau") {
    const std::array<point, 4> p{point{0, 0, 0}, {0.02, 0.01, 0}, {0.03, 0.04, 0.01}, {0.01, 0.06, 0.02}};
    const spline s = from_bezier(p);
    CHECK(distance(s.end(), p[3]) < 1e-16);
    CHECK(s.length() ==
          doctest::Approx(chained([&](double u) { return casteljau(p, u); }, 0, 1, 2000)).epsilon(1e-9));
    // The feed correction says where on the curve a length is; the curve is never left.
    for (double share = 0.05; share < 1; share += 0.1) {
        const point at = s.position(share * s.length());
        double low = 0, high = 1;
        for (int k = 0; k < 60; ++k)
            (casteljau(p, 0.5 * (low + high)).y < at.y ? low : high) = 0.5 * (low + high);
        CHECK(distance(casteljau(p, low), at) < 1e-12);
        const double travelled = chained([&](double u) { return casteljau(p, u); }, 0, low, 500);
        CHECK(std::abs(travelled / s.length() - share) <= s.feed_fluctuation());
    }
    const spline half = s.part(0.25, 0.75);
    CHECK(distance(half.start(), casteljau(p, 0.25)) < 1e-15);
    CHECK(distance(half.end(), casteljau(p, 0.75)) < 1e-15);
    CHECK(half.feed_fluctuation() < 0.1 * s.feed_fluctuation());
}
TEST_CASE("spline: equal lengths are equal steps, within the feed fluctuation that it states") {
    const spline uneven({point{}, {0.01, 0, 0}, {0.03, 0.02, 0}, {-0.01, 0.05, 0}, {}, {}});
    REQUIRE(uneven.feed_fluctuation() > 1e-3); // a plain parameter would be off by a factor of several
    const int n = 2000;
    double worst = 0;
    for (int i = 0; i < n; ++i) {
        const double L = uneven.length();
        worst = std::max(
            worst,
            std::abs(distance(uneven.position(L * i / n), uneven.position(L * (i + 1) / n)) * n / L - 1));
    }
    CHECK(worst <= 1.02 * uneven.feed_fluctuation());
    CHECK(worst >= 0.9 * uneven.feed_fluctuation());
}
TEST_CASE("spline: speed and acceleration do not jump where the feed correction begins and ends") {
    // The second difference next to an end comes to the curvature there, as its step does to zero.
    const spline s = from_bezier({point{0, 0, 0}, {0.02, 0.01, 0}, {0.03, 0.04, 0.01}, {0.01, 0.06, 0.02}});
    const auto off = [&](double h, bool first) {
        const double at = first ? 0 : s.length() - 2 * h;
        const point second = (s.position(at) + s.position(at + 2 * h) - 2 * s.position(at + h)) / (h * h);
        return distance(second, s.curvature(at + h));
    };
    for (const bool first : {true, false}) {
        CHECK(off(1e-4 * s.length(), first) < 0.02 * magnitude(s.curvature(0)));
        CHECK(off(1e-4 * s.length(), first) < 0.2 * off(1e-3 * s.length(), first));
    }
}
TEST_CASE("spline: a quintic between knots of a circle is that circle to the sixth order") {
    const auto off = [](double angle) {
        const spline s = spline::quintic(on_circle(0.05, 0), on_circle(0.05, angle));
        double worst = 0;
        for (double share = 0; share <= 1; share += 0.01)
            worst = std::max(worst, std::abs(magnitude(s.position(share * s.length())) - 0.05));
        return worst;
    };
    CHECK(off(1) < 1e-5);
    CHECK(off(1) / off(0.5) > 50);
}
TEST_CASE("spline: what stands still or turns back is refused") {
    CHECK_THROWS_AS(spline({point{}, {}, {0.01, 0, 0}, {}, {}, {}}), invalid_parameter); // starts at rest
    CHECK_THROWS_AS(spline({point{}, {}, {}, {}, {}, {}}), invalid_parameter);           // goes nowhere
    CHECK_THROWS_AS(spline::quintic(on_circle(0.05, 1), on_circle(0.05, 1)), invalid_parameter); // no chord
    CHECK_THROWS_AS(splines_through({{0, 0, 0}, {0.01, 0, 0}, {0, 0, 0}}), invalid_parameter);
    CHECK_THROWS_AS(splines_through({{0, 0, 0}, {0.01, 0, 0}, {0.01, 0, 0}}), invalid_parameter);
    CHECK_THROWS_AS(splines_through({{0, 0, 0}}), invalid_parameter);
}
TEST_CASE("spline path: through every place, smooth there, and its feed within the tolerance") {
    for (const auto degree : {spline_degree::quintic, spline_degree::cubic}) {
        std::vector<point> places;
        for (int i = 0; i < 40; ++i) {
            const double t = 0.17 * i;
            places.push_back({0.03 * std::sin(t), 0.02 * std::sin(2 * t + 0.4), 0.001 * i});
        }
        const auto pieces = splines_through(places, degree);
        std::size_t met = 0;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            CHECK(pieces[i].feed_fluctuation() <= spline_path::feed_tolerance);
            if (distance(pieces[i].start(), places[met]) < 1e-15) ++met;
            if (i == 0) continue;
            const auto &before = pieces[i - 1], &after = pieces[i];
            const double L = before.length();
            CHECK(distance(before.end(), after.start()) < 1e-15);
            CHECK(distance(before.tangent(L), after.tangent(0)) < 1e-12);
            if (degree == spline_degree::quintic)
                CHECK(distance(before.curvature(L), after.curvature(0)) <
                      1e-9 * (1 + magnitude(after.curvature(0))));
        }
        CHECK(met == places.size() - 1);
        CHECK(distance(pieces.back().end(), places.back()) < 1e-15);
    }
}
TEST_CASE("spline path: closer places bring it to the circle that they are on, fifth order at least") {
    const auto off = [](int n) {
        std::vector<point> places;
        for (int i = 0; i <= n; ++i) places.push_back(on_circle(0.05, 2 * pi_ * i / n).place);
        double worst = 0;
        for (const spline& s : splines_through(places))
            for (double share = 0; share <= 1; share += 0.1)
                worst = std::max(worst, std::abs(magnitude(s.position(share * s.length())) - 0.05));
        return worst;
    };
    const auto coarse = [] { // a place every 30 degrees: chords are 1.1 % shorter than arcs
        std::vector<point> places;
        for (int i = 0; i < 12; ++i) places.push_back(on_circle(0.05, pi_ / 6 * i).place);
        return splines_through(places);
    }();
    for (std::size_t i = 2; i < 9; ++i)
        CHECK(magnitude(coarse[i].curvature(0)) == doctest::Approx(20).epsilon(0.005));
    CHECK(off(36) < 1e-6);
    CHECK(off(18) / off(36) > 20);
}
TEST_CASE("spline path: two places are a straight line, and pieces come before the run ends") {
    const auto straight = splines_through({{0, 0, 0}, {0.03, 0.04, 0}});
    REQUIRE(straight.size() == 1);
    CHECK(straight[0].length() == doctest::Approx(0.05).epsilon(1e-12));
    CHECK(magnitude(straight[0].curvature(0.02)) < 1e-9);

    spline_path run(spline_degree::quintic);
    std::size_t last = 0;
    for (int i = 0; i < 1000; ++i) {
        run.add({0.001 * i, 0.01 * std::sin(0.1 * i), 0});
        while (const auto piece = run.next()) last = piece->knot;
        if (i > 5) CHECK(last + 2 == std::size_t(i)); // two places behind
    }
}
