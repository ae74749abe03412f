// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/excitation.hpp>
#include <quadrant/analysis/frf.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/block/maps.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const duration T = 500_us;
using resonance = notch<signal::force>;
const resonance::parameters dip{.centre = 330_Hz, .width = 0.5};
using force = signal::force;
} // namespace

TEST_CASE("fft: is the sum that defines it") {
    std::vector<complex> x(32), y;
    for (std::size_t n = 0; n < x.size(); ++n) x[n] = {std::sin(double(n * n)), std::cos(3.0 * double(n))};
    y = x;
    fft(y);
    for (std::size_t k = 0; k < x.size(); ++k) {
        complex sum = 0;
        for (std::size_t n = 0; n < x.size(); ++n)
            sum += x[n] * std::polar(1.0, -2 * std::numbers::pi * double(n * k) / 32);
        CHECK(std::abs(sum - y[k]) < 1e-12);
    }
    std::vector<complex> odd(12);
    CHECK_THROWS_AS(fft(odd), invalid_parameter);
}
TEST_CASE("excitation: a chirp passes its frequencies when it says, once, and ends at zero") {
    for (const bool logarithmic : {true, false}) {
        chirp<force> c{{2_N, 1_Hz, 100_Hz, 10_s, 0_s, logarithmic}, T};
        int zeros = 0;
        double before = 0, most = 0;
        for (int k = 0; k <= 10000; ++k) { // to the middle
            const double y = c().value();
            most = std::max(most, std::abs(y));
            if (k > 0 && (before < 0) != (y < 0)) ++zeros;
            before = y;
        }
        // cycles to the middle: 10 (sqrt(100) - 1)/ln 100 = 19.54; 10 (0.5 + 99/8) = 128.75
        CHECK(zeros == doctest::Approx(2 * (logarithmic ? 19.54 : 128.75)).epsilon(0.03));
        CHECK(most == doctest::Approx(2).epsilon(1e-3));
        CHECK_FALSE(c.done());
        for (int k = 0; k < 10001; ++k) c();
        CHECK(c.done());
        CHECK(c() == 0_N);
        c.reset();
        CHECK_FALSE(c.done());
    }
    chirp<force> soft{{2_N, 50_Hz, 50_Hz, 1_s, 0.2_s}, T};
    double rise = 0;
    for (int k = 0; k < 20; ++k) rise = std::max(rise, std::abs(soft().value()));
    CHECK(rise < 2 * 0.01); // (1 - cos(pi/20))/2 at most
}
TEST_CASE("excitation: a multisine repeats, has the lines it says and the peak it says") {
    for (const std::uint32_t seed : {0u, 5u}) {
        multisine<force> m{{3_N, 10_Hz, 200_Hz, 1024, 2, seed}, T};
        std::vector<complex> x(1024);
        double most = 0, power = 0;
        for (auto& each : x) each = m().value();
        for (const auto& each : x) {
            CHECK(m().value() == each.real()); // the second time round
            most = std::max(most, std::abs(each));
            power += std::norm(each) / 1024;
        }
        CHECK(most == doctest::Approx(3));
        if (seed == 0) CHECK(most / std::sqrt(power) < 2.2); // crest of a sum of 49 sines; random phases: 3
        fft(x);
        std::vector<std::size_t> loud;
        for (std::size_t k = 0; k < 512; ++k)
            if (std::abs(x[k]) > 1e-6) loud.push_back(k);
        CHECK(loud == m.lines()); // odd ones
        const auto first = multisine<force>{m.given(), T}();
        m(), m.reset();
        CHECK(m() == first);
        CHECK(loud.front() == 7);
        CHECK(loud.back() == 101);
    }
}
TEST_CASE("excitation: put behind a box by type, any wire") {
    using box = injected<resonance, chirp<force>>;
    static_assert(maps<box, force, force>);
    box b{{dip, {2_N, 1_Hz, 100_Hz, 10_s}}, T};
    resonance n{dip, T};
    for (int k = 0; k < 100; ++k) {
        const auto x = std::sin(0.1 * k) * 5_N, y = b(x);
        CHECK((y - b.source().now()).value() == doctest::Approx(n(x).value()));
    }
}
TEST_CASE("excitation: refuses what no line could carry") {
    CHECK_THROWS_AS((chirp<force>{{1_N, 0_Hz, 10_Hz, 1_s}, T}), invalid_parameter);
    CHECK_THROWS_AS((chirp<force>{{1_N, 1_Hz, 1000_Hz, 1_s}, T}), invalid_parameter);
    CHECK_THROWS_AS((chirp<force>{{1_N, 1_Hz, 10_Hz, 1_s, 0.6_s}, T}), invalid_parameter);
    CHECK_THROWS_AS((multisine<force>{{1_N, 10.1_Hz, 10.2_Hz, 64}, T}), invalid_parameter);
    CHECK_THROWS_AS((multisine<force>{{1_N, 10_Hz, 200_Hz, 64, 3}, T}), invalid_parameter);
}
TEST_CASE("frf: a multisine measures the response of a block to rounding, coherence one") {
    multisine<force> excite{{1_N, 1_Hz, 990_Hz, 1024}, T};
    resonance n{dip, T};
    frf<force, force> measure{{.samples = 1024, .overlap = 0, .shape = window::none, .remove = trend::keep}, T};
    for (int k = 0; k < 2048; ++k) n(excite()); // until it repeats
    for (int k = 0; k < 4096; ++k) {
        const auto x = excite();
        measure.add(x, n(x));
    }
    CHECK(measure.windows() == 4);
    const auto result = measure.result();
    CHECK(result.lines.size() == 506); // 1.95 ... 988.3 Hz
    for (const auto& line : result.lines) {
        CHECK(std::abs(line.value - n.response(line.f)) < 1e-9);
        CHECK(line.coherence == doctest::Approx(1).epsilon(1e-9));
    }
}
TEST_CASE("frf: with noise on the output H1 stays right within its spread, and coherence tells the noise") {
    for (const double overlap : {0.0, 0.5, 0.75}) {
        CAPTURE(overlap);
        std::mt19937 random(7);
        std::normal_distribution<double> gauss;
        resonance n{dip, T};
        frf<force, force> measure{{.samples = 512, .overlap = overlap}, T};
        for (int k = 0; k < 200000; ++k) {
            const double x = gauss(random), y = n(x * 1_N).value() + gauss(random);
            measure.add(x * 1_N, y * 1_N);
        }
        double squares = 0, count = 0, coherence = 0;
        for (const auto& line : measure.result().lines) {
            const complex h = n.response(line.f);
            if (std::abs(h) < 0.7 || line.f > 990_Hz) continue;
            squares += std::norm((line.value - h) / (std::abs(line.value) * line.spread)) / 2, ++count;
            coherence += line.coherence - std::norm(h) / (std::norm(h) + 1);
        }
        // The spread is the spread. Some 200 lines, of which Hann couples neighbours: 1 +- 0.1; windows counted
        // as if independent would give 1.06 at half overlap and 1.9 at three quarters.
        CHECK(squares / count == doctest::Approx(1).epsilon(0.2));
        CHECK(std::abs(coherence / count) < 0.01);
    }
}
TEST_CASE("frf: in a closed loop the direct H1 is biased, the ratio of two is not") {
    // y = G u + noise, u = r - C y; G one step late, C = 0.5.
    std::mt19937 random(3);
    std::normal_distribution<double> gauss;
    transfer_function<force, force, 1> g{{{0.0, 1.0}, {1.0, -0.5}}, T};
    frf<force, force> direct{{.samples = 256}, T}, to_u{{.samples = 256}, T}, to_y{{.samples = 256}, T};
    auto y = 0_N;
    for (int k = 0; k < 200000; ++k) {
        const auto r = gauss(random) * 1_N;
        const auto out = y + gauss(random) * 1_N;
        const auto u = r - 0.5 * out;
        direct.add(u, out), to_u.add(r, u), to_y.add(r, out);
        y = g(u);
    }
    // out[k] = (z^-1 G)(u): the loop above holds one step more
    const auto biased = direct.result(), good = ratio(to_y.result(), to_u.result());
    double off_direct = 0, off_ratio = 0;
    for (std::size_t i = 5; i < 100; ++i) {
        const frequency f = good.lines[i].f;
        const complex h = g.response(f) * std::exp(-laplace(f) * T.value());
        off_direct += std::abs(biased.lines[i].value - h) / 95,
            off_ratio += std::abs(good.lines[i].value - h) / 95;
    }
    CHECK(off_ratio < 0.06);
    CHECK(off_direct > 4 * off_ratio);
}
TEST_CASE("frf: a bad sample drops its window, no window is said") {
    frf<force, force> measure{{.samples = 8, .overlap = 0}, T};
    CHECK_THROWS_WITH_AS(measure.result(),
                         "frf.windows = 0: must be one or more: log at least 8 samples without a gap",
                         invalid_parameter);
    for (int k = 0; k < 7; ++k) measure.add(1_N, 1_N);
    measure.add(std::nan("") * 1_N, 1_N);
    for (int k = 0; k < 7; ++k) measure.add(double(k) * 1_N, 1_N);
    CHECK(measure.windows() == 0);
    measure.add(1_N, 1_N);
    CHECK(measure.windows() == 1);
    measure.reset();
    CHECK(measure.windows() == 0);
    CHECK_THROWS_AS((frf<force, force>{{.samples = 1000}, T}), invalid_parameter);
    CHECK_THROWS_AS((frf<force, force>{{.overlap = 1}, T}), invalid_parameter);
}
