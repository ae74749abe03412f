// SPDX-License-Identifier: BSL-1.0
// Long: one plant: a case for each statement of its page.
#include <quadrant/base/literals.hpp>
#include <quadrant/friction/maxwell_slip.hpp>
#include <quadrant/loop/milling_axis_boxes.hpp>
#include <quadrant/loop/xy_table.hpp>
#include <quadrant/plant/cogging_force.hpp>
#include <quadrant/plant/flexible_modes.hpp>
#include <quadrant/plant/force_ripple.hpp>
#include <quadrant/process/milling_harmonics.hpp>
#include <quadrant/sensor/cyclic_error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string>
#include <type_traits>
#include <vector>

using namespace quadrant;
using namespace quadrant::literals;
namespace {
using doctest::Approx;
const duration T = 500_us;
namespace s = quadrant::signal;

using plain = table_axis_boxes<>;
using plain_table = xy_table<plain, plain>;
const plain::parameters light{.motor = {.mass = 10_kg, .force_constant = 10_N / 1_V}};
const plain::parameters heavy{.motor = {.mass = 25_kg, .force_constant = 25_N / 1_V}};

using x_motor =
    linear_motor<stribeck<>, 32, double, axis_load<cogging_force<2>, force_ripple<>, flexible_modes<2>>>;
using y_motor =
    linear_motor<stribeck<>, 32, double, axis_load<cogging_force<>, through<s::force>, flexible_modes<1>>>;
using x_boxes = table_axis_boxes<x_motor, cyclic_error<>>;
using y_boxes = table_axis_boxes<y_motor, cyclic_error<>>;
using milling_table = xy_table<x_boxes, y_boxes>;

/// The table of [Jamaludin2008] with every effect; sizes of cogging, ripple, cyclic error and coupling are
/// ours.
const milling_table::parameters thesis{
    .x = {.motor = {.mass = 340_kg,
                    .force_constant = 1450_N / 1_V,
                    .friction = {122_N, 177_N, 2.2_mmps, 850_N / 1_mps},
                    .delay = 0.4_ms,
                    .limit = 10_V,
                    .load = {.cogging = {32_mm, {8_N, 3_N}, {0.2, 1.0}},
                             .ripple = {32_mm, {0.01}, {0.5}},
                             .modes = {340_kg, {{{47_Hz, 0.05, 0.2}, {330_Hz, 0.03, -0.05}}}}}},
          .scale = {4_um, {0.05_um}, {}},
          .encoder_step = 0.25_um},
    .y = {.motor = {.mass = 170_kg,
                    .force_constant = 1470_N / 1_V,
                    .friction = {105_N, 165_N, 1_mmps, 16_N / 1_mps},
                    .delay = 0.4_ms,
                    .limit = 10_V,
                    .load = {.cogging = {32_mm, {6_N}, {0.9}},
                             .ripple = {},
                             .modes = {170_kg, {{{44_Hz, 0.05, 0.1}}}}}},
          .scale = {4_um, {0.05_um}, {}},
          .encoder_step = 0.25_um},
    .coupling = {.into_x = 0.01, .into_y = 0.02}};

double up_down(int k) { return 0.2 * std::sin(0.05 * k); }
milling_table::positions run(milling_table& t, int from, int samples) {
    milling_table::positions at;
    for (int k = from; k < from + samples; ++k) {
        const milling_table::commands u{.x = on_x(up_down(k) * 1_V), .y = on_y(up_down(2 * k) * 1_V)};
        at = t(u, {.x = on_x(5_N), .y = on_y(-3_N)});
    }
    return at;
}
bool same(const milling_table::positions& a, const milling_table::positions& b) {
    return a.x.plain() == b.x.plain() && a.y.plain() == b.y.plain();
}
} // namespace

