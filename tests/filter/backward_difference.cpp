// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/backward_difference.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace quadrant;
using namespace quadrant::literals;
using speed = backward_difference<signal::position, signal::velocity>;

TEST_CASE("backward_difference: one count of 0.25 um at 2 kHz reads 0.5 mm/s, once") {
    speed v{{}, 500_us};
    CHECK(v(250_nm).value() == doctest::Approx(0.5e-3).epsilon(1e-12));
    CHECK(v(250_nm).value() == 0);
}
TEST_CASE("backward_difference: a parabola reads its slope half a period late, exactly") {
    speed v{{}, 500_us};
    const auto x = [](double t) { return 1.5 * t * t * 1_m; };
    v.settle(x(0));
    for (int k = 1; k < 100; ++k)
        CHECK(v(x(k * 500e-6)).value() == doctest::Approx(3.0 * (k - 0.5) * 500e-6).epsilon(1e-9));
}
TEST_CASE("backward_difference: after reset a first sample reads as a jump from 0, after settle it does not") {
    speed v{{}, 500_us};
    CHECK(v(1_mm) == 2_mps);
    v.reset();
    v.settle(1_mm);
    CHECK(v(1_mm).value() == 0);
}
TEST_CASE("backward_difference: of a difference is an acceleration, as docs/formats.md takes a_ref") {
    speed v{{}, 500_us};
    backward_difference<signal::velocity, signal::acceleration> a{{}, 500_us};
    double r1 = 0, v1 = 0;
    for (int k = 1; k < 50; ++k) {
        const double r = 1e-3 * std::sin(0.2 * k), v_ref = (r - r1) / 500e-6, a_ref = (v_ref - v1) / 500e-6;
        CHECK(a(v(r * 1_m)).value() == doctest::Approx(a_ref).epsilon(1e-12).scale(100));
        r1 = r, v1 = v_ref;
    }
}
TEST_CASE("backward_difference: moving on at the settled rate keeps it") {
    speed v{{}, 500_us};
    v.settle(10_mm, 20_mmps);
    for (int k = 1; k < 10; ++k)
        CHECK(v(10_mm + k * 0.5 * 20_um).value() == doctest::Approx(20e-3).epsilon(1e-10));
}
