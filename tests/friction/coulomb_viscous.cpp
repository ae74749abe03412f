// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/coulomb_viscous.hpp>
#include <quadrant/friction/stick_slip.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
const auto Ts = 500_us;
const coulomb_viscous<>::parameters x_axis{.coulomb = 122_N, .viscous = 850_N / 1_mps};
constexpr double bad_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();
quantity<si::velocity> mps(double v) { return quantity<si::velocity>::from_value(v); }
} // namespace

TEST_CASE("coulomb_viscous: 122 N and 850 N s/m give 207 N at 100 mm/s, by hand") {
    coulomb_viscous<> friction{x_axis, Ts};
    CHECK(friction(100_mmps).value() == doctest::Approx(207).epsilon(1e-14));
    CHECK(friction(-100_mmps).value() == doctest::Approx(-207).epsilon(1e-14));
    CHECK(friction(1_mmps).value() == doctest::Approx(122.85).epsilon(1e-14));
}
TEST_CASE("coulomb_viscous: at rest it is zero, at the slowest speed there is it is the whole level") {
    coulomb_viscous<> friction{x_axis, Ts};
    CHECK(friction(0_mps) == 0_N);
    CHECK(friction(mps(-0.0)) == 0_N);
    CHECK(friction(mps(std::numeric_limits<double>::denorm_min())) == 122_N);
    CHECK(friction(mps(-std::numeric_limits<double>::denorm_min())) == -122_N);
}
TEST_CASE("coulomb_viscous: odd in the velocity, bit for bit") {
    coulomb_viscous<> friction{x_axis, Ts};
    for (int k = 1; k < 1000; ++k) CHECK(friction(mps(3e-4 * k)) == -friction(mps(-3e-4 * k)));
}
TEST_CASE("coulomb_viscous: as a feedforward in volts it is the friction over the force constant") {
    using feedforward = coulomb_viscous<signal::velocity, signal::voltage>;
    feedforward volts{{.coulomb = 122_N / (1450_N / 1_V), .viscous = 850_N / 1_mps / (1450_N / 1_V)}, Ts};
    CHECK(volts(100_mmps).value() == doctest::Approx(207.0 / 1450).epsilon(1e-14)); // 0.1428 V
}
TEST_CASE("coulomb_viscous: a plant is held and braked by the same level at any speed") {
    const coulomb_viscous<> friction{x_axis, Ts};
    CHECK(friction.breakaway() == 122_N);
    for (const double v : {-3.0, -1e-9, 0.0, 1e-9, 0.1, 3.0}) CHECK(friction.slip(mps(v)) == 122_N);
    CHECK(friction.viscous() == 850_N / 1_mps);
    static_assert(friction_law<coulomb_viscous<>, double>);
}
TEST_CASE("coulomb_viscous: without levels there is no friction") {
    coulomb_viscous<> none{{}, Ts};
    for (const double v : {-3.0, 0.0, 1e-9, 3.0}) CHECK(none(mps(v)) == 0_N);
}
TEST_CASE("coulomb_viscous: a bad velocity gives the last force and is told until reset or settle") {
    for (const double bad : {bad_number, infinite, -infinite}) {
        coulomb_viscous<> friction{x_axis, Ts};
        friction(100_mmps);
        const auto copy = friction;
        CHECK(friction(mps(bad)).value() == doctest::Approx(207));
        CHECK(friction.faulted());
        CHECK_FALSE(copy.faulted());
        CHECK(friction(-100_mmps).value() == doctest::Approx(-207));
        CHECK(friction.faulted());
        friction.settle(100_mmps);
        CHECK_FALSE(friction.faulted());
        CHECK(friction(mps(bad)).value() == doctest::Approx(207)); // what settle left
        friction.reset();
        CHECK_FALSE(friction.faulted());
        CHECK(friction(mps(bad)) == 0_N);
        friction.reset();
        friction.settle(mps(bad));
        CHECK(friction.faulted());
    }
}
TEST_CASE("coulomb_viscous: the derivative by the level is the sign, by the slope the velocity, by the "
          "velocity the slope") {
    using D = dual<3>;
    using law = coulomb_viscous<signal::velocity, signal::force, D>;
    law::parameters p;
    p.coulomb = decltype(p.coulomb)::from_value(D::variable(122, 0));
    p.viscous = decltype(p.viscous)::from_value(D::variable(850, 1));
    law friction{p, Ts};
    const auto at = [&](double v) {
        return friction(quantity_of<signal::velocity, D>::from_value(D::variable(v, 2))).value();
    };
    CHECK(at(0.1).value == doctest::Approx(207));
    CHECK(at(0.1).partial == std::array{1.0, 0.1, 850.0});
    CHECK(at(-0.1).partial == std::array{-1.0, -0.1, 850.0});
    CHECK(at(0).partial == std::array{0.0, 0.0, 850.0});
}
TEST_CASE("coulomb_viscous: in float it is the double law to a part in ten million") {
    coulomb_viscous<signal::velocity, signal::force, float> rough{{122_N, 850_N / 1_mps}, Ts};
    using mps_f = quantity_of<signal::velocity, float>;
    CHECK(rough(mps_f::from_value(0.1f)).value() == doctest::Approx(207).epsilon(1e-7));
    CHECK(rough.breakaway().value() == 122.0f);
}
TEST_CASE("coulomb_viscous: refuses what no axis has") {
    using P = coulomb_viscous<>::parameters;
    CHECK_THROWS_WITH_AS((coulomb_viscous<>{P{-1_N, {}}, Ts}),
                         "coulomb_viscous.coulomb = -1 N: must be finite and not below 0", invalid_parameter);
    CHECK_THROWS_WITH_AS((coulomb_viscous<>{P{1_N, -2_N / 1_mps}, Ts}),
                         "coulomb_viscous.viscous = -2 N s/m: must be finite and not below 0",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS((coulomb_viscous<>{P{}, 0_s}),
                         "coulomb_viscous.period = 0 s: must be finite and above 0", invalid_parameter);
    CHECK_THROWS_AS((coulomb_viscous<>{P{bad_number * 1_N, {}}, Ts}), invalid_parameter);
    CHECK_THROWS_AS((coulomb_viscous<>{P{infinite * 1_N, {}}, Ts}), invalid_parameter);
}
