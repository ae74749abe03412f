// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/modes.hpp>
#include <quadrant/analysis/notch_design.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace quadrant::literals;
namespace qa = quadrant::analysis;
using qa::hertz;
using quadrant::invalid_parameter;
using velocity = quadrant::signal::velocity;

namespace {
const quadrant::duration T = 500_us;
const qa::rigid_axis_model<> rigid{28.57 / 1_s, 4.526_mps2 / 1_V, 0.65_ms};
/// Lines 1 Hz apart, as a window of 2048 samples at 2 kHz gives.
qa::measured_frf of(const qa::flexible_axis_model<>& g) {
    qa::measured_frf out{{}, 1};
    for (double f = 2; f < 950; f += 1) out.lines.push_back({hertz(f), g(hertz(f)), 1, 0});
    return out;
}
const qa::notch_rule rule{.above = 100_Hz, .crossover = 41_Hz};
std::string refused(const qa::measured_frf& frf, const qa::notch_rule& r) {
    try {
        qa::design_notch<velocity>(frf, T, r);
    } catch (const invalid_parameter& e) {
        return e.what();
    }
    return "not refused";
}
} // namespace

TEST_CASE("design_notch: over many axes it stands on the mode and attenuates the whole peak as asked") {
    std::mt19937 random(3);
    const auto between = [&](double low, double high) {
        return low + (high - low) * (double(random()) / double(std::mt19937::max()));
    };
    for (int i = 0; i < 50; ++i) {
        CAPTURE(i);
        const double centre = between(230, 500), zeta = between(0.006, 0.02);
        const qa::flexible_axis_model<> g{rigid,
                                          {{47_Hz, 0.05, 0.2}, {hertz(centre), zeta, between(0.2, 0.5)}}};
        const auto d = qa::design_notch<velocity>(of(g), T, rule);
        CHECK(d.parameters.centre.value() == doctest::Approx(centre).epsilon(0.005));
        CHECK(d.damping == doctest::Approx(zeta).epsilon(0.25).scale(
                               0)); // lines 1 Hz apart, the slope of the rigid axis below
        const quadrant::notch<velocity> n(d.parameters, T);
        // Half power of f |G|, walked down from its top in steps of 10 mHz: within half a line.
        const auto speed = [&](double f) { return f * std::abs(g(hertz(f))); };
        double top = centre, half_low, half_high;
        for (double f = 0.95 * centre; f < 1.05 * centre; f += 0.01)
            if (speed(f) > speed(top)) top = f;
        for (half_low = top; speed(half_low) > speed(top) * std::sqrt(0.5);) half_low -= 0.01;
        for (half_high = top; speed(half_high) > speed(top) * std::sqrt(0.5);) half_high += 0.01;
        CHECK(d.low.value() <= half_low + 0.5);
        CHECK(d.high.value() >= half_high - 0.5);
        double least = 0;
        for (double f = d.low.value(); f <= d.high.value(); f += 0.1)
            least = std::max(least, std::abs(n.response(hertz(f))));
        CHECK(qa::decibel(least) <= -20 + 1e-6);
        // One end is just attenuated enough: no wider than needed.
        CHECK(std::max(std::abs(n.response(d.low)), std::abs(n.response(d.high))) ==
              doctest::Approx(0.1).epsilon(1e-6));
        CHECK(d.phase_cost == doctest::Approx(-std::arg(n.response(41_Hz)) * 180 / std::numbers::pi));
        CHECK(d.phase_cost > 0);
    }
}
TEST_CASE(
    "design_notch: of two modes the one that is higher in the velocity response, never one below the limit") {
    const qa::flexible_axis_model<> g{rigid, {{47_Hz, 0.01, 0.5}, {220_Hz, 0.02, 0.1}, {330_Hz, 0.02, 0.4}}};
    CHECK(qa::design_notch<velocity>(of(g), T, rule).parameters.centre.value() ==
          doctest::Approx(330).epsilon(0.01));
    auto low = rule;
    low.above = 340_Hz;
    CHECK(refused(of(g), low).find("design_notch.above = 340 Hz: no peak above it stands out by 3 dB") == 0);
}
TEST_CASE("design_notch: drift widens it") {
    const qa::flexible_axis_model<> g{rigid, {{330_Hz, 0.01, 0.3}}};
    auto wide = rule;
    wide.drift = 0.05;
    const auto d = qa::design_notch<velocity>(of(g), T, rule), e = qa::design_notch<velocity>(of(g), T, wide);
    CHECK(e.parameters.width > 2 * d.parameters.width);
    CHECK(e.low.value() == doctest::Approx(0.95 * e.parameters.centre.value()));
}
TEST_CASE("design_notch: refuses what the response forbids, each by its rule") {
    const qa::flexible_axis_model<> none{rigid, {}}, fast{rigid, {{900_Hz, 0.02, 0.5}}},
        slow{rigid, {{110_Hz, 0.05, 0.5}}}, good{rigid, {{330_Hz, 0.01, 0.3}}};
    CHECK(refused(of(none), rule).find("no peak above it") != std::string::npos);
    auto much = rule;
    much.attenuation_db = 30;
    CHECK(refused(of(fast), much).find("must lie below half the sampling rate (1000 Hz)") != std::string::npos);
    auto near = rule;
    near.crossover = 90_Hz;
    near.most_phase = 90;
    CHECK(refused(of(slow), near)
              .find("must lie above the crossover (90 Hz): the peak lies in the band of the loop") !=
          std::string::npos);
    auto strict = rule;
    strict.most_phase = 0.5;
    CHECK(refused(of(good), strict).find("design_notch: phase at the crossover = ") == 0);
    auto bad = rule;
    bad.drift = 0.6;
    CHECK(refused(of(good), bad) == "design_notch.drift = 0.6: must lie between 0 and 0.5");
    bad = rule;
    bad.crossover = 0_Hz;
    CHECK(refused(of(good), bad).find("design_notch.crossover = 0 Hz") == 0);
}
TEST_CASE("design_notch: a line without coherence is no peak") {
    auto frf = of({rigid, {{330_Hz, 0.01, 0.3}}});
    frf.lines[600].value *= 1e3, frf.lines[600].coherence = 0.1;
    CHECK(qa::design_notch<velocity>(frf, T, rule).parameters.centre.value() ==
          doctest::Approx(330).epsilon(0.005));
}
