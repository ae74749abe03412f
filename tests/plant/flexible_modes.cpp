// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/flexible_modes.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
using doctest::Approx;
using std::numbers::pi;
const duration T = 500_us;
/// x axis of the milling table: 340 kg, a base below 47 Hz, a structural mode at 330 Hz.
const flexible_modes<2>::parameters table{340_kg, {{{47_Hz, 0.03, 0.2}, {330_Hz, 0.02, -0.3}}}};

/// Runge-Kutta of fourth order on q'' = share F/M - 2 zeta w q' - w^2 q, 400 steps a period.
struct integrated {
    double q = 0, v = 0;
    void period(const machine_mode<>& m, double mass, double force) {
        const double w = 2 * pi * m.centre.value(), h = T.value() / 400;
        const auto a = [&](double x, double y) {
            return m.share * force / mass - 2 * m.damping * w * y - w * w * x;
        };
        for (int i = 0; i < 400; ++i) {
            const double k1 = v, l1 = a(q, v), k2 = v + h / 2 * l1, l2 = a(q + h / 2 * k1, v + h / 2 * l1),
                         k3 = v + h / 2 * l2, l3 = a(q + h / 2 * k2, v + h / 2 * l2), k4 = v + h * l3,
                         l4 = a(q + h * k3, v + h * l3);
            q += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
            v += h / 6 * (l1 + 2 * l2 + 2 * l3 + l4);
        }
    }
};
/// Rigid free mass and modes together, as the encoder sees them.
double size_at(const flexible_modes<1>& m, double hertz) {
    const double w = 2 * pi * hertz;
    return std::abs(-1 / (m.given().mass.value() * w * w) + m.continuous_response(hertz * 1_Hz));
}
double deepest(const flexible_modes<1>& m, double from, double to) {
    double best = from;
    for (double f = from; f < to; f += 0.01)
        if (size_at(m, f) < size_at(m, best)) best = f;
    return best;
}
} // namespace

TEST_CASE(
    "flexible_modes: each step is exact for a held force: Runge-Kutta with 400 steps a period finds the same") {
    flexible_modes<2> modes{table, T};
    std::array<integrated, 2> exact{};
    double off = 0, largest = 0;
    for (int k = 0; k < 200; ++k) {
        const double force = 500 * std::sin(0.9 * k) + (k < 50 ? 300 : -200);
        for (std::size_t i = 0; i < 2; ++i) exact[i].period(table.modes[i], 340, force);
        const double y = modes(force * 1_N).value();
        off = std::max(off, std::abs(y - exact[0].q - exact[1].q));
        largest = std::max(largest, std::abs(y));
        CHECK(modes.now().speed[1].value() == Approx(exact[1].v).epsilon(1e-7).scale(0));
    }
    CHECK(off < 1e-9 * largest);
}

