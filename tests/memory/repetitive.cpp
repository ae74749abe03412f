// SPDX-License-Identifier: BSL-1.0
// Long: one block: a case for each statement of its page.
#include <quadrant/base/literals.hpp>
#include <quadrant/memory/repetitive.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using plain = repetitive<signal::position, 200, 1, 1, 1>; // L = Q = 1
using twice = repetitive<signal::position, 200, 2, 1, 1>;
using full = repetitive<signal::position, 200, 2, 5, 3>;
double wave(double k, double cycle) { // three harmonics, um
    const double w = 2 * std::numbers::pi * k / cycle;
    return std::cos(w) + 0.5 * std::sin(2 * w + 0.4) - 0.3 * std::cos(3 * w);
}
/// Largest |e| of the last cycle when e = d - y: a loop with T = 1, after `cycles` cycles of a disturbance.
template <class Block> double left(Block& memory, double cycle, int cycles) {
    double y = 0, most = 0;
    const int end = int(cycle * cycles);
    for (int k = 0; k < end; ++k) {
        const double e = wave(k, cycle) * 1e-6 - y; // z^-1: y of the last step
        y = memory(e * 1_m).value();
        if (k >= end - int(cycle)) most = std::max(most, std::abs(e));
    }
    return most * 1e6;
}
/// The sum over a window against the exact one, in units of the bound that detail::fir_taps states, and of the
/// plain sum's.
template <class Real, std::size_t Taps> void sums_within_bound(std::mt19937& random) {
    std::uniform_real_distribution<double> any(-1, 1);
    detail::fir_taps<Real, Taps> taps;
    detail::fir_window<Real, detail::fir_taps<Real, Taps>::size> window;
    for (std::size_t i = 0; i < Taps; ++i) taps[i] = Real(any(random) * std::exp2(20 * any(random)));
    std::vector<Real> past(Taps);
    for (int k = 0; k < 1000; ++k) {
        window.put(std::numeric_limits<Real>::quiet_NaN()); // put again: forgotten
        past.insert(past.begin(), Real(any(random) * std::exp2(20 * any(random))));
        window.put(past[0]);
        long double exact = 0, size = 0;
        for (std::size_t i = 0; i < Taps; ++i) {
            REQUIRE(window.ago(i) == past[i]);
            exact += (long double)taps[i] * (long double)past[i];
            size += std::abs((long double)taps[i] * (long double)past[i]);
        }
        const double roundings = Taps < 4 ? double(Taps) : double(taps.size) / 4 + 2;
        const double bound = roundings * double(std::numeric_limits<Real>::epsilon()) / 2 * double(size);
        CHECK(std::abs(double((long double)taps(window.oldest()) - exact)) <= bound * (1 + 1e-6));
        window.advance();
    }
}
} // namespace

