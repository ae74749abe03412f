// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/literals.hpp>
#include <quadrant/block/absent.hpp>
#include <quadrant/block/series.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/rate_limiter.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace quadrant;
using namespace quadrant::literals;
using one = notch<signal::force>;
using other = lowpass<signal::force>;
using amplifier = limiter<signal::force>;

namespace {
const one::parameters resonance{.centre = 330_Hz, .width = 0.06};
const other::parameters noise{.corner = 200_Hz};
const amplifier::parameters limit{.low = -50_N, .high = 50_N};
} // namespace

TEST_CASE("series: is its blocks called one after the other, bit for bit and in that order") {
    series<one, other, amplifier> chain{{resonance, noise, limit}, 500_us};
    one first{resonance, 500_us};
    other second{noise, 500_us};
    amplifier third{limit, 500_us};
    for (int k = 0; k < 1000; ++k) {
        const auto x = std::sin(0.01 * k * k) * 100_N;
        CHECK(chain(x) == third(second(first(x))));
    }
}
TEST_CASE("series: the order matters where a block is not linear") {
    series<amplifier, other> limited_first{{limit, noise}, 500_us};
    series<other, amplifier> limited_last{{noise, limit}, 500_us};
    limited_first(100_N), limited_last(100_N);
    CHECK(limited_first(100_N) != limited_last(100_N));
}
TEST_CASE("series: responds with the product of its blocks") {
    const series<one, other> chain{{resonance, noise}, 500_us};
    const one a{resonance, 500_us};
    const other b{noise, 500_us};
    for (const double hz : {1.0, 100.0, 300.0, 700.0})
        CHECK(std::abs(chain.response(hz * 1_Hz) - a.response(hz * 1_Hz) * b.response(hz * 1_Hz)) < 1e-15);
}
TEST_CASE("series: settles each block at what the one before gives") {
    series<amplifier, other> chain{{limit, noise}, 500_us};
    chain.settle(80_N);
    CHECK(chain(80_N) == 50_N);
    const auto [amplifier_state, filter_state] = chain.now();
    CHECK(filter_state.y.high == 50_N);
}
TEST_CASE("series: of one block is that block, and its parameters come back") {
    series<one> chain{{resonance}, 500_us};
    one alone{resonance, 500_us};
    for (int k = 0; k < 100; ++k) CHECK(chain(double(k) * 1_N) == alone(double(k) * 1_N));
    CHECK(std::get<0>(chain.given()).centre == 330_Hz);
}
TEST_CASE("series: throws what its blocks throw") {
    CHECK_THROWS_WITH_AS((series<one, other>{{resonance, {.corner = 1200_Hz}}, 500_us}),
                         "lowpass.corner = 1200 Hz: must lie between 0 and half the sampling rate (1000 Hz)",
                         invalid_parameter);
}
TEST_CASE("absent: gives zero; through: gives its input") {
    absent<signal::velocity, signal::force> nothing{{}, 500_us};
    through<signal::force> wire{{}, 500_us};
    CHECK(nothing(3_mps) == 0_N);
    CHECK(wire(3_N) == 3_N);
    nothing(quantity<si::velocity>::from_value(std::numeric_limits<double>::infinity()));
    CHECK(nothing.faulted());
}
