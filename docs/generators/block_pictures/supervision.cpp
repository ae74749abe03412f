// SPDX-License-Identifier: BSL-1.0
// What switches an axis on and off and watches it.
#include "families.hpp"

#include <quadrant/control/axis_enable.hpp>
#include <quadrant/control/following_error.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;

picture draw_axis_enable() {
    constexpr double dt = 5e-4;
    curve in("stream", dashed), out("reference"), state("power: 0 off, 1 on, 2 stopping");
    axis_enable<> power{
        {.velocity = 200_mmps, .deceleration = 1_mps2, .emergency_deceleration = 4_mps2, .brake_time = 20_ms},
        T};
    double x = 0;
    for (int k = 0; k < 700; ++k) {
        const bool run = k >= 100;
        const double t = 1e3 * dt * k;
        if (run) x += 0.1 * dt; // 100 mm/s
        const power_request r{.enable = k >= 50 && k < 360};
        const double y = power(r, x * 1_m).value();
        in.add(t, 1e3 * x);
        out.add(t, 1e3 * y);
        state.hold(t, 1e3 * dt, double(power.power()));
    }
    return of("An axis that is enabled at 25 ms, moves from 50 ms on, and loses its enable at 180 ms: "
              "reference and state",
              {over("", "position [mm]", {out, in}), between(over("time [ms]", "state", {state}), -0.3, 2.3)});
}
picture draw_following_error() {
    following_error<> guard{{.window = 1_mm, .per_speed = 20_ms, .patience = 10_ms}, T};
    curve error("error"), window("window", dashed), back("", dashed), share("share of the window"),
        told("1: warns, 2: tripped");
    for (int k = 0; k < 400; ++k) {
        const double t = 0.5 * k, v = t < 60 ? 0 : t < 80 ? 0.1 * (t - 60) / 20 : 0.1;
        const double e = 1e-3 * (0.3 * std::sin(t / 6) + (t < 70 ? 0 : 1.2) + (t < 130 ? 0 : 0.05 * (t - 130)));
        const double y = guard(e * 1_m, v * 1_mps).value();
        error.add(t, 1e3 * e);
        window.add(t, 1 + 20e-3 * v * 1e3);
        share.add(t, y);
        told.hold(t, 0.5, guard.tripped() ? 2 : guard.warns() ? 1 : 0);
    }
    return of("A following error beside its window, its share of the window, and what the guard says",
              {over("", "error [mm]", {error, window}), over("", "share", {share}),
               between(over("time [ms]", "state", {told}), -0.3, 2.3)});
}
} // namespace

family supervision() { return {{"axis_enable", draw_axis_enable}, {"following_error", draw_following_error}}; }
} // namespace block_pictures
