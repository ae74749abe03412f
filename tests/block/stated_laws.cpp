// SPDX-License-Identifier: BSL-1.0
// As stated.cpp: control laws, observers, and the figures that designs are made from.
#include "dice.hpp"

#include <quadrant/analysis/law_loop.hpp>
#include <quadrant/analysis/response.hpp>
#include <quadrant/analysis/virgin_curve.hpp>
#include <quadrant/base/error.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/lead_lag.hpp>
#include <quadrant/control/state_feedback.hpp>
#include <quadrant/observer/disturbance_observer.hpp>
#include <quadrant/observer/lugre_observer.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using stated::dice, stated::trials;
using complex = std::complex<double>;
frequency hertz(double f) { return frequency::from_value(f); }
auto position_of(double x) { return quantity_of<signal::position>::from_value(x); }
auto velocity_of(double v) { return quantity_of<signal::velocity>::from_value(v); }
auto force_of(double f) { return quantity_of<signal::force>::from_value(f); }
auto stiffness_of(double k) { return gain_rate_of<signal::force, signal::velocity>::from_value(k); }
auto volts(double u) { return quantity_of<signal::voltage>::from_value(u); }
axis_model<signal::voltage> axis(double B, double A) {
    return {quantity<unit_quotient<si::acceleration, signal::voltage::unit>>::from_value(B), A / 1_s};
}

/// x/u = B/(s (s + A)) moved over T under a held u, by the solution of its equation.
template <class Number> struct moved {
    Number x, v;
    moved(Number from, Number at, Number u, double B, double A, double T) {
        const double gone = -std::expm1(-A * T), slid = gone / A;
        v = at * (1 - gone) + B * slid * u;
        x = from + at * slid + B * ((T - slid) / A) * u;
    }
};
} // namespace

