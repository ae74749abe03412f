// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/friction/stick_slip.hpp>
#include <quadrant/friction/stribeck.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
/// [Jamaludin2008] section 3: 1/Vs = 0.00045 s/um and sigma = 0.00095 N s/um (x), 0.001 and 0.00004 (y).
const stribeck<>::parameters x_axis{
    .coulomb = 122_N, .static_level = 177_N, .stribeck_velocity = 1_mps / 450.0, .viscous = 950_N / 1_mps};
const stribeck<>::parameters y_axis{
    .coulomb = 105_N, .static_level = 165_N, .stribeck_velocity = 1_mmps, .viscous = 40_N / 1_mps};
constexpr double bad_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
quantity<si::velocity> mps(double v) { return quantity<si::velocity>::from_value(v); }
stribeck<>::parameters with_shape(double shape) {
    auto p = x_axis;
    p.shape = shape;
    return p;
}
bool within_mN(quantity<si::force> f, double newtons) { return std::abs(f.value() - newtons) < 1e-3; }
} // namespace

TEST_CASE("stribeck: the thesis' x axis by hand, to 1 mN: 158.020 N at 1 mm/s, 132.111 N at 10, 217 N at 100") {
    stribeck<> friction{x_axis, Ts};
    CHECK(within_mN(friction(1_mmps), 158.020));         // 122 + 55 * 0.637628 + 0.95
    CHECK(within_mN(friction(mps(1.0 / 450)), 144.344)); // 122 + 55 / e + 2.1111
    CHECK(within_mN(friction(10_mmps), 132.111));        // 122 + 55 * 0.011109 + 9.5
    CHECK(within_mN(friction(100_mmps), 217.000));       // 122 + 95
    CHECK(within_mN(friction(-10_mmps), -132.111));
}
TEST_CASE("stribeck: the thesis' y axis by hand, to 1 mN: 127.113 N at 1 mm/s") {
    stribeck<> friction{y_axis, Ts};
    CHECK(within_mN(friction(1_mmps), 127.113)); // 105 + 60 / e + 0.04
}
TEST_CASE("stribeck: at rest it is zero, at the slowest speed there is it is the static level") {
    for (const double shape : {1.0, 0.25, 2.0, 4.0}) {
        stribeck<> friction{with_shape(shape), Ts};
        CHECK(friction(0_mps) == 0_N);
        CHECK(friction(mps(-0.0)) == 0_N);
        CHECK(friction(mps(1e-300)).value() == doctest::Approx(177).epsilon(1e-12));
        CHECK(friction(mps(-1e-300)).value() == doctest::Approx(-177).epsilon(1e-12));
        CHECK(friction.slip(0_mps) == 177_N);
        CHECK(friction.breakaway() == 177_N);
    }
}
TEST_CASE("stribeck: on the x axis friction falls up to 7.245 mm/s and rises from there") {
    // dF/dv = 0 where exp(-v/vs) = viscous vs / (Fs - Fc): v = vs ln(55 * 450 / 950)
    stribeck<> friction{x_axis, Ts};
    const double slowest = 7.245e-3;
    for (double v = 0.1e-3; v < slowest - 0.1e-3; v += 0.1e-3)
        CHECK(friction(mps(v)) > friction(mps(v + 0.1e-3)));
    for (double v = slowest; v < 30e-3; v += 0.1e-3) CHECK(friction(mps(v)) < friction(mps(v + 0.1e-3)));
}
TEST_CASE("stribeck: shape 2 by hand, to 1 mN: half the Stribeck velocity 164.834 N, twice 123.007 N, dry") {
    const stribeck<> friction{with_shape(2), Ts};
    const double vs = 1.0 / 450;
    CHECK(within_mN(friction.slip(mps(vs / 2)), 164.834)); // 122 + 55 exp(-1/4)
    CHECK(within_mN(friction.slip(mps(vs * 2)), 123.007)); // 122 + 55 exp(-4)
    // Every shape passes through the same point at the Stribeck velocity itself.
    for (const double shape : {0.25, 0.5, 1.0, 2.0, 4.0})
        CHECK(within_mN(stribeck<>{with_shape(shape), Ts}.slip(mps(vs)), 142.233));
}
TEST_CASE("stribeck: shape 1 is the limit of the others, to 1 uN") {
    const stribeck<> one{with_shape(1), Ts}, nearly{with_shape(1 + 1e-9), Ts};
    for (double v = 1e-5; v < 1; v *= 1.3)
        CHECK(std::abs((one.slip(mps(v)) - nearly.slip(mps(v))).value()) < 1e-6);
}
TEST_CASE("stribeck: what a plant asks is even, never above breakaway, never rises with speed") {
    for (const double shape : {0.25, 1.0, 2.0, 4.0}) {
        const stribeck<> friction{with_shape(shape), Ts};
        auto before = friction.breakaway();
        for (double v = 1e-9; v < 10; v *= 1.1) {
            const auto dry = friction.slip(mps(v));
            CHECK(dry <= before);
            CHECK(dry >= 122_N);
            CHECK(dry == friction.slip(mps(-v)));
            before = dry;
        }
        if (shape >= 1) CHECK(before == 122_N);
    }
    static_assert(friction_law<stribeck<>, double>);
}
TEST_CASE("stribeck: without an excess it is coulomb_viscous bit for bit") {
    auto p = x_axis;
    p.static_level = p.coulomb;
    stribeck<> friction{p, Ts};
    coulomb_viscous<> level{{.coulomb = 122_N, .viscous = 950_N / 1_mps}, Ts};
    for (int k = -500; k < 500; ++k) CHECK(friction(mps(3e-4 * k)) == level(mps(3e-4 * k)));
    CHECK(friction.breakaway() == level.breakaway());
}
TEST_CASE("stribeck: a bad velocity gives the last force and is told until reset or settle") {
    for (const double bad : {bad_number, infinite, -infinite}) {
        stribeck<> friction{x_axis, Ts};
        friction(100_mmps);
        const auto copy = friction;
        CHECK(friction(mps(bad)).value() == doctest::Approx(217));
        CHECK(friction.faulted());
        CHECK_FALSE(copy.faulted());
        friction.settle(-100_mmps);
        CHECK_FALSE(friction.faulted());
        CHECK(friction(mps(bad)).value() == doctest::Approx(-217)); // what settle left
        friction.reset();
        CHECK_FALSE(friction.faulted());
        CHECK(friction(mps(bad)) == 0_N);
        friction.reset();
        friction.settle(mps(bad));
        CHECK(friction.faulted());
    }
}
TEST_CASE("stribeck: derivatives by its four parameters and the velocity are those of the formula") {
    using D = dual<5>;
    using law = stribeck<signal::velocity, signal::force, D>;
    for (const double shape : {1.0, 2.0})
        for (const double v : {-3e-3, 3e-3}) {
            law::parameters p;
            p.coulomb = decltype(p.coulomb)::from_value(D::variable(122, 0));
            p.static_level = decltype(p.static_level)::from_value(D::variable(177, 1));
            p.stribeck_velocity = decltype(p.stribeck_velocity)::from_value(D::variable(2e-3, 2));
            p.viscous = decltype(p.viscous)::from_value(D::variable(950, 3));
            p.shape = shape;
            law friction{p, Ts};
            const D f = friction(quantity_of<signal::velocity, D>::from_value(D::variable(v, 4))).value();
            const double sign = v > 0 ? 1 : -1, e = std::exp(-std::pow(1.5, shape));
            const double slope = 55 * e * shape * std::pow(1.5, shape - 1) / 2e-3; // of the fall, per m/s
            CHECK(f.value == doctest::Approx(sign * (122 + 55 * e) + 950 * v).epsilon(1e-13));
            CHECK(f.partial[0] == doctest::Approx(sign * (1 - e)).epsilon(1e-13));
            CHECK(f.partial[1] == doctest::Approx(sign * e).epsilon(1e-13));
            CHECK(f.partial[2] == doctest::Approx(sign * slope * 1.5).epsilon(1e-13));
            CHECK(f.partial[3] == doctest::Approx(v).epsilon(1e-13));
            CHECK(f.partial[4] == doctest::Approx(950 - slope).epsilon(1e-13));
        }
}
TEST_CASE("stribeck: in float it is the double law to a part in a million") {
    stribeck<signal::velocity, signal::force, float> rough{{122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps}, Ts};
    stribeck<> exact{x_axis, Ts};
    for (float v = 1e-5f; v < 1; v *= 1.3f)
        CHECK(double(rough(quantity_of<signal::velocity, float>::from_value(v)).value()) ==
              doctest::Approx(exact(mps(double(v))).value()).epsilon(1e-6));
}
TEST_CASE("stribeck: refuses what no axis has") {
    const auto message = [](auto change) {
        auto p = x_axis;
        change(p);
        try {
            stribeck<>{p, Ts};
        } catch (const invalid_parameter& e) {
            return std::string(e.what());
        }
        return std::string("taken");
    };
    using P = stribeck<>::parameters;
    CHECK(message([](P& p) { p.coulomb = -1_N; }) == "stribeck.coulomb = -1 N: must be finite and not below 0");
    CHECK(message([](P& p) { p.static_level = 121_N; }) ==
          "stribeck.static_level = 121 N: must not be below coulomb (122 N)");
    CHECK(message([](P& p) { p.static_level = infinite * 1_N; }) ==
          "stribeck.static_level = inf N: must be finite");
    CHECK(message([](P& p) { p.stribeck_velocity = 0_mps; }) ==
          "stribeck.stribeck_velocity = 0 m/s: must be finite and above 0");
    CHECK(message([](P& p) { p.viscous = -2_N / 1_mps; }) ==
          "stribeck.viscous = -2 N s/m: must be finite and not below 0");
    CHECK(message([](P& p) { p.shape = 0.2; }) == "stribeck.shape = 0.2: must lie between 0.25 and 4");
    CHECK(message([](P& p) { p.shape = 4.5; }) == "stribeck.shape = 4.5: must lie between 0.25 and 4");
    CHECK(message([](P& p) { p.shape = bad_number; }) == "stribeck.shape = nan: must lie between 0.25 and 4");
    CHECK(message([](P& p) { p.static_level = p.coulomb; }) == "taken");
    CHECK_THROWS_WITH_AS((stribeck<>{x_axis, -1_s}), "stribeck.period = -1 s: must be finite and above 0",
                         invalid_parameter);
}
