// SPDX-License-Identifier: BSL-1.0
#include <quadrant/analysis/excitation.hpp>
#include <quadrant/analysis/fit_plant.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/plant/linear_motor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using namespace quadrant;
using namespace quadrant::literals;
using namespace quadrant::analysis;

namespace {
const analysis::axis_model<> x{28.57 / 1_s, 4.526_mps2 / 1_V, 0.65_ms}, y{20.0 / 1_s, 8.916_mps2 / 1_V, 0.65_ms};
/// The model with a relative error of `spread` on every line, 1 Hz apart.
measured_frf noisy(const analysis::axis_model<>& g, double spread, unsigned seed, double sign = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> gauss;
    measured_frf out{{}, 100};
    for (double f = 2; f <= 250; f += 1) {
        const double here = spread * (1 + f / 50); // worse where the plant answers less
        const complex e(here * gauss(random), here * gauss(random));
        out.lines.push_back({hertz(f), sign * g(hertz(f)) * (1.0 + e), 0.99, here});
    }
    return out;
}
bool holds(const auto& estimate, auto truth) { return estimate.low <= truth && truth <= estimate.high; }
} // namespace

TEST_CASE("fit_plant: gives back the thesis' axes from their own response") {
    for (const auto& g : {x, y}) {
        const auto fit = fit_plant<>(noisy(g, 0, 1), {.from = 2_Hz, .to = 250_Hz});
        CHECK(fit.converged);
        CHECK(fit.pole.value.value() == doctest::Approx(g.pole.value()).epsilon(1e-6));
        CHECK(fit.gain.value.value() == doctest::Approx(g.gain.value()).epsilon(1e-6));
        CHECK(fit.delay.value.value() == doctest::Approx(g.delay.value()).epsilon(1e-6).scale(0));
        CHECK(fit.residual < 1e-9);
    }
}
TEST_CASE("fit_plant: the intervals of 95 % hold the truth in 95 of 100 fits") {
    int a = 0, b = 0, t = 0;
    double surprise = 0;
    for (unsigned seed = 1; seed <= 200; ++seed) {
        const auto fit = fit_plant<>(noisy(x, 0.02, seed), {.from = 2_Hz, .to = 250_Hz});
        CHECK(fit.converged);
        a += holds(fit.pole, x.pole), b += holds(fit.gain, x.gain), t += holds(fit.delay, x.delay);
        surprise += fit.surprise / 200;
    }
    for (const int hits : {a, b, t}) CHECK((hits >= 180 && hits <= 199)); // 190 +- 3 standard deviations of 3.1
    CHECK(surprise == doctest::Approx(1).epsilon(0.05));
}
TEST_CASE("fit_plant: long delays are found though the phase turns many times") {
    const analysis::axis_model<> late{5.0 / 1_s, 4.526_mps2 / 1_V, 9.3_ms}; // 2.3 turns at 250 Hz
    const auto fit = fit_plant<>(noisy(late, 0.02, 4), {.from = 2_Hz, .to = 250_Hz, .longest_delay = 12_ms});
    CHECK(fit.delay.value.value() == doctest::Approx(9.3e-3).epsilon(0.01).scale(0));
}
TEST_CASE("fit_plant: a mode that the model does not have is told by its surprise") {
    auto frf = noisy(x, 0.005, 2);
    for (auto& line : frf.lines) {
        const complex s = laplace(line.f);
        const double p = 2 * std::numbers::pi * 45, z = 2 * std::numbers::pi * 47;
        line.value *= (s * s + 0.04 * z * s + z * z) / (s * s + 0.04 * p * s + p * p);
    }
    const auto fit = fit_plant<>(frf, {.from = 2_Hz, .to = 250_Hz}),
               without = fit_plant<>(noisy(x, 0.005, 2), {.from = 2_Hz, .to = 250_Hz});
    CHECK(fit.surprise > 10);
    const auto width = [](const auto& f) { return (f.gain.high - f.gain.low) / f.gain.value; };
    CHECK(width(fit) > 3 * width(without)); // by its square root
}
TEST_CASE(
    "fit_plant: from a multisine through the simulated axis, A, B and the delay with the hold's half period") {
    using motor = linear_motor<>; // x axis: B = kf/M, A = viscous/M
    const double mass = 1450 / 4.526;
    motor axis{{.mass = mass * 1_kg,
                .force_constant = 1450_N / 1_V,
                .friction = {0_N, mass * 28.57 * 1_N / 1_mps},
                .delay = 0.4_ms,
                .substeps = 50},
               500_us};
    multisine<signal::voltage> excite{{2_V, 4_Hz, 300_Hz, 2048}, 500_us};
    frf<signal::voltage, signal::position> measure{
        {.samples = 2048, .overlap = 0, .shape = window::none, .remove = trend::mean}, 500_us};
    auto reading = 0_m;
    for (int k = 0; k < 2048 * 8; ++k) {
        const auto u = excite();
        if (k >= 2048 * 4) measure.add(u, reading); // position of sample k, before u acts
        reading = axis(u);
    }
    const auto fit = fit_plant<>(measure.result(), {.from = 4_Hz, .to = 150_Hz});
    CHECK(fit.pole.value.value() == doctest::Approx(28.57).epsilon(0.02));
    CHECK(fit.gain.value.value() == doctest::Approx(4.526).epsilon(0.01));
    CHECK(fit.delay.value.value() == doctest::Approx(0.65e-3).epsilon(0.02).scale(0));
}
TEST_CASE("fit_plant: refuses too few lines and a plant of the wrong sign") {
    CHECK_THROWS_AS(fit_plant<>(noisy(x, 0.01, 1), {.from = 2_Hz, .to = 6_Hz}), invalid_parameter);
    CHECK_THROWS_AS(fit_plant<>(noisy(x, 0.01, 1), {.from = 6_Hz, .to = 2_Hz}), invalid_parameter);
    CHECK_THROWS_AS(fit_plant<>(noisy(x, 0.01, 1, -1), {.from = 2_Hz, .to = 250_Hz}), invalid_parameter);
}
