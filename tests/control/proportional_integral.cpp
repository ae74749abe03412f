// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/proportional_integral.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
template <class AntiWindup>
using velocity_loop = proportional_integral<signal::velocity, signal::voltage, AntiWindup>;
using clamped = velocity_loop<integral_clamp>;
using conditional = velocity_loop<conditional_integration>;
using tracked = velocity_loop<back_calculation>;

const auto gain = 60_V / 1_mps;
const auto integral_gain = 450_V / 1_m;
constexpr double T = 500e-6;
const auto Ts = 500_us;
const auto forever = quantity<si::electric_potential>::from_value(std::numeric_limits<double>::infinity());

/// A repeatable error between -2 and 2 m/s that stays on one side long enough to reach any limit.
double error(int k) { return 2 * std::sin(0.003 * k) + 0.3 * std::sin(1.7 * k); }
quantity<si::velocity> mps(double v) { return quantity<si::velocity>::from_value(v); }
} // namespace

TEST_CASE("proportional_integral: 10 mm/s give 0.60225 V at once and 5.1 V after a second") {
    clamped pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    CHECK(pi(10_mmps).value() == doctest::Approx(0.60225).epsilon(1e-12));
    double u = 0;
    for (int k = 1; k < 2000; ++k) u = pi(10_mmps).value();
    CHECK(u == doctest::Approx(5.1).epsilon(1e-12));
}
TEST_CASE("proportional_integral, clamp: bit for bit the bare loop of docs/formats.md") {
    clamped pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    double integral = 0;
    bool same = true, reached = false;
    for (int k = 0; k < 20000; ++k) {
        const double e = error(k);
        integral = std::clamp(integral + 450 * T * e, -10.0, 10.0);
        same = same && pi(mps(e)).value() == 60 * e + integral && pi.now().integral.value() == integral;
        reached = reached || integral == 10;
        CHECK_FALSE(pi.faulted());
    }
    CHECK(same);
    CHECK(reached);
}
TEST_CASE("proportional_integral, clamp: the output is not clipped, and limited() reports the integral") {
    clamped pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    CHECK(pi(1_mps).value() > 60);
    CHECK_FALSE(pi.limited());
    for (int k = 0; k < 100; ++k) pi(1_mps);
    CHECK(pi.limited());
    CHECK(pi.now().integral == 10_V);
    pi(-1_mmps);
    CHECK_FALSE(pi.limited());
}
TEST_CASE("proportional_integral, conditional: the integral stands still beyond the limit, and only outwards") {
    conditional pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    double integral = 0;
    bool same = true, stood = false;
    for (int k = 0; k < 20000; ++k) {
        const double e = error(k), more = 450 * T * e, u = 60 * e + (integral + more);
        const bool stands = (u > 10 && more > 0) || (u < -10 && more < 0);
        if (!stands) integral += more;
        stood = stood || stands;
        same = same && pi(mps(e)).value() == 60 * e + integral && pi.limited() == stands;
    }
    CHECK(same);
    CHECK(stood);
}
TEST_CASE("proportional_integral, conditional: stands still when told that the amplifier gave less") {
    conditional pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    pi(10_mmps);
    const auto before = pi.now().integral;
    pi.applied(0.1_V); // of 0.6 V: feedforward had taken the rest
    pi(10_mmps);
    CHECK(pi.now().integral == before);
    pi.applied(0.1_V);
    pi(-10_mmps); // back out of the limit: free
    CHECK(pi.now().integral < before);
    const auto lower = pi.now().integral;
    pi(10_mmps); // not told: within limit, free
    CHECK(pi.now().integral > lower);
}
TEST_CASE("proportional_integral, back calculation: the excess decays with the tracking time") {
    tracked pi{{.gain = gain, .integral_gain = 0.0 * integral_gain, .limit = 10_V, .anti_windup = {20_ms}}, Ts};
    pi.settle(0_mps, 30_V); // 20 V beyond
    double u = 0;
    for (int k = 0; k < 41; ++k) u = pi(0_mps).value(); // 40 periods = one tracking time after the first excess
    CHECK(u == doctest::Approx(10 + 20 * std::pow(1 - T / 20e-3, 40)).epsilon(1e-12));
    CHECK(pi.limited());
}
TEST_CASE("proportional_integral, back calculation: applied() replaces the assumed clipping") {
    tracked pi{{.gain = gain, .integral_gain = 0.0 * integral_gain, .limit = 10_V, .anti_windup = {20_ms}}, Ts};
    pi.settle(0_mps, 8_V);
    pi(0_mps); // within limit: nothing assumed
    pi.applied(4_V);
    CHECK(pi(0_mps).value() == doctest::Approx(8 - 4 * T / 20e-3).epsilon(1e-14));
    CHECK(pi(0_mps).value() == doctest::Approx(8 - 4 * T / 20e-3).epsilon(1e-14)); // told once, charged once
}
TEST_CASE("proportional_integral: told of a bad applied value, it raises the fault and ignores it") {
    tracked pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V, .anti_windup = {20_ms}}, Ts};
    pi.settle(0_mps, 8_V);
    pi(0_mps);
    pi.applied(quantity<si::electric_potential>::from_value(std::nan("")));
    CHECK(pi.faulted());
    CHECK(pi(0_mps) == 8_V);
}
TEST_CASE("proportional_integral: after saturation the three rules come back in time, no rule does not") {
    // One second of 1 m/s, then -50 mm/s: how many samples until the demand is below the limit of 10 V?
    const auto samples = [](auto pi) {
        for (int k = 0; k < 2000; ++k) pi(1_mps);
        int n = 0;
        for (; n < 100000 && pi(-50_mmps) > 10_V; ++n) {
        }
        return n;
    };
    CHECK(samples(clamped{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts}) == 0);
    CHECK(samples(conditional{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts}) == 0);
    CHECK(samples(tracked{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V, .anti_windup = {20_ms}},
                          Ts}) == 0);
    CHECK(samples(clamped{{.gain = gain, .integral_gain = integral_gain, .limit = forever}, Ts}) > 30000);
}
TEST_CASE("proportional_integral: settle keeps what the limit of the integral allows") {
    clamped pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    pi.settle(10_mmps, 14_V); // 0.6 V of it are proportional
    CHECK(pi(10_mmps).value() == doctest::Approx(10.6).epsilon(1e-14));
    CHECK(pi.now().integral <= 10_V);
    pi.settle(0_mps, -14_V);
    CHECK(pi(0_mps) == -10_V);
}
TEST_CASE("proportional_integral, conditional: settles beyond its limit too") {
    conditional pi{{.gain = gain, .integral_gain = integral_gain, .limit = 10_V}, Ts};
    for (const auto& e : {10_mmps, -10_mmps}) {
        pi.settle(e, 14_V);
        CHECK(pi(e).value() == doctest::Approx(14).epsilon(1e-14));
    }
}
TEST_CASE("proportional_integral: with integral_gain 0 it is a gain that keeps its integral") {
    clamped pi{{.gain = gain, .integral_gain = 0.0 * integral_gain, .limit = 10_V}, Ts};
    pi.settle(0_mps, 2_V);
    for (int k = 0; k < 100; ++k) CHECK(pi(10_mmps).value() == doctest::Approx(2.6).epsilon(1e-15));
}
TEST_CASE("proportional_integral: derivative by limit is one while clamped, that of the gain is the error") {
    using D = dual<2>;
    using loop = proportional_integral<signal::velocity, signal::voltage, integral_clamp, D>;
    loop::parameters p{.gain = decltype(p.gain)::from_value(D::variable(60, 0)),
                       .integral_gain = decltype(p.integral_gain)::from_value(450),
                       .limit = decltype(p.limit)::from_value(D::variable(10, 1))};
    loop pi{p, Ts};
    D u;
    for (int k = 0; k < 1000; ++k) u = pi(quantity_of<signal::velocity, D>::from_value(1)).value();
    CHECK(u.value == 70);
    CHECK(u.partial[0] == 1);
    CHECK(u.partial[1] == 1);
}
TEST_CASE("proportional_integral: refuses what no loop can have") {
    using P = clamped::parameters;
    CHECK_THROWS_WITH_AS((clamped{P{-1.0 * gain, integral_gain, 10_V}, Ts}),
                         "proportional_integral.gain = -60 V s/m: must be finite and not below 0",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS((clamped{P{gain, -1.0 * integral_gain, 10_V}, Ts}),
                         "proportional_integral.integral_gain = -450 V/m: must be finite and not below 0",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS((clamped{P{gain, integral_gain, 0_V}, Ts}),
                         "proportional_integral.limit = 0 V: must be above 0 (infinite: no limit)",
                         invalid_parameter);
    CHECK_THROWS_AS((clamped{P{gain, integral_gain, std::nan("") * 1_V}, Ts}), invalid_parameter);
    CHECK_THROWS_WITH_AS(
        (tracked{{gain, integral_gain, 10_V, {100_us}}, Ts}),
        "proportional_integral.tracking_time = 1e-04 s: must be finite and not below the period (5e-04 s)",
        invalid_parameter);
    CHECK_NOTHROW(clamped{P{gain, integral_gain, forever}, Ts});
}
