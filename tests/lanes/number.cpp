// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/finite.hpp>
#include <quadrant/base/lanes.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/base/signal.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using portable = lanes<4, isa::other>; // as without xsimd
constexpr double infinity = std::numeric_limits<double>::infinity(),
                 no_number = std::numeric_limits<double>::quiet_NaN();

template <class L> L numbers(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-20, 20);
    std::array<double, L::size> out;
    for (double& x : out) x = any(random);
    return L(out);
}
bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
/// Units in the last place between two doubles.
double ulps(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    return std::abs(a - b) / (std::nextafter(std::abs(b), infinity) - std::abs(b));
}
} // namespace

TEST_CASE_TEMPLATE("lanes: + - * / and sqrt are those of double, bit for bit", L, lanes<1>, lanes<2>, lanes<3>,
                   lanes<4>, lanes<6>, lanes<8>) {
    std::mt19937 random(1);
    for (int n = 0; n < 1000; ++n) {
        const L a = numbers<L>(random), b = numbers<L>(random);
        L sum = a;
        sum += b, sum -= 2, sum *= a, sum /= b;
        for (std::size_t i = 0; i < L::size; ++i) {
            CHECK(same((a + b)[i], a[i] + b[i]));
            CHECK(same((a - 1)[i], a[i] - 1));
            CHECK(same((2.5 * b)[i], 2.5 * b[i]));
            CHECK(same((1 / b)[i], 1 / b[i]));
            CHECK(same((-a)[i], -a[i]));
            CHECK(same(sum[i], (a[i] + b[i] - 2) * a[i] / b[i]));
            CHECK(same(sqrt(a * a)[i], std::sqrt(a[i] * a[i])));
        }
    }
}

TEST_CASE_TEMPLATE("lanes: a comparison answers for every lane, select takes what each answer says", L,
                   lanes<1>, lanes<2>, lanes<3>, lanes<4>, lanes<8>, portable) {
    const std::array<double, 6> probes{-infinity, -1, -0.0, 0, 1, no_number};
    for (double p : probes)
        for (double q : probes)
            for (std::size_t i = 0; i < L::size; ++i) {
                L a(0.5), b(0.5);
                a.set(i, p), b.set(i, q);
                const auto below = less(a, b), below_or = less_equal(a, b), above = greater(a, b),
                           above_or = greater_equal(a, b), same_as = equal(a, b);
                CHECK(below[i] == (p < q));
                CHECK(below_or[i] == (p <= q));
                CHECK(above[i] == (p > q));
                CHECK(above_or[i] == (p >= q));
                CHECK(same_as[i] == (p == q));
                CHECK((!below)[i] == !(p < q));
                CHECK(both(below_or, above_or)[i] == (p <= q && p >= q));
                CHECK(either(below, above)[i] == (p < q || p > q));
                CHECK(any(below) == (p < q));
                CHECK(none(below) == !(p < q));
                CHECK(all(below_or) == (p <= q));
                const L one = select(below, L(7), L(8));
                for (std::size_t k = 0; k < L::size; ++k) CHECK(one[k] == (k == i && p < q ? 7 : 8));
                CHECK(same(min(a, b)[i], std::min(p, q)));
                CHECK(same(max(a, b)[i], std::max(p, q)));
                CHECK(same(clamp(a, -0.5, b)[i], p < -0.5 ? -0.5 : q < p ? q : p));
            }
}

TEST_CASE("lanes: a number without lanes compares, selects and counts the same way with bool") {
    using variable = dual<2>;
    CHECK(less(1.0, 2.0));
    CHECK(less(variable(1), variable(2)));
    CHECK(greater_equal(3_N, 3_N));
    CHECK(none(less(3_N, 3_N)));
    CHECK(select(less(1_N, 2_N), 5_N, 6_N) == 5_N);
    CHECK(absolute(-4_mm) == 4_mm);
    CHECK(smaller(1_N, 2_N) == 1_N);
    CHECK(larger(1_N, 2_N) == 2_N);
    CHECK(lane(2_N, 0) == 2_N);
    static_assert(lane_count<double> == 1 && lane_count<duration> == 1 && lane_count<lanes<4>> == 4);
    static_assert(std::is_same_v<mask_of<variable>, bool> && std::is_same_v<mask_of<duration>, bool>);
    static_assert(lane_count<quantity_of<signal::force, lanes<4>>> == 4);
    static_assert(std::is_same_v<mask_of<quantity_of<signal::force, lanes<4>>>, lane_mask<4>>);
}

template <class T>
concept has_less = requires(T a) {
    a < a;
};
template <class T>
concept has_equal = requires(T a) {
    a == a;
};
TEST_CASE("lanes: there is no operator that would answer with one bool") {
    static_assert(has_less<double> && has_equal<double>);
    static_assert(!has_less<lanes<4>> && !has_equal<lanes<4>>);
    static_assert(!std::is_convertible_v<lane_mask<4>, bool> && !std::is_constructible_v<bool, lane_mask<4>>);
}

