// SPDX-License-Identifier: BSL-1.0
// Long: one block on three laws with memory.
// linear_motor on friction that remembers: dahl, lugre, maxwell_slip.
#include "../friction/hysteresis.hpp"

#include <quadrant/base/dual.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

using namespace hysteresis;

namespace {
using gms = maxwell_slip<4>;
using table = linear_motor<gms>;
using stage = linear_motor<lugre<>>;
const auto kf = 1450_N / 1_V;
auto volts(double u) { return quantity<si::electric_potential>::from_value(u); }

table::parameters x_axis(std::size_t substeps = 10) {
    return {.mass = 340_kg,
            .force_constant = kf,
            .friction = {.curve = {122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps},
                         .weights = {},
                         .forces = {65_N, 55_N, 26_N, 6.5_N},
                         .stiffness = {per_um(61.80), per_um(9.852), per_um(4.490), per_um(0.325)},
                         .attraction = 450_N / 1_s},
            .substeps = substeps};
}
/// reference/linear_stage.md: 6 kg, 40 N/A taken as 40 N/V, 2 ms.
stage::parameters light(std::size_t substeps = 10) {
    return {.mass = 6_kg,
            .force_constant = 40_N / 1_V,
            .friction = {.curve = {8_N, 12_N, 5_mmps, 15_N / 1_mps, 2},
                         .stiffness = per_um(1.5),
                         .damping = 2985_N / 1_mps,
                         .damping_velocity = {}},
            .substeps = substeps};
}
} // namespace