TEST_CASE("repetitive: the sums over its windows keep their bound, at random, wherever the ring stands") {
    std::mt19937 random(7);
    sums_within_bound<double, 1>(random);
    sums_within_bound<double, 3>(random);
    sums_within_bound<double, 4>(random);
    sums_within_bound<double, 61>(random);
    sums_within_bound<double, 90>(random);
    sums_within_bound<float, 5>(random);
    sums_within_bound<float, 90>(random);
}
TEST_CASE("repetitive: with 90 and 61 taps it is its equation, written down without a ring, to 1e-12 of the "
          "largest output") {
    using large = repetitive<signal::position, 100, 2>;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1, 1);
    large::parameters p{.cycle = 77.3_ms, .weights = {1.2, -0.4}, .ahead = 31};
    for (double& tap : p.learning) tap = any(random) / 20;
    for (std::size_t i = 0; i < 61; ++i) p.smoothing[i] = i > 30 ? p.smoothing[60 - i] : any(random) / 20;
    large memory{p, 1_ms};
    std::vector<long double> m, q, r; // e + r, Q (e + r) half a Q late, r from 31 samples ahead
    const auto at = [](const std::vector<long double>& x, std::size_t late) {
        return late < x.size() ? x[x.size() - 1 - late] : 0;
    };
    long double worst = 0, most = 0;
    for (int k = 0; k < 2000; ++k) {
        const double e = any(random);
        long double early = 0, learnt = 0, smooth = 0;
        for (std::size_t i = 0; i < 2; ++i) {
            const long double delay = (i + 1) * 77.3L, u = delay - std::floor(delay);
            const auto newest =
                std::size_t(std::floor(delay)) - 31 - 30 - 2; // of the four; q ends a sample ago
            const long double cubic[] = {-u * (1 - u) * (2 - u) / 6, (1 + u) * (1 - u) * (2 - u) / 2,
                                         (1 + u) * u * (2 - u) / 2, -(1 + u) * u * (1 - u) / 6};
            for (std::size_t j = 0; j < 4; ++j) early += p.weights[i] * cubic[j] * at(q, newest + j);
        }
        r.push_back(early);
        m.push_back(e + at(r, 31));
        for (std::size_t i = 0; i < 61; ++i) smooth += p.smoothing[i] * at(m, i);
        for (std::size_t i = 0; i < 90; ++i) learnt += p.learning[i] * at(r, i);
        q.push_back(smooth);
        most = std::max(most, std::abs(learnt));
        worst = std::max(worst, std::abs(learnt - (long double)memory(e * 1_m).value()));
    }
    CHECK(most > 0.1);
    CHECK(double(worst / most) < 1e-12);
}

