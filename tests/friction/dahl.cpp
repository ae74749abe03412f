// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include "hysteresis.hpp"

#include <quadrant/base/dual.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/friction/dahl.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>

using namespace hysteresis;

namespace {
/// 122 N, 60 N/um at the start of a motion: 2.03 um is the displacement in which a spring would get there.
dahl<>::parameters contact(double shape = 1) { return {122_N, per_um(60), shape, {}}; }
constexpr double bend = 122.0 / 60e6;
const double shapes[] = {0, 0.3, 0.5, 1, 1.5, 2, 4};

/// dr/da = -r^shape by Runge-Kutta, r = 1 - F sign(v)/Fc, a = displacement in bends.
double curve(double shape, double r, double a) {
    const auto slope = [&](double at) { return at > 0 ? -std::pow(at, shape) : 0.0; };
    const int n = 20000;
    for (int k = 0; k < n && r > 0; ++k) {
        const double h = a / n, p = slope(r), q = slope(r + h / 2 * p), s = slope(r + h / 2 * q),
                     t = slope(r + h * s);
        r = std::max(0.0, r + h / 6 * (p + 2 * q + 2 * s + t));
    }
    return r;
}
} // namespace

TEST_CASE("dahl: exponent 1 by hand, to 1 mN: 1 um gives 47.394 N, 5 um 111.567 N, 1 mm the level") {
    dahl<> law{contact(), Ts};
    CHECK(std::abs(go(law, 1 * um) - 47.394) < 1e-3); // 122 (1 - exp(-60/122))
    CHECK(std::abs(go(law, 4 * um) - 111.567) < 1e-3);
    CHECK(go(law, 1e-3) == doctest::Approx(122).epsilon(1e-12));
    CHECK(std::abs(go(law, -1 * um) - (2 * 74.6058 - 122)) < 1e-3); // back from the level: r starts at 2
}
TEST_CASE("dahl: every exponent follows the differential equation, from rest and after a reversal, to 1e-4 of "
          "the level") {
    for (const double shape : shapes) {
        CAPTURE(shape);
        for (const double a : {0.2, 0.9, 1.5, 5.0}) {
            CAPTURE(a);
            dahl<> law{contact(shape), Ts};
            CHECK(std::abs(go(law, a * bend, 7) - 122 * (1 - curve(shape, 1, a))) < 1e-4 * 122);
            law.become({newtons(100)});
            CHECK(std::abs(go(law, -a * bend, 7) + 122 * (1 - curve(shape, 1 + 100.0 / 122, a))) < 1e-4 * 122);
        }
    }
}
TEST_CASE("dahl: one step is as good as many: only the way counts, neither speed nor steps") {
    dice roll;
    for (const double shape : shapes) {
        CAPTURE(shape);
        dahl<> once{contact(shape), Ts}, often{contact(shape), Ts}, fast{contact(shape), Ts};
        for (int k = 0; k < 200; ++k) {
            const double way = roll(-5, 5) * um;
            const double f = go(once, way, 1, std::abs(way) / 1e-6);
            CHECK(std::abs(go(often, way, 50, 1e-6) - f) < 1e-8);
            CHECK(std::abs(go(fast, way, 1, std::abs(way) / 2.0) - f) < 1e-8);
        }
    }
}
TEST_CASE("dahl: it comes to its level at a constant speed, in both directions, and never beyond") {
    for (const double shape : shapes) {
        CAPTURE(shape);
        auto p = contact(shape);
        p.viscous = 950_N / 1_mps;
        dahl<> law{p, Ts};
        const double off =
            shape > 1 ? 122 * std::pow((shape - 1) * 1e6, -1 / (shape - 1)) : 1e-9; // r after 1e6 bends
        CHECK(std::abs(go(law, 1e6 * bend, 1000, 1e6 * bend / 1000 / 0.1) - 122 - 95) <= off * 1.01 + 1e-9);
        CHECK(std::abs(go(law, -1e6 * bend, 1000, 1e6 * bend / 1000 / 0.1) + 122 + 95) <= off * 1.01 + 1e-9);
    }
}
TEST_CASE("dahl: bounded by its level at steps of 1 us to 2 ms and speeds up to 2 m/s, any motion") {
    dice roll;
    for (const double shape : shapes)
        for (const double h : {1e-6, 10e-6, 0.125e-3, 0.5e-3, 2e-3}) {
            dahl<> law{contact(shape), Ts};
            for (int k = 0; k < 2000; ++k) {
                const double v = (roll.often() ? 1 : -1) * roll.decades(1e-7, 2);
                CHECK(std::abs(step(law, v, h)) <= 122 * (1 + 1e-12));
            }
        }
}
TEST_CASE("dahl: below exponent 1 the level is reached within 1/(1 - shape) bends, from 1 on never") {
    for (const double shape : {0.0, 0.3, 0.5}) {
        dahl<> law{contact(shape), Ts};
        CHECK(go(law, 0.999 / (1 - shape) * bend) < 122);
        CHECK(go(law, 0.002 / (1 - shape) * bend) == doctest::Approx(122).epsilon(1e-12));
    }
    dahl<> law{contact(2), Ts};
    CHECK(go(law, 99 * bend) == doctest::Approx(122 * 0.99).epsilon(1e-9)); // r = 1/(1 + a)
}
TEST_CASE("dahl: exponent 1 is the limit of the others, to 0.1 mN") {
    dahl<> exact{contact(), Ts}, above{contact(1 + 1e-7), Ts}, below{contact(1 - 1e-7), Ts};
    dice roll;
    for (int k = 0; k < 300; ++k) {
        const double way = roll(-5, 5) * um, f = go(exact, way, 2);
        CHECK(std::abs(go(above, way, 2) - f) < 1e-4);
        CHECK(std::abs(go(below, way, 2) - f) < 1e-4);
    }
}
TEST_CASE("dahl: has no memory of inner loops: a loop of 1 um half way up leaves the force 19.78 N lower") {
    // u: F/Fc. Back by a: (1 + u) e^-a - 1, on by a again: 1 - (2 - (1 + u) e^-a) e^-a. maxwell_slip comes back
    // to u.
    dahl<> law{contact(), Ts};
    law.become({newtons(61)});
    go(law, -1 * um);
    const double e = std::exp(-60.0 / 122), f = go(law, 1 * um);
    CHECK(f == doctest::Approx(122 * (1 - (2 - 1.5 * e) * e)).epsilon(1e-12));
    CHECK(std::abs(61 - f - 19.78) < 0.01);
    // Nor does Masing's rule hold: from the level back by 2 um the force falls by 152.8 N, not by twice the
    // 47.4 N of 1 um.
    dahl<> slides{contact(), Ts};
    slides.settle(1_mmps);
    CHECK(122 - go(slides, -2 * um) == doctest::Approx(2 * 122 * (1 - e * e)).epsilon(1e-12));
}
TEST_CASE("dahl: loops of one amplitude close after the first cycles") {
    for (const double shape : shapes) {
        dahl<> law{contact(shape), Ts};
        go(law, 3 * um);
        for (int k = 0; k < 200; ++k) go(law, -6 * um, 5), go(law, 6 * um, 5);
        const double top = law.now().force.value();
        const double bottom = go(law, -6 * um, 5);
        CHECK(go(law, 6 * um, 5) == doctest::Approx(top).epsilon(1e-6));
        CHECK(bottom == doctest::Approx(-top).epsilon(1e-6));
    }
}
TEST_CASE("dahl: a step never gives more energy than the bristles had stored") {
    // F v h >= change of F^2/(2 stiffness), since (1 - r)(1 - r^shape) >= 0
    dice roll;
    for (const double shape : shapes) {
        dahl<> law{contact(shape), Ts};
        for (int k = 0; k < 20000; ++k) {
            const double h = roll.decades(1e-6, 2e-3), way = roll(-1, 1) * roll.decades(1e-9, 1e-4);
            const double before = law.now().force.value();
            const double f = step(law, way / h, h);
            CHECK(f * way >= (f * f - before * before) / (2 * 60e6) - 1e-15);
        }
    }
}
TEST_CASE("dahl: energy dissipated per cycle is never negative, at any exponent, amplitude and step") {
    dice roll;
    for (const double shape : shapes)
        for (int n = 0; n < 60; ++n) {
            dahl<> law{contact(shape), Ts};
            const double amplitude = roll.decades(0.01, 1e4) * um;
            const int steps = static_cast<int>(roll(40, 400));
            double x = amplitude;
            for (int cycle = 0; cycle < 60; ++cycle) {
                double work = 0, scale = 0;
                for (int k = 1; k <= steps; ++k) {
                    const double to = amplitude * std::cos(2 * 3.14159265358979 * k / steps);
                    const double f = step(law, (to - x) / 1e-3, 1e-3);
                    work += f * (to - x), scale += std::abs(f * (to - x));
                    x = to;
                }
                if (cycle > 50) CHECK(work >= -1e-9 * scale); // the loop has closed
            }
        }
}
TEST_CASE("dahl: breaks away at its level: 340 kg pulled by 2 N/s run away at 122 N, to 1 %") {
    dahl<> law{contact(), Ts};
    double v = 0, x = 0, pull = 0;
    const double h = 50e-6;
    while (x < 100 * um && pull < 300) {
        pull += 2 * h;
        const auto to = presliding<double>(law, 340_kg, mps(v), newtons(pull), seconds(h));
        law.become(to.friction);
        v = to.v.value(), x += v * h;
    }
    CHECK(pull == doctest::Approx(122).epsilon(1e-2));
}
TEST_CASE("dahl: as a block it is the law with its period, odd bit for bit, and holds its force at rest") {
    static_assert(maps<dahl<>, signal::velocity, signal::force>);
    static_assert(friction_with_memory<dahl<>, double>);
    dice roll;
    for (const double shape : shapes) {
        dahl<> block{contact(shape), Ts}, mirror{contact(shape), Ts}, law{contact(shape), Ts};
        for (int k = 0; k < 300; ++k) {
            const double v = roll(-1, 1) * roll.decades(1e-5, 0.1);
            const auto f = block(mps(v));
            CHECK(f.value() == step(law, v, 500e-6));
            CHECK(mirror(mps(-v)) == -f);
        }
        const auto f = block(0_mps);
        for (int k = 0; k < 100; ++k) CHECK(block(0_mps) == f);
    }
}
TEST_CASE(
    "dahl: settle is sliding, or relaxed at rest; a bad velocity gives the last force and moves nothing") {
    dahl<> law{contact(2), Ts};
    law.settle(-1_mmps);
    for (int k = 0; k < 10; ++k) CHECK(law(-1_mmps) == -122_N);
    check_bad_velocities(law);
}
TEST_CASE("dahl: in float it follows double to 1e-4 of the level over a path of reversals") {
    for (const double shape : shapes) {
        CAPTURE(shape);
        dahl<signal::velocity, signal::force, float> rough{{122_N, per_um(60), shape, {}}, Ts};
        dahl<> exact{contact(shape), Ts};
        dice roll;
        for (int k = 0; k < 1000; ++k) {
            const auto v = static_cast<float>(roll(-1, 1) * roll.decades(1e-5, 0.1));
            const double f =
                static_cast<double>(rough(quantity_of<signal::velocity, float>::from_value(v)).value());
            CHECK(std::abs(f - exact(mps(static_cast<double>(v))).value()) < 1e-4 * 122);
        }
    }
}
TEST_CASE(
    "dahl: with duals the derivatives by level, stiffness and velocity are those of difference quotients") {
    using D = dual<3>;
    for (const double shape : {0.0, 0.5, 1.0, 2.0}) {
        CAPTURE(shape);
        const auto end = [&]<class Real>(const std::array<Real, 3>& with) {
            using law = dahl<signal::velocity, signal::force, Real>;
            typename law::parameters p;
            p.coulomb = decltype(p.coulomb)::from_value(with[0]);
            p.stiffness = decltype(p.stiffness)::from_value(with[1]);
            p.shape = shape;
            law friction{p, Ts};
            Real sum(0);
            for (int k = 0; k < 40; ++k)
                sum += friction(
                           quantity_of<signal::velocity, Real>::from_value(with[2] * Real(std::sin(0.37 * k))))
                           .value();
            return sum;
        };
        const std::array<double, 3> given{122, 2e7, 4e-3};
        const D y =
            end(std::array{D::variable(given[0], 0), D::variable(given[1], 1), D::variable(given[2], 2)});
        CHECK(y.value == doctest::Approx(end(given)).epsilon(1e-12));
        for (std::size_t i = 0; i < 3; ++i) {
            CAPTURE(i);
            auto up = given, down = given;
            up[i] *= 1 + 1e-6, down[i] *= 1 - 1e-6;
            CHECK(alike(y.partial[i] * given[i], (end(up) - end(down)) / 2e-6, 1e-5));
        }
    }
}
TEST_CASE("dahl: refuses what no contact has") {
    using P = dahl<>::parameters;
    const auto says = [](auto change, duration period = Ts) {
        return refusal<dahl<>>(contact(), change, period);
    };
    CHECK(says([](P&) {}) == "taken");
    CHECK(says([](P& p) { p.coulomb = 0_N; }) == "dahl.coulomb = 0 N: must be finite and above 0");
    CHECK(says([](P& p) { p.stiffness = per_um(-1); }) ==
          "dahl.stiffness = -1e+06 N/m: must be finite and above 0");
    CHECK(says([](P& p) { p.shape = -0.1; }) == "dahl.shape = -0.1: must lie between 0 and 4");
    CHECK(says([](P& p) { p.shape = 4.1; }) == "dahl.shape = 4.1: must lie between 0 and 4");
    CHECK(says([](P& p) { p.shape = bad_number; }) == "dahl.shape = nan: must lie between 0 and 4");
    CHECK(says([](P& p) { p.viscous = -2_N / 1_mps; }) ==
          "dahl.viscous = -2 N s/m: must be finite and not below 0");
    CHECK(says([](P&) {}, 0_s) == "dahl.period = 0 s: must be finite and above 0");
}