TEST_CASE("linear_motor: on maxwell_slip, pushed below breakaway, it yields as far as the virgin curve says "
          "and springs back") {
    // 100 N, raised and lowered within 0.4 s: virgin curve 1.667 um, on return what Masing's rule leaves.
    table m{x_axis(), Ts};
    for (int k = 0; k < 800; ++k) m(volts(100.0 / 1450 * k / 800));
    for (int k = 0; k < 4000; ++k) m(volts(100.0 / 1450));
    const double there = m.now().x.value();
    CHECK(std::abs(there - 1.674e-6) < 0.08e-6); // 75.443 + 14.667 N/um z = 100 N
    for (int k = 0; k < 800; ++k) m(volts(100.0 / 1450 * (800 - k) / 800));
    for (int k = 0; k < 4000; ++k) m(0_V);
    // Back by twice the displacement of 50 N on the virgin curve, 0.6539 um: 0.366 um are left.
    CHECK(std::abs(m.now().x.value() - (there - 2 * 50.0 / 76.467e6)) < 0.08e-6);
}
TEST_CASE("linear_motor: on maxwell_slip, pushed beyond breakaway, it comes to the speed where the Stribeck "
          "curve meets the push") {
    table m{x_axis(), Ts};
    for (int k = 0; k < 20000; ++k) m(volts(217.0 / 1450));
    CHECK(alike(m.now().v.value(), 0.1, 1e-4)); // 122 + 95 N
    for (int k = 0; k < 20000; ++k) m(volts(-217.0 / 1450));
    CHECK(alike(m.now().v.value(), -0.1, 1e-4));
}
TEST_CASE(
    "linear_motor: on each law the end of a motion with stops and reversals converges with the sub-step") {
    const auto end = []<class Friction>(const typename linear_motor<Friction>::parameters& given, double push,
                                        std::size_t substeps, duration period) {
        auto p = given;
        p.substeps = substeps;
        linear_motor<Friction> m{p, period};
        for (double t = 0; t < 0.6; t += period.value())
            m(volts(push * std::sin(2 * 3.14159265358979 * 3 * t)));
        return m.now().x.value();
    };
    SUBCASE("maxwell_slip, 340 kg, 0.5 ms: 40 um at one sub-step, 8 at ten, 1.2 at a hundred") {
        const double exact = end.operator()<gms>(x_axis(), 0.3, 1000, Ts);
        CHECK(exact > 5e-3);
        CHECK(std::abs(end.operator()<gms>(x_axis(), 0.3, 1, Ts) - exact) < 40e-6);
        CHECK(std::abs(end.operator()<gms>(x_axis(), 0.3, 10, Ts) - exact) < 8e-6);
        CHECK(std::abs(end.operator()<gms>(x_axis(), 0.3, 100, Ts) - exact) < 1.2e-6);
    }
    SUBCASE("lugre, 6 kg, 2 ms: 0.4 mm at one sub-step, 50 um at ten, 6 at a hundred") {
        const double exact = end.operator()<lugre<>>(light(), 0.5, 1000, 2_ms);
        CHECK(exact > 5e-3);
        CHECK(std::abs(end.operator()<lugre<>>(light(), 0.5, 1, 2_ms) - exact) < 0.4e-3);
        CHECK(std::abs(end.operator()<lugre<>>(light(), 0.5, 10, 2_ms) - exact) < 50e-6);
        CHECK(std::abs(end.operator()<lugre<>>(light(), 0.5, 100, 2_ms) - exact) < 6e-6);
    }
}
TEST_CASE("linear_motor: without a drive kinetic and spring energy together never grow, at any sub-step") {
    for (const std::size_t substeps : {1u, 3u, 10u})
        for (const auto& period : {125_us, 2_ms}) {
            auto p = x_axis(substeps);
            p.friction.curve.coulomb = 177_N; // one level: none is added by dwelling
            table m{p, period};
            for (int k = 0; k < 300; ++k) m(0.5_V);
            const auto energy = [&] {
                double sum = 0.5 * 340 * m.now().v.value() * m.now().v.value();
                for (std::size_t i = 0; i < 4; ++i) {
                    const double f = m.friction().now().elements[i].force.value();
                    sum += f * f / (2 * p.friction.stiffness[i].value());
                }
                return sum;
            };
            double before = energy();
            for (int k = 0; k < 5000; ++k) {
                m(0_V);
                const double now = energy();
                CHECK(now <= before * (1 + 1e-9) + 1e-15);
                before = now;
            }
        }
}
TEST_CASE("linear_motor: stable on each law with one sub-step of 1 us to 2 ms, thrown about at up to 2 m/s") {
    dice roll;
    for (const auto& period : {1_us, 10_us, 125_us, 500_us, 2_ms}) {
        table heavy{x_axis(1), period};
        stage fast{light(1), period};
        linear_motor<dahl<>> spring{{.mass = 6_kg,
                                     .force_constant = 40_N / 1_V,
                                     .friction = {8_N, per_um(1.5), 2, 15_N / 1_mps},
                                     .substeps = 1},
                                    period};
        double v = 0;
        for (int k = 0; k < 3000; ++k) {
            const double to = roll(-1, 1) * 0.02 / period.value(); // newtons
            heavy(0_V, newtons(std::clamp(to, -1e5, 1e5)));
            fast(0_V, newtons(std::clamp(to / 60, -2e3, 2e3)));
            spring(0_V, newtons(std::clamp(to / 60, -2e3, 2e3)));
            v = std::max({v, std::abs(heavy.now().v.value()), std::abs(fast.now().v.value()),
                          std::abs(spring.now().v.value())});
        }
        CHECK(v < 100);
        for (double t = 0; t < 60; t += std::max(period.value(), 500e-6)) {
            if (period < 500_us) break; // a minute of microseconds is too long for a test
            heavy(0_V), fast(0_V), spring(0_V);
        }
        if (period >= 500_us) {
            CHECK(std::abs(heavy.now().v.value()) < 1e-9);
            CHECK(std::abs(fast.now().v.value()) < 1e-9);
            CHECK(std::abs(spring.now().v.value()) < 1e-9);
        }
        CHECK_FALSE(heavy.faulted());
        CHECK_FALSE(fast.faulted());
    }
}
TEST_CASE("linear_motor: the stage of 2 ms without compensation stands still under 95 % of the static level") {
    stage m{light(), 2_ms};
    for (int k = 0; k < 3000; ++k) m(volts(0.95 * 12 / 40 * std::min(1.0, k / 1000.0)));
    const double there = m.now().x.value();
    CHECK(there < 50e-6);
    for (int k = 0; k < 3000; ++k) m(volts(0.95 * 12 / 40));
    CHECK(std::abs(m.now().x.value() - there) < 1e-9);
}
TEST_CASE("linear_motor: a bad command or force, or a motion beyond all numbers, leaves the memory of friction "
          "as it was") {
    for (const double bad : {bad_number, infinite, 1.7e308}) {
        table m{x_axis(), Ts};
        for (int k = 0; k < 100; ++k) m(volts(0.1 + 1e-3 * k));
        const auto last = m(0.1_V);
        auto twin = m;
        CHECK(m(0.1_V, newtons(bad)) == last);
        CHECK(m.faulted());
        bool same = true;
        for (int k = 0; k < 300; ++k) same = same && m(volts(-0.1)) == twin(volts(-0.1));
        CHECK(same);
    }
}
TEST_CASE("linear_motor: on friction that remembers, reset and settle relax it, copies are independent") {
    table m{x_axis(), Ts}, fresh{x_axis(), Ts};
    for (int k = 0; k < 100; ++k) m(0.5_V);
    auto copy = m;
    for (int k = 0; k < 100; ++k) copy(-0.5_V);
    CHECK(copy.now().x != m.now().x);
    m.settle(5_mm);
    for (int k = 0; k < 20; ++k) CHECK(m(0_V) == 5_mm);
    for (int k = 0; k < 100; ++k) m(0.11_V);
    m.reset();
    for (int k = 0; k < 100; ++k) CHECK(m(0.3_V) == fresh(0.3_V));
    static_assert(maps<table, signal::voltage, signal::position>);
}
TEST_CASE("linear_motor: on maxwell_slip in float it follows double to 2 um over 10 mm") {
    using rough_motor = linear_motor<maxwell_slip<4, signal::velocity, signal::force, float>, 32, float>;
    rough_motor rough{{.mass = 340_kg,
                       .force_constant = kf,
                       .friction = {.curve = {122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps},
                                    .weights = {},
                                    .forces = {65_N, 55_N, 26_N, 6.5_N},
                                    .stiffness = {per_um(61.80), per_um(9.852), per_um(4.490), per_um(0.325)},
                                    .attraction = 450_N / 1_s}},
                      Ts};
    table exact{x_axis(), Ts};
    double worst = 0;
    for (int k = 0; k < 500; ++k) {
        const float u = static_cast<float>(0.2 + 0.3 * std::sin(0.02 * k));
        const float x = rough(quantity_of<signal::voltage, float>::from_value(u)).value();
        worst = std::max(worst, std::abs(double(x) - exact(volts(double(u))).value()));
    }
    CHECK(std::abs(exact.now().x.value()) > 10e-3);
    CHECK(worst < 2e-6);
}
TEST_CASE("linear_motor: on maxwell_slip with duals the end moves with mass, levels, stiffness as a difference "
          "quotient says") {
    constexpr std::array given{340.0, 122.0, 177.0, 61.8e6, 0.41e-3};
    const auto end = []<class Real>(const std::array<Real, 5>& with) {
        using machine = linear_motor<maxwell_slip<2, signal::velocity, signal::force, Real>, 32, Real>;
        typename machine::parameters p;
        p.mass = decltype(p.mass)::from_value(with[0]);
        p.force_constant = decltype(p.force_constant)::from_value(Real(1450));
        auto& f = p.friction;
        f.curve.coulomb = decltype(f.curve.coulomb)::from_value(with[1]);
        f.curve.static_level = decltype(f.curve.coulomb)::from_value(with[2]);
        f.curve.stribeck_velocity = decltype(f.curve.stribeck_velocity)::from_value(Real(2.2e-3));
        f.curve.viscous = decltype(f.curve.viscous)::from_value(Real(850));
        f.weights = {Real(0.625), Real(0.375)};
        f.stiffness[0] = f.stiffness[1] =
            gain_rate_of<signal::force, signal::velocity, Real>::from_value(with[3]);
        f.stiffness[1] *= Real(0.1);
        f.attraction = decltype(f.attraction)::from_value(Real(450));
        p.delay = decltype(p.delay)::from_value(with[4]);
        machine m{p, Ts};
        for (int k = 0; k < 600; ++k)
            m(quantity_of<signal::voltage, Real>::from_value(Real(k < 100 ? 0.4 : k < 350 ? 0.05 : -0.3)));
        return m.now().x.value();
    };
    using D = dual<5>;
    std::array<D, 5> variables;
    for (std::size_t i = 0; i < 5; ++i) variables[i] = D::variable(given[i], i);
    const D x = end(variables);
    CHECK(alike(x.value, end(given), 1e-9));
    for (std::size_t i = 0; i < given.size(); ++i) {
        CAPTURE(i);
        auto up = given, down = given;
        up[i] *= 1 + 1e-5, down[i] *= 1 - 1e-5;
        const double quotient = (end(up) - end(down)) / 2e-5; // per relative change: metres
        CHECK(std::abs(quotient) > 1e-8);
        CHECK(alike(x.partial[i] * given[i], quotient, 1e-4));
    }
}
TEST_CASE("linear_motor: refuses in the name of the friction box") {
    auto p = x_axis();
    p.friction.stiffness[0] = per_um(-1);
    CHECK_THROWS_WITH_AS((table{p, Ts}), "maxwell_slip.stiffness = -1e+06 N/m: must be finite and above 0",
                         invalid_parameter);
}
