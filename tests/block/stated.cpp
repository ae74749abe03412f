// SPDX-License-Identifier: BSL-1.0
// What a header states with "always", "exact" or "bounded", over a hundred thousand random trials each, a
// million with QUADRANT_TESTS=all; a case names the block and its words. tests/static/claims.txt has the whole
// list, and where each is held.
#include "dice.hpp"

#include <quadrant/base/literals.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/friction/stick_slip.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/path/arc.hpp>
#include <quadrant/path/line.hpp>
#include <quadrant/plant/amplifier_lag.hpp>
#include <quadrant/process/turning_phase.hpp>
#include <quadrant/trajectory/stream_limiter.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using stated::dice, stated::trials;
constexpr double infinite = std::numeric_limits<double>::infinity();

auto force_of(double f) { return quantity_of<signal::force>::from_value(f); }
auto velocity_of(double v) { return quantity_of<signal::velocity>::from_value(v); }
auto stiffness_of(double k) { return gain_rate_of<signal::force, signal::velocity>::from_value(k); }

/// A law moved at one velocity, in one step and in two: the largest difference, as a share of `scale`.
template <class Law> double apart(Law once, double v, double h, double share, double scale) {
    Law twice = once;
    const auto whole = once.after(velocity_of(v), duration::from_value(h));
    twice.become(twice.after(velocity_of(v), duration::from_value(h * share)).next);
    const auto rest = twice.after(velocity_of(v), duration::from_value(h * (1 - share)));
    return std::abs((whole.force - rest.force).value()) / scale;
}
template <class Law> void shake(Law& law, dice& roll, double scale) { // to some memory that it can have
    for (int k = 0; k < 2; ++k)
        law.become(
            law.after(velocity_of(roll(-1, 1) * scale), duration::from_value(roll.decades(1e-4, 1e-1))).next);
}
} // namespace

