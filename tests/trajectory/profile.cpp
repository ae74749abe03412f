// SPDX-License-Identifier: BSL-1.0
#include "limits.hpp"

#include <doctest/doctest.h>
#include <quadrant/base/literals.hpp>
#include <quadrant/trajectory/profile.hpp>
#include <quadrant/trajectory/s_curve.hpp>

#include <cmath>
#include <random>
#include <string>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::trajectory;

namespace {

constexpr auto seven_phases = profile_kind::trapezoidal_acceleration;
constexpr auto cubic = profile_kind::cubic_acceleration;

profile move_of(double length, const motion_limits& limits, profile_kind kind = seven_phases, double from = 0,
                double to = 0) {
    return profile({.length = length * 1_m,
                    .limits = limits,
                    .kind = kind,
                    .from = from * 1_mps,
                    .to = to * 1_mps,
                    .line = 12});
}
std::string refused(const profile::parameters& p) {
    try {
        return profile(p).lasts().value() > 0 ? "made" : "";
    } catch (const invalid_parameter& why) {
        return why.what();
    }
}

} // namespace

TEST_CASE("profile: jerk-limited moves last as long as Ruckig's own tests say") {
    // pantor/ruckig, test/test_target_known.cpp: durations of one axis without acceleration at its ends.
    struct known {
        double length, v, a, j, from, lasts;
    };
    for (const known& k :
         {known{1, 1, 1, 1, 0, 3.1748021039}, known{1, 1, 1, 2, 0, 2.5615528128},
          known{1, 0.6, 1, 2, 0, 2.7666666667}, known{1, 0.4, 1, 2, 0, 3.394427191},
          known{1, 1, 1, 2, 0.3, 2.2319602829}, known{1, 0.6, 1, 2, 0.3, 2.410315834},
          known{2, 0.4, 1, 2, 0.2, 5.6053274785}, known{400, 1800, 20000, 200000, 0, 0.4119588818}}) {
        const auto limits = at_most(k.v, k.a, k.j);
        CHECK(std::abs(move_of(k.length, limits, seven_phases, k.from).lasts().value() - k.lasts) < 1e-9);
        // Backwards in time it is as long.
        CHECK(std::abs(move_of(k.length, limits, seven_phases, 0, k.from).lasts().value() - k.lasts) < 1e-9);
    }
}

TEST_CASE("profile: no seven phases with other peaks of acceleration and speed are shorter") {
    std::mt19937 random(3);
    const auto between = [&](double a, double b) { return a + (b - a) * double(random()) / 4294967296.0; };
    for (int i = 0; i < 40; ++i) {
        const double v = between(0.2, 1), a = between(0.5, 4), j = between(2, 60), v0 = between(0, v),
                     v1 = between(0, v);
        const double length = between(0.01, 1);
        const bounds within{v, a, j};
        if (!speed_profile::feasible(seven_phases, within, length, v0, v1)) continue;
        const double ours = speed_profile(seven_phases, within, length, v0, v1).duration();
        // Any peak of the speed with any peaks of acceleration; the rest of the length at the peak speed.
        double shortest = 1e9;
        constexpr int grid = 60;
        for (int k = 1; k <= grid; ++k)
            for (int m = 1; m <= grid; ++m)
                for (int n = 1; n <= grid; ++n) {
                    const double peak = v * k / grid, a0 = a * m / grid, a1 = a * n / grid;
                    const double d0 = std::abs(peak - v0), d1 = std::abs(peak - v1);
                    if (d0 * j < a0 * a0 || d1 * j < a1 * a1) continue; // cannot be that peak of acceleration
                    const double t0 = d0 / a0 + a0 / j, t1 = d1 / a1 + a1 / j;
                    const double left = length - 0.5 * (v0 + peak) * t0 - 0.5 * (peak + v1) * t1;
                    if (left >= 0) shortest = std::min(shortest, t0 + t1 + left / peak);
                }
        CHECK(ours <= shortest * (1 + 1e-12));
        CHECK(shortest < 1.2 * ours); // the grid is fine enough to mean something
    }
}

