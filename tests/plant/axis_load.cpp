// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/axis_load.hpp>
#include <quadrant/plant/cogging_force.hpp>
#include <quadrant/plant/flexible_modes.hpp>
#include <quadrant/plant/force_ripple.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
using std::numbers::pi;
const duration T = 500_us;
using bare = linear_motor<>;
using empty_load = linear_motor<coulomb_viscous<>, 32, double, axis_load<>>;
using magnets = axis_load<cogging_force<2>, force_ripple<>, flexible_modes<1>>;
using loaded = linear_motor<coulomb_viscous<>, 32, double, magnets>;
using cogged = linear_motor<coulomb_viscous<>, 32, double, axis_load<cogging_force<>>>;

const loaded::parameters whole{.mass = 170_kg,
                               .force_constant = 1470_N / 1_V,
                               .friction = {0_N, 3400_N / 1_mps},
                               .delay = 0.4_ms,
                               .substeps = 20,
                               .load = {.cogging = {30_mm, {40_N, 15_N}, {0.3, 1.2}},
                                        .ripple = {30_mm, {0.05}, {0.9}},
                                        .modes = {170_kg, {{{44_Hz, 0.03, 0.2}}}}}};
double command(int k) { return 0.15 + 0.4 * std::sin(0.02 * k) + (k % 90 < 45 ? 0.1 : -0.1); }

/// The machine as its differential equations, Runge-Kutta of fourth order with 200 steps a period.
struct machine {
    std::array<double, 4> s{}; // x, v, q, q'
    std::array<double, 4> slope(const std::array<double, 4>& at, double u) const {
        const double w = 2 * pi * 44, force = 1470 * u * (1 + 0.05 * std::sin(2 * pi * at[0] / 0.03 + 0.9)) +
                                              40 * std::sin(2 * pi * at[0] / 0.03 + 0.3) +
                                              15 * std::sin(4 * pi * at[0] / 0.03 + 1.2);
        return {at[1], (force - 3400 * at[1]) / 170, at[3],
                0.2 * force / 170 - 2 * 0.03 * w * at[3] - w * w * at[2]};
    }
    void period(double older, double newer) {
        const int n = 200;
        const double h = T.value() / n;
        for (int i = 0; i < n; ++i) {
            const double u = i < 160 ? older : newer; // 0.4 ms of 0.5
            const auto along = [&](const std::array<double, 4>& d, double step) {
                std::array<double, 4> to = s;
                for (std::size_t j = 0; j < 4; ++j) to[j] += step * d[j];
                return to;
            };
            const auto a = slope(s, u), b = slope(along(a, h / 2), u), c = slope(along(b, h / 2), u),
                       d = slope(along(c, h), u);
            for (std::size_t j = 0; j < 4; ++j) s[j] += h / 6 * (a[j] + 2 * b[j] + 2 * c[j] + d[j]);
        }
    }
};
/// Largest distance in x of 2 s at 100 mm/s over cogging of 10 N and 30 mm, free 340 kg, from a step of a
/// microsecond;
/// per sample: the force at the sample held over the period. [m]
double cogging_error(std::size_t substeps, bool per_sample) {
    const auto p = [](std::size_t n) {
        return cogged::parameters{.mass = 340_kg,
                                  .force_constant = 1_N / 1_V,
                                  .substeps = n,
                                  .load = {.cogging = {30_mm, {10_N}, {0.0}}}};
    };
    cogged exact{p(500), T}, coarse{p(substeps), T};
    bare held{{.mass = 340_kg, .force_constant = 1_N / 1_V, .substeps = substeps}, T};
    cogging_force<> magnet{p(1).load.cogging, T};
    double off = 0;
    for (int k = 0; k < 4000; ++k) {
        const auto push = k < 20 ? 3400_N : 0_N; // 340 kg to 0.1 m/s
        const auto true_x = exact(0_V, push).value();
        const auto x = per_sample ? held(0_V, push + magnet(held.now().x)).value() : coarse(0_V, push).value();
        off = std::max(off, std::abs(x - true_x));
    }
    return off;
}
} // namespace

TEST_CASE("axis_load: an empty one changes no bit of the plant") {
    const bare::parameters p{
        .mass = 340_kg, .force_constant = 1450_N / 1_V, .friction = {122_N, 850_N / 1_mps}, .delay = 0.4_ms};
    bare a{p, T};
    empty_load b{{.mass = p.mass, .force_constant = p.force_constant, .friction = p.friction, .delay = p.delay},
                 T};
    bool same = true;
    for (int k = 0; k < 2000; ++k) same = same && a(command(k) * 1_V, 20_N) == b(command(k) * 1_V, 20_N);
    CHECK(same);
    CHECK(b.load().deflection() == 0_m);
}

TEST_CASE("axis_load: cogging, ripple and a mode: the differential equations by Runge-Kutta find the same "
          "within 0.1 %") {
    loaded motor{whole, T};
    machine exact;
    double off_rigid = 0, off_bent = 0, rigid = 0, bent = 0, older = 0;
    for (int k = 0; k < 2000; ++k) {
        const double u = command(k);
        motor(u * 1_V);
        exact.period(older, u);
        older = u;
        off_rigid = std::max(off_rigid, std::abs(motor.now().x.value() - exact.s[0]));
        off_bent = std::max(off_bent, std::abs(motor.load().deflection().value() - exact.s[2]));
        rigid = std::max(rigid, std::abs(exact.s[0]));
        bent = std::max(bent, std::abs(exact.s[2]));
    }
    CHECK(rigid > 0.03); // over more than one magnet
    CHECK(off_rigid < 1e-3 * rigid);
    CHECK(off_bent < 1e-3 * bent);
}

TEST_CASE("axis_load: cogging of 30 mm at 100 mm/s: right to 1 nm in ten sub-steps, to 1.8 um if held") {
    // 10 N move the free mass by 67 um; after 2 s, against a plant of 1 us steps.
    CHECK(cogging_error(10, false) < 1e-9);
    const double once = cogging_error(10, true);
    CHECK(once > 1.6e-6);
    CHECK(once < 1.9e-6);
}

TEST_CASE("axis_load: after a bad sample the plant and its boxes are where they were") {
    loaded motor{whole, T};
    for (int k = 0; k < 100; ++k) motor(command(k) * 1_V);
    auto twin = motor;
    const auto held = motor(std::nan("") * 1_V);
    CHECK(held.value() == doctest::Approx(twin.now().x.value()).scale(0));
    CHECK(motor.faulted());
    CHECK(motor(0_V, std::numeric_limits<double>::infinity() * 1_N) == held);
    CHECK(motor(1e306_V) == held); // a force beyond all numbers
    CHECK_FALSE(motor.load().faulted());
    bool same = true;
    for (int k = 0; k < 100; ++k) {
        same = same && motor(command(k) * 1_V) == twin(command(k) * 1_V) &&
               motor.load().deflection() == twin.load().deflection();
    }
    CHECK(same);
    motor.reset();
    loaded fresh{whole, T};
    for (int k = 0; k < 100; ++k) same = same && motor(command(k) * 1_V) == fresh(command(k) * 1_V);
    CHECK(same);
}
