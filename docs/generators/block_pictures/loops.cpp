// SPDX-License-Identifier: BSL-1.0
// Long: a function for each picture.
// Loops around the stock cascade, and what composes them.
#include "families.hpp"

#include <quadrant/quadrant.hpp>

#include <fmt/format.h>

namespace block_pictures {
namespace {
const duration T = 500_us;
constexpr double pi = std::numbers::pi;

template <class Estimator = filtered_derivative<s::position, s::velocity>>
using cascade_boxes = cascade_p_pi_boxes<Estimator, notch<s::voltage>>;
/// The controller of examples/02_closed_loop.cpp.
template <class Boxes = cascade_boxes<>> typename Boxes::parameters tuning() {
    typename Boxes::parameters p{.position_gain = 150.0 / 1_s,
                                 .velocity_gain = 60_V / 1_mps,
                                 .velocity_integral = 450_V / 1_m,
                                 .estimator = {},
                                 .notch = {.centre = 330_Hz, .width = 0.06},
                                 .limit = 10_V,
                                 .dac_step = {}};
    if constexpr (requires { p.estimator.corner; }) p.estimator.corner = 150_Hz;
    p.velocity_feedforward = 1;
    p.acceleration_feedforward = 340_kg / (1450_N / 1_V);
    p.viscous_feedforward = 950_N / 1_mps / (1450_N / 1_V);
    p.coulomb_feedforward = 122_N / (1450_N / 1_V);
    return p;
}
linear_motor<stribeck<>> machine() {
    return {{.mass = 340_kg,
             .force_constant = 1450_N / 1_V,
             .friction = {122_N, 177_N, 2.22_mmps, 950_N / 1_mps},
             .delay = 0.4_ms,
             .limit = 10_V,
             .encoder_step = 250_nm},
            T};
}
double sway(double t) { return 0.03 * (1 - std::cos(3.3333 * t)); } // 30 mm, 100 mm/s at most

double smooth_step(double t) { // 20 mm in 0.3 s, from 20 ms on
    const double u = std::clamp((t - 0.02) / 0.3, 0.0, 1.0);
    return 0.02 * (u - std::sin(2 * pi * u) / (2 * pi));
}

picture draw_cascade() {
    auto without = tuning();
    without.acceleration_feedforward = {}, without.viscous_feedforward = {}, without.coulomb_feedforward = {};
    cascade<cascade_boxes<>> a{.box = {tuning(), T}}, b{.box = {without, T}};
    auto x = machine(), y = machine();
    auto at_x = 0_m, at_y = 0_m;
    curve r("reference"), with("with feedforward"), bare("velocity feedforward alone");
    for (int k = 0; k < 4000; ++k) {
        const double t = 5e-4 * k;
        at_x = x(a(sway(t) * 1_m, at_x)), at_y = y(b(sway(t) * 1_m, at_y));
        if (k % 4 != 0) continue;
        r.add(t, 1e3 * sway(t));
        with.add(t, 1e6 * a.wire.position_error.value());
        bare.add(t, 1e6 * b.wire.position_error.value());
    }
    return of("A cascade that moves a linear motor 60 mm there and back: reference, position error with and "
              "without feedforward of mass and friction",
              {over("", "position [mm]", {r}), over("time [s]", "error [um]", {with, bare})});
}
picture draw_maps() {
    using plain = cascade_boxes<two_sample_derivative<s::position, s::velocity>>;
    cascade<cascade_boxes<>> a{.box = {tuning(), T}};
    cascade<plain> b{.box = {tuning<plain>(), T}};
    auto x = machine(), y = machine();
    auto at_x = 0_m, at_y = 0_m;
    curve one("filtered_derivative"), other("two_sample_derivative");
    for (int k = 0; k < 400; ++k) {
        const double t = 5e-4 * k;
        at_x = x(a(sway(t) * 1_m, at_x)), at_y = y(b(sway(t) * 1_m, at_y));
        if (k < 200) continue;
        one.add(1e3 * t, 1e3 * a.wire.velocity_error.value());
        other.add(1e3 * t, 1e3 * b.wire.velocity_error.value());
    }
    return of("Velocity error of one cascade with two boxes that map position to velocity in the same place",
              {over("time [ms]", "velocity error [mm/s]", {one, other})});
}
picture draw_taps() {
    cascade<cascade_boxes<>> a{.box = {tuning(), T}};
    auto x = machine();
    auto at = 0_m;
    std::vector<panel> all;
    for (int k = 0; k < 1000; ++k) {
        const double t = 5e-4 * k;
        const auto r = smooth_step(t);
        at = x(a(r * 1_m, at));
        std::size_t i = 0;
        for_each_tap(a.wire, a.taps(), [&](const char* name, const char* unit, double value) {
            const std::string wire = name;
            if (wire != "reference" && wire != "position_error" && wire != "demand" && wire != "inertia" &&
                wire != "command")
                return;
            if (k == 0) all.push_back(over("", fmt::format("[{}]", unit), {curve(wire)}));
            all[i].lines[0].x.push_back(1e3 * t), all[i].lines[0].y.push_back(value);
            ++i;
        });
    }
    all.back().x_label = "time [ms]";
    return of("Five of the fifteen taps of a cascade along a move of 20 mm, with the names and units that the "
              "list gives",
              std::move(all));
}
picture draw_parameter_swap() {
    auto first = tuning();
    first.velocity_feedforward = 0, first.acceleration_feedforward = {}, first.viscous_feedforward = {},
    first.coulomb_feedforward = {};
    cascade<cascade_boxes<>> a{.box = {first, T}};
    auto other = first;
    other.position_gain = 60.0 / 1_s;
    parameter_swap<cascade_boxes<>> tuning_slots{a.box};
    linear_motor<> x{{.mass = 340_kg,
                      .force_constant = 1450_N / 1_V,
                      .friction = {.coulomb = 0_N, .viscous = 950_N / 1_mps},
                      .delay = 0.4_ms},
                     T};
    auto at = 0_m;
    curve place("position"), r("reference", dashed), taken("set in use");
    int set = 1;
    for (int k = 0; k < 1200; ++k) {
        const double t = 0.5 * k, wanted = 1e-5 * std::floor(t / 100);
        if (k == 650) tuning_slots.offer(cascade_boxes<>{other, T}); // the thread that tunes
        if (const auto* next = tuning_slots.take()) a.retune(*next), set = 2;
        at = x(a(wanted * 1_m, at));
        place.add(t, 1e6 * at.value()), r.hold(t, 0.5, 1e6 * wanted), taken.hold(t, 0.5, set);
    }
    return of("Steps of 10 um; at 325 ms another set of gains is taken whole, between two samples",
              {over("", "position [um]", {place, r}), between(over("time [ms]", "set", {taken}), 0.7, 2.3)});
}

picture draw_gantry_pair() {
    gantry_pair<> beam{{.share = 0.35, .limit = 100_N}, T};
    curve along("asked along"), turn("asked to turn"), left("left along"), kept("left to turn"),
        first("motor 1"), second("motor 2"), limit("limit", dashed);
    for (int k = 0; k <= 400; ++k) {
        const double t = 0.5 * k, u = 1.2 * t, w = t < 100 ? 0 : 40;
        const auto d = beam.split(u * 1_N, w * 1_N);
        along.add(t, u), turn.add(t, w);
        left.add(t, d.mean.value()), kept.add(t, d.skew.value());
        first.add(t, d.first.value()), second.add(t, d.second.value());
    }
    limit.add(0, 100), limit.add(200, 100);
    return of("Two motors of 100 N at a beam with 35 % of its mass at end 1: a growing push along, and a turn "
              "of 40 N from 100 ms on",
              {over("", "asked [N]", {along, turn}), over("", "left [N]", {left, kept}),
               over("time [ms]", "motors [N]", {first, second, limit})});
}

using loaded = linear_motor<coulomb_viscous<>, 32, double,
                            axis_load<cogging_force<1>, through<s::force>, flexible_modes<1>>>;
picture draw_table_axis() {
    using boxes = table_axis_boxes<loaded, cyclic_error<>>;
    boxes::parameters p{.motor = {.mass = 340_kg,
                                  .force_constant = 1450_N / 1_V,
                                  .friction = {.coulomb = 0_N, .viscous = 950_N / 1_mps}},
                        .scale = {2_mm, {0.5_um}, {}}};
    p.motor.load.cogging = {1_mm, {40_N}, {}};
    p.motor.load.modes = {340_kg, {{{47_Hz, 0.03, 0.2}}}};
    table_axis<boxes> axis{.box = {p, T}};
    curve place("place"), bent("deflection of the mode"), added("reading - place: the scale");
    for (int k = 0; k < 500; ++k) {
        const double t = 0.5 * k;
        axis((t < 20 ? 0 : t < 70 ? 0.5 : t < 120 ? -0.4 : 0) * 1_V);
        place.add(t, 1e3 * axis.wire.place.value());
        bent.add(t, 1e6 * axis.wire.deflection.value());
        added.add(t, 1e6 * (axis.wire.reading - axis.wire.place).value());
    }
    return of("Wires of a table axis with cogging, a mode of 47 Hz and a scale that errs: 0.5 V forward from "
              "20 ms on, -0.4 V from 70 to 120 ms",
              {over("", "place [mm]", {place}), over("", "mode [um]", {bent}),
               over("time [ms]", "scale [um]", {added})});
}
picture draw_xy_table() {
    using boxes = table_axis_boxes<>;
    using table = xy_table<boxes, boxes>;
    const boxes::parameters axis{.motor = {.mass = 340_kg,
                                           .force_constant = 1450_N / 1_V,
                                           .friction = {.coulomb = 0_N, .viscous = 950_N / 1_mps}}};
    auto given = tuning();
    given.coulomb_feedforward = {};
    curve acceleration("x"), coupled("y, into_y = 0.05"), alone("y, into_y = 0");
    for (const double into_y : {0.05, 0.0}) {
        table t{{.x = axis, .y = axis, .coupling = {.into_x = 0, .into_y = into_y}}, T};
        cascade<cascade_boxes<>> x{.box = {given, T}}, y{.box = {given, T}};
        for (int k = 0; k < 800; ++k) {
            const auto at = t.reading();
            t({.x = on_x(x(smooth_step(5e-4 * k) * 1_m, at.x)), .y = on_y(y(0_m, at.y))});
            if (into_y > 0) acceleration.add(0.5 * k, t.x().wire.acceleration.value());
            (into_y > 0 ? coupled : alone).add(0.5 * k, 1e6 * t.y().wire.place.value());
        }
    }
    return of("x of a table moves 20 mm, y is held at zero: acceleration of x, and where y goes with 5 % of "
              "coupling and without",
              {over("", "acceleration [m/s^2]", {acceleration}),
               over("time [ms]", "position of y [um]", {coupled, alone})});
}
/// Gains and friction as [Jamaludin2008] prints them for x; y is a third heavier.
template <class Boxes> typename Boxes::parameters axis_in_circle(double heavier) {
    typename Boxes::parameters p{.position_gain = 150.0 / 1_s,
                                 .velocity_gain = 60_V / 1_mps,
                                 .velocity_integral = 450_V / 1_m,
                                 .estimator_corner = 150_Hz,
                                 .notch = {330_Hz, 0.06},
                                 .plant_gain = 4.526_mps2 / 1_V / heavier,
                                 .plant_pole = 2.5_per_s,
                                 .friction = {},
                                 .limit = 10_V};
    if constexpr (requires { p.friction.curve; }) {
        p.friction.curve = {0.084_V, 0.122_V, 2.2_mmps, {}};
        p.friction.forces = {0.045_V, 0.038_V, 0.018_V, 0.0045_V};
        p.friction.stiffness = {42621_V / 1_m, 6794_V / 1_m, 3096_V / 1_m, 224_V / 1_m};
        p.friction.attraction = 0.31_V / 1_s;
        p.disturbance = {60_Hz, axis_model<signal::voltage>{4.526_mps2 / 1_V / heavier, 2.5_per_s}};
    }
    return p;
}
template <class Boxes> curve on_a_circle(const char* name) {
    using motor = linear_motor<maxwell_slip<4>>;
    using slide = table_axis_boxes<motor>;
    const auto machine = [](double heavier) {
        motor::parameters m{
            .mass = heavier * 320_kg, .force_constant = 1450_N / 1_V, .friction = {}, .delay = 0.4_ms};
        m.friction.curve = {122_N, 177_N, 2.2_mmps, 800_N / 1_mps};
        m.friction.forces = {65_N, 55_N, 26_N, 6.5_N};
        m.friction.stiffness = {61.8e6_N / 1_m, 9.852e6_N / 1_m, 4.49e6_N / 1_m, 0.325e6_N / 1_m};
        m.friction.attraction = 450_N / 1_s;
        return slide::parameters{.motor = m, .encoder_step = 250_nm};
    };
    xy_loop<Boxes, Boxes, xy_table<slide, slide>> loop(
        {.control = {axis_in_circle<Boxes>(1), axis_in_circle<Boxes>(1.3)},
         .table = {machine(1), machine(1.3)}},
        T);
    curve radial(name);
    const double R = 0.03, w = 0.02 / R, turn = 2 * pi / w, run_in = 0.2;
    for (int k = 0; k * T.value() < 1.5 * turn; ++k) {
        const double t = k * T.value(), late = std::exp(-t / run_in), angle = w * (t - run_in * (1 - late));
        const double v = w * (1 - late), a = w / run_in * late, s = R * std::sin(angle),
                     c = R * std::cos(angle);
        const double x = R + loop.table().x().wire.place.value(), y = loop.table().y().wire.place.value();
        if (t > 0.5 * turn && k % 40 == 0) radial.add(angle * 180 / pi - 180, 1e6 * (std::hypot(x, y) - R));
        loop({.x = {(c - R) * 1_m, -s * v * 1_mps, (-s * a - c * v * v) * 1_mps2},
              .y = {s * 1_m, c * v * 1_mps, (c * a - s * v * v) * 1_mps2}});
    }
    return radial;
}
picture draw_xy_loop() {
    using friction = maxwell_slip<4, signal::velocity, signal::voltage>;
    using compensated = milling_axis_boxes<friction, disturbance_observer<signal::voltage>>;
    return of("Radial error of a table on a circle of 30 mm at 20 mm/s: cascade and inverse of the axis alone, "
              "and with "
              "Maxwell-slip friction and disturbance observer",
              {over("angle from 180 deg [deg]", "radial error [um]",
                    {on_a_circle<milling_axis_boxes<>>("cascade"),
                     on_a_circle<compensated>("with friction and observer")})});
}
} // namespace

family loops() {
    return {{"cascade", draw_cascade},
            {"maps", draw_maps},
            {"taps", draw_taps},
            {"parameter_swap", draw_parameter_swap},
            {"gantry_pair", draw_gantry_pair},
            {"table_axis", draw_table_axis},
            {"xy_table", draw_xy_table},
            {"xy_loop", draw_xy_loop}};
}
} // namespace block_pictures
