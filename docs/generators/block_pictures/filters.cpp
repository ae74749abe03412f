// SPDX-License-Identifier: BSL-1.0
// Filters and derivatives: their response.
#include "families.hpp"

#include <quadrant/filter/backward_difference.hpp>
#include <quadrant/filter/butterworth.hpp>
#include <quadrant/filter/discretize.hpp>
#include <quadrant/filter/edge_velocity.hpp>
#include <quadrant/filter/filtered_derivative.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/filter/transfer_function.hpp>
#include <quadrant/filter/two_sample_derivative.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;

picture draw_notch() {
    const notch<s::force> narrow{{.centre = 330_Hz, .width = 0.06}, T},
        wide{{.centre = 330_Hz, .width = 0.5}, T};
    const auto at = frequencies_around(330, 50, 990);
    return of(
        "Gain and phase of a notch at 330 Hz with width 0.06 and 0.5, at 2 kHz",
        {between(gains({gain("width 0.06", at, response_of(narrow)), gain("width 0.5", at, response_of(wide))}),
                 -60, 5),
         phases({phase("width 0.06", at, response_of(narrow)), phase("width 0.5", at, response_of(wide))})});
}

picture draw_lowpass() {
    const lowpass<s::force> b{{100_Hz}, 125_us};
    const auto at = frequencies(5, 3900);
    return of(
        "Gain and phase of a lowpass of 100 Hz, at 8 kHz",
        {between(gains({gain("", at, response_of(b))}), -60, 5), phases({phase("", at, response_of(b))})});
}

picture draw_butterworth() {
    const butterworth<s::force> steep{{100_Hz}, 125_us};
    const lowpass<s::force> flat{{100_Hz}, 125_us};
    const auto at = frequencies(5, 3900);
    return of(
        "Gain and phase of a butterworth of 100 Hz beside a lowpass of the same corner, at 8 kHz",
        {between(gains({gain("butterworth", at, response_of(steep)), gain("lowpass", at, response_of(flat))}),
                 -80, 5),
         phases({phase("butterworth", at, response_of(steep)), phase("lowpass", at, response_of(flat))})});
}

picture draw_transfer_function() {
    transfer_function<s::force, s::force, 3> b{{{0.2, 0.1, 0.05, -0.3}, {1, -0.7, 0.3, 0.1}}, 500_us};
    curve out("output"), in("input", dashed);
    for (int k = 0; k < 40; ++k) {
        const auto x = k < 4 ? 0_N : 1_N;
        in.hold(k, 1, x.value());
        out.hold(k, 1, b(x).value());
    }
    return of("Step response of the transfer function of the worked number",
              {over("sample", "force [N]", {out, in})});
}

/// |H| in 1/s: a derivative rises by 20 dB per decade.
template <class Block> line rise(const char* name, const Block& b) {
    curve c(name);
    for (const double f : frequencies(5, 990)) c.add(f, std::abs(b.response(hertz(f))));
    return c;
}
line true_derivative() {
    curve c("true derivative", dashed);
    for (const double f : {5.0, 990.0}) c.add(f, 2 * std::numbers::pi * f);
    return c;
}
/// What an encoder of 0.25 um at 2 kHz makes of 0.8 mm/s.
template <class Block> line counted(const char* name, Block b) {
    curve c(name);
    const double start = -20;
    b.settle(start * 1_um);
    for (int k = 0; k < 80; ++k) {
        const double counts = std::floor((start + 0.4 * k) / 0.25);
        const double v = 1e3 * b(counts * 250_nm).value();
        if (k >= 40) c.hold(0.5 * (k - 40), 0.5, v);
    }
    return c;
}
line even_speed() {
    curve c("axis", dashed);
    c.hold(0, 20, 0.8);
    return c;
}
template <class Block> picture derivative(const char* title, const char* name, const Block& b) {
    panel p = gains_alone({rise(name, b), true_derivative()}, "gain [1/s]");
    p.log_y = true;
    return of(title, {p, over("time [ms]", "velocity [mm/s]", {counted(name, b), even_speed()})});
}
picture draw_backward_difference() {
    return derivative(
        "Gain of a backward difference at 2 kHz, and its reading of 0.8 mm/s from an encoder of 0.25 um",
        "backward_difference", backward_difference<s::position, s::velocity>{{}, T});
}
picture draw_two_sample_derivative() {
    return derivative(
        "Gain of a two-sample derivative at 2 kHz, and its reading of 0.8 mm/s from an encoder of 0.25 um",
        "two_sample_derivative", two_sample_derivative<s::position, s::velocity>{{}, T});
}
picture draw_filtered_derivative() {
    return derivative("Gain of a filtered derivative of 150 Hz at 2 kHz, and its reading of 0.8 mm/s from an "
                      "encoder of 0.25 um",
                      "filtered_derivative", filtered_derivative<s::position, s::velocity>{{150_Hz}, T});
}

picture draw_edge_velocity() {
    edge_velocity<s::position, s::velocity> by_edges({1_um, 5_ms, 100_ms}, T);
    filtered_derivative<s::position, s::velocity> by_difference({150_Hz}, T);
    curve edges("edge_velocity, window 5 ms"), difference("filtered_derivative, 150 Hz"),
        truth("truth", dashed);
    double x = 0;
    for (int k = 0; k < 400; ++k) {
        const double t = k * T.value(), v = t < 0.12 ? 0.3e-3 * std::sin(2 * std::numbers::pi * 5 * t) : 0;
        x += v * T.value();
        const auto reading = std::round(x * 1e6) * 1_um;
        edges.add(1e3 * t, 1e3 * by_edges(reading).value());
        difference.add(1e3 * t, 1e3 * by_difference(reading).value());
        truth.add(1e3 * t, 1e3 * v);
    }
    return of("Velocity of an axis that swings and stops, from an encoder of 1 um at 2 kHz",
              {over("time [ms]", "velocity [mm/s]", {difference, edges, truth})});
}

picture draw_discretize() {
    const double w = 2 * std::numbers::pi * 330, zeta = 0.02;
    const continuous<2> mode{{w * w}, {w * w, 2 * zeta * w, 1}};
    using filter = transfer_function<s::force, s::force, 2>;
    const auto at = frequencies(100, 990, 500);
    const auto sampled = [&](const char* name, const auto& d) {
        const filter b{filter::parameters::in_si(d), T};
        return gain(name, at, response_of(b));
    };
    line truth = gain("in s", at, [&](frequency f) {
        const std::complex<double> p(0, 2 * std::numbers::pi * f.value());
        return w * w / (p * p + 2 * zeta * w * p + w * w);
    });
    truth.drawn = dashed;
    return of("Gain of a resonance at 330 Hz in s and after four ways of sampling at 2 kHz",
              {between(gains_alone({sampled("zero_order_hold", zero_order_hold(mode, T)),
                                    sampled("bilinear", bilinear(mode, T)),
                                    sampled("bilinear at 330 Hz", bilinear(mode, T, 330_Hz)),
                                    sampled("matched", matched(mode, T)), truth}),
                       -40, 35)});
}
} // namespace

family filters() {
    return {{"notch", draw_notch},
            {"lowpass", draw_lowpass},
            {"butterworth", draw_butterworth},
            {"transfer_function", draw_transfer_function},
            {"backward_difference", draw_backward_difference},
            {"edge_velocity", draw_edge_velocity},
            {"two_sample_derivative", draw_two_sample_derivative},
            {"filtered_derivative", draw_filtered_derivative},
            {"discretize", draw_discretize}};
}
} // namespace block_pictures
