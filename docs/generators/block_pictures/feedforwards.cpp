// SPDX-License-Identifier: BSL-1.0
// Feedforward: what is added to a command or reference before there is an error.
#include "families.hpp"

#include <quadrant/feedforward/backlash_compensation.hpp>
#include <quadrant/feedforward/cogging_harmonics.hpp>
#include <quadrant/feedforward/cogging_table.hpp>
#include <quadrant/feedforward/friction_feedforward.hpp>
#include <quadrant/feedforward/inverse_model.hpp>
#include <quadrant/feedforward/preview.hpp>
#include <quadrant/feedforward/sampled_inverse_model.hpp>
#include <quadrant/friction/stribeck.hpp>
#include <quadrant/plant/backlash.hpp>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

picture draw_backlash_compensation() {
    backlash_compensation<> help{{20_um, 4_mmps, 1_um}, T};
    backlash<> play{{20_um}, T}, bare{{20_um}, T};
    help.settle(0_m, +1);
    play.settle(0_m), bare.settle(0_m);
    curve reference("reference", dashed), with("load, compensated"), without("load, not compensated"),
        added("added to the reference");
    for (int k = 0; k <= 800; ++k) {
        const double t = 0.5 * k;
        const auto r = 50_um * std::sin(2 * pi * t / 200);
        const auto add = help(r);
        reference.add(t, 1e6 * r.value());
        with.add(t, 1e6 * play(r + add).value());
        without.add(t, 1e6 * bare(r).value());
        added.add(t, 1e6 * add.value());
    }
    return of(
        "A sine of 50 um through a play of 20 um, with and without compensation, and what it adds",
        {over("", "position [um]", {with, without, reference}), over("time [ms]", "added [um]", {added})});
}
picture draw_cogging_harmonics() {
    cogging_harmonics<2> both{{24_mm, {{{1, 20_N, 0}, {6, 6_N, 0.5}}}}, T},
        first{{24_mm, {{{1, 20_N, 0}, {6, 0_N, 0}}}}, T};
    curve sum("orders 1 and 6"), one("order 1 alone", dashed);
    for (int i = 0; i <= 480; ++i) {
        const double x = 0.1 * i;
        sum.add(x, both(x * 1_mm).value());
        one.add(x, first(x * 1_mm).value());
    }
    return of("Force over position of two cogging harmonics on a pitch of 24 mm",
              {over("position [mm]", "force [N]", {sum, one})});
}
picture draw_cogging_table() {
    const std::array<quantity<si::force>, 8> table{0_N, 14_N, 20_N, 9_N, -2_N, -13_N, -21_N, -8_N};
    cogging_table<8, s::force, 1> straight{{24_mm, table}, T};
    cogging_table<8> cubic{{24_mm, table}, T};
    curve lines("order 1", dashed), curved("order 3"), nodes("points", points);
    for (int i = 0; i <= 360; ++i) {
        const double x = 0.1 * i;
        lines.add(x, straight(x * 1_mm).value());
        curved.add(x, cubic(x * 1_mm).value());
    }
    for (int i = 0; i <= 12; ++i) nodes.add(3.0 * i, table[std::size_t(i % 8)].value());
    return of("Force over position of a cogging table of 8 points over 24 mm, order 1 and 3",
              {over("position [mm]", "force [N]", {curved, lines, nodes})});
}
picture draw_friction_feedforward() {
    using law = stribeck<>;
    const law::parameters friction{122_N, 177_N, 1_mps / 450.0, 950_N / 1_mps};
    using block = friction_feedforward<law, s::voltage>;
    block off{{friction, 1450_N / 1_V, 1_mmps, 1, at_rest::off}, T},
        held{{friction, 1450_N / 1_V, 1_mmps, 1, at_rest::held}, T};
    law bare{friction, T};
    curve v("velocity"), a("off"), b("held"), c("the law itself", dashed);
    for (int k = 0; k <= 800; ++k) { // one reversal with a rest in it
        const double t = 0.5 * k, speed = t < 120   ? 20 * std::cos(pi * t / 240)
                                          : t < 280 ? 0
                                                    : -20 * std::sin(pi * (t - 280) / 240);
        v.add(t, speed);
        a.add(t, off(speed * 1_mmps).value());
        b.add(t, held(speed * 1_mmps).value());
        c.add(t, bare(speed * 1_mmps).value() / 1450);
    }
    return of("A reference that stops and reverses, and the friction feedforward: off, held, and the bare law",
              {over("", "velocity [mm/s]", {v}), over("time [ms]", "command [V]", {a, b, c})});
}

