// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include "hysteresis.hpp"

#include <quadrant/base/dual.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/friction/dahl.hpp>
#include <quadrant/friction/maxwell_slip.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

using namespace hysteresis;

namespace {
using gms = maxwell_slip<4>;
using one = maxwell_slip<1>;

/// [Jamaludin2008] Tables 3.3 and 4.3, x axis; without the viscous part, and C as reference/thesis.md takes it.
gms::parameters x_axis() {
    return {.curve = {122_N, 177_N, 1_mps / 450.0, {}},
            .weights = {},
            .forces = {65_N, 55_N, 26_N, 6.5_N},
            .stiffness = {per_um(61.80), per_um(9.852), per_um(4.490), per_um(0.325)},
            .attraction = 450_N / 1_s};
}
/// The same with one level at all speeds: nothing but the path counts.
gms::parameters flat() {
    auto p = x_axis();
    p.curve.coulomb = 177_N;
    return p;
}
double dry(const gms& law) {
    double sum = 0;
    for (const auto& e : law.now().elements) sum += e.force.value();
    return sum;
}
double stored(const gms& law) { // energy of the springs
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const double f = law.now().elements[i].force.value();
        sum += f * f / (2 * law.given().stiffness[i].value());
    }
    return sum;
}
/// Virgin curve by hand, N over metres: shares 75.443, 63.836, 30.177, 7.544 N of 177 N.
double virgin(double z) {
    double sum = 0;
    const double alpha[] = {65, 55, 26, 6.5}, k[] = {61.80e6, 9.852e6, 4.490e6, 0.325e6};
    for (int i = 0; i < 4; ++i) sum += std::min(k[i] * z, alpha[i] / 152.5 * 177);
    return sum;
}
} // namespace