TEST_CASE("sampled_axis: exact at the samples: phasors of its responses solve the held axis' own equation") {
    dice roll;
    double off = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double T = roll.decades(1e-5, 1e-2), A = roll.decades(1e-2, 10) / T, B = roll.decades(1e-2, 100),
                     f = roll(0.01, 0.49) / T;
        const analysis::sampled_axis<> plant{axis(B, A), duration::from_value(T)};
        const complex z = std::polar(1.0, 2 * std::numbers::pi * f * T), x = plant.position(hertz(f)),
                      v = plant.velocity(hertz(f)), a = plant.acceleration(hertz(f));
        const moved<complex> next(x, v, 1, B, A, T);
        const double size = std::max({std::abs(x), std::abs(v) * T, B * T * T});
        off = std::max({off, std::abs(next.x - z * x) / size, std::abs(next.v - z * v) * T / size,
                        std::abs(z * a - (next.v - v) / T) * T * T / size});
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
TEST_CASE("tabulated_response: between two lines exact for any power of f") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        const double size = roll.decades(1e-6, 1e6), power = roll(-4, 4), low = roll.decades(1e-2, 1e3),
                     high = low * roll(1.01, 30), turn = roll(-3, 3), more = roll(-3, 3);
        const auto at = [&](double f) { return size * std::pow(f / low, power); };
        const analysis::tabulated_response table(
            {hertz(low), hertz(high)}, {std::polar(at(low), turn), std::polar(at(high), turn + more)});
        for (int k = 0; k < 10; ++k, ++tried) {
            const double f = roll(low, high);
            off = std::max(off, std::abs(std::abs(table(hertz(f))) / at(f) - 1));
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
TEST_CASE("virgin_curve: where the tangent meets zero displacement is what slips, exact for springs that stick "
          "and slip") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        std::array<std::pair<double, double>, 4> springs; // force per way, and at most
        for (auto& [stiff, most] : springs) stiff = roll.decades(1e4, 1e8), most = roll.decades(0.1, 100);
        for (int k = 0; k < 10; ++k, ++tried) {
            const double way = roll.decades(1e-9, 1e-2);
            double force = 0, slope = 0, slips = 0;
            for (const auto& [stiff, most] : springs) {
                const bool holds = stiff * way < most;
                force += holds ? stiff * way : most, slope += holds ? stiff : 0, slips += holds ? 0 : most;
            }
            off = std::max(off, std::abs(analysis::detail::slipping(force, slope, way) - slips) / force);
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-13);
}
TEST_CASE("lead_lag: crossover and phase margin are exact") {
    dice roll;
    double off_gain = 0, off_margin = 0;
    int tried = 0;
    while (tried < trials) {
        const double T = roll.decades(1e-4, 1e-2), fc = roll.decades(2e-3, 0.03) / T, margin = roll(30, 50);
        const auto plant =
            pulse_transfer(axis(roll.decades(0.01, 100), roll.decades(0.01, 1) * fc), duration::from_value(T));
        rst_polynomials<2, 2, 2> law;
        try {
            law = design_lead_lag<signal::voltage>(plant, {hertz(fc), margin, roll(0.02, 0.2)},
                                                   duration::from_value(T));
        } catch (const invalid_parameter&) {
            continue;
        } // more lead than one such compensation gives
        const complex back = std::polar(1.0, -2 * std::numbers::pi * fc * T);
        const auto value = [&](const auto& p) {
            complex sum = 0;
            for (std::size_t i = p.size(); i-- > 0;) sum = sum * back + p[i];
            return sum;
        };
        std::array<double, 3> s{};
        for (std::size_t i = 0; i < 3; ++i) s[i] = law.feedback[i].value();
        const complex open = value(plant.b) / value(plant.a) * value(s) / value(law.r);
        off_gain = std::max(off_gain, std::abs(std::abs(open) - 1));
        off_margin = std::max(off_margin, std::abs(std::arg(-open) * 180 / std::numbers::pi - margin));
        ++tried;
    }
    CHECK(tried >= trials);
    CHECK(off_gain < 1e-8); // (1 - 1/z)^2 of a crossover of 1/500 of the rate has lost four digits
    CHECK(off_margin < 1e-6);
}
TEST_CASE(
    "state_feedback: the prediction over a period is exact: of an axis as believed nothing is corrected") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        const double T = roll.decades(1e-4, 2e-3), A = roll.decades(1e-2, 100), B = roll.decades(0.1, 10);
        const auto p = place_state_feedback<signal::voltage>(
            axis(B, A), {hertz(roll(0.005, 0.05) / T), 0.7, position_of(roll.decades(1e-8, 1e-5))},
            volts(roll.decades(0.1, 100)), duration::from_value(T));
        state_feedback<> law(p, duration::from_value(T));
        double x = roll(-0.1, 0.1), v = 0;
        const double d = roll(-5, 5);
        law.settle(position_of(x), volts(-d));
        for (int k = 0; k < 1000; ++k, ++tried) {
            const double u = roll(-10, 10);
            law.applied(volts(u));
            const moved<double> next(x, v, u + d, B, A, T);
            x = next.x, v = next.v;
            law({}, position_of(x), {});
            const double size = std::abs(x) + std::abs(v) * T + 1e-3;
            off = std::max(
                {off, std::abs(law.now().x.value() - x) / size, std::abs(law.now().v.value() - v) * T / size});
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-10); // 1000 periods, and a gain per position of 1/T of what their rounding is
}
TEST_CASE("disturbance_observer: solves u = wanted - d exactly: Q (Gn^-1 z - u) with this cycle's u is d") {
    dice roll;
    double off = 0;
    int tried = 0;
    while (tried < trials) {
        const double T = roll.decades(1e-4, 1e-2), w = 2 * std::numbers::pi * roll(0.005, 0.3) / T,
                     A = roll(0, 100), B = roll(0.1, 10), k = 2 / T;
        disturbance_observer<signal::voltage> block({hertz(w / (2 * std::numbers::pi)), axis(B, A)},
                                                    duration::from_value(T));
        double z[3]{}, u[3]{}, d[3]{};
        for (int n = 0; n < 100; ++n, ++tried) {
            for (int i = 2; i > 0; --i) z[i] = z[i - 1], u[i] = u[i - 1], d[i] = d[i - 1];
            z[0] = roll(-1, 1) * B * T * T;
            const double wanted = roll(-1, 1);
            d[0] = block(position_of(z[0]), volts(wanted)).value();
            u[0] = wanted - d[0];
            // (s + w)^2 d = w^2 ((s^2 + A s)/B z - u), s = k (1 - 1/z)/(1 + 1/z)
            const double a = w + k, b = w - k, left = a * a * d[0] + 2 * a * b * d[1] + b * b * d[2],
                         pushed = (k * k * (z[0] - 2 * z[1] + z[2]) + A * k * (z[0] - z[2])) / B,
                         right = w * w * (pushed - (u[0] + 2 * u[1] + u[2]));
            off = std::max(off, std::abs(left - right) / (a * a + w * w * 16));
        }
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
TEST_CASE(
    "lugre_observer: z is the exact solution for what stands during the period: one period is two halves") {
    dice roll;
    double off = 0;
    int tried = 0;
    for (; tried < trials; ++tried) {
        const double level = roll.decades(1, 300), T = roll.decades(1e-4, 1e-2);
        lugre_observer<>::parameters p;
        p.friction.curve = {force_of(level), force_of(level * roll(1, 2)),
                            velocity_of(roll.decades(1e-3, 0.1))};
        p.friction.stiffness = stiffness_of(level / roll.decades(1e-6, 1e-4));
        p.correction = decltype(p.correction)::from_value(roll.decades(0.1, 1000));
        lugre_observer<> whole(p, duration::from_value(T)), half(p, duration::from_value(T / 2));
        const auto before = velocity_of(roll(-1, 1) * 1e-3),
                   v = velocity_of(roll(-1, 1) * roll.decades(1e-5, 1e-2));
        const auto behind = position_of(roll(-1, 1) * roll.decades(1e-8, 1e-5));
        whole.settle(before), half.settle(before);
        whole(v, behind), half(v, behind), half(v, behind);
        off = std::max(off, std::abs((whole.now().force - half.now().force).value()) / level);
    }
    CHECK(tried >= trials);
    CHECK(off < 1e-11);
}