TEST_CASE("xy_table: with every box absent each axis is a linear_motor with its own encoder, bit for bit") {
    using boxes = table_axis_boxes<linear_motor<>>;
    const linear_motor<>::parameters inner{
        .mass = 340_kg, .force_constant = 1450_N / 1_V, .friction = {122_N, 850_N / 1_mps}, .delay = 0.4_ms};
    auto whole = inner;
    whole.encoder_step = 0.25_um;
    linear_motor<> motor{whole, T};
    xy_table<boxes, boxes> t{{.x = {inner, {}, 0.25_um}, .y = {inner, {}, 0.25_um}}, T};
    bool equal = true;
    for (int k = 0; k < 2000; ++k) {
        const auto u = up_down(k) * 1_V;
        const auto at = t({.x = on_x(u), .y = on_y(u)}, {.x = on_x(7_N), .y = on_y(7_N)});
        const auto expected = motor(u, 7_N);
        equal = equal && at.x.plain() == expected && at.y.plain() == expected;
    }
    CHECK(equal);
}

TEST_CASE("xy_table: 5 % of x's 1 m/s^2 drive y by 25 mm in a second, one sample late; nothing comes back") {
    plain_table t{{.x = light, .y = heavy, .coupling = {.into_x = 0, .into_y = 0.05}}, T};
    plain_table::positions at;
    for (int k = 0; k < 2000; ++k) at = t({.x = on_x(1_V), .y = on_y(0_V)});
    CHECK(at.x.plain().value() == Approx(0.5).epsilon(1e-9));
    const double late = 1 - T.value();
    CHECK(at.y.plain().value() == Approx(0.05 * 0.5 * late * late).epsilon(1e-9));
    CHECK(t.y().wire.coupling.value() == Approx(0.05 * 25).epsilon(1e-9)); // on 25 kg
    CHECK(t.x().wire.coupling.value() == 0);
    t.settle({}); // the speed of before is forgotten: nothing accelerates, nothing is coupled
    for (int k = 0; k < 2; ++k) t({.x = on_x(0_V), .y = on_y(0_V)});
    CHECK(t.x().wire.acceleration == 0_mps2);
    CHECK(t.reading().y.plain() == 0_m);
}

TEST_CASE("xy_table: coupled both ways, a steady force moves each as the two equations solved together say") {
    plain_table t{{.x = light, .y = heavy, .coupling = {.into_x = 0.3, .into_y = -0.2}}, T};
    for (int k = 0; k < 100; ++k) t({.x = on_x(1_V), .y = on_y(2_V)});
    // a_x = 1 + 0.3 a_y, a_y = 2 - 0.2 a_x
    CHECK(t.x().wire.acceleration.value() == Approx((1 + 0.3 * 2) / 1.06).epsilon(1e-9));
    CHECK(t.y().wire.acceleration.value() == Approx((2 - 0.2 * 1) / 1.06).epsilon(1e-9));
}

TEST_CASE(
    "xy_table: rigid axis and modes give the response of the machine from command to reading, within 1 %") {
    using motor = linear_motor<coulomb_viscous<>, 32, double,
                               axis_load<absent<s::position, s::force>, through<s::force>, flexible_modes<2>>>;
    using boxes = table_axis_boxes<motor>;
    const flexible_modes<2>::parameters modes{340_kg, {{{47_Hz, 0.05, 0.2}, {330_Hz, 0.03, -0.05}}}};
    const boxes::parameters p{.motor = {.mass = 340_kg,
                                        .force_constant = 1450_N / 1_V,
                                        .friction = {0_N, 9714_N / 1_mps},
                                        .delay = 0.4_ms,
                                        .load = {.cogging = {}, .ripple = {}, .modes = modes}}};
    const flexible_modes<2> machine{modes, T};
    for (const double f : {20.0, 40.0, 45.0, 47.0, 100.0, 300.0, 330.0}) {
        CAPTURE(f);
        table_axis<boxes> axis{.box = {p, T}};
        constexpr int before = 6000, window = 2000; // whole periods of every f
        std::complex<double> sum = 0;
        for (int k = 0; k < before + window; ++k) {
            const double y = axis(0.1 * std::sin(2 * pi * f * k * T.value()) * 1_V).value(); // of sample k + 1
            if (k >= before) sum += y * std::polar(2.0 / window, -2 * pi * f * (k + 1) * T.value());
        }
        const std::complex<double> j{0, 1}, w = 2 * pi * f * j, measured = sum / (0.1 / j);
        const double x = pi * f * T.value();
        const auto hold = std::sin(x) / x * std::exp(-w * (0.5 * T.value() + 0.4e-3));
        const auto model =
            hold * 1450.0 * (1.0 / (340.0 * w * (w + 28.57)) + machine.continuous_response(f * 1_Hz));
        CHECK(std::abs(measured - model) < 0.01 * std::abs(model));
    }
}

