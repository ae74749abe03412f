// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/memory/delay_line.hpp>
#include <quadrant/memory/fractional_delay.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
using line = fractional_delay<signal::force, 5, 1>;
using cubic = fractional_delay<signal::force, 5, 3>;

namespace {
/// y(t) = t^power through a delay, from sample 20 on, against (t - delay)^power, t in periods.
template <class Delay> void polynomial(double delay_periods, int power, double tolerance) {
    CAPTURE(delay_periods);
    CAPTURE(power);
    Delay d{{.delay = delay_periods * 500_us}, 500_us};
    for (int k = 0; k < 40; ++k) {
        const double y = d(std::pow(k, power) * 1_N).value(), expected = std::pow(k - delay_periods, power);
        if (k >= 20) CHECK(y == doctest::Approx(expected).epsilon(tolerance));
    }
}
} // namespace

TEST_CASE("fractional_delay: 0.4 ms at 0.5 ms a sample is 0.8 of a period on a ramp") {
    line d{{.delay = 400_us}, 500_us};
    d(0_N);
    CHECK(d(1_N).value() == doctest::Approx(0.2).epsilon(1e-12));
    CHECK(d(2_N).value() == doctest::Approx(1.2).epsilon(1e-12));
}
TEST_CASE("fractional_delay: exact for polynomials up to its order, anywhere in its range") {
    for (const double delay : {0.0, 0.3, 1.0, 2.5, 4.999, 5.0})
        for (int power = 0; power <= 1; ++power) polynomial<line>(delay, power, 1e-12);
    for (const double delay : {1.0, 1.3, 2.5, 4.999, 5.0})
        for (int power = 0; power <= 3; ++power) polynomial<cubic>(delay, power, 1e-11);
}
TEST_CASE("fractional_delay: at whole periods it is a delay_line") {
    for (std::size_t n = 1; n <= 5; ++n) {
        line a{{.delay = double(n) * 1_ms}, 1_ms};
        cubic b{{.delay = double(n) * 1_ms}, 1_ms};
        delay_line<signal::force, 5> reference{{.length = n}, 1_ms};
        for (int k = 0; k < 50; ++k) {
            const auto x = std::sin(0.1 * k * k) * 100_N, y = reference(x);
            CHECK(std::abs((a(x) - y).value()) < 1e-12);
            CHECK(std::abs((b(x) - y).value()) < 1e-12);
        }
    }
}
TEST_CASE("fractional_delay: the weights of 1.7 periods are scipy's") {
    // [float(scipy.interpolate.lagrange([0,1,2,3], np.eye(4)[i])(1.7)) for i in range(4)]
    cubic d{{.delay = 1.7_ms}, 1_ms};
    CHECK(d(1_N).value() == doctest::Approx(-0.0455).epsilon(1e-12));
    CHECK(d(0_N).value() == doctest::Approx(0.3315).epsilon(1e-12));
    CHECK(d(0_N).value() == doctest::Approx(0.7735).epsilon(1e-12));
    CHECK(d(0_N).value() == doctest::Approx(-0.0595).epsilon(1e-12));
    CHECK(d(0_N).value() == 0);
}
TEST_CASE("fractional_delay: gain at an eighth of the sampling rate 0.924 and 0.992, never above one") {
    CHECK(std::abs(line{{.delay = 1.5_ms}, 1_ms}.response(125_Hz)) ==
          doctest::Approx(0.9238795325112867).epsilon(1e-12));
    CHECK(std::abs(cubic{{.delay = 1.5_ms}, 1_ms}.response(125_Hz)) ==
          doctest::Approx(0.9915290450295614).epsilon(1e-12));
    for (double periods = 1; periods <= 3; periods += 0.05)
        for (double hz = 0; hz <= 500; hz += 5) {
            CHECK(std::abs(line{{.delay = periods * 1_ms}, 1_ms}.response(hz * 1_Hz)) <= 1 + 1e-12);
            CHECK(std::abs(cubic{{.delay = periods * 1_ms}, 1_ms}.response(hz * 1_Hz)) <= 1 + 1e-12);
        }
}
TEST_CASE("fractional_delay: a delay that changes on the way reads what was put in") {
    line d{{.delay = 0_ms}, 1_ms};
    for (int k = 0; k < 500; ++k) {
        const double periods = 2.5 + 2.5 * std::sin(0.7 * k);
        d.delay(periods * 1_ms);
        const double y = d(double(k) * 1_N).value();
        if (k >= 6) CHECK(y == doctest::Approx(k - periods).epsilon(1e-12));
    }
}
TEST_CASE("fractional_delay: a delay outside its range saturates, and it says so") {
    cubic d{{.delay = 2_ms}, 1_ms};
    d.settle(0_N);
    d.delay(0.5_ms); // the cubic needs a younger sample than it has
    CHECK(d.limited());
    CHECK(d(8_N).value() == 0);
    CHECK(d(0_N).value() == doctest::Approx(8));
    d.delay(9_ms);
    CHECK(d.limited());
    d.delay(5_ms);
    CHECK_FALSE(d.limited());
    d.delay(quantity<si::time>::from_value(std::numeric_limits<double>::quiet_NaN()));
    CHECK(d.faulted());
    CHECK_FALSE(d.limited()); // and nothing changed
    d.delay(9_ms);
    d.reset();
    CHECK_FALSE(d.limited());
    CHECK_FALSE(d.faulted());
}
TEST_CASE("fractional_delay: refuses a delay outside its range") {
    CHECK_THROWS_WITH_AS((line{{.delay = 6_ms}, 1_ms}),
                         "fractional_delay.delay = 0.006 s: must lie between 0 s and 0.005 s (capacity)",
                         invalid_parameter);
    CHECK_THROWS_WITH_AS((cubic{{.delay = 0.5_ms}, 1_ms}),
                         "fractional_delay.delay = 5e-04 s: must lie between 0.001 s and 0.005 s (capacity)",
                         invalid_parameter);
    CHECK_THROWS_AS((line{{.delay = std::numeric_limits<double>::quiet_NaN() * 1_ms}, 1_ms}),
                    invalid_parameter);
    CHECK_THROWS_AS((line{{.delay = 1_ms}, 0_ms}), invalid_parameter);
}
