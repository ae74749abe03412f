// SPDX-License-Identifier: BSL-1.0
#include "modal_axis.hpp"

#include <quadrant/analysis/excitation.hpp>
#include <quadrant/analysis/fit_modes.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace quadrant::literals;
namespace qa = quadrant::analysis;
using qa::hertz;

namespace {
const qa::rigid_axis_model<> rigid{28.57 / 1_s, 4.526_mps2 / 1_V, 0.4_ms};
const qa::flexible_axis_model<> truth{rigid, {{47_Hz, 0.03, 0.15}, {312_Hz, 0.015, -0.08}}};

/// The model with a relative error of `spread` on every line, 2 Hz apart.
qa::measured_frf noisy(const qa::flexible_axis_model<>& g, double spread, unsigned seed, double to = 450) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    qa::measured_frf out{{}, 100};
    for (double f = 4; f <= to; f += 2) {
        const qa::complex e(spread * gauss(random), spread * gauss(random));
        out.lines.push_back({hertz(f), g(hertz(f)) * (1.0 + e), 0.99, spread});
    }
    return out;
}
/// Measured: white noise through the axis in time at 2 kHz, encoder noise on top, H1.
qa::measured_frf noisy_run(const qa::flexible_axis_model<>& g, double noise, unsigned seed,
                           std::size_t samples) {
    modal_axis axis(g, 500e-6);
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    qa::multisine<quadrant::signal::voltage> excite{{3_V, 4_Hz, 600_Hz, 2048, 1, seed}, 500_us};
    qa::frf<quadrant::signal::voltage, quadrant::signal::position> out{
        {.samples = 2048, .overlap = 0, .shape = qa::window::none, .remove = qa::trend::mean}, 500_us};
    double reading = 0;
    for (std::size_t k = 0; k < samples; ++k) {
        const auto u = excite();
        if (k >= 4096) out.add(u, (reading + noise * gauss(random)) * 1_m);
        reading = axis(u.value());
    }
    return out.result();
}
} // namespace

TEST_CASE("fit_modes: gives back an axis with two modes from its own response") {
    const auto fit = qa::fit_modes<>(noisy(truth, 0, 1), {.from = 4_Hz, .to = 450_Hz});
    CHECK(fit.converged);
    REQUIRE(fit.modes.size() == 2);
    CHECK(fit.residual < 1e-6);
    for (std::size_t i = 0; i < 2; ++i) {
        CHECK(fit.modes[i].centre.value.value() ==
              doctest::Approx(truth.modes[i].centre.value()).epsilon(1e-6));
        CHECK(fit.modes[i].damping.value == doctest::Approx(truth.modes[i].damping).epsilon(1e-5).scale(0));
        CHECK(fit.modes[i].share.value == doctest::Approx(truth.modes[i].share).epsilon(1e-5).scale(0));
    }
    for (const double f : {5.0, 46.0, 312.0})
        CHECK(std::abs(fit.model()(hertz(f)) / truth(hertz(f)) - 1.0) < 1e-6);
}
TEST_CASE("fit_modes: intervals of 95 % hold the truth in 95 of 100 fits, and the count of modes is found") {
    int hits = 0, asked = 0, right = 0;
    for (unsigned seed = 1; seed <= 24; ++seed) {
        const auto fit =
            qa::fit_modes<>(noisy(truth, 0.03, seed), {.from = 4_Hz, .to = 450_Hz, .most_modes = 3});
        if (fit.modes.size() != 2) continue;
        ++right;
        hits += fit.pole.holds(rigid.viscous_rate) + fit.gain.holds(rigid.gain) + fit.delay.holds(rigid.delay);
        for (std::size_t i = 0; i < 2; ++i)
            hits += fit.modes[i].centre.holds(truth.modes[i].centre) +
                    fit.modes[i].damping.holds(truth.modes[i].damping) +
                    fit.modes[i].share.holds(truth.modes[i].share);
        asked += 9;
    }
    CHECK(right >= 23);
    CHECK(hits >= 0.905 * asked); // 0.95 +- 3 standard deviations of 0.0148
    CHECK(hits <= 0.994 * asked);
}
TEST_CASE("fit_modes: an axis without modes gets none") {
    int none = 0;
    for (unsigned seed = 1; seed <= 20; ++seed)
        none += qa::fit_modes<>(noisy({rigid, {}}, 0.03, seed), {.from = 4_Hz, .to = 300_Hz, .most_modes = 1})
                    .modes.empty();
    CHECK(none >= 19);
}
TEST_CASE("fit_modes: from a noisy multisine through the simulated axis, within its own intervals") {
    int hits = 0, asked = 0;
    for (unsigned seed = 1; seed <= 6; ++seed) {
        const auto fit = qa::fit_modes<>(noisy_run(truth, 0.2e-6, seed, 4096 + 40 * 2048),
                                         {.from = 4_Hz, .to = 450_Hz, .modes = 2, .period = 500_us});
        CHECK(fit.converged);
        REQUIRE(fit.modes.size() == 2);
        for (std::size_t i = 0; i < 2; ++i) {
            hits += fit.modes[i].centre.holds(truth.modes[i].centre) +
                    fit.modes[i].damping.holds(truth.modes[i].damping) +
                    fit.modes[i].share.holds(truth.modes[i].share);
            asked += 3;
            CHECK(fit.modes[i].centre.value.value() ==
                  doctest::Approx(truth.modes[i].centre.value()).epsilon(0.01));
        }
        CHECK(fit.delay.value.value() ==
              doctest::Approx(0.65e-3).epsilon(0.02).scale(0)); // 0.4 ms and half a period
    }
    CHECK(hits >= 31); // of 36; 0.95 of them, 34.2 +- 1.3
    CHECK(asked == 36);
}
TEST_CASE("fit_modes: too few modes are told by the surprise, too few lines are refused") {
    CHECK(qa::fit_modes<>(noisy(truth, 0.01, 3), {.from = 4_Hz, .to = 450_Hz, .modes = 1}).surprise > 5);
    CHECK(qa::fit_modes<>(noisy(truth, 0.01, 3), {.from = 4_Hz, .to = 450_Hz, .modes = 2}).surprise < 1.3);
    CHECK_THROWS_AS(qa::fit_modes<>(noisy(truth, 0.01, 3), {.from = 40_Hz, .to = 50_Hz, .modes = 2}),
                    quadrant::invalid_parameter);
    CHECK_THROWS_AS(qa::fit_modes<>(noisy(truth, 0.01, 3), {.from = 4_Hz, .to = 450_Hz, .period = -1_s}),
                    quadrant::invalid_parameter);
}
TEST_CASE("modes: a base under a slide has its anti-resonance where its share puts it, both masses counted") {
    // Slide M = 340 kg on base Mb = 2000 kg on springs: m x'' = F, Mb xb'' = -F - k xb; encoder reads x - xb.
    const double M = 340, Mb = 2000, w = 2 * std::numbers::pi * 47, k = Mb * w * w;
    const qa::flexible_axis_model<> g{{0_per_s, 1.0 / M * 1_mps2 / 1_V, 0_s}, {{47_Hz, 1e-9, M / Mb}}};
    for (const double f : {1.0, 43.0, 46.0, 100.0}) {
        const qa::complex s = qa::laplace(hertz(f));
        const qa::complex both = 1.0 / (M * s * s) + 1.0 / (Mb * s * s + k);
        CHECK(std::abs(g(hertz(f)) / both - 1.0) < 1e-6);
    }
    const auto zero = g.modes[0].anti_resonance();
    CHECK(std::abs(g(zero)) < 1e-6 * std::abs(g(0.9 * zero)));
}
