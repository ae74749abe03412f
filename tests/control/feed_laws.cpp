// SPDX-License-Identifier: BSL-1.0
// pid and sliding_mode, their designs, and the loop that their response() closes.
#include <quadrant/analysis/law_loop.hpp>
#include <quadrant/base/literals.hpp>
#include <quadrant/control/pid.hpp>
#include <quadrant/control/sliding_mode.hpp>
#include <quadrant/plant/ball_screw_drive.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <complex>
#include <string>

using namespace quadrant;
using namespace quadrant::literals;

namespace {
using cd = std::complex<double>;
const axis_model<signal::voltage> plant{0.63364_mps2 / 1_V, 2.5485 / 1_s}; // x of [Yeung2006]

pid<>::parameters pid_gains() {
    return {
        .gain = 70e3 * 1_V / 1_m, .integral_gain = 800e3 * 1_V / (1_m * 1_s), .derivative_gain = 300_V / 1_mps};
}
sliding_mode<>::parameters smc_gains() {
    return {.plant = plant, .sliding = 200.0 / 1_s, .gain = 300_V / 1_mps, .adaptation = 30e3 * 1_V / 1_m};
}
axis_motion<> motion(double x, double v = 0, double a = 0) { return {x * 1_m, v * 1_mps, a * 1_mps2}; }

/// The linear plant at the samples, stepped by its matrix exponential from a Taylor series.
struct linear_axis {
    double A, B, T, x = 0, v = 0;
    void step(double u) {
        // (x, v, u)' = M (x, v, u): three series, one for each entry that is not trivial
        double a = 0, held = 0, way = 0, term = 1;
        for (int n = 0; n < 30; ++n, term *= -A * T / n) {
            a += term;
            held += term * T / (n + 1);
            way += term * T * T / ((n + 1) * (n + 2));
        }
        x += held * v + B * way * u;
        v = a * v + B * held * u;
    }
};
template <class F> bool says(F&& make, const char* words) {
    try {
        make();
    } catch (const invalid_parameter& e) {
        return std::string(e.what()).find(words) == 0;
    }
    return false;
}
} // namespace

