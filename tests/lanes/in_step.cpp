// SPDX-License-Identifier: BSL-1.0
// Lanes that take a sample all together: what no other test of lanes sees.
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/friction/maxwell_slip_lanes.hpp>
#include <quadrant/memory/repetitive_in_step.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;

namespace {
const duration T = 500_us;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
template <class L> L numbers(std::mt19937& random, double amplitude) {
    std::uniform_real_distribution<double> any_of(-amplitude, amplitude);
    L out;
    for (std::size_t i = 0; i < L::size; ++i) out.set(i, any_of(random));
    return out;
}
template <class L, class Unit> quantity<Unit, L> spread(quantity<Unit> q) { // lane i: 10 i % more
    L out;
    for (std::size_t i = 0; i < L::size; ++i) out.set(i, q.value() * (1 + 0.1 * double(i)));
    return quantity<Unit, L>::from_value(out);
}

template <class L> using springs = maxwell_slip<4, s::velocity, s::force, L>;
template <class L> typename springs<L>::parameters rubbing(double more = 1) {
    typename springs<L>::parameters p;
    p.curve = {spread<L>(more * 122_N), spread<L>(more * 177_N), spread<L>(2.2_mmps), spread<L>(950_N / 1_mps),
               1};
    const std::array forces{65_N, 55_N, 26_N, 6.5_N};
    const std::array stiffness{61.8e6, 9.852e6, 4.49e6, 0.325e6};
    for (std::size_t i = 0; i < 4; ++i) {
        p.forces[i] = spread<L>(more * forces[i]);
        p.stiffness[i] = spread<L>(stiffness[i] * 1_N / 1_m);
    }
    p.attraction = spread<L>(450_N / 1_s);
    return p;
}

using memory_of_one = repetitive<s::position, 40, 2, 13, 7>;
template <class L> using memory = repetitive<s::position, 40, 2, 13, 7, L>;
/// `alike`: the same taps in every lane.
template <class L>
typename memory<L>::parameters learning(double periods, double more = 1, bool alike = false) {
    typename memory<L>::parameters p{.cycle = spread<L>(periods * T), .ahead = 4};
    p.weights = {L(1.9), L(-0.95)};
    for (std::size_t i = 0; i < 13; ++i) {
        L tap;
        for (std::size_t k = 0; k < L::size; ++k)
            tap.set(k, more * std::cos(double(i + (alike ? 0 : k))) / (3.0 + double(i)));
        p.learning[i] = tap;
    }
    for (std::size_t i = 0; i < 7; ++i) p.smoothing[i] = L(0.9 / (1 + std::abs(double(i) - 3)) / 2.9);
    p.fade = 6.0 * T;
    return p;
}
} // namespace

TEST_CASE("lanes in step: finite is true of them without a look, and a mask of it is known to the compiler") {
    using L = lanes_in_step<2>;
    static_assert(steps_together<L> && !steps_together<lanes<2>> && !steps_together<double>);
    static_assert(std::is_empty_v<decltype(finite(L(no_number)))>);
    CHECK(all(finite(L(no_number))));
    CHECK(none(L(no_number).finite_mask()));
    const lane_mask<2> some(std::array{true, false});
    CHECK(both(in_every_lane<true>(), some)[0]);
    CHECK_FALSE(any(both(in_every_lane<false>(), some)));
    CHECK(all(either(some, in_every_lane<true>())));
    CHECK_FALSE(either(some, in_every_lane<false>())[1]);
    const lane_mask<2> converted = in_every_lane<true>();
    CHECK(all(converted));
}

TEST_CASE_TEMPLATE("maxwell_slip in lanes: per lane that of double, through reversals, rests and a retune", L,
                   lanes<2>, lanes<4>, lanes<3>, lanes_in_step<2>, lanes_in_step<4>) {
    springs<L> together(rubbing<L>(), T);
    std::vector<springs<double>> alone;
    for (std::size_t i = 0; i < L::size; ++i) alone.emplace_back(rubbing<L>().of(i), T);
    std::mt19937 random(3);
    for (int k = 0; k < 20'000; ++k) {
        CAPTURE(k);
        L v = numbers<L>(random, k % 3 == 0 ? 1e-5 : 3e-3);
        if (k % 50 < 10) v = numbers<L>(random, 0); // both zeros
        if (k % 500 == 100) {
            together.settle(quantity_of<s::velocity, L>::from_value(v));
            for (std::size_t i = 0; i < L::size; ++i)
                alone[i].settle(quantity_of<s::velocity>::from_value(v[i]));
        }
        if (k % 1000 == 300) {
            const double more = k % 2000 == 300 ? 0.6 : 1;
            together.retune(springs<L>(rubbing<L>(more), T));
            for (std::size_t i = 0; i < L::size; ++i)
                alone[i].retune(springs<double>(rubbing<L>(more).of(i), T));
        }
        const auto y = together(quantity_of<s::velocity, L>::from_value(v)).value();
        for (std::size_t i = 0; i < L::size; ++i) {
            CAPTURE(i);
            const double one = alone[i](quantity_of<s::velocity>::from_value(v[i])).value();
            // Each spring's level is off by an ulp or two of the exponentials, and keeps it until it sticks
            // again.
            REQUIRE(std::abs(y[i] - one) <= 1e-12 * 200);
        }
    }
}

