// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
template <std::size_t Order> using filter = transfer_function<signal::force, signal::force, Order>;
constexpr std::array x{1.0, -2.0, 3.0, 0.5, 0.0, 0.0, 4.0, -1.0};
} // namespace

TEST_CASE("transfer_function: filters as scipy does") {
    // scipy.signal.lfilter([.2,.1,.05,-.3], [1,-.7,.3,.1], [1,-2,3,.5,0,0,4,-1])
    constexpr std::array y{0.2, -0.16, 0.278, 0.2226, 0.88842, -0.347686, 0.1178338, 0.29794746};
    filter<3> f{{{0.2, 0.1, 0.05, -0.3}, {1, -0.7, 0.3, 0.1}}, 1_ms};
    for (std::size_t k = 0; k < x.size(); ++k)
        CHECK(f(x[k] * 1_N).value() == doctest::Approx(y[k]).epsilon(1e-14).scale(1));
}
TEST_CASE("transfer_function: a common factor cancels") {
    // scipy.signal.lfilter([.4,.2], [2,-1.4], ...)
    constexpr std::array y{0.2, -0.16, 0.288, 0.6016, 0.47112, 0.329784, 1.0308488, 0.92159416};
    filter<1> f{{{0.4, 0.2}, {2, -1.4}}, 1_ms}, same{{{0.2, 0.1}, {1, -0.7}}, 1_ms};
    for (std::size_t k = 0; k < x.size(); ++k) {
        CHECK(f(x[k] * 1_N).value() == doctest::Approx(y[k]).epsilon(1e-14));
        CHECK(same(x[k] * 1_N).value() == doctest::Approx(y[k]).epsilon(1e-14));
    }
}
TEST_CASE("transfer_function: of order 0 it is a gain") {
    filter<0> f{{{3.0}, {2}}, 1_ms};
    CHECK(f(4_N) == 6_N);
    f.settle(2_N);
    CHECK(f(0_N) == 0_N);
}
TEST_CASE("transfer_function: the numerator carries the unit") {
    transfer_function<signal::voltage, signal::position, 1> motor{{{0_m / 1_V, 0.5_m / 1_V}, {1, -0.5}}, 1_ms};
    motor(2_V);
    CHECK(motor(0_V) == 1_m);
}
TEST_CASE("transfer_function: settle(x) stands at the gain of standstill") {
    filter<3> f{{{0.2, 0.1, 0.05, -0.3}, {1, -0.7, 0.3, 0.1}}, 1_ms};
    CHECK_FALSE(f.integrates());
    f.settle(7_N);
    for (int k = 0; k < 50; ++k) CHECK(f(7_N).value() == doctest::Approx(7 * 0.05 / 0.7).epsilon(1e-13));
}
TEST_CASE("transfer_function, integrating: settle(x, y) starts at y and goes on from there") {
    filter<1> sum{{{0.0, 0.5}, {1, -1}}, 1_ms};
    CHECK(sum.integrates());
    sum.settle(4_N, 10_N);
    CHECK(sum(4_N) == 10_N);
    CHECK(sum(4_N) == 12_N);
    CHECK(sum(0_N) == 14_N);
    CHECK(sum(0_N) == 14_N);
    sum.settle(1_N); // no state of rest: keeps the last output
    CHECK(sum(1_N) == 14_N);
}
TEST_CASE("transfer_function, double integrator: settled at (0, y) it rests there") {
    filter<2> twice{{{0.0, 0.5, 0.5}, {1, -2, 1}}, 1_ms};
    CHECK(twice.integrates());
    twice.settle(0_N, 10_N);
    for (int k = 0; k < 10; ++k) CHECK(twice(0_N) == 10_N);
}
TEST_CASE("transfer_function: a pole near z = 1 is no integrator while its coefficients can tell") {
    CHECK_FALSE(filter<1>({{0.0, 1e-9}, {1, -(1 - 1e-9)}}, 1_ms).integrates());
    CHECK(filter<2>({{0.0, 1.0}, {1, -(1 + 0.3), 0.3}}, 1_ms).integrates());
}
TEST_CASE("transfer_function: an unstable one grows, then holds the last finite output") {
    filter<1> f{{{1.0, 0.0}, {1, -10}}, 1_ms};
    double last = f(1_N).value();
    while (!f.faulted()) {
        const double y = f(0_N).value();
        CHECK((f.faulted() ? y == last : y > last));
        last = y;
    }
    CHECK(std::isfinite(last));
    CHECK(last > 1e300);
}
TEST_CASE("transfer_function: a sample that overflows a state alone is refused as a whole") {
    filter<1> f{{{1.0, 4.0}, {1, 0}}, 1_ms};
    f(1_N);
    CHECK(f(0.5 * std::numeric_limits<double>::max() * 1_N) == 1_N);
    CHECK(f.faulted());
    CHECK(f(1_N) == 5_N);
}
TEST_CASE("transfer_function: refuses a leading denominator of 0, and no numbers") {
    CHECK_THROWS_WITH_AS((filter<1>{{{1.0, 0.0}, {0, 1}}, 1_ms}),
                         "transfer_function.denominator[0] = 0: must not be zero", invalid_parameter);
    CHECK_THROWS_WITH_AS((filter<1>{{{1.0, 0.0}, {1, std::nan("")}}, 1_ms}),
                         "transfer_function.denominator = nan: must be finite", invalid_parameter);
    CHECK_THROWS_AS((filter<1>{{{1e300, 0.0}, {1e-300, 1}}, 1_ms}),
                    invalid_parameter); // overflows when divided
    CHECK_THROWS_AS((filter<1>{{}, 1_ms}), invalid_parameter);
}