TEST_CASE("profile: known closed forms of the other kinds") {
    // Ramps of speed: L = v^2/a with a cruise of none, T = 2 sqrt(L/a); with a cruise T = v/a + L/v.
    CHECK(std::abs(move_of(0.5, at_most(10, 2), profile_kind::constant_acceleration).lasts().value() - 1.0) <
          1e-9);
    CHECK(std::abs(move_of(0.5, at_most(0.5, 2), profile_kind::constant_acceleration).lasts().value() - 1.25) <
          1e-12);
    CHECK(std::abs(move_of(0.5, at_most(0.25), profile_kind::constant_velocity).lasts().value() - 2) < 1e-12);
    // A cubic ramp needs 1.5 times the time of a straight one for the same peak of jerk.
    CHECK(std::abs(move_of(1, at_most(1, 1, 1.5), cubic).lasts().value() - 3.1748021039) < 1e-9);
}

TEST_CASE(
    "profile: every kind keeps its limits, ends at its end, and its derivatives are those of its position") {
    std::mt19937 random(1);
    const auto between = [&](double a, double b) { return a + (b - a) * double(random()) / 4294967296.0; };
    for (int i = 0; i < 400; ++i) {
        const auto kind = i % 3 == 0 ? cubic : i % 3 == 1 ? seven_phases : profile_kind::constant_acceleration;
        const bool jerk = kind != profile_kind::constant_acceleration;
        const double v = between(0.05, 1), a = between(0.2, 5), j = jerk ? between(2, 300) : unlimited;
        const double length = std::pow(10, between(-4, 0)), v0 = between(0, v), v1 = between(0, v);
        if (!speed_profile::feasible(kind, {v, a, j}, length, v0, v1)) continue;
        speed_profile curve(kind, {v, a, j}, length, v0, v1);
        if (i % 2 == 0) curve.stretch(curve.duration() * between(1, 1.05));
        const double T = curve.duration();
        const int n = 200;
        const double h = T / n;
        double worst_v = 0, worst_a = 0, worst_j = 0, off_v = 0, off_a = 0;
        for (int k = 0; k < n; ++k) {
            const path_motion p = curve.at(k * h), q = curve.at((k + 1) * h);
            worst_v = std::max(worst_v, std::abs(p.v));
            worst_a = std::max(worst_a, std::abs(p.a));
            worst_j = std::max(worst_j, std::abs(p.j));
            // Mean of a derivative over a step, against what it changed: off by the next derivative at most.
            off_v = std::max(off_v, std::abs((q.s - p.s) - 0.5 * h * (p.v + q.v)) - 0.25 * a * h * h);
            if (jerk) off_a = std::max(off_a, std::abs((q.v - p.v) - 0.5 * h * (p.a + q.a)) - 0.25 * j * h * h);
        }
        CHECK(worst_v <= v * (1 + 1e-12));
        CHECK(worst_a <= a * (1 + 1e-12));
        if (jerk) CHECK(worst_j <= j * (1 + 1e-12));
        CHECK(off_v < 1e-13);
        CHECK(off_a < 1e-13);
        const path_motion end = curve.at(T);
        CHECK(end.s == length);
        CHECK(std::abs(end.v - v1) < 1e-12);
        if (jerk) CHECK(std::abs(end.a) < 1e-9);
        CHECK(std::abs(curve.at(0).v - v0) < 1e-15);
    }
}

TEST_CASE(
    "profile: fitted to whole periods it is less than one period longer and as long as it was asked to go") {
    for (const double from : {0.0, 0.05, 0.2})
        for (int i = 1; i <= 50; ++i) {
            const auto free =
                move_of(0.02 + 0.0007 * i, at_most(0.2, 2, 50), i % 2 ? seven_phases : cubic, from);
            const auto fitted = free.in_whole_periods(1_ms);
            const double periods = fitted.lasts().value() / 1e-3;
            CHECK(std::abs(periods - std::round(periods)) < 1e-9);
            CHECK(fitted.lasts() >= free.lasts());
            CHECK((fitted.lasts() - free.lasts()).value() < 1e-3);
            CHECK(fitted(fitted.lasts()).position == free.given().length);
        }
}

