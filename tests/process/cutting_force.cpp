// SPDX-License-Identifier: BSL-1.0
#include <quadrant/base/dual.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/process/milling_harmonics.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
const duration T = 500_us;
const cutting_force<15>::parameters whole_x{milling_harmonics::fundamental, milling_harmonics::scale,
                                            milling_harmonics::x};
const cutting_force<15>::parameters whole_y{milling_harmonics::fundamental, milling_harmonics::scale,
                                            milling_harmonics::y};

/// Eq. (3.10) as it is printed, in long double [N].
template <std::size_t N> double brute(const harmonic_table<N>& table, long double hertz, long double t) {
    long double sum = 0;
    for (std::size_t i = 0; i < N; ++i) {
        const long double turns = hertz * t * static_cast<long double>(i + 1);
        const long double angle = 2 * std::numbers::pi_v<long double> * (turns - std::floor(turns));
        sum += static_cast<long double>(table.real[i]) * std::cos(angle) -
               static_cast<long double>(table.imaginary[i]) * std::sin(angle);
    }
    return double(sum * 2 / 6053);
}
} // namespace

TEST_CASE("cutting_force: the sum of eq. (3.10), sample by sample, to 1e-11 N of 140 N") {
    for (const auto& p : {whole_x, whole_y}) {
        cutting_force<15> force{p, T};
        double off = 0;
        for (int k = 0; k < 4000; ++k)
            off = std::max(off, std::abs(force().value() - brute(p.harmonics, 23.294L, k * 0.0005L)));
        CHECK(off < 1e-11);
    }
}

TEST_CASE("cutting_force: in phase to 1e-8 N after ten hours at 2 kHz, stepped sample by sample") {
    cutting_force<1> force{{23.294_Hz, 100_N, {{1.0}, {0.0}}}, T};
    constexpr long samples = 72'000'000; // the angle alone is stepped: 72 million sines would take seconds
    turning_phase turn{23.294_Hz, T};
    for (long k = 0; k < samples; ++k) turn.advance();
    force.settle(T * double(samples));
    const double exact = brute<1>({{1.0}, {0.0}}, static_cast<long double>(23.294),
                                  static_cast<long double>(T.value()) * samples) *
                         6053 / 2 * 100;
    CHECK(100 * std::cos(turn.angle()) == doctest::Approx(exact).epsilon(1e-10));
    CHECK(force().value() == doctest::Approx(exact).epsilon(1e-10));
}

TEST_CASE("cutting_force: repeats with the turn of the spindle, 8000 samples of 4 Hz harmonics are the same "
          "500 again") {
    cutting_force<3> force{{4_Hz, 1_N, {{1.0, 2.0, -3.0}, {0.5, 0.0, 1.0}}}, T};
    std::vector<double> turn;
    double off = 0;
    for (std::size_t k = 0; k < 8000; ++k) {
        const double f = force().value();
        if (k < 500)
            turn.push_back(f);
        else
            off = std::max(off, std::abs(f - turn[k % 500]));
    }
    CHECK(off < 1e-12);
}

TEST_CASE("cutting_force: the published tables have peaks of 144 N on x and 130 N on y at our scale") {
    const auto peak = [](const cutting_force<15>::parameters& p) {
        cutting_force<15> force{p, 50_us};
        double most = 0;
        for (int k = 0; k < 20'000; ++k) most = std::max(most, std::abs(force().value()));
        return most;
    };
    CHECK(std::abs(peak(whole_x) - 144) < 0.5);
    CHECK(std::abs(peak(whole_y) - 130) < 0.5);
}

TEST_CASE("cutting_force: the tool enters and leaves within `entry`, without a jump, and the phase goes on") {
    auto p = whole_y;
    p.entry = 100_ms;
    cutting_force<15> force{p, T}, always{whole_y, T};
    double gate = 0, before = 0, full_before = 0,
           off = 0; // gate: what a step is larger than that of the cut alone
    for (int k = 0; k < 1000; ++k) {
        if (k == 200) force.engage(false);
        if (k == 600) force.engage(true);
        const double f = force().value(), full = always().value();
        const double ramp = k <= 200  ? 1
                            : k < 600 ? std::max(0.0, 1 - (k - 200) / 200.0)
                                      : std::min(1.0, (k - 600) / 200.0);
        off = std::max(off, std::abs(f - ramp * full));
        if (k > 0) gate = std::max(gate, std::abs(f - before) - std::abs(full - full_before));
        before = f, full_before = full;
    }
    CHECK(off < 1e-10);
    CHECK(gate < 149 / 200.0); // the peak by the samples of the ramp; a hard gate jumps by the whole force
    CHECK(force.now().tool.depth() == doctest::Approx(1));

    force.settle(0_s, false);
    CHECK(force().value() == 0);
}

TEST_CASE("cutting_force: settle(t) is where t of stepping leads, reset is t = 0") {
    cutting_force<15> stepped{whole_x, T}, settled{whole_x, T}, fresh{whole_x, T};
    for (int k = 0; k < 12345; ++k) stepped();
    settled.settle(12345.0 * T);
    CHECK(settled().value() == doctest::Approx(stepped().value()).epsilon(1e-11));
    settled.settle(std::numeric_limits<double>::quiet_NaN() * 1_s); // changes nothing
    CHECK(settled().value() == doctest::Approx(stepped().value()).epsilon(1e-11));
    stepped.reset();
    CHECK(stepped().value() == fresh().value());
}

TEST_CASE("cutting_force: the lowest harmonics alone are the first terms of the table") {
    cutting_force<3> force{
        {milling_harmonics::fundamental, milling_harmonics::scale, lowest<3>(milling_harmonics::x)}, T};
    for (int k = 0; k < 100; ++k) {
        const double expected = brute(lowest<3>(milling_harmonics::x), 23.294L, k * 0.0005L);
        CHECK(force().value() == doctest::Approx(expected).epsilon(1e-10));
    }
}

TEST_CASE("cutting_force: refuses a harmonic above half the sampling rate, and what is not finite") {
    using c = cutting_force<15>;
    const auto refuse = [](c::parameters p, auto change, const char* words) {
        change(p);
        CHECK_THROWS_WITH_AS((c{p, T}), words, invalid_parameter);
    };
    refuse(
        whole_x, [](auto& p) { p.fundamental = 70_Hz; },
        "cutting_force.fundamental = 70 Hz: must lie between 0 and half the sampling rate by the number of "
        "harmonics "
        "(66.66666666666667 Hz)");
    refuse(
        whole_x, [](auto& p) { p.fundamental = 0_Hz; },
        "cutting_force.fundamental = 0 Hz: must lie between 0 and half the sampling rate by the number of "
        "harmonics "
        "(66.66666666666667 Hz)");
    refuse(
        whole_x, [](auto& p) { p.scale = std::numeric_limits<double>::infinity() * 1_N; },
        "cutting_force.scale = inf N: must be finite");
    refuse(
        whole_x, [](auto& p) { p.harmonics.imaginary[7] = std::nan(""); },
        "cutting_force.harmonics.imaginary = nan N: must be finite");
    refuse(
        whole_x, [](auto& p) { p.entry = -1_ms; },
        "cutting_force.entry = -0.001 s: must be finite and not below 0");
    CHECK_THROWS_WITH_AS((c{whole_x, 0_s}), "cutting_force.period = 0 s: must be finite and above 0",
                         invalid_parameter);
}
