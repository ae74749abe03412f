// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/filter/notch.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <numbers>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
template <std::size_t N> void same(const discrete<N>& got, const discrete<N>& expected, double tolerance) {
    double size_n = 0, size_d = 0;
    for (std::size_t i = 0; i <= N; ++i) {
        size_n = std::max(size_n, std::abs(expected.numerator[i]));
        size_d = std::max(size_d, std::abs(expected.denominator[i]));
    }
    for (std::size_t i = 0; i <= N; ++i) {
        CAPTURE(i);
        CHECK(std::abs(got.numerator[i] - expected.numerator[i]) <= tolerance * size_n);
        CHECK(std::abs(got.denominator[i] - expected.denominator[i]) <= tolerance * size_d);
    }
}
template <std::size_t N> std::complex<double> at(const continuous<N>& c, double hz) {
    const std::complex<double> s(0, 2 * std::numbers::pi * hz);
    std::complex<double> over = 0, under = 0;
    for (std::size_t i = N + 1; i-- > 0;)
        over = over * s + c.numerator[i], under = under * s + c.denominator[i];
    return over / under;
}
template <std::size_t N> std::complex<double> at(const discrete<N>& d, double hz, double T) {
    using filter = transfer_function<signal::number, signal::number, N>;
    return filter(filter::parameters::in_si(d), duration::from_value(T)).response(hz * 1_Hz);
}
const continuous<1> lag{{62.8}, {62.8, 1}};
const continuous<2> motor{{1450}, {0, 850, 340}};
const continuous<2> resonance{{4e6, 0, 1}, {4.2e6, 40, 1}};
const continuous<3> third{{1000, 50}, {1000, 400, 30, 1}};
} // namespace