TEST_CASE(
    "flexible_modes: a mode above half the sampling rate is stepped exactly too, without damping for ever") {
    const machine_mode<> fast{1300_Hz, 0, 1};
    flexible_modes<1> modes{{10_kg, {{fast}}}, T};
    integrated exact;
    for (int k = 0; k < 100; ++k) {
        exact.period(fast, 10, k < 3 ? 5 : 0);
        CHECK(std::abs(modes(k < 3 ? 5_N : 0_N).value() - exact.q) < 1e-13); // of 1e-8 m
    }
    // Free, undamped: the energy of the last samples is that of the first.
    const auto energy = [&] {
        const double w = 2 * pi * 1300, q = modes.now().deflection[0].value(), v = modes.now().speed[0].value();
        return v * v + w * w * q * q;
    };
    const double before = energy();
    for (int k = 0; k < 200'000; ++k) modes(0_N);
    CHECK(energy() == Approx(before).epsilon(1e-9).scale(0));
}

TEST_CASE("flexible_modes: a constant force bends by share F/(M w^2): 1000 N a base of 47 Hz by 6.75 um") {
    flexible_modes<1> base{{340_kg, {{table.modes[0]}}}, T};
    base.settle(1000_N);
    CHECK(base(1000_N).value() ==
          Approx(0.2 * 1000 / (340 * std::pow(2 * pi * 47, 2))).epsilon(1e-12).scale(0));
    CHECK(base(1000_N).value() == Approx(6.75e-6).epsilon(1e-3).scale(0));
}

TEST_CASE("flexible_modes: the sampled response tends to that of the machine as the sampling gets faster") {
    for (const double f : {20.0, 47.0, 200.0, 330.0}) {
        const flexible_modes<2> slow{table, 500_us}, fast{table, 5_us};
        const auto exact = slow.continuous_response(f * 1_Hz);
        // The hold is half a period late, the output one ahead: half a period ahead in sum.
        const auto held = [&](const flexible_modes<2>& m, double period) {
            return std::abs(m.response(f * 1_Hz) * std::polar(1.0, -pi * f * period) - exact) / std::abs(exact);
        };
        CHECK(held(fast, 5e-6) < 2e-4);
        CHECK(held(slow, 5e-4) < 0.2);
    }
}

TEST_CASE("flexible_modes: share > 0 dips below the resonance, -1 < share < 0 above it, share <= -1 nowhere") {
    const auto mode = [](double share) { return flexible_modes<1>{{100_kg, {{{100_Hz, 1e-4, share}}}}, T}; };
    CHECK(deepest(mode(0.5), 20, 99) == Approx(100 / std::sqrt(1.5)).epsilon(1e-3));
    CHECK(deepest(mode(-0.5), 101, 400) == Approx(100 / std::sqrt(0.5)).epsilon(1e-3));
    for (const double f : {50.0, 150.0, 300.0}) // no dip: everywhere above the rigid axis alone
        CHECK(size_at(mode(-2.0), f) > 1 / (100 * std::pow(2 * pi * f, 2)));
}

TEST_CASE(
    "base_mode: two masses, motor between them, base on a spring: encoder against base, simulated in full") {
    const machine_base<> given{.slide = 340_kg, .base = 1700_kg, .bolts = 47_Hz, .damping = 0.03};
    const auto mode = base_mode(given);
    CHECK(mode.share == Approx(0.2).epsilon(1e-12));
    flexible_modes<1> modes{{given.slide, {{mode}}}, T};
    // slide: M x'' = F;  base: Mb b'' = -F - d b' - k b;  the encoder reads x - b.
    const double mb = 1700, w = 2 * pi * 47, k = mb * w * w, d = 2 * 0.03 * mb * w, h = T.value() / 400;
    double b = 0, vb = 0, x = 0, vx = 0, off = 0, largest = 0;
    for (int n = 0; n < 200; ++n) {
        const double force = n < 40 ? 800 : -300;
        for (int i = 0; i < 400; ++i) { // midpoint rule
            const auto a = [&](double at, double speed) { return (-force - d * speed - k * at) / mb; };
            const double vm = vb + h / 2 * a(b, vb), bm = b + h / 2 * vb;
            vb += h * a(bm, vm), b += h * vm;
            x += h * (vx + h / 2 * force / 340), vx += h * force / 340;
        }
        const double rigid = x;
        off = std::max(off, std::abs(rigid + modes(force * 1_N).value() - (x - b)));
        largest = std::max(largest, std::abs(b));
    }
    CHECK(off < 1e-6 * largest); // second order of 1.25 us
    // With the slide clamped to the base both hang on the bolts: the anti-resonance.
    CHECK(deepest(flexible_modes<1>{{340_kg, {{{47_Hz, 1e-4, mode.share}}}}, T}, 30, 46.9) ==
          Approx(std::sqrt(k / (340 + mb)) / (2 * pi)).epsilon(1e-3));
}

TEST_CASE("flexible_modes: refuses what is no mode") {
    const auto refuse = [](machine_mode<> m, const char* words) {
        CHECK_THROWS_WITH_AS((flexible_modes<1>{{340_kg, {{m}}}, T}), words, invalid_parameter);
    };
    refuse({0_Hz, 0.1, 1}, "flexible_modes.centre = 0 Hz: must be finite and above 0");
    refuse({47_Hz, -0.1, 1}, "flexible_modes.damping = -0.1: must not be below 0 and must be below 1");
    refuse({47_Hz, 1, 1}, "flexible_modes.damping = 1: must not be below 0 and must be below 1");
    refuse({47_Hz, 0.1, std::nan("")}, "flexible_modes.share = nan: must be finite");
    CHECK_THROWS_WITH_AS((flexible_modes<1>{{0_kg, {{{47_Hz, 0.1, 1}}}}, T}),
                         "flexible_modes.mass = 0 kg: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_WITH_AS((flexible_modes<1>{{1_kg, {{{47_Hz, 0.1, 1}}}}, 0_s}),
                         "flexible_modes.period = 0 s: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_WITH_AS((base_mode(machine_base<>{340_kg, 0_kg, 47_Hz, 0.03})),
                         "machine_base.base = 0 kg: must be finite and above 0", invalid_parameter);
}