/// A move of 10 mm from rest to rest with limited jerk.
axis_motion<> move(double t) {
    constexpr double length = 0.01, time = 0.2;
    const double u = std::clamp(t / time, 0.0, 1.0), w = 2 * pi / time, on = t > 0 && t < time;
    return {length * (u - std::sin(2 * pi * u) / (2 * pi)) * 1_m,
            on * length / time * (1 - std::cos(w * t)) * 1_mps,
            on * length / time * w * std::sin(w * t) * 1_mps2};
}
picture draw_inverse_model() {
    inverse_model<s::voltage> b{{4.526_mps2 / 1_V, 28.57 / 1_s}, T};
    inverse_model<s::voltage> mass{{4.526_mps2 / 1_V, 0.0 / 1_s}, T};
    curve v("velocity"), u("command"), part("of it for the mass", dashed);
    for (int k = 0; k <= 500; ++k) {
        const double t = 0.5 * k;
        const auto r = move(1e-3 * (t - 25));
        v.add(t, 1e3 * r.velocity.value());
        u.add(t, b(r).value());
        part.add(t, mass(r).value());
    }
    return of("A move of 10 mm and the command that makes the nominal axis do it",
              {over("", "velocity [mm/s]", {v}), over("time [ms]", "command [V]", {u, part})});
}
picture draw_sampled_inverse_model() {
    inverse_model<s::voltage> exact{{4.526_mps2 / 1_V, 28.57 / 1_s}, 5_ms};
    sampled_inverse_model<s::voltage> b{axis_model<s::voltage>{4.526_mps2 / 1_V, 28.57 / 1_s}, 5_ms};
    curve u("sampled_inverse_model, from positions"),
        truth("inverse_model, from velocity and acceleration", dashed);
    for (int k = 0; k <= 50; ++k) {
        const auto r = move(5e-3 * (k - 5));
        u.hold(5 * k, 5, b(r.position).value());
        truth.hold(5 * k, 5, exact(r).value());
    }
    return of("The command for a move of 10 mm from positions alone, at 5 ms, beside that from its derivatives",
              {over("time [ms]", "command [V]", {u, truth})});
}
picture draw_preview() {
    preview<4> look{{5_ms}, 2_ms};
    curve in("trajectory", dashed), late("reference"), ahead("ahead, lead 5 ms");
    for (int k = 0; k <= 60; ++k) {
        const double t = 2 * k;
        const auto r = move(2e-3 * 2 * (k - 5)); // twice as fast
        const auto y = look(r);
        in.add(t, 1e3 * r.position.value());
        late.add(t, 1e3 * y.reference.position.value());
        ahead.add(t, 1e3 * y.ahead.position.value());
    }
    return of("A move through a preview of 4 periods of 2 ms with a lead of 5 ms",
              {over("time [ms]", "position [mm]", {late, ahead, in})});
}
} // namespace

family feedforwards() {
    return {{"backlash_compensation", draw_backlash_compensation},
            {"cogging_harmonics", draw_cogging_harmonics},
            {"cogging_table", draw_cogging_table},
            {"friction_feedforward", draw_friction_feedforward},
            {"inverse_model", draw_inverse_model},
            {"sampled_inverse_model", draw_sampled_inverse_model},
            {"preview", draw_preview}};
}
} // namespace block_pictures