TEST_CASE("maxwell_slip: the thesis' x axis by hand, to 0.1 N: 76.5 N at 1 um, 148.8 at 5, 177 at 30") {
    gms law{x_axis(), Ts};
    const auto near = [&](double way, double newtons) { // at 1 um/s the level has fallen by 25 mN
        CHECK(std::abs(go(law, way, 1000, way / 1e-6 / 1000) - newtons) < 0.1);
    };
    near(1 * um, 76.467);  // all four stick: 76.467 N/um
    near(4 * um, 148.778); // 75.443 + 14.667 N/um * 5 um
    near(3 * um, 172.056); // 8 um: 75.443 + 63.836 + 30.177 + 0.325 N/um * 8 um
    near(22 * um, 177);
}
TEST_CASE("maxwell_slip: from rest it follows the virgin curve, whatever the steps") {
    for (const int steps : {1, 3, 100}) {
        gms law{flat(), Ts};
        double z = 0;
        for (const double way : {0.3, 0.7, 1.0, 2.0, 2.5, 0.2, 10.0, 20.0}) {
            z += way * um;
            CHECK(go(law, way * um, steps) == doctest::Approx(virgin(z)).epsilon(1e-12));
        }
    }
}
TEST_CASE(
    "maxwell_slip: Masing's rule: after a reversal at z, force and way are twice those of the virgin curve") {
    for (const double z : {1.0, 5.0, 10.0, 40.0}) {
        gms law{flat(), Ts};
        const double top = go(law, z * um);
        for (int k = 1; k <= 40; ++k) {
            const double f = go(law, -z * um / 20);
            CHECK(top - f == doctest::Approx(2 * virgin(k * z * um / 20 / 2)).epsilon(1e-9));
        }
        CHECK(dry(law) == doctest::Approx(-top).epsilon(1e-9)); // at -z the loop is at its other corner
        go(law, 2 * z * um);
        CHECK(dry(law) == doctest::Approx(top).epsilon(1e-9)); // and closes
    }
}
TEST_CASE("maxwell_slip: after a reversal it is back on the virgin curve as soon as it has passed the turning "
          "point") {
    gms law{flat(), Ts};
    go(law, 3 * um);
    go(law, -2 * um);
    CHECK(dry(law) < virgin(1 * um) - 10); // inside
    go(law, 2 * um);
    for (double z = 3; z < 30; z += 0.5, go(law, 0.5 * um))
        CHECK(dry(law) == doctest::Approx(virgin(z * um)).epsilon(1e-9));
}
TEST_CASE("maxwell_slip: wiping out: inner loops of any depth leave no trace once passed") {
    dice roll;
    for (int n = 0; n < 300; ++n) {
        gms plain{flat(), Ts}, nested{flat(), Ts};
        const double first = roll(1, 40) * um, back = roll(0.2, 1.8) * first;
        go(plain, first), go(nested, first);
        go(plain, -back), go(nested, -back);
        // Turning points that nest: up and down, each within the one before, then back to where the nest began.
        double low = 0, high = back, at = 0;
        for (int turn = 0; turn < 6; ++turn) {
            const double to = turn % 2 == 0 ? roll(at, high) : roll(low, at);
            go(nested, to - at, 20);
            (turn % 2 == 0 ? high : low) = to;
            at = to;
        }
        go(nested, -at);
        CHECK(dry(nested) == doctest::Approx(dry(plain)).epsilon(1e-9));
        for (int k = 0; k < 20; ++k) { // and what comes is what would have come
            const double way = roll(-5, 5) * um;
            CHECK(std::abs(go(nested, way, 10) - go(plain, way, 10)) < 1e-6);
        }
    }
}
TEST_CASE("maxwell_slip: memory is not local: at one force, going one way, the future depends on the past") {
    gms virgin_branch{flat(), Ts}, returning{flat(), Ts};
    const double f = go(virgin_branch, 0.5 * um);
    go(returning, 20 * um), go(returning, -60 * um);
    double low = 0, high = 60 * um; // the displacement up to the same force
    for (int i = 0; i < 60; ++i) {
        gms trial = returning;
        (go(trial, (low + high) / 2) < f ? low : high) = (low + high) / 2;
    }
    CHECK(go(returning, low) == doctest::Approx(f).epsilon(1e-9));
    double apart = 0;
    for (int k = 0; k < 30; ++k)
        apart = std::max(apart, std::abs(go(virgin_branch, 0.1 * um) - go(returning, 0.1 * um)));
    CHECK(apart > 20); // newtons
}
TEST_CASE("maxwell_slip: with the level that falls, inner loops close on the outer curve to 0.1 N at 10 um/s") {
    gms plain{x_axis(), Ts}, looped{x_axis(), Ts};
    const double h = 1e-4, v = 10 * um;
    const auto move = [&](gms& law, double way) {
        const int steps = std::max(1, static_cast<int>(std::abs(way) / (v * h)));
        return go(law, way, steps, h);
    };
    move(plain, 50 * um), move(looped, 50 * um);
    move(plain, -4 * um), move(looped, -4 * um);
    for (const double loop : {1.0, 0.3, 2.0}) move(looped, loop * um), move(looped, -loop * um);
    CHECK(std::abs(dry(plain) - dry(looped)) < 0.1);
    CHECK(std::abs(move(plain, -10 * um) - move(looped, -10 * um)) < 0.1);
}
TEST_CASE("maxwell_slip: before it slides only the path counts, not the speed nor the steps") {
    SUBCASE("one level: from 1 um/s to 1 m/s to 1e-9 N") {
        dice roll;
        std::vector<double> path;
        for (int k = 0; k < 200; ++k) path.push_back(roll(-8, 8) * um);
        gms slow{flat(), Ts}, fast{flat(), Ts}, fine{flat(), Ts};
        for (const double way : path) {
            const double f = go(slow, way, 1, std::abs(way) / 1e-6);
            CHECK(std::abs(go(fast, way, 1, std::abs(way) / 1.0) - f) < 1e-9);
            CHECK(std::abs(go(fine, way, 1000, 1e-6) - f) < 1e-7);
        }
    }
    SUBCASE("a level that falls: 0.1 and 1 um/s differ by less than the fall, 23 mN") {
        gms slow{x_axis(), Ts}, fast{x_axis(), Ts};
        for (const double way : {3.0, -4.0, 2.0, -1.0, 6.0, -12.0, 20.0})
            CHECK(std::abs(go(slow, way * um, 200, std::abs(way) / 0.1 / 200) -
                           go(fast, way * um, 200, std::abs(way) / 1.0 / 200)) < 0.023);
    }
}
TEST_CASE("maxwell_slip: at a constant speed it comes to the Stribeck curve, in both directions, to 1e-9 N") {
    auto p = x_axis();
    p.curve.viscous = 950_N / 1_mps;
    stribeck<> curve{p.curve, Ts};
    gms law{p, Ts};
    for (const double v : {1e-3, -1e-3, 10e-3, 0.1, -0.1, 2.0, -2e-3, 5e-3})
        for (const double h : {1e-6, 0.5e-3, 2e-3}) {
            gms each = law;
            double f = 0;
            f = go(each, v * 3e-3, 3000, 1e-6); // breaks away
            f = go(each, v * 12, 12, 1.0);      // s/C = 0.4 s: e^-30 is left
            f = step(each, v, h);
            CHECK(std::abs(f - curve(mps(v)).value()) < 1e-9);
            law = each;
        }
}
TEST_CASE("maxwell_slip: from one speed to another the force goes over as exp(-C t/s), exactly, at any step") {
    const auto p = x_axis();
    const stribeck<> curve{p.curve, Ts};
    for (const double h : {1e-6, 50e-6, 0.5e-3, 2e-3, 0.1}) {
        gms law{p, Ts};
        law.settle(1_mmps);
        const double before = curve.slip(1_mmps).value(), level = curve.slip(10_mmps).value();
        double t = 0;
        for (int k = 0; k < 1000; ++k) {
            const double f = step(law, 10e-3, h);
            t += h;
            CHECK(std::abs(f - level - (before - level) * std::exp(-450 * t / level)) < 1e-9);
        }
    }
}
TEST_CASE(
    "maxwell_slip: what sticks with more than the level of a sudden speed lets go at the rate C, not at once") {
    one law{{{122_N, 177_N, 1_mps / 450.0, {}}, {1.0}, {}, {per_um(60)}, 450_N / 1_s}, Ts};
    const double stuck = go(law, 2.9 * um, 100, 0.1); // 174 N at 0.29 um/s
    CHECK(stuck == doctest::Approx(174).epsilon(1e-9));
    CHECK_FALSE(law.now().elements[0].slips);
    for (int k = 1; k <= 100; ++k)
        CHECK(std::abs(step(law, 0.1, 1e-3) - 122 - 52 * std::exp(-450 * k * 1e-3 / 122)) < 1e-6);
}
TEST_CASE(
    "maxwell_slip: while the speed changes it follows a fine Runge-Kutta solution, the error halving with h") {
    one law{{{122_N, 177_N, 1_mps / 450.0, {}}, {1.0}, {}, {per_um(60)}, 2000_N / 1_s}, Ts};
    const double C = 2000, end = 0.5;
    const auto speed = [](double t) { return 4e-3 + 3e-3 * std::sin(20 * t); };
    const auto rate = [&](double t, double f) { return C * (1 - f / (122 + 55 * std::exp(-450 * speed(t)))); };
    law.settle(mps(speed(0)));
    double exact = law.now().elements[0].force.value();
    for (int k = 0; k < 20000; ++k) {
        const double h = end / 20000, t = k * h, a = rate(t, exact), b = rate(t + h / 2, exact + h / 2 * a),
                     c = rate(t + h / 2, exact + h / 2 * b), d = rate(t + h, exact + h * c);
        exact += h / 6 * (a + 2 * b + 2 * c + d);
    }
    const auto error = [&](int steps) {
        one trial = law;
        double f = 0;
        for (int k = 0; k < steps; ++k) f = step(trial, speed((k + 1) * end / steps), end / steps);
        return std::abs(f - exact);
    };
    CHECK(error(1000) < 0.05);
    CHECK(error(1000) / error(2000) == doctest::Approx(2).epsilon(0.02));
}
TEST_CASE(
    "maxwell_slip: one element of one level is a spring in series with a Coulomb slider: the closed form") {
    dice roll;
    one law{{{100_N, 100_N, 1_mmps, {}}, {1.0}, {}, {per_um(10)}, 450_N / 1_s}, Ts};
    dahl<> spring{{.coulomb = 100_N, .stiffness = per_um(10), .shape = 0}, Ts};
    double f = 0;
    for (int k = 0; k < 10000; ++k) {
        const double way = roll(-15, 15) * um, h = roll.decades(1e-6, 2e-3);
        f = std::clamp(f + 10e6 * way, -100.0, 100.0);
        CHECK(std::abs(step(law, way / h, h) - f) < 1e-9);
        CHECK(std::abs(step(spring, way / h, h) - f) < 1e-9); // and Dahl's with exponent zero
    }
}
TEST_CASE("maxwell_slip: N equal elements are one; their order does not matter") {
    auto p = flat();
    gms law{p, Ts};
    std::reverse(p.forces.begin(), p.forces.end());
    std::reverse(p.stiffness.begin(), p.stiffness.end());
    gms turned{p, Ts};
    one single{{p.curve, {1.0}, {}, {per_um(40)}, 450_N / 1_s}, Ts};
    maxwell_slip<3> triple{{p.curve, {0.5, 0.25, 0.25}, {}, {per_um(20), per_um(10), per_um(10)}, 450_N / 1_s},
                           Ts};
    dice roll;
    for (int k = 0; k < 1000; ++k) {
        const double way = roll(-8, 8) * um;
        CHECK(std::abs(go(law, way, 3) - go(turned, way, 3)) < 1e-9);
        CHECK(std::abs(go(single, way, 3) - go(triple, way, 3)) < 1e-9);
    }
}
TEST_CASE("maxwell_slip: forces are weights times their sum, bit for bit") {
    auto p = flat();
    p.weights = {0.5, 0.25, 0.125, 0.125};
    p.forces = {};
    auto q = p;
    q.weights = {};
    q.forces = {64_N, 32_N, 16_N, 16_N};
    gms by_weight{p, Ts}, by_force{q, Ts};
    CHECK(by_weight.weights() == by_force.weights());
    dice roll;
    for (int k = 0; k < 100; ++k) {
        const double way = roll(-8, 8) * um;
        CHECK(go(by_weight, way, 3) == go(by_force, way, 3));
    }
    CHECK(by_weight.weights()[0] == 0.5);
}
TEST_CASE("maxwell_slip: breaks away at the static level, not at the printed sum of forces: 177 N, to 0.5 %") {
    // 340 kg pulled by a force that grows by 2 N/s; it has run away when it has gone 100 um.
    const auto mass = 340_kg;
    gms law{x_axis(), Ts};
    double v = 0, x = 0, pull = 0;
    const double h = 50e-6;
    while (x < 100 * um && pull < 300) {
        pull += 2 * h;
        const auto to = presliding<double>(law, mass, mps(v), newtons(pull), seconds(h));
        law.become(to.friction);
        v = to.v.value(), x += v * h;
    }
    CHECK(pull == doctest::Approx(177).epsilon(5e-3));
}
TEST_CASE("maxwell_slip: at rest it holds its force, for ever and by the bit") {
    gms law{x_axis(), Ts};
    go(law, 5 * um), go(law, -2 * um);
    const double f = dry(law);
    for (int k = 0; k < 1000; ++k) CHECK(step(law, 0, 2e-3) == f);
    CHECK(step(law, -0.0, 2e-3) == f);
}
TEST_CASE("maxwell_slip: after a stop it sticks: the first micrometre onwards is elastic") {
    gms law{flat(), Ts};
    go(law, 100 * um);
    CHECK(law.now().elements[0].slips);
    step(law, 0, 1e-3);
    CHECK_FALSE(law.now().elements[0].slips);
    CHECK(go(law, -0.5 * um) == doctest::Approx(177 - 0.5 * 76.467).epsilon(1e-9));
}
TEST_CASE(
    "maxwell_slip: bounded by the static level at steps of 1 us to 2 ms and speeds up to 2 m/s, any motion") {
    dice roll;
    for (const double attraction : {0.001, 450.0, 1e4, 1e9})
        for (const double h : {1e-6, 10e-6, 0.125e-3, 0.5e-3, 2e-3}) {
            auto p = x_axis();
            p.attraction = attraction * 1_N / 1_s;
            gms law{p, Ts};
            for (int k = 0; k < 2000; ++k) {
                const double v = (roll.often() ? 1 : -1) * roll.decades(1e-7, 2);
                CHECK(std::abs(step(law, v, h)) <= 177 * (1 + 1e-12));
            }
        }
}
TEST_CASE("maxwell_slip: a step never gives more energy than the springs had stored") {
    // One level: F v h >= change of sum F_i^2/(2 k_i), each step, any motion.
    dice roll;
    gms law{flat(), Ts};
    for (int k = 0; k < 20000; ++k) {
        const double h = roll.decades(1e-6, 2e-3), way = roll(-1, 1) * roll.decades(1e-9, 1e-4);
        const double before = stored(law);
        const double work = step(law, way / h, h) * way;
        CHECK(work >= stored(law) - before - 1e-15);
    }
}
TEST_CASE("maxwell_slip: energy dissipated per cycle is never negative, at any amplitude, speed and step") {
    dice roll;
    for (int n = 0; n < 300; ++n) {
        gms law{x_axis(), Ts};
        const double amplitude = roll.decades(0.01, 5e4) * um, h = roll.decades(1e-6, 2e-3);
        const int steps = static_cast<int>(roll(40, 400));
        double work = 0, scale = 0;
        for (int cycle = 0; cycle < 4; ++cycle) {
            work = 0;
            double x = amplitude;
            if (cycle == 0) go(law, amplitude, 1, h);
            for (int k = 1; k <= steps; ++k) {
                const double to = amplitude * std::cos(2 * 3.14159265358979 * k / steps), way = to - x;
                const double f = step(law, way / h, h);
                work += f * way;
                scale += std::abs(f * way);
                x = to;
            }
            if (cycle > 0) CHECK(work >= -1e-12 * scale);
            if (amplitude > 50 * um && cycle > 0) CHECK(work > 122 * 4 * amplitude * 0.8);
        }
    }
}
TEST_CASE("maxwell_slip: as a block it is the law with its period, and odd, bit for bit") {
    gms block{x_axis(), Ts}, mirror{x_axis(), Ts}, law{x_axis(), Ts};
    static_assert(maps<gms, signal::velocity, signal::force>);
    static_assert(friction_with_memory<gms, double>);
    static_assert(!friction_with_memory<stribeck<>, double>);
    static_assert(!friction_with_memory<maxwell_slip<4, signal::velocity, signal::voltage>,
                                        double>); // volts hold no axis
    dice roll;
    for (int k = 0; k < 1000; ++k) {
        const double v = roll(-1, 1) * roll.decades(1e-5, 0.1);
        const auto f = block(mps(v));
        CHECK(f.value() == step(law, v, 500e-6));
        CHECK(mirror(mps(-v)) == -f);
    }
}
TEST_CASE("maxwell_slip: settle is sliding at that speed, or relaxed at rest") {
    auto p = x_axis();
    p.curve.viscous = 950_N / 1_mps;
    gms law{p, Ts};
    stribeck<> curve{p.curve, Ts};
    for (const double v : {1e-3, -20e-3, 2.0}) {
        law.settle(mps(v));
        for (int k = 0; k < 100; ++k)
            CHECK(law(mps(v)).value() == doctest::Approx(curve(mps(v)).value()).epsilon(1e-12));
    }
    law.settle(0_mps);
    CHECK(dry(law) == 0);
    CHECK(law(0_mps) == 0_N);
}
TEST_CASE(
    "maxwell_slip: a bad velocity gives the last force, moves nothing and is told until reset or settle") {
    check_bad_velocities(gms{x_axis(), Ts});
}
TEST_CASE("maxwell_slip: in float it follows double to 1e-4 of the level over a path of reversals") {
    maxwell_slip<4, signal::velocity, signal::force, float> rough{{.curve = {122_N, 177_N, 1_mps / 450.0, {}},
                                                                   .weights = {},
                                                                   .forces = x_axis().forces,
                                                                   .stiffness = x_axis().stiffness,
                                                                   .attraction = 450_N / 1_s},
                                                                  Ts};
    gms exact{x_axis(), Ts};
    dice roll;
    for (int k = 0; k < 2000; ++k) {
        const auto v = static_cast<float>(roll(-1, 1) * roll.decades(1e-5, 0.1));
        const double f =
            static_cast<double>(rough(quantity_of<signal::velocity, float>::from_value(v)).value());
        CHECK(std::abs(f - exact(mps(static_cast<double>(v))).value()) < 1e-4 * 177);
    }
}
TEST_CASE("maxwell_slip: with duals the derivatives by all parameters are those of difference quotients") {
    using D = dual<7>;
    const auto end = []<class Real>(const std::array<Real, 7>& with) {
        using law = maxwell_slip<2, signal::velocity, signal::force, Real>;
        typename law::parameters p;
        p.curve.coulomb = decltype(p.curve.coulomb)::from_value(with[0]);
        p.curve.static_level = decltype(p.curve.static_level)::from_value(with[1]);
        p.curve.stribeck_velocity = decltype(p.curve.stribeck_velocity)::from_value(with[2]);
        p.forces = {quantity_of<signal::force, Real>::from_value(Real(60)),
                    quantity_of<signal::force, Real>::from_value(Real(30))};
        p.stiffness[0] = decltype(p.attraction * 1.0_s / 1.0_m)::from_value(with[3]);
        p.stiffness[1] = decltype(p.attraction * 1.0_s / 1.0_m)::from_value(with[4]);
        p.attraction = decltype(p.attraction)::from_value(with[5]);
        law friction{p, Ts};
        Real sum(0);
        for (int k = 0; k < 40; ++k)
            sum += friction(quantity_of<signal::velocity, Real>::from_value(with[6] * Real(std::sin(0.37 * k))))
                       .value();
        return sum;
    };
    const std::array<double, 7> given{122, 177, 2.2e-3, 2e7, 3e6, 450, 4e-3};
    std::array<D, 7> variables;
    for (std::size_t i = 0; i < 7; ++i) variables[i] = D::variable(given[i], i);
    const D y = end(variables);
    CHECK(y.value == doctest::Approx(end(given)).epsilon(1e-12));
    for (std::size_t i = 0; i < 7; ++i) {
        CAPTURE(i);
        auto up = given, down = given;
        up[i] *= 1 + 1e-6, down[i] *= 1 - 1e-6;
        CHECK(alike(y.partial[i] * given[i], (end(up) - end(down)) / 2e-6, 1e-5));
        CHECK(y.partial[i] != 0);
    }
}
TEST_CASE("maxwell_slip: refuses what no contact has, in the name of the box that minds") {
    using P = gms::parameters;
    const auto says = [](auto change, duration period = Ts) { return refusal<gms>(x_axis(), change, period); };
    CHECK(says([](P&) {}) == "taken");
    CHECK(says([](P& p) { p.stiffness[2] = per_um(-1); }) ==
          "maxwell_slip.stiffness = -1e+06 N/m: must be finite and above 0");
    CHECK(says([](P& p) { p.stiffness[3] = per_um(0); }) ==
          "maxwell_slip.stiffness = 0 N/m: must be finite and above 0");
    CHECK(says([](P& p) { p.curve.static_level = 121_N; }) ==
          "stribeck.static_level = 121 N: must not be below coulomb (122 N)");
    CHECK(says([](P& p) { p.curve.coulomb = 0_N; }) ==
          "maxwell_slip.curve.coulomb = 0 N: must be finite and above 0");
    CHECK(says([](P& p) { p.attraction = 0_N / 1_s; }) ==
          "maxwell_slip.attraction = 0 N/s: must be finite and above 0");
    CHECK(says([](P& p) { p.forces[1] = 0_N; }) == "maxwell_slip.forces = 0 N: must be finite and above 0");
    CHECK(says([](P& p) { p.forces[1] = -55_N; }) == "maxwell_slip.forces = -55 N: must be finite and above 0");
    CHECK(says([](P& p) { p.forces[0] = 90_N; }) ==
          "maxwell_slip.forces (sum) = 177.5 N: must not be above static_level (177 N)");
    CHECK(says([](P& p) { p.forces = {}; }) ==
          "maxwell_slip.weights (sum) = 0: must be 1, or forces must be given in their place");
    CHECK(says([](P& p) { p.forces = {}, p.weights = {0.4, 0.3, 0.2, 0.1}; }) == "taken");
    CHECK(says([](P& p) {
              p.forces = {}, p.weights = {0.4, 0.3, 0.2, 0.2};
          }).substr(0, 30) == "maxwell_slip.weights (sum) = 1");
    CHECK(says([](P& p) {
              p.forces = {}, p.weights = {0.5, 0.25, 0.25, 0.25};
          }) == "maxwell_slip.weights (sum) = 1.25: must be 1; shares given as forces go into forces");
    CHECK(says([](P& p) {
              p.forces = {}, p.weights = {65, 55, 26, 6.5};
          }) == // the table, in the wrong place
          "maxwell_slip.weights (sum) = 152.5: must be 1; shares given as forces go into forces");
    CHECK(says([](P& p) {
              p.forces = {}, p.weights = {1.5, -0.5, 0.5, -0.5};
          }) == "maxwell_slip.weights = -0.5: must be finite and above 0");
    CHECK(says([](P& p) {
              p.forces = {}, p.weights = {1, -1, 1, -1};
          }) == "maxwell_slip.weights = -1: must be finite and above 0");
    CHECK(says([](P& p) {
              p.weights = {0.4, 0.3, 0.2, 0.1};
          }) == "maxwell_slip.forces = 65 N: must be zero where weights are given");
    CHECK(says([](P& p) {
              p.forces = {}, p.weights = {0.4, 0.6, 0, 0};
          }) == "maxwell_slip.weights = 0: must be finite and above 0");
    CHECK(says([](P& p) {
              p.weights = {bad_number, 0, 0, 0};
          }) == "maxwell_slip.weights = nan: must be finite and above 0");
    CHECK(says([](P&) {}, 0_s) == "stribeck.period = 0 s: must be finite and above 0");
}
