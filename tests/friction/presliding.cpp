// SPDX-License-Identifier: BSL-1.0
// One implicit step of a mass on friction that remembers, over random axes: from 0.1 to 1000 kg, steps from 1
// us to 2 ms.
#include "hysteresis.hpp"

#include <quadrant/base/dual.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/lugre.hpp>
#include <quadrant/friction/maxwell_slip.hpp>

#include <doctest/doctest.h>

#include <algorithm>

using namespace hysteresis;

namespace {
struct situation {
    double mass, v, drive, h;
    template <class Law> auto step(const Law& law) const {
        return presliding<double>(law, quantity<si::mass>::from_value(mass), mps(v), newtons(drive),
                                  seconds(h));
    }
};
/// Energy of the springs.
double stored(const dahl<>& law) {
    const double f = law.now().force.value();
    return f * f / (2 * law.given().stiffness.value());
}
double stored(const lugre<>& law) {
    const double f = law.now().force.value();
    return f * f / (2 * law.given().stiffness.value());
}
double stored(const maxwell_slip<3>& law) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double f = law.now().elements[i].force.value();
        sum += f * f / (2 * law.given().stiffness[i].value());
    }
    return sum;
}

/// Calls f(law, situation, level) for random axes of each kind, each in a random state. `falling`: with a
/// Stribeck curve.
template <class F> void random_axes(bool falling, F&& f) {
    dice roll;
    for (int n = 0; n < 4000; ++n) {
        const double mass = roll.decades(0.1, 1000), h = roll.decades(1e-6, 2e-3),
                     coulomb = roll.decades(1, 300);
        const double held = coulomb * (falling ? roll(1, 2) : 1.0);
        const double k = held / roll.decades(0.1e-6, 50e-6); // it yields within 0.1 to 50 um
        const double viscous = roll.often() ? roll.decades(1, 2000) : 0;
        situation s{mass, 0, 0, h};
        if (roll.often()) s.v = roll(-1, 1) * roll.decades(1e-6, 2);
        if (roll.often()) s.drive = roll(-2, 2) * held;
        const stribeck<>::parameters curve{newtons(coulomb), newtons(held), mps(roll.decades(1e-3, 1e-2)),
                                           viscous * 1_N / 1_mps, falling ? roll(0.5, 2) : 1.0};
        const auto per_m = [](double x) { return per_um(x * 1e-6); };
        const auto wander = [&](auto law) {
            for (int i = 0; i < 5; ++i) go(law, roll(-2, 2) * held / k, 3);
            f(law, s, held);
        };
        wander(dahl<>{{newtons(held), per_m(k), roll(0, 2), viscous * 1_N / 1_mps}, Ts});
        wander(lugre<>{{curve, per_m(k), {}, {}}, Ts});
        lugre<>::parameters damped{curve, per_m(k), roll(0, 1) * std::sqrt(k * mass) * 1_N / 1_mps, mps(1e-3)};
        while (!lugre<>::passive(damped)) damped.damping *= 0.5;
        wander(lugre<>{damped, Ts});
        const double a = roll(0.2, 0.6), b = roll(0.1, 0.3);
        wander(maxwell_slip<3>{
            {curve, {a, b, 1 - a - b}, {}, {per_m(k), per_m(k / 5), per_m(k / 20)}, 450_N / 1_s}, Ts});
    }
}
} // namespace

