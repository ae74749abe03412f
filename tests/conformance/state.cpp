// SPDX-License-Identifier: BSL-1.0
// reset, settle, copies, zero: what holds of every block, for double, float and dual.
#include "blocks.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace conformance;

namespace {
using two = dual<most_parameters>;

template <class Real, class Block>
std::vector<double> outputs(Block& block, double amplitude, std::uint32_t seed = 1) {
    noise input(seed);
    std::vector<double> y;
    for (int k = 0; k < 100; ++k)
        y.push_back(
            detail::plain(one_sample(block, input_of<Block, Real>::from_value(Real(input(amplitude))))));
    return y;
}

template <class Real> void reset_equals_new() {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        auto used = e(values<Real>{});
        const auto fresh = outputs<Real>(used, e.amplitude);
        used(input_of<decltype(used), Real>::from_value(Real(unknown(std::nan("")))));
        CHECK(used.faulted());
        used.reset();
        CHECK_FALSE(used.faulted());
        CHECK(outputs<Real>(used, e.amplitude) == fresh);
    });
}

template <class Real> void settle_holds(double tolerance) {
    for_each_block([&](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<Real>{});
        using in = input_of<decltype(block), Real>;
        outputs<Real>(block, e.amplitude);
        const in x = in::from_value(Real(0.375 * e.amplitude));
        if constexpr (requires { block.settle(x); }) {
            if constexpr (requires { block.integrates(); }) {
                if (block.integrates()) return; // no such state: see "settle(x, y)" below
            }
            block.settle(x);
            const double first = detail::plain(one_sample(block, x));
            double worst = 0;
            for (int k = 0; k < 1000; ++k)
                worst = std::max(worst, std::abs(detail::plain(one_sample(block, x)) - first));
            CHECK(worst <= tolerance * std::abs(first));
        }
    });
}

template <class Real> void settle_is_bumpless(double tolerance) {
    for_each_block([&](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<Real>{});
        using in = input_of<decltype(block), Real>;
        using out = decltype(block(in()));
        outputs<Real>(block, e.amplitude);
        const in x = in::from_value(Real(0.03125 * e.amplitude));
        const out y = out::from_value(Real(1.5)); // within the limits of those that have one
        if constexpr (requires { block.settle(x, y); }) {
            if constexpr (rate_of<typename decltype(block)::output, typename decltype(block)::input> &&
                          !requires { block.limited(); }) {
                block.settle(x, y); // has been moving at y, x was the last sample
                CHECK(detail::plain(one_sample(block, in(x + y * in_real<Real>(T)))) ==
                      doctest::Approx(1.5).epsilon(tolerance));
            } else {
                block.settle(x, y); // the coming step with x gives y
                CHECK(detail::plain(one_sample(block, x)) == doctest::Approx(1.5).epsilon(tolerance));
            }
            CHECK_FALSE(block.faulted());
        }
    });
}

template <class Real> void copies_are_independent() {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        auto original = e(values<Real>{}), twin = e(values<Real>{});
        outputs<Real>(original, e.amplitude), outputs<Real>(twin, e.amplitude);
        auto copy = original;
        auto continued = copy;
        outputs<Real>(copy, e.amplitude, 7);
        copy.reset();
        const auto expected = outputs<Real>(twin, e.amplitude, 3);
        CHECK(outputs<Real>(original, e.amplitude, 3) == expected);  // not touched by its copy
        CHECK(outputs<Real>(continued, e.amplitude, 3) == expected); // and a copy is a snapshot
    });
}

template <class Real> void zero_in_zero_out() {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<Real>{});
        double worst = 0;
        for (int k = 0; k < 100; ++k)
            worst =
                std::max(worst, std::abs(detail::plain(one_sample(block, input_of<decltype(block), Real>()))));
        CHECK(worst == 0);
        CHECK_FALSE(block.faulted());
    });
}
} // namespace

TEST_CASE_TEMPLATE("every block: reset leaves it as new, bit for bit", Real, double, float, two) {
    reset_equals_new<Real>();
}
TEST_CASE("every block: settle(x) is the state that a constant x leaves") {
    settle_holds<double>(1e-12); // of the output
    settle_holds<float>(1e-5);
    settle_holds<two>(1e-12);
}
TEST_CASE("every block: settle(x, y) starts without a bump") {
    settle_is_bumpless<double>(1e-12);
    settle_is_bumpless<float>(1e-3); // of a difference of positions over 0.5 ms
    settle_is_bumpless<two>(1e-12);
}
TEST_CASE_TEMPLATE("every block: a copy is a snapshot and drives nothing but itself", Real, double, float,
                   two) {
    copies_are_independent<Real>();
}
TEST_CASE_TEMPLATE("every block: zero in, zero out", Real, double, float, two) { zero_in_zero_out<Real>(); }

TEST_CASE("every block has its own name in the list") {
    std::vector<std::string> names;
    for_each_block([&](const auto& e) { names.emplace_back(e.name); });
    for (std::size_t i = 0; i < names.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) CHECK(names[i] != names[j]);
}