TEST_CASE("limiter: what comes out is finite, always, and within its bounds, whatever comes in") {
    dice roll;
    int bad = 0, tried = 0;
    while (tried < trials) {
        double low = roll.often() ? roll(-1e3, 1e3) : -infinite,
               high = roll.often() ? roll(-1e3, 1e3) : infinite;
        if (low > high) std::swap(low, high);
        limiter<signal::force> block({force_of(low), force_of(high)}, 1_ms);
        for (int k = 0; k < 100; ++k, ++tried) {
            const double x = roll.often() ? roll(-2e3, 2e3) : roll.any_number();
            const double y = block(force_of(x)).value();
            bad += !std::isfinite(y) || (std::isfinite(x) && (y < low || y > high));
        }
    }
    CHECK(tried >= trials);
    CHECK(bad == 0);
}
TEST_CASE("lowpass: the gain at standstill is one exactly") {
    dice roll;
    int tried = 0;
    int off = 0;
    for (; tried < trials; ++tried) {
        lowpass<signal::force> block({frequency::from_value(roll.decades(1e-3, 499))}, 1_ms);
        const auto x = force_of(roll(-1, 1) * roll.decades(1e-200, 1e200));
        block.settle(x);
        off += block(x).value() != x.value() || block(x).value() != x.value();
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
}
TEST_CASE("line: exact at both ends; arc: exact at the start") {
    using path::point;
    dice roll;
    int tried = 0;
    int off = 0;
    const auto place = [&] { return point{roll(-2, 2), roll(-2, 2), roll(-2, 2)}; };
    const auto same = [](point a, point b) { return a.x == b.x && a.y == b.y && a.z == b.z; };
    for (; tried < trials; ++tried) {
        const point from = place(), to = place();
        const path::line straight(from, to);
        off += !same(straight.position(0), from) || !same(straight.position(straight.length()), to) ||
               !same(straight.position(straight.length() * roll(1, 2)), to) ||
               !same(straight.position(-roll(0, 1)), from);
        const path::arc bent(from, to, roll(0.1, 6), roll(-1, 1));
        off += !same(bent.position(0), from);
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
}
TEST_CASE("turning_phase: whole turns are exact") {
    dice roll;
    int tried = 0;
    int off = 0;
    for (; tried < trials; ++tried) { // so many turns in 2^k samples
        const int k = int(roll(8, 20));
        const double turns = std::floor(roll(1, 200));
        const turning_phase phase(frequency::from_value(turns), duration::from_value(std::ldexp(1.0, -k)));
        off += (phase.increment() << k) != 0;
    }
    CHECK(tried >= trials);
    CHECK(off == 0);
}
TEST_CASE(
    "stream_limiter: in float they exceed none by more than what positions within range() are rounded by") {
    dice roll;
    double over = 0; // as a share of what three positions, or four, are rounded by at most
    int tried = 0, faults = 0;
    while (tried < trials) {
        const double v = roll.decades(0.01, 2), a = roll.decades(0.1, 20), T = 1e-3, j = a / roll(2e-3, 60e-3);
        trajectory::stream_limiter<128, float> block(
            {quantity<si::velocity, float>::from_value(float(v)),
             quantity<si::acceleration, float>::from_value(float(a)),
             quantity<trajectory::jerk_unit, float>::from_value(float(j))},
            1_ms);
        const double reach = block.range().value();
        double x = 0, y1 = 0, y2 = 0, y3 = 0;
        for (int k = 0; k < 2000; ++k, ++tried) {
            if (!roll.often() && !roll.often()) x = roll(-1, 1) * reach;
            const double y = block(quantity_of<signal::position, float>::from_value(float(x))).value();
            const double d1 = y - y1, d2 = y - 2 * y1 + y2, d3 = y - 3 * y1 + 3 * y2 - y3, step = a * T * T;
            over =
                std::max({over, (std::abs(d1) - v * T) / (0.02 * step), (std::abs(d2) - step) / (0.04 * step),
                          (std::abs(d3) - j * T * T * T) / (0.08 * step)});
            y3 = y2, y2 = y1, y1 = y;
        }
        faults += block.faulted();
    }
    CHECK(tried >= trials);
    CHECK(over < 1);
    CHECK(faults == 0);
}
TEST_CASE("stream_limiter: differences of the output exceed no limit, always") {
    dice roll;
    double over = 0;
    int tried = 0;
    while (tried < trials) {
        const double v = roll.decades(0.01, 2), a = roll.decades(0.1, 20), T = 1e-3, j = a / roll(2e-3, 60e-3);
        trajectory::stream_limiter<128> block({velocity_of(v), quantity<si::acceleration>::from_value(a),
                                               quantity<trajectory::jerk_unit>::from_value(j)},
                                              1_ms);
        double x = 0, drift = 0, y1 = 0, y2 = 0, y3 = 0;
        for (int k = 0; k < 2000; ++k, ++tried) {
            if (!roll.often() && !roll.often()) drift = roll(-3, 3) * v;
            x = std::clamp(!roll.often() && !roll.often() && !roll.often() ? roll(-1, 1) : x + drift * T, -1.0,
                           1.0);
            const double y = block(quantity_of<signal::position>::from_value(x)).value();
            const double d1 = y - y1, d2 = y - 2 * y1 + y2, d3 = y - 3 * y1 + 3 * y2 - y3;
            over = std::max({over, std::abs(d1) / (v * T) - 1, std::abs(d2) / (a * T * T) - 1,
                             std::abs(d3) / (j * T * T * T) - 1});
            y3 = y2, y2 = y1, y1 = y;
        }
    }
    CHECK(tried >= trials);
    CHECK(over < 1e-3); // rounding of four positions of a metre beside 2e-9 m, the smallest jerk's
}
TEST_CASE(
    "dahl, lugre, maxwell_slip: solved exactly for a velocity constant over the step: one step is any two") {
    dice roll;
    int tried = 0;
    double of_dahl = 0, of_lugre = 0, of_springs = 0;
    for (; tried < trials; ++tried) {
        const double level = roll.decades(1, 300), k = level / roll.decades(1e-6, 1e-4);
        const double v = roll(-1, 1) * roll.decades(1e-5, 1e-2), h = roll.decades(1e-5, 1e-2),
                     share = roll(0.05, 0.95);
        dahl<> one({.coulomb = force_of(level), .stiffness = stiffness_of(k)}, 1_ms);
        shake(one, roll, 1e-3);
        of_dahl = std::max(of_dahl, apart(one, v, h, share, level));
        const stribeck<>::parameters curve{force_of(level), force_of(level * roll(1, 2)),
                                           velocity_of(roll.decades(1e-3, 1e-1))};
        lugre<> bristles({.curve = curve, .stiffness = stiffness_of(k)}, 1_ms);
        shake(bristles, roll, 1e-3);
        of_lugre = std::max(of_lugre, apart(bristles, v, h, share, level));
        maxwell_slip<2>::parameters p{
            .curve = curve, .weights = {0.6, 0.4}, .forces = {}, .stiffness = {}, .attraction = {}};
        p.stiffness = {stiffness_of(k), stiffness_of(0.2 * k)};
        p.attraction = decltype(p.attraction)::from_value(roll.decades(1, 1000));
        maxwell_slip<2> springs(p, 1_ms);
        springs.settle(velocity_of(roll(-1, 1) * 1e-3));
        of_springs = std::max(of_springs, apart(springs, std::abs(v), h, share, level));
    }
    CHECK(tried >= trials);
    CHECK(of_dahl < 1e-9);
    CHECK(of_lugre < 1e-9);
    CHECK(of_springs < 1e-9);
}
TEST_CASE("stick_slip: stick is exact: a resting axis below breakaway does not creep") {
    dice roll;
    int tried = 0;
    int crept = 0;
    for (; tried < trials; ++tried) {
        const double level = roll.decades(1, 300), held = level * roll(1, 3);
        const stribeck<> law({force_of(level), force_of(held), velocity_of(roll.decades(1e-4, 1e-2))}, 1_ms);
        crept += stick_slip<double>(law, quantity<si::mass>::from_value(roll.decades(0.1, 1000)),
                                    velocity_of(0), force_of(roll(-1, 1) * held),
                                    duration::from_value(roll.decades(1e-6, 1e-3))) != velocity_of(0);
    }
    CHECK(tried >= trials);
    CHECK(crept == 0);
}
TEST_CASE("amplifier_lag: the mean over the step is exact: that of its two halves, and their end is its end") {
    dice roll;
    int tried = 0;
    double off = 0;
    for (; tried < trials; ++tried) {
        const double h = roll.decades(1e-5, 1e-2), begin = roll(-1, 1), u = roll(-1, 1);
        const amplifier_lag<>::parameters p{.lag = duration::from_value(roll.decades(1e-5, 1e-1))};
        const amplifier_lag<> whole(p, h), half(p, h / 2);
        double once = begin, twice = begin;
        const double mean = whole(once, u), first = half(twice, u), second = half(twice, u);
        off = std::max({off, std::abs(mean - (first + second) / 2), std::abs(once - twice)});
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11); // 1 - exp(-h/lag) of a step of 1e-4 lags has lost four digits
}