TEST_CASE("repetitive: order 1 gives the error back one cycle later, and keeps adding") {
    plain m{{.cycle = 10_ms}, 1_ms};
    for (int k = 0; k < 35; ++k) {
        const double y = m((k == 3 ? 1.0 : 0.0) * 1_um).value();
        CHECK(y ==
              doctest::Approx(k == 13 || k == 23 || k == 33 ? 1e-6 : 0).epsilon(1e-12)); // r repeats for ever
    }
}
TEST_CASE("repetitive: order 2 with weights 2, -1 answers an impulse by 2, 3, 4") {
    twice m{{.cycle = 10_ms, .weights = {2, -1}}, 1_ms}; // r = 2 (e + r) z^-N - (e + r) z^-2N
    double at10 = 0, at20 = 0, at30 = 0;
    for (int k = 0; k <= 30; ++k) {
        const double y = m((k == 0 ? 1.0 : 0.0) * 1_m).value();
        if (k == 10) at10 = y;
        if (k == 20) at20 = y;
        if (k == 30) at30 = y;
    }
    CHECK(at10 == doctest::Approx(2));
    CHECK(at20 == doctest::Approx(3));
    CHECK(at30 == doctest::Approx(4));
}
TEST_CASE("repetitive: look-ahead of L and Q goes into the delay, an impulse shows it tap by tap") {
    // L: 2 ahead; Q: 1 ahead. y[k] = sum l q e[k - N + ...]: the convolution of both, centred on one cycle
    // later.
    full m{
        {.cycle = 20_ms, .weights = {1, 0}, .learning = {1, 2, 3, 4, 5}, .ahead = 2, .smoothing = {7, 11, 7}},
        1_ms};
    const double both[] = {7, 25, 50, 75, 100, 83, 35}; // conv([1,2,3,4,5],[7,11,7]), from N - 3 on
    for (int k = 0; k < 30; ++k) {
        const double y = m((k == 0 ? 1.0 : 0.0) * 1_m).value();
        CHECK(y == doctest::Approx(k >= 17 && k <= 23 ? both[k - 17] : 0));
    }
}
TEST_CASE("repetitive: what repeats dies out, with a cycle of whole and of broken periods") {
    // y of sample k acts at k + 1, so L looks one sample ahead: the inverse of T = z^-1.
    using inverse = repetitive<signal::position, 200, 1, 2, 1>;
    for (const double cycle : {80.0, 85.87, 60.5, 200.0}) {
        CAPTURE(cycle);
        inverse m{{.cycle = cycle * 1_ms, .learning = {1, 0}, .ahead = 1}, 1_ms};
        // 2 um before; what is left is the interpolation of a third harmonic between samples, learnt over and
        // over
        CHECK(left(m, cycle, 20) < 2e-3);
    }
    inverse rounded{{.cycle = 85_ms, .learning = {1, 0}, .ahead = 1}, 1_ms};
    CHECK(left(rounded, 85.87, 20) > 0.05); // a whole number only: |1 - e^{j w N}| of 1 % is 6 % and more
}
TEST_CASE(
    "repetitive: a change of cycle fades, no step is larger than the memory's own plus its share of the fade") {
    for (const double to : {40.0, 99.3, 50.5}) {
        CAPTURE(to);
        plain m{{.cycle = 50_ms, .fade = 25_ms}, 1_ms};
        double last = 0, most = 0;
        for (int k = 0; k < 300; ++k) {
            if (k == 137) m.cycle(to * 1_ms);
            const double y = m(k < 50 ? wave(k, 50) * 1_um : 0_um).value() * 1e6;
            if (k > 60) most = std::max(most, std::abs(y - last));
            last = y;
            if (k == 137 + 23) CHECK(m.fading());
            if (k == 137 + 25) CHECK_FALSE(m.fading());
        }
        // amplitude 1.8 at most, slope of the wave 0.36 a sample; the fade adds 2 * 1.8 / 25
        CHECK(most < 0.36 + 0.15);
        CHECK(m.cycle().value() == doctest::Approx(to * 1e-3).scale(0));
    }
}
TEST_CASE("repetitive: of several changes during a fade the last one wins, after the fade") {
    plain m{{.cycle = 50_ms, .fade = 10_ms}, 1_ms};
    m.cycle(60_ms), m.cycle(70_ms), m.cycle(80_ms);
    CHECK(m.cycle().value() == doctest::Approx(60e-3).scale(0));
    for (int k = 0; k < 10; ++k) m(0_m);
    CHECK(m.fading());
    CHECK(m.cycle().value() == doctest::Approx(80e-3).scale(0));
    for (int k = 0; k < 10; ++k) m(0_m);
    CHECK_FALSE(m.fading());
    m.cycle(80_ms); // the same: nothing to fade
    CHECK_FALSE(m.fading());
}
TEST_CASE("repetitive: a cycle outside its range saturates, and it says so; reset goes back") {
    full m{{.cycle = 20_ms, .ahead = 2}, 1_ms};
    m.cycle(1_s);
    CHECK(m.limited());
    CHECK(m.cycle().value() == doctest::Approx(0.2).scale(0));
    m.cycle(2_ms);
    for (int k = 0; k < 500; ++k) m(1_um);
    CHECK(m.limited());
    CHECK(m.cycle().value() == doctest::Approx(5e-3).scale(0));
    m.cycle(quantity<si::time>::from_value(std::nan("")));
    CHECK(m.faulted());
    m.reset();
    CHECK_FALSE(m.limited());
    CHECK_FALSE(m.faulted());
    CHECK(m.cycle().value() == doctest::Approx(20e-3).scale(0));
}
TEST_CASE("repetitive: a bad sample in a fade changes nothing but the flag") {
    plain a{{.cycle = 50_ms}, 1_ms};
    for (int k = 0; k < 120; ++k) a(wave(k, 50) * 1_um);
    a.cycle(60_ms);
    plain b = a;
    for (int k = 0; k < 200; ++k) {
        if (k % 7 == 0) a(std::nan("") * 1_um);
        CHECK(a(wave(k, 60) * 1_um) == b(wave(k, 60) * 1_um));
    }
}
TEST_CASE("repetitive: settles where its memory leaks, starts without a bump where it does not") {
    full leaky{{.cycle = 20_ms, .weights = {0.6, 0.3}, .learning = {0, 0.5, 0, 0, 0}, .ahead = 2}, 1_ms};
    CHECK_FALSE(leaky.integrates());
    leaky.settle(1_um);
    for (int k = 0; k < 100; ++k)
        CHECK(leaky(1_um).value() == doctest::Approx(0.5 * 9e-6).scale(0)); // 0.9 / (1 - 0.9)
    full whole{{.cycle = 20_ms, .weights = {2, -1}, .smoothing = {0.25, 0.5, 0.25}}, 1_ms};
    CHECK(whole.integrates());
    whole.settle(0_um, 3_um);
    for (int k = 0; k < 100; ++k) CHECK(whole(0_um).value() == doctest::Approx(3e-6).scale(0));
}
TEST_CASE(
    "repetitive: switched off (weights, Q or L of sum zero) it settles without a fault and gives nothing") {
    full off{{.cycle = 20_ms, .weights = {0, 0}, .smoothing = {0.25, 0.5, 0.25}}, 1_ms};
    full band{{.cycle = 20_ms, .smoothing = {-0.25, 0.5, -0.25}}, 1_ms}; // Q passes no constant
    full step{{.cycle = 20_ms, .learning = {1, -1}}, 1_ms}; // nor does L; but the memory integrates an error
    full leak{{.cycle = 20_ms, .weights = {0.5, 0.2}, .learning = {1, -1}}, 1_ms};
    for (full* m : {&off, &band, &step, &leak})
        for (const auto& x : {0_um, m == &step ? 0_um : 2_um}) {
            (*m)(3_um);
            m->settle(x, 0_um);
            CHECK_FALSE(m->faulted());
            for (int k = 0; k < 60; ++k) CHECK(std::abs((*m)(x).value()) < 1e-20);
        }
    off.settle(1_um, 5_um); // what it never gives
    CHECK_FALSE(off.faulted());
    CHECK(off(1_um) == 0_um);
    off.settle(1_um, std::nan("") * 1_um);
    CHECK(off.faulted());
}
TEST_CASE("repetitive: refuses what cannot be") {
    CHECK_THROWS_WITH_AS(
        (full{{.cycle = 4_ms, .ahead = 2}, 1_ms}),
        "repetitive.cycle = 0.004 s: must lie between 0.005 s (look-ahead of learning and smoothing, "
        "and two periods) and 0.2 s (capacity)",
        invalid_parameter);
    CHECK_THROWS_AS((full{{.cycle = 201_ms}, 1_ms}), invalid_parameter);
    CHECK_THROWS_AS((full{{.cycle = std::nan("") * 1_ms}, 1_ms}), invalid_parameter);
    CHECK_NOTHROW((full{{.cycle = 5_ms, .ahead = 2}, 1_ms}));
    CHECK_THROWS_WITH_AS((full{{.cycle = 20_ms, .ahead = 5}, 1_ms}),
                         "repetitive.ahead = 5: must be below the taps of learning (5)", invalid_parameter);
    CHECK_THROWS_WITH_AS((full{{.cycle = 20_ms, .smoothing = {1, 2, 3}}, 1_ms}),
                         "repetitive.smoothing = 1: must be symmetric (linear phase)", invalid_parameter);
    CHECK_THROWS_AS((full{{.cycle = 20_ms, .weights = {1, std::nan("")}}, 1_ms}), invalid_parameter);
    CHECK_THROWS_AS((full{{.cycle = 20_ms, .learning = {INFINITY}}, 1_ms}), invalid_parameter);
    CHECK_THROWS_AS((full{{.cycle = 20_ms, .fade = -1_ms}, 1_ms}), invalid_parameter);
    CHECK_THROWS_AS((full{{.cycle = 20_ms}, 0_ms}), invalid_parameter);
}