TEST_CASE("profile: what cannot be driven is refused with its line") {
    profile::parameters p{.length = 1_mm, .limits = at_most(0.2, 2, 50), .from = 0.1_mps, .line = 12};
    CHECK(
        refused(p).find(
            "line = 12: the acceleration limit cannot be met within the block: from 0.1 to 0 m/s needs 0.0") ==
        0);
    p.length = 4_mm; // enough for 2 m/s^2 alone: 2.5 mm
    CHECK(refused(p).find("line = 12: the jerk limit cannot be met within the block") == 0);
    p.length = 5_mm;
    CHECK(refused(p) == "made");
    p.limits = at_most(0.2, 2, 0);
    CHECK(refused(p) == "profile.limits.jerk = 0 m/s^3: must be above 0 (infinite: no bound)");
    p.limits = at_most(0.2, 2, 50);
    p.kind = profile_kind::constant_acceleration;
    CHECK(refused(p).find("profile.limits.jerk = 50 m/s^3: must be infinite") == 0);
    p.limits = at_most(0.05, 2);
    CHECK(refused(p).find("profile.from = 0.1 m/s: must lie between 0 and the feed (0.05 m/s)") == 0);
    // At one speed all along there is nothing to make slower.
    const auto through = move_of(0.01235, at_most(0.1, 2, 50), seven_phases, 0.1, 0.1);
    CHECK_THROWS_WITH_AS(through.in_whole_periods(1_ms),
                         "line = 12: the block cannot last 0.124 s, the next whole number of periods, with its "
                         "speeds at both ends",
                         invalid_parameter);
}

TEST_CASE("s_curve: the published move of the precision stage, 30 cm in 1 s with a peak of 1.127 m/s") {
    const s_curve curve({.length = 0.3_m, .duration = 1_s});
    CHECK(std::abs(curve(0.5_s).velocity.value() - 1.127) < 0.002);
    CHECK(curve(0_s).position == 0_m);
    CHECK(std::abs(curve(1_s).position.value() - 0.3) < 1e-15);
    CHECK(curve(2_s).velocity.value() == 0);
}

TEST_CASE("s_curve: its derivatives are those of its position and its peaks those of the formulas") {
    const s_curve curve({.length = -0.02_m, .duration = 0.5_s});
    const motion_limits peaks = curve.peaks();
    const double h = 1e-5;
    double v = 0, a = 0, j = 0, off_v = 0, off_a = 0, off_j = 0;
    for (double t = h; t < 0.5 - h; t += 2.5e-4) {
        const auto at = [&](double when) { return curve(when * 1_s); };
        const motion m = at(t), before = at(t - h), after = at(t + h);
        off_v = std::max(off_v,
                         std::abs((after.position - before.position).value() / (2 * h) - m.velocity.value()));
        off_a = std::max(
            off_a, std::abs((after.velocity - before.velocity).value() / (2 * h) - m.acceleration.value()));
        off_j = std::max(
            off_j, std::abs((after.acceleration - before.acceleration).value() / (2 * h) - m.jerk.value()));
        v = std::max(v, std::abs(m.velocity.value()));
        a = std::max(a, std::abs(m.acceleration.value()));
        j = std::max(j, std::abs(m.jerk.value()));
    }
    CHECK(off_v < 1e-7 * v);
    CHECK(off_a < 1e-6 * a);
    CHECK(off_j < 1e-6 * j);
    CHECK(std::abs(v / peaks.velocity.value() - 1) < 1e-4);
    CHECK(std::abs(a / peaks.acceleration.value() - 1) < 1e-4);
    CHECK(std::abs(j / peaks.jerk.value() - 1) < 1e-4);
}
