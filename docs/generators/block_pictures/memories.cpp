// SPDX-License-Identifier: BSL-1.0
// Delays.
#include "families.hpp"

#include <quadrant/memory/cycle_tracker.hpp>
#include <quadrant/memory/delay_line.hpp>
#include <quadrant/memory/fractional_delay.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

/// One swing, and nothing before and after.
double swing(int k) { return k > 2 && k < 23 ? std::sin(2 * pi * (k - 3) / 20.0) : 0; }

picture draw_delay_line() {
    delay_line<s::force, 16> b{{6}, T};
    curve in("input", dashed), out("output, length 6");
    for (int k = 0; k < 40; ++k) {
        in.hold(k, 1, swing(k));
        out.hold(k, 1, b(swing(k) * 1_N).value());
    }
    return of("One swing of a force through a delay line of 6 periods",
              {over("sample", "force [N]", {out, in})});
}
picture draw_fractional_delay() {
    const fractional_delay<s::force, 8, 1> straight{{1.1_ms}, T};
    const fractional_delay<s::force, 8, 3> cubic{{1.1_ms}, T};
    const auto at = frequencies(20, 990);
    const auto late = [&](const char* name, const auto& b) {
        curve c(name);
        for (const double f : at) { // the phase that is left once the exact delay is taken out
            const std::complex<double> exact = std::polar(1.0, -2 * pi * f * 1.1e-3);
            c.add(f, 1.1e3 - 1e6 * std::arg(std::complex<double>(b.response(hertz(f))) / exact) / (2 * pi * f));
        }
        return c;
    };
    return of(
        "Gain and delay over frequency of a fractional delay of 1.1 ms at 2 kHz, order 1 and order 3",
        {between(gains({gain("order 1", at, response_of(straight)), gain("order 3", at, response_of(cubic))}),
                 -6, 0.5),
         between(gains({late("order 1", straight), late("order 3", cubic)}, "delay [us]", "frequency [Hz]"),
                 1000, 1120)});
}
picture draw_cycle_tracker() {
    cycle_tracker<s::force, 100> b{{.cycle = 85.859 * T, .range = 0.05, .settles_in = 200_ms}, T};
    curve truth("cycle of the spindle", dashed), found("cycle()"), off("what does not repeat");
    double angle = 0;
    for (int k = 0; k < 4000; ++k) {
        const double cycle = k < 1000 ? 85.859 : 1.02 * 85.859;
        angle += 2 * pi / cycle;
        const double x = 80 * std::cos(angle) + 60 * std::sin(2 * angle) + 70 * std::cos(3 * angle + 1);
        const double y = b(x * 1_N).value();
        if (k < 200) continue; // the first cycle
        truth.add(0.5 * k, cycle), found.add(0.5 * k, b.cycle().value() / T.value());
        off.add(0.5 * k, y);
    }
    return of(
        "A spindle of 23.294 Hz that slows down by 2 % after 500 ms: the cycle that is followed, and what of "
        "the force does not repeat",
        {over("", "cycle [periods]", {found, truth}), over("time [ms]", "force [N]", {off})});
}
} // namespace

family memories() {
    return {{"cycle_tracker", draw_cycle_tracker},
            {"delay_line", draw_delay_line},
            {"fractional_delay", draw_fractional_delay}};
}
} // namespace block_pictures
