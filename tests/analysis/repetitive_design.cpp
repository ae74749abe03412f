// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/loop.hpp>
#include <quadrant/analysis/repetitive_design.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const duration T = 500_us;
const frequency spindle = hertz(23.294);
const auto one = [](frequency) { return complex(1); };
const p_pi_loop x{analysis::axis_model<>{28.57 / 1_s, 4.526_mps2 / 1_V, 0.65_ms}, pi_model<>{60_V / 1_mps, 450_V / 1_m},
                  in_series{derivative_model{150_Hz}, notch_model{330.03_Hz, 0.0606}}, 150.0 / 1_s};
const auto closed = [](frequency f) { return x.tracking(f); };
template <std::size_t Order> auto ideal(const std::array<double, Order>& w, std::size_t harmonics) {
    return performance(one, one, one, w,
                       {.cycle = period_of(spindle), .harmonics = harmonics, .bandwidth = 10.0 * spindle});
}
} // namespace

TEST_CASE("repetitive_design: closed-form indices of order 1 and of weights 2, -1") {
    const double pi_ = std::numbers::pi;
    const std::array<double, 1> first{1};
    const std::array<double, 2> second{2, -1};
    CHECK(ideal(first, 1).periodic == doctest::Approx(2 * std::sin(0.01 * pi_)).epsilon(1e-9)); // 0.0628
    CHECK(ideal(first, 1).non_periodic_db == doctest::Approx(decibel(2)).epsilon(1e-9));        // 6.02 dB
    CHECK(ideal(first, 8).periodic == doctest::Approx(2 * std::sin(0.08 * pi_)).epsilon(1e-9)); // 0.50
    CHECK(ideal(second, 1).periodic == doctest::Approx(std::pow(2 * std::sin(0.01 * pi_), 2)).epsilon(1e-9));
    CHECK(ideal(second, 1).non_periodic_db == doctest::Approx(decibel(4)).epsilon(1e-9)); // 12 dB
    CHECK(ideal(second, 8).periodic == doctest::Approx(std::pow(2 * std::sin(0.08 * pi_), 2)).epsilon(1e-9));
}
TEST_CASE("repetitive_design: weights for a stated amplification have it, and the most that the cycle may then "
          "be off") {
    for (const double db : {6.03, 8.0, 10.0, 12.0}) {
        const auto two = repetitive_weights<2>(db);
        const auto three = repetitive_weights<3>(db);
        CHECK(ideal(two, 1).non_periodic_db == doctest::Approx(db).epsilon(1e-6));
        CHECK(ideal(three, 1).non_periodic_db == doctest::Approx(db).epsilon(1e-6));
        CHECK(two[0] + two[1] == doctest::Approx(1)); // nothing of the cycle gets through
        CHECK(three[0] + three[1] + three[2] == doctest::Approx(1));
        CHECK(ideal(two, 8).periodic <= 2 * std::sin(0.08 * std::numbers::pi)); // better than order 1
    }
    const auto flat = repetitive_weights<2>(12.04);
    CHECK(flat[0] == doctest::Approx(2).epsilon(1e-3));
    CHECK(flat[1] == doctest::Approx(-1).epsilon(2e-3));
    CHECK(repetitive_weights<1>(6.02)[0] == 1);
    const auto cubic = repetitive_weights<3>(18.06);
    CHECK(cubic[0] == doctest::Approx(3).epsilon(1e-3));
    CHECK(cubic[2] == doctest::Approx(1).epsilon(2e-3));
    CHECK_THROWS_AS(repetitive_weights<2>(3), invalid_parameter);
    CHECK_THROWS_AS(repetitive_weights<2>(13), invalid_parameter);
}
TEST_CASE("repetitive_design: Q has no phase, gain one at standstill and half of it at its corner") {
    const auto q = smoothing_filter<61>(200_Hz, T);
    CHECK(std::abs(q(0_Hz) - 1.0) < 1e-14);
    CHECK(std::abs(q(200_Hz)) == doctest::Approx(0.5).epsilon(0.01));
    CHECK(std::abs(q(300_Hz)) < 0.005);
    CHECK(std::abs(q(100_Hz) - 1.0) < 0.005);
    for (double f = 0; f < 1000; f += 7) {
        CHECK(std::abs(q(hertz(f)).imag()) < 1e-12);
        CHECK(std::abs(q(hertz(f))) < 1.005);
    }
}
TEST_CASE("repetitive_design: 90 taps, 30 ahead, invert the thesis' x loop to 0.002 within Q") {
    const auto q = smoothing_filter<61>(200_Hz, T);
    const auto l = learning_filter<90>(closed, q, 30, T);
    const auto worst = mismatch(closed, l, q, up_to_nyquist(T));
    CAPTURE(worst.at.value());
    CHECK(worst.value < 0.002); // 0.0015; plain least squares, without the rounds: 0.0028
    CHECK(mismatch(closed, learning_filter<90>(closed, q, 30, T, {}, 1e-4, 0), q, up_to_nyquist(T)).value <
          0.003);
    const std::array<double, 2> second{2, -1};
    CHECK(stability(closed, l, q, second, up_to_nyquist(T)).value == doctest::Approx(3 * worst.value));
    // with real filters the indices stay those of the closed form where Q is one
    const auto p =
        performance(closed, l, q, std::array<double, 1>{1}, {.cycle = period_of(spindle), .bandwidth = 100_Hz});
    CHECK(p.periodic == doctest::Approx(0.0628).epsilon(0.05).scale(0));
    CHECK(p.non_periodic_db == doctest::Approx(6.02).epsilon(0.02));
}
TEST_CASE("repetitive_design: a measured T gives the same L as the model it was measured on") {
    std::vector<frequency> lines;
    std::vector<complex> values;
    for (double f = 0.5; f <= 600; f += 0.5) lines.push_back(hertz(f)), values.push_back(closed(hertz(f)));
    const tabulated_response measured(lines, values);
    const auto q = smoothing_filter<61>(200_Hz, T);
    const span known{1_Hz, 600_Hz, 600};
    const auto l = learning_filter<90>(measured, q, 30, T, known);
    CHECK(mismatch(closed, l, q, known).value < 0.004);
    CHECK_THROWS_AS(learning_filter<90>(measured, q, 30, T),
                    invalid_parameter); // nothing measured above 600 Hz
}
TEST_CASE("repetitive_design: the designed block in a sampled loop takes a repeating error to a hundredth") {
    // T here is sampled: two periods late and a pole at 0.8, the loop around it simulated sample by sample.
    const auto t = [](frequency f) {
        const complex back = std::exp(-laplace(f) * T.value());
        return 0.2 * back * back / (1.0 - 0.8 * back);
    };
    const auto q = smoothing_filter<61>(200_Hz, T);
    const auto l = learning_filter<90>(t, q, 30, T);
    using block = repetitive<signal::position, 100, 2>;
    const duration cycle = period_of(spindle); // 85.86 periods
    block memory(repetitive_parameters<block>(t, std::array<double, 2>{2, -1}, l, q, cycle, up_to_nyquist(T)),
                 T);
    double y = 0, added = 0, first = 0, end = 0;
    for (int k = 0; k < 4000; ++k) {
        const double w = laplace(spindle).imag() * T.value() * k;
        const double e = std::cos(w) + 0.3 * std::sin(3 * w) - y;
        if (k < 80) first = std::max(first, std::abs(e));
        if (k >= 3900) end = std::max(end, std::abs(e));
        const double now = memory(e * 1_um).value() * 1e6;
        y = 0.8 * y + 0.2 * added; // at k + 1: two periods behind its input
        added = now;
    }
    CHECK(first > 1);
    CHECK(end < 0.01);
}
TEST_CASE("repetitive_design: a stated margin is kept or refused") {
    const auto q = smoothing_filter<61>(200_Hz, T);
    const auto l = learning_filter<90>(closed, q, 30, T);
    using block = repetitive<signal::position, 100, 2>;
    const std::array<double, 2> w{2, -1};
    const auto with = [&](double margin) {
        return repetitive_parameters<block>(closed, w, l, q, 42.93_ms, up_to_nyquist(T), margin);
    };
    const double worst = 3 * mismatch(closed, l, q, up_to_nyquist(T)).value; // sum |w| = 3
    CHECK_NOTHROW(with(1 - worst - 1e-6));
    CHECK_THROWS_AS(with(1 - worst + 1e-6), invalid_parameter);
    CHECK_THROWS_AS(with(1), invalid_parameter);
}
TEST_CASE("repetitive_design: refuses a loop that does not converge, and bad questions") {
    const auto q = smoothing_filter<61>(200_Hz, T);
    fir<90> none{{}, 30, T}; // L = 0
    using block = repetitive<signal::position, 100, 2>;
    CHECK_THROWS_AS(
        repetitive_parameters<block>(closed, std::array<double, 2>{2, -1}, none, q, 42.93_ms, up_to_nyquist(T)),
        invalid_parameter);
    CHECK_THROWS_AS(smoothing_filter<61>(1200_Hz, T), invalid_parameter);
    CHECK_THROWS_AS(learning_filter<90>(closed, q, 90, T), invalid_parameter);
    CHECK_THROWS_AS(learning_filter<90>(closed, q, 30, T, span{0_Hz, 1200_Hz}), invalid_parameter);
    CHECK_THROWS_AS(performance(one, one, one, std::array<double, 1>{1}, {.cycle = 0_s, .bandwidth = 1_Hz}),
                    invalid_parameter);
}