TEST_CASE(
    "presliding: the new velocity solves M (v' - v)/h + friction(v') = drive, to 1e-9 of the forces in it") {
    int jumps = 0, all = 0;
    random_axes(true, [&](const auto& law, const situation& s, double held) {
        const auto to = s.step(law);
        const double v = to.v.value(), inertia = s.mass / s.h,
                     friction = law.after(to.v, seconds(s.h)).force.value();
        const double forces = inertia * (std::abs(v) + std::abs(s.v)) + std::abs(s.drive) + held;
        ++all;
        if (std::abs(inertia * (v - s.v) + friction - s.drive) > 1e-9 * forces) {
            // Only where a slipping element jumps as it starts to stick: at rest.
            ++jumps;
            CHECK(std::abs(v) * inertia < 1e-6 * forces);
            CHECK(std::abs(inertia * (v - s.v) + friction - s.drive) < 0.01 * held);
        }
    });
    CHECK(all == 16000);
    CHECK(jumps < 160);
}
TEST_CASE("presliding: the slope that a law gives is the derivative of its force by the velocity") {
    int compared = 0, kinks = 0;
    random_axes(true, [&](const auto& law, const situation& s, double held) {
        if (s.v == 0) return;
        const auto force = [&](double v) { return law.after(mps(v), seconds(s.h)).force.value(); };
        const double e = 1e-5 * s.v, slope = law.after(mps(s.v), seconds(s.h)).slope.value();
        const double before = (force(s.v) - force(s.v - e)) / e, behind = (force(s.v + e) - force(s.v)) / e;
        ++compared;
        const double rounding = 1e-14 * held / std::abs(e);
        if (std::abs(before - behind) >
            1e-3 * std::abs(behind) + rounding) { // an element breaks away just here
            ++kinks;
            return;
        }
        CHECK(std::abs(slope - (before + behind) / 2) <= 1e-3 * std::abs(slope) + rounding);
    });
    CHECK(compared > 5000);
    CHECK(kinks < 0.01 * compared);
}
TEST_CASE("presliding: no step gives more energy than drive and springs") {
    // M/2 (v'^2 - v^2) + stored' - stored <= drive v' h, with one level; the falling level adds what dwell time
    // adds.
    random_axes(false, [](auto law, const situation& s, double) {
        const double before = stored(law);
        const auto to = s.step(law);
        law.become(to.friction);
        const double v = to.v.value(), kinetic = 0.5 * s.mass * (v - s.v) * (v + s.v);
        const double scale = 0.5 * s.mass * (v * v + s.v * s.v) + before + std::abs(s.drive * v * s.h);
        CHECK(kinetic + stored(law) - before <= s.drive * v * s.h + 1e-9 * scale);
    });
}
TEST_CASE(
    "presliding: a free axis comes to rest, at every step length and stiffness, without ringing on and on") {
    for (const double h : {1e-6, 50e-6, 0.5e-3, 2e-3})
        for (const double mass : {0.5, 6.0, 340.0}) {
            CAPTURE(h);
            CAPTURE(mass);
            const stribeck<>::parameters curve{100_N, 150_N, 2_mmps, 50_N / 1_mps};
            maxwell_slip<2> law{{curve, {0.5, 0.5}, {}, {per_um(100), per_um(5)}, 450_N / 1_s}, Ts};
            situation s{mass, std::sqrt(2 * 100 * 20e-6 / mass), 0, h}; // stops within some 20 um
            double energy = 1, x = 0;
            for (int k = 0; k < 200000 && k * h < 1; ++k) {
                const auto to = s.step(law);
                law.become(to.friction);
                s.v = to.v.value(), x += s.v * h;
                energy = 0.5 * mass * s.v * s.v;
            }
            if (h >= 50e-6) CHECK(energy < 1e-9 * 0.002);
            CHECK(std::abs(x) < 100 * um);
        }
}
TEST_CASE("presliding: at rest without a drive an axis on a relaxed contact does not move by one bit") {
    lugre<> law{{{8_N, 12_N, 5_mmps, 15_N / 1_mps, 2}, per_um(1.5), 2985_N / 1_mps, {}}, Ts};
    CHECK(situation{6, 0, 0, 50e-6}.step(law).v == 0_mps);
    CHECK(situation{6, 0, -0.0, 50e-6}.step(law).v == 0_mps);
    CHECK(situation{6, 0, 1e-9, 50e-6}.step(law).v > 0_mps);
}
TEST_CASE("presliding: odd in velocity, drive and memory, bit for bit") {
    dice roll;
    for (int n = 0; n < 3000; ++n) {
        const maxwell_slip<2>::parameters p{
            {100_N, 150_N, 2_mmps, 50_N / 1_mps}, {0.5, 0.5}, {}, {per_um(100), per_um(5)}, 450_N / 1_s};
        maxwell_slip<2> law{p, Ts}, mirror{p, Ts};
        for (int i = 0; i < 5; ++i) {
            const double way = roll(-10, 10) * um;
            go(law, way, 3), go(mirror, -way, 3);
        }
        const situation s{roll.decades(0.1, 1000), roll(-1, 1) * 1e-2, roll(-200, 200),
                          roll.decades(1e-6, 2e-3)};
        CHECK((situation{s.mass, -s.v, -s.drive, s.h}.step(mirror).v == -s.step(law).v));
    }
}
TEST_CASE("presliding: below breakaway the axis rings about its spring at sqrt(k/M), and its place is drive "
          "over stiffness") {
    // 340 kg on 76.467 N/um: 75.5 Hz. One newton more at 1 us steps, each of which takes 1/2 (w h)^2 of the
    // swing's energy.
    maxwell_slip<4> law{{.curve = {122_N, 177_N, 1_mps / 450.0, {}},
                         .weights = {},
                         .forces = {65_N, 55_N, 26_N, 6.5_N},
                         .stiffness = {per_um(61.80), per_um(9.852), per_um(4.490), per_um(0.325)},
                         .attraction = 450_N / 1_s},
                        Ts};
    situation s{340, 0, 1, 1e-6};
    double x = 0, highest = 0, last = 0;
    int turns = 0, first = 0, latest = 0;
    for (int k = 0; k < 200000; ++k) {
        const auto to = s.step(law);
        law.become(to.friction);
        s.v = to.v.value(), x += s.v * s.h;
        highest = std::max(highest, x);
        if (last > 0 && s.v <= 0) ++turns, first = first ? first : k, latest = k;
        last = s.v;
    }
    CHECK(alike((turns - 1) / ((latest - first) * 1e-6), 75.477, 1e-3));
    CHECK(alike(highest, 2.0 / 76.467e6, 1e-3)); // swings up to twice the rest
}
TEST_CASE("presliding: with duals the derivatives of a step are those of difference quotients") {
    using D = dual<4>; // by mass, velocity, drive, stiffness
    const auto step = [](auto mass, auto v, auto drive, auto stiffness) {
        using Real = decltype(mass);
        using law = lugre<signal::velocity, signal::force, Real>;
        typename law::parameters p;
        p.curve.coulomb = decltype(p.curve.coulomb)::from_value(Real(122));
        p.curve.static_level = decltype(p.curve.coulomb)::from_value(Real(177));
        p.curve.stribeck_velocity = decltype(p.curve.stribeck_velocity)::from_value(Real(2.2e-3));
        p.stiffness = decltype(p.stiffness)::from_value(stiffness);
        p.damping = decltype(p.damping)::from_value(Real(1e4));
        return presliding<Real>(law{p, Ts}, quantity<si::mass, Real>::from_value(mass),
                                quantity_of<signal::velocity, Real>::from_value(v),
                                quantity_of<signal::force, Real>::from_value(drive),
                                quantity<si::time, Real>::from_value(Real(500e-6)))
            .v.value();
    };
    for (const double v : {-3e-3, 0.0, 1e-4, 4e-3}) {
        const D y = step(D::variable(340, 0), D::variable(v, 1), D::variable(50, 2), D::variable(6e7, 3));
        const double e = 1e-5;
        const auto near = [&](std::size_t i, double quotient) {
            CAPTURE(i);
            CHECK(alike(y.partial[i], quotient, 1e-4));
            CHECK((quotient != 0 || v == 0));
        };
        near(0, (step(340 * (1 + e), v, 50.0, 6e7) - step(340 * (1 - e), v, 50.0, 6e7)) / (680 * e));
        near(1, (step(340.0, v + 1e-8, 50.0, 6e7) - step(340.0, v - 1e-8, 50.0, 6e7)) / 2e-8);
        near(2, (step(340.0, v, 50 * (1 + e), 6e7) - step(340.0, v, 50 * (1 - e), 6e7)) / (100 * e));
        near(3, (step(340.0, v, 50.0, 6e7 * (1 + e)) - step(340.0, v, 50.0, 6e7 * (1 - e))) / (12e7 * e));
    }
}
namespace {
/// A law that does not say its force at rest: presliding asks after(0, h) of it.
template <class Law> struct silent {
    using state = typename Law::state;
    Law law;
    auto after(quantity_of<signal::velocity> v, quantity<si::time> h) const noexcept { return law.after(v, h); }
    void become(const state& next) noexcept { law.become(next); }
    const state& now() const noexcept { return law.now(); }
    void reset() noexcept { law.reset(); }
};
} // namespace
TEST_CASE(
    "presliding: a law that says its force at rest gives the same step, to the bit, as one that is asked") {
    using detail::tells_force_at_rest;
    static_assert(tells_force_at_rest<maxwell_slip<3>, double, signal::force>);
    static_assert(tells_force_at_rest<lugre<>, double, signal::force>);
    static_assert(!tells_force_at_rest<silent<lugre<>>, double, signal::force>);
    int told = 0, moving = 0;
    for (const bool falling : {false, true})
        random_axes(falling, [&](const auto& law, const situation& s, double) {
            if constexpr (requires { law.at_rest(); }) {
                REQUIRE(law.at_rest().value() == law.after(mps(0), seconds(s.h)).force.value());
                const auto one = s.step(law), two = s.step(silent<std::decay_t<decltype(law)>>{law});
                REQUIRE(one.v.value() == two.v.value());
                ++told, moving += s.v != 0 && one.v.value() != 0;
            }
        });
    CHECK(told > 5000);
    CHECK(moving > 2000);
}