TEST_CASE("xy_table: the wires are the diagram, and every one can be tapped") {
    milling_table t{thesis, T};
    run(t, 0, 300);
    const auto& w = t.x().wire;
    CHECK(w.place == w.rigid + w.deflection);
    cyclic_error<> scale{thesis.x.scale, T};
    CHECK(w.scale == scale(w.place));
    quantizer<s::position> encoder{{0.25_um}, T};
    CHECK(w.reading == encoder(w.scale));
    CHECK(w.reading == t.reading().x.plain());
    CHECK(w.deflection != 0_m);
    CHECK(w.coupling != 0_N);
    std::string names;
    for_each_tap(w, t.x().taps(), [&](const char* name, const char* unit, double) {
        names += std::string(name) + " [" + unit + "] ";
    });
    CHECK(names == "command [V] external [N] coupling [N] rigid [m] velocity [m/s] acceleration [m/s^2] "
                   "deflection [m] place [m] "
                   "scale [m] reading [m] ");
}

TEST_CASE("xy_table: two milling_axis loops hold the thesis' table with every effect on a circle, under "
          "cutting force") {
    const auto loop = [](double kp, double ki, double b, double a) {
        return milling_axis<milling_axis_boxes<>>{.box = {{.position_gain = 150.0 / 1_s,
                                                           .velocity_gain = kp * 1_V / 1_mps,
                                                           .velocity_integral = ki * 1_V / 1_m,
                                                           .estimator_corner = 150_Hz,
                                                           .notch = {330_Hz, 0.0606},
                                                           .plant_gain = b * 1_mps2 / 1_V,
                                                           .plant_pole = a / 1_s,
                                                           .limit = 10_V},
                                                          T}};
    };
    auto lx = loop(60, 450, 1450 / 340.0, 2.5);
    auto ly = loop(30, 250, 1470 / 170.0, 0.095);
    milling_table t{thesis, T};
    cutting_force<15> fx{{milling_harmonics::fundamental, milling_harmonics::scale, milling_harmonics::x}, T},
        fy{{milling_harmonics::fundamental, milling_harmonics::scale, milling_harmonics::y}, T};
    const double radius = 0.03, w = 0.1 / radius; // 100 mm/s
    double worst = 0;
    lx.settle(0_m);
    ly.settle(0_m);
    for (int k = 0; k < 8000; ++k) {
        const double time = k * T.value(), ramp = std::min(1.0, time / 1.0), phase = w * time;
        const auto wanted = [&](double c, double dc, double ddc) {
            const double r = radius * ramp * ramp * (3 - 2 * ramp),
                         dr = ramp < 1 ? radius * 6 * ramp * (1 - ramp) : 0,
                         ddr = ramp < 1 ? radius * (6 - 12 * ramp) : 0;
            return milling_axis<milling_axis_boxes<>>::motion{.position = r * c * 1_m,
                                                              .velocity = (dr * c + r * dc) * 1_mps,
                                                              .acceleration =
                                                                  (ddr * c + 2 * dr * dc + r * ddc) * 1_mps2};
        };
        const auto rx = wanted(std::sin(phase), w * std::cos(phase), -w * w * std::sin(phase)),
                   ry = wanted(std::cos(phase), -w * std::sin(phase), -w * w * std::cos(phase));
        const auto at = t.reading();
        const milling_table::commands u{.x = on_x(lx(rx, at.x)), .y = on_y(ly(ry, at.y))};
        if (k >= 3000) {
            const double off = std::hypot(at.x.plain().value(), at.y.plain().value()) - radius;
            worst = std::max(worst, std::abs(off));
        }
        t(u, {.x = on_x(fx()), .y = on_y(fy())});
    }
    CHECK_FALSE(t.faulted());
    CHECK(worst < 100e-6);
}

