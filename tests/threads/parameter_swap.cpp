// SPDX-License-Identifier: BSL-1.0
#include <quadrant/block/parameter_swap.hpp>

#include <doctest/doctest.h>

#include <array>
#include <thread>

using quadrant::parameter_swap;

TEST_CASE("parameter_swap: a set arrives whole, once, and the last one offered wins") {
    parameter_swap<std::array<int, 3>> swap({1, 1, 1});
    CHECK(swap.take() == nullptr);
    swap.offer({2, 2, 2});
    swap.offer({3, 3, 3});
    CHECK(swap.pending());
    const auto* taken = swap.take();
    REQUIRE(taken != nullptr);
    CHECK(*taken == std::array{3, 3, 3});
    CHECK(swap.take() == nullptr);
    swap.offer({4, 4, 4});
    swap.offer({5, 5, 5});
    CHECK(*taken == std::array{3, 3, 3}); // nobody writes where the servo thread reads
}

TEST_CASE("parameter_swap: two threads, 20000 sets of 64 numbers: none is torn, none comes twice or too late") {
    using set = std::array<double, 64>;
    constexpr int sets = 20000;
    const auto all = [](double x) {
        set s;
        s.fill(x);
        return s;
    };
    parameter_swap<set> swap(all(0));
    std::thread tunes([&] {
        for (int i = 1; i <= sets; ++i) swap.offer(all(i));
    });
    double last = 0;
    int torn = 0, stale = 0, taken = 0;
    while (last < sets)
        if (const set* s = swap.take()) {
            for (const double x : *s) torn += x != (*s)[0];
            stale += !((*s)[0] > last);
            last = (*s)[0];
            ++taken;
        }
    tunes.join();
    CHECK(torn == 0);
    CHECK(stale == 0);
    CHECK(taken > 0);
    CHECK(last == sets);
}