TEST_CASE("pid: 10 um behind at rest: 0.7 V and 8 mV more from the first sample on; 1 mm/s too slow: 0.3 V") {
    pid<> law{pid_gains(), 1_ms};
    for (int k = 1; k <= 5; ++k)
        CHECK(law(motion(10e-6), 0_m, 0_mps).value() == doctest::Approx(0.7 + 0.008 * k).epsilon(1e-12));
    law.reset();
    CHECK(law(motion(0, 2e-3, 100), 0_m, 1_mmps).value() == doctest::Approx(0.3).epsilon(1e-12));
}
TEST_CASE("pid: weights take the reference out of proportion and derivative, never out of the integral") {
    auto p = pid_gains();
    p.position_weight = 0, p.velocity_weight = 0;
    pid<> law{p, 1_ms};
    CHECK(law(motion(10e-6, 1e-3), 0_m, 0_mps).value() == doctest::Approx(0.008).epsilon(1e-12));
    CHECK(law(motion(10e-6, 1e-3), 10_um, 1_mmps).value() == doctest::Approx(0.008 - 0.7 - 0.3).epsilon(1e-12));
}
TEST_CASE("pid: the derivative of positions is their difference over the period, and its filter the "
          "first-order lag") {
    auto p = pid_gains();
    p.gain = {}, p.integral_gain = {}, p.derivative = derivative_from::positions;
    pid<> law{p, 1_ms};
    CHECK(law(motion(1e-6), 0_m, 5_mps).value() ==
          doctest::Approx(0.3).epsilon(1e-12)); // the tachometer is not read
    CHECK(law(motion(1e-6), 3_um, 0_mps).value() == doctest::Approx(-0.9).epsilon(1e-12));
    p.derivative = derivative_from::tachometer, p.derivative_corner = 40_Hz;
    pid<> slow{p, 1_ms};
    for (int k = 1; k <= 20; ++k) { // the step response of 1/(1 + s/w)
        const double rise = 1 - std::exp(-2 * std::numbers::pi * 40 * 1e-3 * k);
        CHECK(slow(motion(0, 1e-3), 0_m, 0_mps).value() == doctest::Approx(0.3 * rise).epsilon(1e-12));
    }
}
TEST_CASE("sliding_mode: is eq. (20, 21) written out, sum and all") {
    sliding_mode<> law{smc_gains(), 1_ms};
    const double Je = 1 / 0.63364, Be = 2.5485 / 0.63364, lambda = 200, Ks = 300, rho = 30e3;
    double sum = 0;
    unsigned n = 1;
    const auto random = [&](double size) {
        n = n * 1664525u + 1013904223u;
        return size * ((n >> 16) / 32768.0 - 1);
    };
    for (int k = 0; k < 200; ++k) {
        const double xr = random(1e-5), vr = random(1e-2), ar = random(1), x = random(1e-5), v = random(1e-2);
        const double e = xr - x, S = lambda * e + (vr - v);
        sum += 1e-3 * e;
        const double u = Je * (lambda * (vr - v) + ar) + Be * v + Ks * S + rho * (lambda * sum + e);
        CHECK(std::abs(law(motion(xr, vr, ar), x * 1_m, v * 1_mps).value() - u) < 1e-12);
        CHECK(std::abs(law.now().s.value() - S) < 1e-15);
    }
}
TEST_CASE("feed laws: settle(x, u) is held: at rest at x they give u, with any weight") {
    auto p = pid_gains();
    p.position_weight = 0.4, p.velocity_weight = 0.7, p.derivative = derivative_from::positions;
    pid<> a{p, 1_ms};
    sliding_mode<> b{smc_gains(), 1_ms};
    a.settle(0.2_m, 1.3_V), b.settle(0.2_m, 1.3_V);
    for (int k = 0; k < 3; ++k) {
        CHECK(a(motion(0.2), 0.2_m, 0_mps).value() == doctest::Approx(1.3).epsilon(1e-9));
        CHECK(b(motion(0.2), 0.2_m, 0_mps).value() == doctest::Approx(1.3).epsilon(1e-12));
    }
}
TEST_CASE("feed laws: told what the amplifier applied they do not wind up, not told they do") {
    const auto overshoot = [](auto law, bool told) { // a step of 20 mm that 0.2 V take half a second for
        linear_axis axis{2.5485, 0.63364, 1e-3};
        double most = 0;
        for (int k = 0; k < 4000; ++k) {
            const auto u = law(motion(0.02), axis.x * 1_m, axis.v * 1_mps);
            const double applied = std::max(-0.2, std::min(0.2, u.value()));
            if (told) law.applied(applied * 1_V);
            axis.step(applied);
            most = std::max(most, axis.x - 0.02);
        }
        return most;
    };
    auto gentle = place_pid(plant, {.natural = 2_Hz});
    gentle.velocity_weight = 0;
    const auto smc = design_sliding_mode(plant, {.sliding = 12.0 / 1_s, .natural = 2_Hz, .damping = 1});
    CHECK(overshoot(pid<>{gentle, 1_ms}, true) < 0.7 * overshoot(pid<>{gentle, 1_ms}, false));
    CHECK(overshoot(sliding_mode<>{smc, 1_ms}, true) < 0.7 * overshoot(sliding_mode<>{smc, 1_ms}, false));
}
TEST_CASE("place_pid: the characteristic polynomial has the poles that were asked for") {
    const pid_poles wanted{.natural = 8_Hz, .damping = 0.8, .real = 1.5};
    const auto p = place_pid(plant, wanted);
    const double w = 2 * std::numbers::pi * 8, B = plant.gain.value(), A = plant.viscous_rate.value();
    const cd pair = w * cd(-0.8, 0.6);
    for (const cd s : {pair, std::conj(pair), cd(-1.5 * w)}) {
        const cd rest = s * s * (s + A) +
                        B * (p.derivative_gain.value() * s * s + p.gain.value() * s + p.integral_gain.value());
        CHECK(std::abs(rest) < 1e-9 * w * w * w);
    }
    // Too slow for a plant that damps itself more: the gain would be negative.
    const axis_model<signal::voltage> tough{1_mps2 / 1_V, 100.0 / 1_s};
    CHECK(says([&] { pid<>{place_pid(tough, {.natural = 2_Hz}), 1_ms}; }, "pid.derivative_gain = -62.3"));
}
TEST_CASE("design_sliding_mode: a step of disturbance is answered as a mass on spring and damper") {
    // q = e + sliding * (integral of e) obeys q'' + 2 w q' + w^2 q = -B d with damping 1: q = -B d/w^2 (1 - (1
    // + w t) e^{-w t})
    const double T = 20e-6, w = 2 * std::numbers::pi * 15, d = 1, B = plant.gain.value();
    sliding_mode<> law{design_sliding_mode(plant, {.sliding = 150.0 / 1_s, .natural = 15_Hz, .damping = 1}),
                       20_us};
    linear_axis axis{2.5485, B, T};
    double sum = 0, off = 0;
    for (int k = 0; k < 10000; ++k) { // 0.2 s
        const double q = -axis.x + 150 * sum, t = k * T;
        off = std::max(off, std::abs(q + B * d / (w * w) * (1 - (1 + w * t) * std::exp(-w * t))));
        axis.step(law(motion(0), axis.x * 1_m, axis.v * 1_mps).value() + d);
        sum -= axis.x * T;
    }
    CHECK(off < 0.01 * B * d / (w * w));              // the period is 1/530 of 1/w
    CHECK(std::abs(axis.x) < 1e-3 * B * d / (w * w)); // adapted: the error is gone
}
TEST_CASE("feed laws: what no law can be is refused by name") {
    CHECK(says(
        [] {
            auto p = smc_gains();
            p.plant.gain = {};
            sliding_mode<>{p, 1_ms};
        },
        "sliding_mode.plant.gain = 0 m/(V s^2): must be finite and above 0"));
    CHECK(says(
        [] {
            auto p = pid_gains();
            p.derivative_corner = 0_Hz;
            pid<>{p, 1_ms};
        },
        "pid.derivative_corner = 0 Hz: must be above 0 (infinite: no filter)"));
}