TEST_CASE_TEMPLATE("maxwell_slip in lanes: a NaN in one lane holds that lane alone", L, lanes<2>, lanes<4>) {
    springs<L> together(rubbing<L>(), T);
    const auto at = [](L v) { return quantity_of<s::velocity, L>::from_value(v); };
    for (int k = 0; k < 10; ++k) together(at(L(1e-4)));
    const auto before = together(at(L(1e-4))).value();
    L bad(1e-4);
    bad.set(1, no_number);
    const auto y = together(at(bad)).value();
    CHECK(y[1] == before[1]);
    CHECK(y[0] != before[0]);
    CHECK(together.faulted_lanes()[1]);
    CHECK_FALSE(together.faulted_lanes()[0]);
    CHECK(together.now().of(1).elements[0].force.value() <=
          together.now().of(0).elements[0].force.value() * 1.1);
    together.reset();
    CHECK_FALSE(together.faulted());
}

TEST_CASE_TEMPLATE("repetitive in lanes in step: per lane that of double to rounding, also while a cycle fades",
                   L, lanes_in_step<2>, lanes_in_step<4>) {
    memory<L> together(learning<L>(19.3), T);
    std::vector<memory_of_one> alone;
    for (std::size_t i = 0; i < L::size; ++i) alone.emplace_back(learning<L>(19.3).of(i), T);
    const auto at = [](const L& x) { return quantity_of<s::position, L>::from_value(x); };
    const auto at_one = [](double x) { return quantity_of<s::position>::from_value(x); };
    std::mt19937 random(5);
    double largest = 0;
    for (int k = 0; k < 4000; ++k) {
        CAPTURE(k);
        if (k % 900 == 400) { // the same change in every lane: a fade of six periods
            const L cycle(k < 1000 ? 21.7 * T.value() : 19.0 * T.value());
            together.cycle(quantity<si::time, L>::from_value(cycle));
            for (auto& one : alone) one.cycle(cycle[0] * 1_s);
        }
        if (k == 1500) {
            const L x = numbers<L>(random, 1);
            together.settle(at(x), at(0.3 * x));
            for (std::size_t i = 0; i < L::size; ++i) alone[i].settle(at_one(x[i]), at_one(0.3 * x[i]));
        }
        if (k == 2000) {
            together.settle(at(L(0.1)));
            for (auto& one : alone) one.settle(at_one(0.1));
        }
        if (k == 3000 || k == 3300) { // taps that all lanes have, and others again
            const auto next = learning<L>(19.3, 0.8, k == 3000);
            together.retune(memory<L>(next, T));
            for (std::size_t i = 0; i < L::size; ++i) alone[i].retune(memory_of_one(next.of(i), T));
        }
        const L e = numbers<L>(random, 1);
        const auto y = together(at(e)).value();
        for (std::size_t i = 0; i < L::size; ++i) {
            const double one = alone[i](at_one(e[i])).value();
            largest = std::max(largest, std::abs(one));
            // 13 + 7 + 8 products a sample in another order, some 20 cycles of a memory that forgets half of it
            // in four.
            REQUIRE(std::abs(y[i] - one) <= 1e3 * std::numeric_limits<double>::epsilon() * (1 + largest));
        }
    }
    CHECK(largest > 1); // it has learnt
}

TEST_CASE_TEMPLATE("lanes: decayed is exp(-x) within one unit in the last place, and never subnormal", L,
                   lanes<2>, lanes<4>, lanes<3>) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> exponent(-20, 9.46); // up to 708
    std::int64_t worst = 0;
    for (int k = 0; k < 200'000; ++k) {
        const double x = std::exp2(exponent(random));
        const double y = decayed(L(x))[L::size - 1], true_one = std::exp(-x);
        std::int64_t a, b;
        std::memcpy(&a, &y, sizeof a);
        std::memcpy(&b, &true_one, sizeof b);
        worst = std::max(worst, std::abs(a - b));
    }
    CHECK(worst <= 1);
    CHECK(decayed(L(0))[0] == 1);
    CHECK(decayed(L(1e9))[0] == decayed(L(708))[0]);
    CHECK(decayed(L(1e9))[0] >= std::numeric_limits<double>::min());
}

TEST_CASE_TEMPLATE("lanes: round is std::round at and beside every half, and of large numbers", L, lanes<2>,
                   lanes<4>, lanes<3>, lanes_in_step<2>) {
    const double most = std::numeric_limits<double>::max();
    for (const double half : {0.5, 1.5, 2.5, 1e6 + 0.5, 0x1p51 + 0.5, 0x1p52 - 0.5})
        for (const double sign : {1.0, -1.0})
            for (const double to : {-most, half, most}) {
                const double x = sign * std::nextafter(half, to);
                CHECK(round(L(x))[0] == std::round(x));
            }
    for (const double x : {0.0, -0.0, 0x1p52, 0x1p52 + 1, 0x1p53 - 1, -0x1p60, most})
        CHECK(round(L(x))[0] == std::round(x));
}
TEST_CASE_TEMPLATE("lanes: limited_to is that of a double in each lane, also of infinities and of no number", L,
                   lanes<2>, lanes<4>, lanes_in_step<2>) {
    const double all[] = {-3, -1, -0.0, 0, 0.5, 1, 3, std::numeric_limits<double>::infinity(), no_number};
    for (const double one : all)
        for (const double other : all) {
            L x(one);
            x.set(1, other);
            const L y = limited_to(x, L(-1), L(1));
            for (std::size_t i = 0; i < 2; ++i) {
                const double is = y[i], was = limited_to(x[i], -1.0, 1.0);
                CHECK(std::memcmp(&is, &was, sizeof is) == 0);
            }
        }
}
TEST_CASE_TEMPLATE("lanes: nearest is within half of x, and whole", L, lanes<2>, lanes_in_step<2>) {
    std::mt19937 random(8);
    for (int k = 0; k < 100'000; ++k) {
        const L x = numbers<L>(random, k % 2 ? 10 : 1e6), y = nearest(x);
        CHECK(std::abs(y[0] - x[0]) <= 0.5);
        CHECK(y[0] == std::floor(y[0]));
    }
}
