// SPDX-License-Identifier: BSL-1.0
// NaN, infinities, extremes, allocation: the same policy in every block.
#include "blocks.hpp"
#include "count_allocations.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace conformance;
std::size_t conformance::allocated() { return counted::allocations; }

namespace {
template <class Real>
const Real bad_numbers[] = {unknown(std::numeric_limits<Real>::quiet_NaN()),
                            unknown(std::numeric_limits<Real>::infinity()),
                            unknown(-std::numeric_limits<Real>::infinity())};

template <class Real, class Block>
void run(Block& block, double amplitude, std::uint32_t seed, int samples = 20) {
    noise input(seed);
    for (int k = 0; k < samples; ++k) block(input_of<Block, Real>::from_value(Real(input(amplitude))));
}

/// The next outputs are those of the twin, bit for bit.
template <class Real, class Block> bool same_future(Block a, Block b, double amplitude) {
    noise input(11);
    for (int k = 0; k < 20; ++k) {
        const auto x = input_of<Block, Real>::from_value(Real(input(amplitude)));
        if (!(one_sample(a, x) == one_sample(b, x))) return false;
    }
    return true;
}

/// One piece of machine code for all: with -ffast-math a second one may round differently.
template <class Block> [[gnu::noinline]] void start_again(Block& block) { block.reset(); }
} // namespace

TEST_CASE_TEMPLATE("every block: a bad sample gives the last output, changes no state and is told until reset",
                   Real, double, float) {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        for (const Real bad : bad_numbers<Real>) {
            CAPTURE(bad);
            auto block = e(values<Real>{});
            using in = input_of<decltype(block), Real>;
            run<Real>(block, e.amplitude, 5);
            const auto last = block(in::from_value(Real(0.375 * e.amplitude)));
            const auto twin = block;
            for (int k = 0; k < 3; ++k) CHECK(block(in::from_value(bad)) == last);
            CHECK(block.faulted());
            CHECK(same_future<Real>(block, twin, e.amplitude));
            block(in());
            CHECK(block.faulted()); // a good sample does not clear it
            block.reset();
            CHECK_FALSE(block.faulted());
        }
    });
}

TEST_CASE_TEMPLATE("every block: settle clears the fault; with a bad value it changes nothing and raises it",
                   Real, double, float) {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        for (const Real bad : bad_numbers<Real>) {
            CAPTURE(bad);
            auto block = e(values<Real>{});
            using in = input_of<decltype(block), Real>;
            using out = decltype(block(in()));
            run<Real>(block, e.amplitude, 5);
            const auto twin = block;
            const auto last = block(in::from_value(bad));
            block = twin;
            int ways = 0;
            const auto check = [&](auto&& settle_badly, auto&& settle_well) {
                ++ways;
                block = twin;
                settle_badly();
                CHECK(block.faulted());
                CHECK(same_future<Real>(block, twin, e.amplitude));
                CHECK(block(in::from_value(bad)) == last); // nor is the held output lost
                settle_well();
                CHECK_FALSE(block.faulted());
            };
            const auto holds = [&](double expected) { // what a bad sample gives right after settle
                const double held = detail::plain(block(in::from_value(bad)));
                CHECK(std::abs(held - expected) <= 1e-5 * std::abs(expected)); // float
            };
            if constexpr (requires { block.settle(in()); }) {
                check([&] { block.settle(in::from_value(bad)); },
                      [&] { block.settle(in::from_value(Real(1))); });
                auto copy = block;
                holds(detail::plain(copy(in::from_value(Real(1)))));
            } else if constexpr (requires { block.settle(out()); }) // a plant: settles at an output
                check([&] { block.settle(out::from_value(bad)); },
                      [&] { block.settle(out::from_value(Real(1))); });
            if constexpr (requires { block.settle(in(), out()); }) {
                const auto well = [&] { block.settle(in::from_value(Real(1)), out::from_value(Real(1))); };
                check([&] { block.settle(in::from_value(bad), out::from_value(Real(1))); }, well);
                check([&] { block.settle(in::from_value(Real(1)), out::from_value(bad)); }, well);
                holds(1);
            }
            CHECK(ways > 0);
        }
    });
}

TEST_CASE_TEMPLATE("every block: finite on extremes, and usable after a reset", Real, double, float) {
    const Real most = unknown(std::numeric_limits<Real>::max()),
               least = unknown(std::numeric_limits<Real>::denorm_min());
    for_each_block([most, least](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<Real>{});
        using in = input_of<decltype(block), Real>;
        bool all_finite = true;
        for (int round = 0; round < 20; ++round)
            for (const Real x :
                 {most, -most, most, most, least, -least, Real(0), most / 2, -most / 4, Real(1), -most}) {
                all_finite = all_finite && finite(block(in::from_value(x)));
                if (round % 3 == 0) block.reset();
                if constexpr (requires { block.settle(in()); })
                    if (round % 3 == 1) block.settle(in::from_value(x));
            }
        CHECK(all_finite);
        start_again(block);
        auto fresh = e(values<Real>{});
#ifdef __FAST_MATH__ // the constructor's piece of code may round differently (docs/use_in_a_project.md)
        start_again(fresh);
#endif
        CHECK(same_future<Real>(block, fresh, e.amplitude));
    });
}

TEST_CASE("every block: a dual whose derivative is not finite is a bad sample") {
    using D = dual<most_parameters>;
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<D>{});
        using in = input_of<decltype(block), D>;
        const auto last = block(in::from_value(D(0.375 * e.amplitude)));
        const auto twin = block;
        D bad(0.25);
        bad.partial[1] = unknown(std::numeric_limits<double>::infinity());
        CHECK(block(in::from_value(bad)) == last);
        CHECK(block.faulted());
        CHECK(same_future<D>(block, twin, e.amplitude));
    });
}

TEST_CASE("every block: no allocation in step, reset, settle or copy") {
    for_each_block([](const auto& e) {
        CAPTURE(e.name);
        auto block = e(values<double>{});
        using in = input_of<decltype(block), double>;
        const std::size_t before = counted::allocations;
        run<double>(block, e.amplitude, 5, 100);
        block(in::from_value(unknown(std::numeric_limits<double>::quiet_NaN())));
        if constexpr (requires { block.settle(in()); }) block.settle(in::from_value(1));
        auto copy = block;
        copy.reset();
        run<double>(copy, e.amplitude, 5, 100);
        const std::size_t after = counted::allocations;
        CHECK(after == before);
    });
    const std::size_t before = counted::allocations;
    ::operator delete(::operator new(8));
    CHECK(counted::allocations == before + 1); // the counter counts
}