TEST_CASE("sampled_axis: encoder and tachometer of the drive, from a sine of current") {
    ball_screw_drive<> drive{{.inertia = 0.0077736_kgm2,
                              .viscous = 0.3_Nm / 1_radps,
                              .torque_constant = 0.4769_Nm / 1_A,
                              .pitch = 10_mm,
                              .friction = {{{}, {}, 1_radps, 1_radps}, {{}, {}, 1_radps, 1_radps}}},
                             1_ms};
    const analysis::sampled_axis<signal::current> axis{drive.model(), 1_ms};
    const double w = 2 * std::numbers::pi * 40 * 1e-3;
    cd way = 0, v = 0; // way of a period: position itself runs away
    for (int k = 0; k < 1000 + 400; ++k) {
        const auto [x0, v0] = drive.now();
        drive(quantity<si::current>::from_value(3 + std::cos(w * k))); // never turns
        if (k < 1000) continue;
        way += (drive.now().x - x0).value() * std::polar(2.0 / 400, -w * k);
        v += v0.value() * std::polar(2.0 / 400, -w * k);
    }
    CHECK(std::abs(way - axis.position(40_Hz) * (std::polar(1.0, w) - 1.0)) < 1e-9 * std::abs(way));
    CHECK(std::abs(v - axis.velocity(40_Hz)) < 1e-9 * std::abs(v));
}
TEST_CASE_TEMPLATE("law_loop: tracking and disturbance are what the closed loop does", Law, pid<>,
                   sliding_mode<>) {
    const auto make = [] {
        if constexpr (std::same_as<Law, pid<>>)
            return Law{pid_gains(), 1_ms};
        else
            return Law{smc_gains(), 1_ms};
    };
    for (const double A : {2.5485, 0.05}) { // the second by the series for small A T
        const axis_model<signal::voltage> of{plant.gain, A / 1_s};
        const analysis::law_loop loop{make(), analysis::sampled_axis<>{of, 1_ms}};
        for (const double hertz : {5.0, 50.0}) {
            const double wt = 2 * std::numbers::pi * hertz * 1e-3, w = wt * 1e3;
            const auto measure = [&](double reference, double push) {
                Law law = make();
                linear_axis axis{A, plant.gain.value(), 1e-3};
                cd sum = 0;
                for (int k = 0; k < 3000 + 400; ++k) {
                    if (k >= 3000) sum += axis.x * std::polar(2.0 / 400, -wt * k);
                    const auto u = law(motion(reference * std::cos(wt * k), -reference * w * std::sin(wt * k),
                                              -reference * w * w * std::cos(wt * k)),
                                       axis.x * 1_m, axis.v * 1_mps);
                    axis.step(u.value() + push * std::cos(wt * k));
                }
                return sum;
            };
            const cd tracked = measure(1e-3, 0) / 1e-3, pushed = measure(0, 1);
            CHECK(std::abs(tracked - loop.tracking(analysis::hertz(hertz))) < 1e-6);
            CHECK(std::abs(pushed - loop.disturbance(analysis::hertz(hertz))) < 1e-6 * std::abs(pushed));
            CHECK(std::abs(loop.disturbance(analysis::hertz(hertz)) -
                           loop.axis.position(analysis::hertz(hertz)) *
                               loop.sensitivity(analysis::hertz(hertz))) < 1e-15);
        }
    }
}
