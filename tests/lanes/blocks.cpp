// SPDX-License-Identifier: BSL-1.0
#include "blocks.hpp"

#include <quadrant/base/lanes.hpp>

#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace lanes_conformance;

namespace {
/// A block in lanes beside W blocks in double with the parameters of each lane.
template <class L, class Make> struct side_by_side {
    static constexpr std::size_t W = L::size;
    using together = decltype(std::declval<Make>()(std::declval<own<L>&>()));
    using alone = decltype(std::declval<Make>()(std::declval<own<double>&>()));
    using argument = typename alone::argument;

    together all;
    std::vector<alone> each;

    explicit side_by_side(const Make& make) : all(built(make)) {
        for (std::size_t i = 0; i < W; ++i) {
            own<double> p{.which = i};
            each.push_back(make(p));
        }
    }
    static together built(const Make& make) {
        own<L> p;
        return make(p);
    }
    static auto in_lanes(const std::array<double, W>& x) { return together::argument::from_value(L(x)); }
    void settle(const std::array<double, W>& x) {
        settle(all, in_lanes(x));
        for (std::size_t i = 0; i < W; ++i) settle(each[i], argument::from_value(x[i]));
    }
    template <class Block, class X> static void settle(Block& block, X x) {
        if constexpr (requires { block.settle(x); })
            block.settle(x);
        else
            block.settle(x, Block::value::from_value(x.value()));
    }
    void shift(const std::array<double, W>& x) {
        if constexpr (requires { each[0].shift(argument()); }) {
            all.shift(in_lanes(x));
            for (std::size_t i = 0; i < W; ++i) each[i].shift(argument::from_value(x[i]));
        }
    }
    void retune(const side_by_side& next) {
        if constexpr (requires { each[0].retune(each[0]); }) {
            all.retune(next.all);
            for (std::size_t i = 0; i < W; ++i) each[i].retune(next.each[i]);
        }
    }
    /// True when the step gives the same bits in every lane.
    bool step(const std::array<double, W>& x) {
        const auto y = all(in_lanes(x));
        bool same = true, fault = false;
        for (std::size_t i = 0; i < W; ++i) {
            const double one = each[i](argument::from_value(x[i])).value();
            same = same && y.value()[i] == one;
            fault = fault || each[i].faulted();
            if constexpr (requires { all.faulted_lanes(); })
                same = same && all.faulted_lanes()[i] == each[i].faulted();
            if constexpr (requires { all.applied(y); }) each[i].applied(alone::value::from_value(0.9 * one));
        }
        if constexpr (requires { all.applied(y); }) all.applied(0.9 * y);
        return same && all.faulted() == fault;
    }
};
} // namespace

TEST_CASE_TEMPLATE(
    "lanes: every block steps as W blocks in double do, bit for bit, also with faults in some lanes", L,
    lanes<2>, lanes<4>) {
    constexpr std::size_t W = L::size;
    const auto check = [](const auto& entry) {
        CAPTURE(std::string(entry.name));
        std::mt19937 random(1);
        std::uniform_real_distribution<double> any_of(-entry.amplitude, entry.amplitude);
        const auto draw = [&] {
            std::array<double, W> x;
            for (double& each : x) each = any_of(random);
            return x;
        };
        side_by_side<L, decltype(entry.make)> both_ways(entry.make);
        const auto fresh = both_ways;
        for (int k = 0; k < 500; ++k) {
            std::array<double, W> x = draw();
            if (k % 50 > 40) x[std::size_t(k) % W] = std::numeric_limits<double>::quiet_NaN();
            if (k % 70 > 60) x[std::size_t(k + 1) % W] = std::numeric_limits<double>::infinity();
            if (k % 100 == 30) both_ways.settle(x);
            if (k % 100 == 45) both_ways.settle(x); // a NaN in one lane
            if (k % 100 == 60) both_ways.retune(fresh);
            if (k % 100 == 75) both_ways.shift(draw());
            if (k % 100 == 91) both_ways.shift(x);
            if (k == 250) {
                both_ways.all.reset();
                for (auto& each : both_ways.each) each.reset();
            }
            CAPTURE(k);
            REQUIRE(both_ways.step(x));
        }
    };
    std::apply([&](const auto&... entry) { (check(entry), ...); }, blocks);
}