TEST_CASE("xy_table: a bad sample in one axis moves neither, is told, and forgotten after reset or settle") {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        milling_table t{thesis, T};
        run(t, 0, 300);
        auto twin = t;
        const auto held = t.reading();
        CHECK(same(t({.x = on_x(0_V), .y = on_y(bad * 1_V)}), held));
        CHECK(same(t({.x = on_x(0_V), .y = on_y(0_V)}, {.x = on_x(bad * 1_N), .y = on_y(0_N)}), held));
        CHECK(t.faulted());
        CHECK(same(run(t, 300, 100), run(twin, 300, 100)));
        CHECK(t.faulted());
        t.settle({.x = on_x(1_mm), .y = on_y(2_mm)});
        CHECK_FALSE(t.faulted());
        CHECK(t.reading().x.plain().value() == Approx(1e-3).epsilon(1e-3).scale(0));
        CHECK(t.reading().y.plain().value() == Approx(2e-3).epsilon(1e-3).scale(0));
        t.settle({.x = on_x(bad * 1_m), .y = on_y(0_m)});
        CHECK(t.faulted());
        t.reset();
        milling_table fresh{thesis, T};
        CHECK(same(run(t, 0, 300), run(fresh, 0, 300)));
    }
}

TEST_CASE("xy_table: a copy is a snapshot and drives nothing but itself") {
    milling_table t{thesis, T}, twin{thesis, T};
    run(t, 0, 100), run(twin, 0, 100);
    auto copy = t;
    run(copy, 7, 50);
    CHECK(same(run(t, 100, 100), run(twin, 100, 100)));
}

TEST_CASE("along: of the other axis or of no axis is refused, as a plain quantity it is read") {
    using ax = along<x_direction, quantity_of<s::voltage>>;
    using ay = along<y_direction, quantity_of<s::voltage>>;
    static_assert(std::is_convertible_v<ax, quantity_of<s::voltage>>);
    static_assert(!std::is_convertible_v<quantity_of<s::voltage>, ax>);
    static_assert(!std::is_constructible_v<ax, ay>);
    static_assert(!std::is_assignable_v<ax&, ay>);
    static_assert(std::is_assignable_v<ax&, ax>);
    CHECK(on_x(3_V).plain() == 3_V);
}

TEST_CASE("xy_table: refuses a coupling of one, an encoder in the motor, and modes of another mass") {
    const auto refuse = [](auto change, const char* words) {
        auto p = thesis;
        change(p);
        CHECK_THROWS_WITH_AS((milling_table{p, T}), words, invalid_parameter);
    };
    refuse([](auto& p) { p.coupling.into_x = 1; }, "xy_table.coupling.into_x = 1: must lie between -1 and 1");
    refuse([](auto& p) { p.coupling.into_y = std::nan(""); },
           "xy_table.coupling.into_y = nan: must lie between -1 and 1");
    refuse([](auto& p) { p.x.motor.encoder_step = 1_um; },
           "table_axis.motor.encoder_step = 1e-06 m: must be 0 (the encoder is a box of its own)");
    refuse([](auto& p) { p.y.motor.load.modes.mass = 340_kg; },
           "table_axis.motor.load.modes.mass = 340 kg: must be that of the motor (170 kg)");
}
