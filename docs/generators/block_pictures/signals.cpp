// SPDX-License-Identifier: BSL-1.0
// Blocks that shape or watch one wire: what goes in beside what comes out.
#include "families.hpp"

#include <quadrant/block/absent.hpp>
#include <quadrant/block/series.hpp>
#include <quadrant/control/dead_band.hpp>
#include <quadrant/control/gain_schedule.hpp>
#include <quadrant/control/limiter.hpp>
#include <quadrant/control/proportional.hpp>
#include <quadrant/control/quantizer.hpp>
#include <quadrant/control/rate_limiter.hpp>
#include <quadrant/filter/lowpass.hpp>
#include <quadrant/filter/notch.hpp>
#include <quadrant/sensor/white_noise.hpp>
#include <quadrant/trajectory/stream_limiter.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

/// Output over input, from -most to most.
template <class Block> line characteristic(const char* name, Block b, double most, double in_si = 1) {
    curve c(name);
    for (int i = -1000; i <= 1000; ++i) {
        const double x = most * i / 1000;
        c.add(x, b(Block::value::from_value(in_si * x)).value() / in_si);
    }
    return c;
}
line same(double most) {
    curve c("input", dashed);
    c.add(-most, -most);
    c.add(most, most);
    return c;
}

picture draw_limiter() {
    limiter<s::voltage> b{{-10_V, 10_V}, T};
    curve in("input", dashed), out("output"), told("limited()");
    for (int k = 0; k < 200; ++k) {
        const auto x = 14_V * std::sin(2 * pi * k / 160.0);
        in.add(0.5 * k, x.value());
        out.add(0.5 * k, b(x).value());
        told.hold(0.5 * k, 0.5, b.limited());
    }
    return of("A sine of 14 V through a limiter of 10 V, and its flag",
              {over("", "command [V]", {out, in}), between(over("time [ms]", "flag", {told}), -0.2, 1.2)});
}
picture draw_rate_limiter() {
    rate_limiter<s::voltage> b{{1000_V / 1_s}, T};
    curve in("input", dashed), out("output");
    for (int k = 0; k < 120; ++k) {
        const auto x = k < 20 ? 0_V : k < 60 ? 10_V : 10_V * std::cos(2 * pi * (k - 60) / 120.0);
        in.hold(0.5 * k, 0.5, x.value());
        out.hold(0.5 * k, 0.5, b(x).value());
    }
    return of("A step of 10 V and a slow sine through a rate limiter of 1000 V/s",
              {over("time [ms]", "command [V]", {out, in})});
}
picture draw_dead_band() {
    return of("Output over input of a dead band of 0.5 V",
              {over("input [V]", "output [V]",
                    {characteristic("output", dead_band<s::voltage>{{0.5_V}, T}, 2), same(2)})});
}
picture draw_quantizer() {
    return of("Output over input of a quantizer with steps of 0.25 um",
              {over("input [um]", "output [um]",
                    {characteristic("output", quantizer<s::position>{{0.25_um}, T}, 1, 1e-6), same(1)})});
}
picture draw_proportional() {
    proportional<s::position, s::velocity> b{{150.0 / 1_s}, T};
    curve in("position error"), out("velocity demand");
    for (int k = 0; k <= 200; ++k) {
        const auto e = 20_um * std::sin(2 * pi * k / 100.0) * std::exp(-k / 80.0);
        in.add(0.5 * k, 1e6 * e.value());
        out.add(0.5 * k, 1e3 * b(e).value());
    }
    return of("A position error of 20 um that dies out, and what a proportional of 150 /s makes of it",
              {over("", "in [um]", {in}), over("time [ms]", "out [mm/s]", {out})});
}
picture draw_gain_schedule() {
    gain_schedule<s::position, s::position, s::velocity, 3> b{
        {{0_mm, 100_mm, 400_mm}, {1.0 / 1_s, 3.0 / 1_s, 1.5 / 1_s}}, T};
    curve map("gain"), nodes("nodes", points);
    for (int x = -100; x <= 500; x += 2) map.add(x, 1e3 * b(1_mm, double(x) * 1_mm).value());
    for (std::size_t i = 0; i < 3; ++i) nodes.add(1e3 * b.given().at[i].value(), b.given().gain[i].value());
    return of("Gain over the scheduling position, with nodes at 0, 100 and 400 mm",
              {over("position [mm]", "gain [1/s]", {map, nodes})});
}
picture draw_absent() {
    absent<s::velocity, s::force> nothing{{}, T};
    through<s::force> wire{{}, T};
    curve in("input", dashed), none("absent"), same_again("through");
    for (int k = 0; k <= 200; ++k) {
        const double x = 3 * std::sin(2 * pi * k / 100.0);
        in.add(0.5 * k, x);
        none.add(0.5 * k, nothing(x * 1_mps).value());
        same_again.add(0.5 * k, wire(x * 1_N).value());
    }
    return of("A sine of 3 m/s into absent and one of 3 N through through",
              {over("time [ms]", "force [N]", {in, none, same_again})});
}
picture draw_series() {
    const notch<s::force> first{{330_Hz, 0.06}, T};
    const lowpass<s::force> second{{200_Hz}, T};
    const series<notch<s::force>, lowpass<s::force>> both{{{330_Hz, 0.06}, {200_Hz}}, T};
    const auto at = frequencies_around(330, 20, 990);
    const auto dash = [](line l) {
        l.drawn = dashed;
        return l;
    };
    return of("Gain of a notch, of a lowpass and of both in a series",
              {between(gains_alone({gain("series", at, response_of(both)),
                                    dash(gain("notch", at, response_of(first))),
                                    dash(gain("lowpass", at, response_of(second)))}),
                       -50, 3)});
}
picture draw_stream_limiter() {
    constexpr double dt = 1e-3;
    trajectory::stream_limiter<100> plain{{100_mmps, 1_mps2}, 1_ms},
        smooth{{100_mmps, 1_mps2, 40.0 * 1_mps2 / 1_s}, 1_ms};
    curve in("stream", dashed), a("without jerk limit"), b("with 40 m/s^3"), va("without jerk limit"),
        vb("with 40 m/s^3");
    double was_a = 0, was_b = 0;
    for (int k = 0; k < 500; ++k) {
        const double x = k < 30 ? 0 : 0.02;
        const double ya = plain(x * 1_m).value(), yb = smooth(x * 1_m).value(), t = k;
        in.hold(t, 1, 1e3 * x);
        a.add(t, 1e3 * ya), b.add(t, 1e3 * yb);
        va.add(t, 1e3 * (ya - was_a) / dt), vb.add(t, 1e3 * (yb - was_b) / dt);
        was_a = ya, was_b = yb;
    }
    return of("A jump of 20 mm through stream limiters of 100 mm/s and 1 m/s^2, without and with a jerk limit",
              {over("", "position [mm]", {a, b, in}), over("time [ms]", "velocity [mm/s]", {va, vb})});
}
picture draw_white_noise() {
    white_noise<s::velocity> noise{{0.3_mmps, 7}, T};
    curve samples("noise"), counted("histogram of 100 000 samples"), bell("normal distribution", dashed);
    std::vector<int> bins(61, 0);
    for (int k = 0; k < 100000; ++k) {
        const double v = 1e3 * noise().value();
        if (k < 300) samples.add(0.5 * k, v);
        const int bin = int(std::floor((v + 1.22) / 0.04));
        if (bin >= 0 && bin < 61) ++bins[std::size_t(bin)];
    }
    for (int i = 0; i < 61; ++i) {
        const double low = -1.22 + 0.04 * i, middle = low + 0.02;
        counted.hold(low, 0.04, bins[std::size_t(i)] / (100000 * 0.04));
        bell.add(middle, std::exp(-middle * middle / (2 * 0.09)) / (0.3 * std::sqrt(2 * pi)));
    }
    return of("300 samples of white noise of 0.3 mm/s, and the histogram of 100 000",
              {over("time [ms]", "velocity [mm/s]", {samples}),
               over("velocity [mm/s]", "density [s/mm]", {counted, bell})});
}
} // namespace

family signals() {
    return {{"limiter", draw_limiter},
            {"rate_limiter", draw_rate_limiter},
            {"dead_band", draw_dead_band},
            {"quantizer", draw_quantizer},
            {"proportional", draw_proportional},
            {"gain_schedule", draw_gain_schedule},
            {"absent", draw_absent},
            {"series", draw_series},
            {"stream_limiter", draw_stream_limiter},
            {"white_noise", draw_white_noise}};
}
} // namespace block_pictures