TEST_CASE_TEMPLATE("lanes: fits into a quantity, units checked as ever", L, lanes<2>, lanes<4>) {
    using force = quantity_of<signal::force, L>;
    using velocity = quantity_of<signal::velocity, L>;
    L given(1);
    given.set(1, 3);
    const force f = force::from_value(given);
    const auto power = f * velocity::from_value(L(2));
    CHECK((power / velocity::from_value(L(4))).value()[1] == 1.5);
    CHECK(lane(2 * f + f * 0.5 - f / 4.0, 1) == 6.75_N);
    CHECK(lane(given * f, 1) == 9_N);
    CHECK(lane(-f, 0) == -1_N);
    const L ratio = f / force::from_value(L(2)); // no unit is left
    CHECK(ratio[1] == 1.5);
    CHECK(lane(f * 2_s, 1) == 6_N * 1_s);
    const auto small = less(f, force::from_value(L(2)));
    CHECK(small[0]);
    CHECK_FALSE(small[1]);
    CHECK(any(less(f, 2_N)));
    CHECK_FALSE(all(greater(f, 2_N)));
    CHECK(lane(select(small, -f, f), 0) == -1_N);
    CHECK(lane(absolute(-f), 1) == 3_N);
    force g = f;
    set_lane(g, 0, 8_N);
    set_where(small, g, force());
    CHECK(lane(g, 0) == 0_N);
    CHECK(lane(g, 1) == 3_N);
}

TEST_CASE_TEMPLATE("lanes: finite answers for each lane, and one fault stays in its lane", L, lanes<2>,
                   lanes<3>, lanes<4>, lanes<8>, portable) {
    for (const double bad : {no_number, infinity, -infinity}) {
        L x(1e308);
        x.set(1, bad);
        CHECK(finite(x)[0]);
        CHECK_FALSE(finite(x)[1]);
        CHECK(finite(x, L(1))[0]);
        held_output<L> out;
        out.reset(L(5));
        CHECK_FALSE(out.faulted());
        const L y = out.keep(finite(x), x);
        CHECK(y[0] == 1e308);
        CHECK(y[1] == 5);
        CHECK(out.faulted());
        CHECK_FALSE(out.faulted_lanes()[0]);
        CHECK(out.faulted_lanes()[1]);
        out.settle(finite(L(1)), L(1));
        CHECK_FALSE(out.faulted());
    }
}

TEST_CASE_TEMPLATE("lanes: floor, round, trunc, abs and copysign are those of double", L, lanes<2>, lanes<3>,
                   lanes<4>) {
    std::mt19937 random(2);
    std::vector<double> probes{0.0,   -0.0,  0.5, -0.5, 1.5, -1.5, 2.5, 0.49999999999999994, 4503599627370495.5,
                               1e300, -1e300};
    for (int n = 0; n < 1000; ++n) probes.push_back(std::ldexp(numbers<lanes<1>>(random)[0], n % 50));
    for (const double p : probes) {
        CAPTURE(p);
        const L x(p);
        CHECK(floor(x)[1] == std::floor(p));
        CHECK(round(x)[1] == std::round(p));
        CHECK(trunc(x)[1] == std::trunc(p));
        CHECK(same(abs(x)[1], std::abs(p)));
        CHECK(same(copysign(L(3), x)[1], std::copysign(3, p)));
    }
}

namespace {
/// The largest distance from the C library's result, in units in the last place, over `range` evenly and at
/// random.
template <class L, class F, class G> double worst(F of_lanes, G of_double, double low, double high) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> any(low, high);
    double most = 0;
    for (int n = 0; n < 100000; ++n) {
        const double x = any(random);
        most = std::max(most, ulps(L(of_lanes(L(x)))[1], of_double(x)));
    }
    return most;
}
} // namespace

TEST_CASE_TEMPLATE("lanes: exp, log, sin and cos are within one unit in the last place of the C library's", L,
                   lanes<2>, lanes<3>, lanes<4>, lanes<8>, portable) {
    CHECK(worst<L>([](L x) { return exp(x); }, [](double x) { return std::exp(x); }, -700, 700) <= 1);
    CHECK(worst<L>([](L x) { return log(x); }, [](double x) { return std::log(x); }, 1e-9, 1e3) <= 1);
    CHECK(worst<L>([](L x) { return sin(x); }, [](double x) { return std::sin(x); }, -100, 100) <= 1);
    CHECK(worst<L>([](L x) { return cos(x); }, [](double x) { return std::cos(x); }, -100, 100) <= 1);
}

TEST_CASE_TEMPLATE("lanes: tan, atan2 and pow are the C library's", L, lanes<2>, lanes<3>, lanes<4>) {
    CHECK(worst<L>([](L x) { return tan(x); }, [](double x) { return std::tan(x); }, -1.5, 1.5) == 0);
    CHECK(worst<L>([](L x) { return atan2(x, 0.7); }, [](double x) { return std::atan2(x, 0.7); }, -5, 5) == 0);
    CHECK(worst<L>([](L x) { return pow(x, 1.7); }, [](double x) { return std::pow(x, 1.7); }, 0.01, 100) == 0);
}