TEST_CASE("discretize, zero-order hold: a double integrator is T^2/2 (z^-1 + z^-2) / (1 - z^-1)^2") {
    const auto d = zero_order_hold(continuous<2>{{1}, {0, 0, 1}}, 1_ms);
    same(d, {{0, 0.5e-6, 0.5e-6}, {1, -2, 1}}, 1e-15);
    CHECK(d.denominator == std::array{1.0, -2.0, 1.0}); // exactly: an integrator must not leak
}
TEST_CASE("discretize, zero-order hold: agrees with scipy where scipy is accurate") {
    // scipy.signal.cont2discrete(([62.8],[1,62.8]), .001, 'zoh')
    same(zero_order_hold(lag, 1_ms), {{0, 0.06086871883600753}, {1, -0.9391312811639926}}, 1e-14);
    // scipy.signal.cont2discrete(([1,0,4e6],[1,40,4.2e6]), 5e-4, 'zoh')
    same(zero_order_hold(resonance, 500_us),
         {{1, -1.0677182482440455, 0.9741302126095934}, {1, -1.0284661107229298, 0.9801986733067554}}, 1e-14);
    // scipy.signal.cont2discrete(([50,1000],[1,30,400,1000]), .01, 'zoh') gives the same to 4e-13; these digits
    // are from mpmath, 80 digits, expm of the enlarged matrix.
    same(zero_order_hold(third, 10_ms),
         {{0, 0.00241482446397741965, 0.000358287805347799394, -0.00191204502191056399},
          {1, -2.705923463313794, 2.4476027512429273, -0.7408182206817188}},
         1e-14);
}
TEST_CASE(
    "discretize, zero-order hold: a motor's numerator to full accuracy, where scipy has lost seven digits") {
    // The textbook pair k/(s(s+a)) -> k/a^2 ((aT-1+E) z^-1 + (1-E-aTE) z^-2) / ((1-z^-1)(1-E z^-1)), E =
    // exp(-aT)
    const long double a = 850.0L / 340, k = 1450.0L / 340, T = 500e-6L, E = std::exp(-a * T);
    const long double less = std::expm1(-a * T); // E - 1
    // aT-1+E and 1-E-aTE cancel; by their series instead: (aT)^2/2 - (aT)^3/6 + ... and (aT)^2/2 - (aT)^3/3 +
    // ...
    const long double x = a * T;
    long double first = 0, second = 0, term = x; // term = x^n / n!
    for (int n = 2; n < 20; ++n) {
        term *= x / n;
        first += (n % 2 == 0 ? 1 : -1) * term;
        second += (n % 2 == 0 ? 1 : -1) * term * (n - 1);
    }
    same(zero_order_hold(motor, 500_us),
         {{0, double(k / a / a * first), double(k / a / a * second)}, {1, double(-2 - less), double(E)}},
         1e-15);
}
TEST_CASE(
    "discretize, zero-order hold: an input held over the period gives the continuous output at the samples") {
    // step response of 62.8/(s + 62.8), and 1 - exp(-at)
    transfer_function<signal::number, signal::number, 1> f{
        transfer_function<signal::number, signal::number, 1>::parameters::in_si(zero_order_hold(lag, 1_ms)),
        1_ms};
    for (int k = 0; k < 100; ++k)
        CHECK(f(1.0).value() == doctest::Approx(1 - std::exp(-62.8 * k * 1e-3)).epsilon(1e-12).scale(1));
}
TEST_CASE("discretize, zero-order hold: multiple and fast poles do no harm") {
    // (1 + s/p)^-4 with p T = 0.003: 80-digit reference, mpmath expm of the enlarged matrix
    // (docs/blocks/discretize.md)
    const double p = 2 * std::numbers::pi, T = 500e-6;
    const auto slow =
        zero_order_hold(continuous<4>{{p * p * p * p}, {p * p * p * p, 4 * p * p * p, 6 * p * p, 4 * p, 1}},
                        duration::from_value(T));
    double sum_n = 0;
    for (const double b : slow.numerator) sum_n += b;
    // Gain one at standstill: sum of the numerator = (1 - exp(-pT))^4, 1e-10 of a denominator's coefficient
    CHECK(sum_n == doctest::Approx(std::pow(-std::expm1(-p * T), 4)).epsilon(1e-12));
    for (std::size_t i = 0; i <= 4; ++i) {
        const double binomial = i == 0 || i == 4 ? 1 : i == 2 ? 6 : 4;
        CHECK(slow.denominator[i] ==
              doctest::Approx((i % 2 == 0 ? 1 : -1) * binomial * std::exp(-p * T * double(i))).epsilon(1e-14));
    }
    // poles at -60000 and -10 rad/s, T = 0.5 ms: z = exp(-30), exp(-0.005)
    const auto fast = zero_order_hold(continuous<2>{{1}, {600000, 60010, 1}}, 500_us);
    CHECK(std::abs(fast.denominator[1] + std::exp(-30.0) + std::exp(-0.005)) < 1e-13);
    CHECK(std::abs(fast.denominator[2] - std::exp(-30.005)) < 1e-13);
}
TEST_CASE("discretize, bilinear: agrees with scipy") {
    // scipy.signal.bilinear([50,1000], [1,30,400,1000], fs=100)
    same(bilinear(third, 10_ms),
         {{0.0011852171102251913, 0.0014007111302661351, -0.0007542290701433035, -0.0009697230901842474},
          {1, -2.7062816506841934, 2.448335308695184, -0.7411916819308264}},
         1e-14);
    // k = w/np.tan(w*.01/2), w = 2*np.pi*10; scipy.signal.bilinear([50,1000], [1,30,400,1000], fs=k/2)
    same(bilinear(third, 10_ms, 10_Hz),
         {{0.001265367898486288, 0.001502576315309072, -0.0007909510648407198, -0.0010281594816635038},
          {1, -2.69648327590608, 2.431086240395493, -0.7336541308221222}},
         1e-13);
}
TEST_CASE("discretize, bilinear: with pre-warp exact at that frequency, and that is how notch is made") {
    CHECK(std::abs(at(bilinear(third, 10_ms, 10_Hz), 10, 10e-3) - at(third, 10)) < 1e-12);
    const double w = 2 * std::numbers::pi * 330;
    const auto d = bilinear(continuous<2>{{w * w, 0, 1}, {w * w, 0.1 * w, 1}}, 500_us, 330_Hz);
    const notch<signal::force> block{{.centre = 330_Hz, .width = 0.1}, 500_us};
    for (const double hz : {0.0, 100.0, 300.0, 335.0, 900.0})
        CHECK(std::abs(at(d, hz, 500e-6) - block.response(hz * 1_Hz)) < 1e-12);
}
TEST_CASE("discretize, bilinear: integrators and differentiators") {
    same(bilinear(continuous<1>{{1}, {0, 1}}, 1_ms), {{0.5e-3, 0.5e-3}, {1, -1}}, 1e-15);
    same(bilinear(continuous<1>{{0, 62.8}, {62.8, 1}}, 1_ms),
         {{62.8 * 2000 / 2062.8, -62.8 * 2000 / 2062.8}, {1, -(2000 - 62.8) / 2062.8}}, 1e-15);
}
TEST_CASE("discretize, matched: poles and zeros by exp(s T), the rest at -1 but for one") {
    // z = list(np.exp(np.roots(num)*.01)) + [-1]; p = np.exp(np.roots(den)*.01), gain at standstill kept
    same(matched(third, 10_ms),
         {{0, 0.002375105711629804, 0.00043053362370731863, -0.0019445720879224854},
          {1, -2.7059234633137925, 2.447602751242925, -0.7408182206817179}},
         1e-13);
}
TEST_CASE("discretize, matched: an anti-resonance stays where it is, without pre-warp") {
    const auto d = matched(resonance, 500_us);
    CHECK(std::abs(at(d, std::sqrt(4e6) / (2 * std::numbers::pi), 500e-6)) < 1e-12);
    CHECK(std::abs(at(d, 0, 500e-6)) == doctest::Approx(4 / 4.2).epsilon(1e-12));
}
TEST_CASE("discretize, matched: with integrators and differentiators the slowest term is kept") {
    const double T = 500e-6;
    const auto d = matched(motor, 500_us); // 1450 / (s (340 s + 850)): near s = 0 it is 1450/850 / s
    CHECK(d.denominator[0] + d.denominator[1] + d.denominator[2] == doctest::Approx(0).scale(1).epsilon(1e-15));
    const double hz = 1e-4;
    CHECK(std::abs(at(d, hz, T)) == doctest::Approx(std::abs(at(motor, hz))).epsilon(1e-6));
    const continuous<2> rate{{0, 5}, {6, 5, 1}};
    CHECK(std::abs(at(matched(rate, 10_ms), hz, 10e-3)) ==
          doctest::Approx(std::abs(at(rate, hz))).epsilon(1e-6));
}
TEST_CASE("discretize: the three agree at low frequencies") {
    for (const double hz : {0.01, 0.1, 1.0}) {
        const auto exact = at(third, hz);
        for (const auto& d : {zero_order_hold(third, 1_ms), bilinear(third, 1_ms), matched(third, 1_ms)})
            CHECK(std::abs(at(d, hz, 1e-3) - exact) <=
                  0.005 * hz + 1e-6 * std::abs(exact)); // half a period of hold, or less
    }
}
TEST_CASE("discretize: derivatives by a coefficient are those of a difference quotient") {
    using D = dual<1>;
    const double h = 1e-5;
    const auto c = [](auto stiffness) {
        return continuous<2, decltype(stiffness)>{
            {decltype(stiffness)(4e6), decltype(stiffness)(0), decltype(stiffness)(1)},
            {stiffness, decltype(stiffness)(40), decltype(stiffness)(1)}};
    };
    const auto check = [&](auto method) {
        const auto d = method(c(D::variable(4.2e6, 0)));
        const auto up = method(c(4.2e6 * (1 + h))), down = method(c(4.2e6 * (1 - h)));
        for (std::size_t i = 0; i <= 2; ++i) {
            CHECK(d.numerator[i].partial[0] * 4.2e6 ==
                  doctest::Approx((up.numerator[i] - down.numerator[i]) / (2 * h)).epsilon(1e-6).scale(0.1));
            CHECK(
                d.denominator[i].partial[0] * 4.2e6 ==
                doctest::Approx((up.denominator[i] - down.denominator[i]) / (2 * h)).epsilon(1e-6).scale(0.1));
        }
    };
    check([](const auto& x) { return zero_order_hold(x, 500_us); });
    check([](const auto& x) { return bilinear(x, 500_us, 100_Hz); });
    check([](const auto& x) { return matched(x, 500_us); });
}
TEST_CASE("discretize: refuses what has no discrete form") {
    CHECK_THROWS_WITH_AS(
        zero_order_hold(continuous<2>{{1}, {1, 1}}, 1_ms),
        "discretize.denominator = 0: highest coefficient must not be zero (coefficients go by rising power)",
        invalid_parameter);
    CHECK_THROWS_AS(bilinear(continuous<1>{{1}, {-2000, 1}}, 1_ms), invalid_parameter); // a pole at s = 2/T
    CHECK_THROWS_AS(matched(continuous<1>{{std::nan("")}, {1, 1}}, 1_ms), invalid_parameter);
    CHECK_THROWS_AS(zero_order_hold(continuous<1>{{1}, {1e12, 1}}, 1_ms), invalid_parameter);
    CHECK_THROWS_AS(bilinear(lag, 1_ms, 500_Hz), invalid_parameter);
    CHECK_THROWS_AS(bilinear(lag, 0_ms), invalid_parameter);
}
