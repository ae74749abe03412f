// SPDX-License-Identifier: BSL-1.0
#include "modal_axis.hpp"

#include <quadrant/analysis/loop_dob.hpp>
#include <quadrant/analysis/nyquist.hpp>
#include <quadrant/analysis/q_design.hpp>
#include <quadrant/base/literals.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace quadrant::literals;
namespace qa = quadrant::analysis;
namespace s = quadrant::signal;
using qa::hertz;
using quadrant::invalid_parameter;

namespace {
const quadrant::duration T = 500_us;
using observer = quadrant::disturbance_observer<s::voltage>;
const quadrant::axis_model<s::voltage> nominal{4.526_mps2 / 1_V, 28.57 / 1_s};
const qa::rigid_axis_model<> rigid{28.57 / 1_s, 4.526_mps2 / 1_V, 0.65_ms};
const qa::q_rule half{.margin = 0.5, .from = 1_Hz, .to = 900_Hz};

qa::measured_frf of(const auto& g) { return qa::as_measured(g, {1_Hz, 900_Hz, 200}); }
} // namespace

TEST_CASE("check_q: the thesis' corners hold on the model with delay, by as much as stepping through it says") {
    // 0.122 near 60 Hz: tests/observer/disturbance_observer.cpp.
    const auto v = qa::check_q(observer{{60_Hz, nominal}, T}, of(rigid), half);
    CHECK(v.worst == doctest::Approx(0.122).epsilon(0.01).scale(0));
    CHECK(v.at.value() == doctest::Approx(60).epsilon(0.05));
    CHECK(v.left_out.empty());
}
TEST_CASE("design_q: on an axis late by Td the corner is where |Q (e^{-s Td} - 1)| touches the margin, 1/Gn "
          "bilinear") {
    const auto d = qa::design_q<observer>(of(rigid), nominal, T, half);
    const observer ob(d.parameters, T);
    double worst = 0; // by another route: the closed form on a fine grid
    for (double f = 1; f <= 900; f += 0.05) {
        const double w = 2 * std::numbers::pi * f, warped = std::tan(w * T.value() / 2) * 2 / T.value(),
                     wc = 2 * std::numbers::pi * d.parameters.corner.value();
        const qa::complex s(0, w), k(0, warped), q = wc * wc / ((k + wc) * (k + wc));
        worst =
            std::max(worst, std::abs(q * (k * (k + 28.57) / (s * (s + 28.57)) * std::exp(-s * 0.65e-3) - 1.0)));
    }
    CHECK(worst == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(d.verdict.worst == doctest::Approx(0.5).epsilon(1e-9));
    CHECK(d.binding.value() > 0);
    CHECK_THROWS_AS(qa::check_q(observer{{1.01 * d.parameters.corner, nominal}, T}, of(rigid), half),
                    invalid_parameter);
}
TEST_CASE("design_q: over many axes the corner it gives keeps the rule and the observed axis stable, 5 % more "
          "breaks it") {
    std::mt19937 random(7);
    const auto between = [&](double low, double high) {
        return low + (high - low) * (double(random()) / double(std::mt19937::max()));
    };
    for (int i = 0; i < 20; ++i) {
        CAPTURE(i);
        const double gain = between(0.8, 1.25), delay = between(0.3, 1.5), base = between(30, 60),
                     heavy = between(0.02, 0.2), twist = between(-0.1, 0.1);
        const qa::flexible_axis_model<> g{{rigid.viscous_rate, gain * rigid.gain, delay * 1_ms},
                                          {{hertz(base), 0.05, heavy}, {320_Hz, 0.02, twist}}};
        const qa::q_rule whole{.margin = 0.9, .from = 1_Hz, .to = 900_Hz};
        const auto d = qa::design_q<observer>(of(g), nominal, T, whole);
        const observer ob(d.parameters, T);
        double worst = 0;
        for (double f = 1; f <= 900; f *= 1.003) {
            const auto back = std::exp(-qa::laplace(hertz(f)) * T.value()),
                       k = 4000.0 * (1.0 - back) / (1.0 + back);
            const auto delta = g(hertz(f)) * k * (k + 28.57) / 4.526 - 1.0; // 1/Gn, bilinear
            worst = std::max(worst, std::abs(ob.q(hertz(f)) * delta));
        }
        CHECK(worst <= 0.9 * 1.04); // between two lines: (1.9 Hz/6.4 Hz)^2/2 of a mode
        // The observer's own loop is Q Delta: below one it cannot turn around -1.
        const auto own = [&](auto f) { return g(f) * ob.inverse(f) - ob.q(f); };
        CHECK(qa::unstable_poles(own, {1_Hz, 900_Hz}, 0) == 0);
        CHECK_THROWS_AS(qa::check_q(observer{{1.05 * d.parameters.corner, nominal}, T}, of(g), whole),
                        invalid_parameter);
    }
}
TEST_CASE("check_q: a mode too large for Q is refused with the frequency where it stands") {
    const qa::flexible_axis_model<> g{rigid, {{45_Hz, 0.01, 0.1}}};
    try {
        qa::check_q(observer{{60_Hz, nominal}, T}, of(g), half);
        FAIL("was not refused");
    } catch (const invalid_parameter& refused) {
        const std::string what = refused.what();
        CHECK(what.find("check_q: largest |Q Delta| = ") == 0);
        CHECK(what.find("must not be above q_rule.margin (0.5), is at 4") != std::string::npos);
        CHECK(what.find("lower disturbance_observer.corner") != std::string::npos);
    }
}
TEST_CASE("design_q: lines with little coherence are left out and told, the spread of the others counts") {
    auto frf = of(rigid);
    for (auto& line : frf.lines) line.spread = 0.05;
    const auto clean = qa::design_q<observer>(of(rigid), nominal, T, half),
               noisy = qa::design_q<observer>(frf, nominal, T, half);
    CHECK(noisy.parameters.corner < clean.parameters.corner);
    double worst = 0; // two deviations of 5 % of the measured G Q/Gn
    const observer ob{{60_Hz, nominal}, T};
    for (const auto& line : frf.lines) {
        const auto late = std::polar(1.0, -0.65e-3 * qa::laplace(line.f).imag());
        const double q = std::abs(ob.q(line.f));
        worst = std::max(worst, q * (std::abs(late - 1.0) + 0.1));
    }
    CHECK(qa::q_mismatch(ob, frf, half).worst ==
          doctest::Approx(worst).epsilon(0.01).scale(0)); // 1/Gn bilinear
    for (auto& line : frf.lines)
        if (line.f > 44_Hz && line.f < 46_Hz) line.coherence = 0.2, line.value *= 7;
    const auto blind = qa::design_q<observer>(frf, nominal, T, half);
    CHECK(blind.verdict.left_out.size() == 4);
    for (const auto& f : blind.verdict.left_out) CHECK((f > 44_Hz && f < 46_Hz));
    CHECK(blind.parameters.corner == noisy.parameters.corner);
    CHECK(blind.verdict.beyond == doctest::Approx(std::abs(observer(blind.parameters, T).q(900_Hz))));
}
TEST_CASE(
    "design_q: an axis that is its nominal plant lets Q go as far as sampling does, a wrong plant is refused") {
    const auto exact = [](quadrant::frequency f) {
        const observer ob{{10_Hz, nominal}, T};
        return ob.q(f) / ob.inverse(f);
    };
    const auto d = qa::design_q<observer>(of(exact), nominal, T, half);
    CHECK(d.parameters.corner.value() == doctest::Approx(980));
    CHECK(d.binding.value() == 0);
    const auto thrice = [&](quadrant::frequency f) { return 3.0 * exact(f); };
    CHECK_THROWS_AS(qa::design_q<observer>(of(thrice), nominal, T, half), invalid_parameter);
    CHECK_THROWS_AS(qa::design_q<observer>(of(rigid), nominal, T, {.margin = 1.5, .from = 1_Hz, .to = 90_Hz}),
                    invalid_parameter);
    CHECK_THROWS_AS(qa::design_q<observer>(of(rigid), nominal, T, {.from = 901_Hz, .to = 990_Hz}),
                    invalid_parameter);
    CHECK_THROWS_AS(qa::design_q<observer>(of(rigid), nominal, T, {.from = 90_Hz, .to = 9_Hz}),
                    invalid_parameter);
}
TEST_CASE("design_q: in time the observer that it gives is stable on the measured axis") {
    std::mt19937 random(11);
    const auto between = [&](double low, double high) {
        return low + (high - low) * (double(random()) / double(std::mt19937::max()));
    };
    for (int i = 0; i < 6; ++i) {
        CAPTURE(i);
        const double gain = between(0.8, 1.25), delay = between(0.2, 0.9), base = between(30, 60),
                     heavy = between(0.05, 0.2), twist = between(-0.1, 0.1);
        const qa::flexible_axis_model<> g{{rigid.viscous_rate, gain * rigid.gain, delay * 1_ms},
                                          {{hertz(base), 0.05, heavy}, {320_Hz, 0.02, twist}}};
        const auto d =
            qa::design_q<observer>(measured(g, T), nominal, T, {.margin = 0.9, .from = 2_Hz, .to = 955_Hz});
        observer ob(d.parameters, T);
        modal_axis axis(g, T.value());
        double x = 0, early = 0, late = 0;
        for (int k = 0; k < 8000; ++k) { // a push of 5 ms, then nothing: what is still estimated must go
            const double estimate = ob(x * 1_m).value();
            if (k < 2000) early = std::max(early, std::abs(estimate));
            if (k >= 6000) late = std::max(late, std::abs(estimate));
            x = axis((k < 10 ? 1 : 0) - estimate);
        }
        CHECK(late < 0.01 * early);
    }
}
