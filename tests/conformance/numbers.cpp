// SPDX-License-Identifier: BSL-1.0
// Linearity, response() against a measured sine, float against double, derivatives against difference
// quotients.
#include "blocks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <vector>

using namespace conformance;

namespace {
template <class Real, class Block> std::vector<Real> outputs(Block block, const std::vector<double>& x) {
    std::vector<Real> y;
    for (const double each : x)
        y.push_back(Real(one_sample(block, input_of<Block, Real>::from_value(Real(each))).value()));
    return y;
}
std::vector<double> noisy(double amplitude, std::uint32_t seed, std::size_t samples = 200) {
    noise next(seed);
    std::vector<double> x(samples);
    for (double& each : x) each = next(amplitude);
    return x;
}
double largest(const std::vector<double>& y) {
    double most = 0;
    for (const double each : y) most = std::max(most, std::abs(each));
    return most;
}
} // namespace

TEST_CASE("every block: linear if and only if it has a response()") {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        const auto block = e(values<double>{});
        const auto a = noisy(e.amplitude, 1), b = noisy(e.amplitude, 2);
        auto sum = a;
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] = 0.5 * a[k] - 0.25 * b[k];
        const auto ya = outputs<double>(block, a), yb = outputs<double>(block, b),
                   y = outputs<double>(block, sum);
        double off = 0;
        for (std::size_t k = 0; k < y.size(); ++k)
            off = std::max(off, std::abs(y[k] - (0.5 * ya[k] - 0.25 * yb[k])));
        const bool is_linear = off <= 1e-12 * (largest(ya) + largest(yb)); // rounding of 200 samples
        CHECK(is_linear == linear<decltype(block)>);
    });
}

TEST_CASE("every linear block: response() is what a sine measures") {
    // 400 samples hold a whole number of periods of every frequency below; 4000 more before that let it settle.
    constexpr int window = 400, before = 4000;
    for_each_block([](const auto& e) {
        auto block = e(values<double>{});
        using Block = decltype(block);
        if constexpr (linear<Block>) {
            CAPTURE(e.name);
            for (const double f : {5.0, 40.0, 100.0, 330.0, 555.0, 960.0}) {
                CAPTURE(f);
                block.reset();
                const double angle = 2 * std::numbers::pi * f * T.value(), small = e.amplitude / 64;
                std::complex<double> sum = 0;
                for (int k = 0; k < before + window; ++k) {
                    const double x = small * std::cos(angle * k);
                    const double y = one_sample(block, input_of<Block, double>::from_value(x)).value();
                    if (k >= before) sum += y * std::polar(2.0 / window, -angle * k);
                }
                const std::complex<double> expected = block.response(frequency::from_value(f)),
                                           measured = sum / small;
                CHECK(std::abs(measured - expected) <= 1e-9 * (1 + std::abs(expected)));
            }
        }
    });
}

TEST_CASE("every block: float follows double to 1e-4 of its largest output") {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        const auto x = noisy(e.amplitude, 1);
        const auto exact = outputs<double>(e(values<double>{}), x);
        const auto rough = outputs<float>(e(values<float>{}), x);
        double worst = 0;
        for (std::size_t k = 0; k < x.size(); ++k)
            worst = std::max(worst, std::abs(exact[k] - double(rough[k])));
        CHECK(worst <= 1e-4 * largest(exact));
    });
}

TEST_CASE("every block: a dual has the value of a double and the derivative of a difference quotient") {
    using D = dual<most_parameters>;
    constexpr double h = 1e-6; // relative; central, so 1e-12 of the third derivative, and 1e-10 of rounding
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        const auto x = noisy(e.amplitude, 1);
        const auto exact = outputs<double>(e(values<double>{}), x);
        const auto y = outputs<D>(e(values<D>{}), x);
        double off = 0;
        for (std::size_t k = 0; k < x.size(); ++k) off = std::max(off, std::abs(exact[k] - y[k].value));
        CHECK(off <= 1e-12 * largest(exact));

        values<double> counter;
        e.make(counter);
        REQUIRE(counter.count <= most_parameters);
        for (std::size_t i = 0; i < counter.count; ++i) {
            CAPTURE(i);
            const auto up = outputs<double>(e(values<double>{.bumped = i, .factor = 1 + h}), x);
            const auto down = outputs<double>(e(values<double>{.bumped = i, .factor = 1 - h}), x);
            // d/d(ln p): the parameter itself is its derivative's scale, and the dual's variable i has slope
            // one in p.
            double worst = 0, size = 0;
            for (std::size_t k = 0; k < x.size(); ++k) {
                const double quotient = (up[k] - down[k]) / (2 * h);
                const double slope = y[k].partial[i] * counter.given[i];
                worst = std::max(worst, std::abs(quotient - slope));
                size = std::max(size, std::abs(quotient));
            }
            CHECK(worst <= 1e-6 * size + 1e-8 * largest(exact));
            CHECK(size > 0); // the parameter does something
        }
    });
}
