// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/quantizer.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using dac = quantizer<signal::voltage>;

TEST_CASE("quantizer: of a 16-bit DAC over 20 V, 1 V is 3277 steps, 1.00006103515625 V") {
    dac d{{.step = 20_V / 65536.0}, 500_us};
    CHECK(d(1_V).value() == 1.00006103515625);
    CHECK(d(-1_V).value() == -1.00006103515625);
}
TEST_CASE("quantizer: halves go away from zero, on both sides") {
    dac d{{.step = 0.25_V}, 500_us};
    CHECK(d(0.125_V) == 0.25_V);
    CHECK(d(-0.125_V) == -0.25_V);
    CHECK(d(0.375_V) == 0.5_V);
    CHECK(d(-0.375_V) == -0.5_V);
    CHECK(d(std::nextafter(0.125, 0.0) * 1_V) == 0_V);
}
TEST_CASE("quantizer: never off by more than half a step, and its own output stays") {
    dac d{{.step = 20_V / 65536.0}, 500_us};
    for (double x = -10; x < 10; x += 0.00777) {
        const auto y = d(x * 1_V);
        CHECK(std::abs(y.value() - x) <= 0.5 * 20 / 65536 * (1 + 1e-12));
        CHECK(d(y) == y);
    }
}
TEST_CASE("quantizer: a step of 0 does not round") {
    dac d{{}, 500_us};
    CHECK(d(0.123456789_V) == 0.123456789_V);
}
TEST_CASE("quantizer: a derivative passes as if the steps were seen from afar") {
    using D = dual<1>;
    quantizer<signal::voltage, D> d{{.step = quantity_of<signal::voltage, D>::from_value(0.25)}, 500_us};
    const D y = d(quantity_of<signal::voltage, D>::from_value(D::variable(1.1, 0))).value();
    CHECK(y.value == 1.0);
    CHECK(y.partial[0] == 1);
}
TEST_CASE("quantizer: refuses a negative step") {
    CHECK_THROWS_WITH_AS((dac{{.step = -1_V}, 1_ms}), "quantizer.step = -1 V: must be finite and not below 0",
                         invalid_parameter);
}
TEST_CASE("quantizer: the nearest whole number is std::round bit for bit, for any bits and beside every half") {
    std::mt19937_64 random(3);
    const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    int off = 0;
    const auto look = [&](double x) {
        off += bits(quadrant::detail::whole(x)) != bits(std::round(x)) && !std::isnan(x);
    };
    for (int k = 0; k < 1'000'000; ++k) {
        look(std::bit_cast<double>(random()));
        const double half = std::ldexp(double(random() >> 12), -int(random() % 54)); // and whole ones
        for (const double x : {half, half + 0.5})
            for (const double y : {x, std::nextafter(x, 0.0), std::nextafter(x, 1e300)}) look(y), look(-y);
    }
    for (const double x : {0.0, 0.5, 0x1p52, 0x1p53, 1e308, std::numeric_limits<double>::infinity()})
        look(x), look(-x), look(std::nextafter(x, 0.0)), look(-std::nextafter(x, 0.0));
    CHECK(off == 0);
}
