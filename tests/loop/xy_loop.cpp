// SPDX-License-Identifier: BSL-1.0
// Long: one loop: a case for each statement of its page.
// The controllers of both axes as one block, and the whole loop of a table.
#include <quadrant/base/literals.hpp>
#include <quadrant/loop/xy_control_lanes.hpp>
#include <quadrant/loop/xy_loop.hpp>
#include <quadrant/process/cutting_force.hpp>
#include <quadrant/process/milling_harmonics.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <string>
#include <utility>

using namespace quadrant;
using namespace quadrant::literals;
namespace s = quadrant::signal;

namespace {
const duration T = 500_us;
using friction = maxwell_slip<4, s::velocity, s::voltage>;
using observer = disturbance_observer<s::voltage>;
using memory = repetitive<s::position, 100, 2, 21, 15>;
using boxes = milling_axis_boxes<friction, observer, memory>;
using alone = xy_control<boxes>;
using together = xy_control<in_lanes<boxes>>;
constexpr double no_number = std::numeric_limits<double>::quiet_NaN();

/// An axis of the table of [Jamaludin2008]; `heavier` scales what the command moves.
boxes::parameters axis_of(double heavier, double gain = 1) {
    boxes::parameters p{.position_gain = gain * 150.0 / 1_s,
                        .velocity_gain = 60_V / 1_mps,
                        .velocity_integral = 450_V / 1_m,
                        .estimator_corner = 150_Hz,
                        .notch = {330_Hz * heavier, 0.06},
                        .plant_gain = 4.526_mps2 / 1_V / heavier,
                        .plant_pole = 2.5_per_s,
                        .friction = {},
                        .disturbance = {60_Hz, axis_model<s::voltage>{4.526_mps2 / 1_V / heavier, 2.5_per_s}},
                        .memory = {.cycle = 85.859 * T, .weights = {2, -1}, .ahead = 7},
                        .limit = 10_V,
                        .dac_step = {}};
    p.friction.curve = {heavier * 0.084_V, heavier * 0.122_V, 2.2_mmps, {}};
    p.friction.forces = {0.045_V, 0.038_V, 0.018_V, 0.0045_V};
    p.friction.stiffness = {42621_V / 1_m, 6794_V / 1_m, 3096_V / 1_m, 224_V / 1_m};
    p.friction.attraction = 0.31_V / 1_s;
    for (std::size_t i = 0; i < 21; ++i) p.memory.learning[i] = 0.3 * std::exp(-0.3 * std::abs(double(i) - 7));
    for (std::size_t i = 0; i < 15; ++i) p.memory.smoothing[i] = 0.9 / 15;
    return p;
}
template <class Control> Control both_axes(double gain = 1) {
    return {{axis_of(1, gain), axis_of(1.3, gain)}, T};
}

alone::motions circle(int k) {
    const double R = 0.03, w = 0.1 / R, a = w * k * T.value(), c = R * std::cos(a), y = R * std::sin(a);
    return {.x = {(c - R) * 1_m, -w * y * 1_mps, -w * w * c * 1_mps2},
            .y = {y * 1_m, w * c * 1_mps, -w * w * y * 1_mps2}};
}
/// What an encoder reads of an axis that follows within some um.
alone::positions seen(int k) {
    const auto r = circle(k);
    const auto off = [&](double phase) { return 5e-6 * std::sin(0.0732 * k + phase) * 1_m; };
    return {.x = on_x(r.x.position + off(0)), .y = on_y(r.y.position + off(1))};
}
double volts_apart(const alone::commands& a, const alone::commands& b) {
    return std::max(std::abs((a.x.plain() - b.x.plain()).value()),
                    std::abs((a.y.plain() - b.y.plain()).value()));
}
/// Rounding of 10 V, times the gain of the loop from a position to the command in a sample, some 1e4 rounded
/// operations.
constexpr double rounding = 1e-11;
} // namespace

TEST_CASE("xy_control: each axis gives what its milling_axis gives, bit for bit") {
    auto both = both_axes<alone>();
    milling_axis<boxes> x{.box = {axis_of(1), T}}, y{.box = {axis_of(1.3), T}};
    for (int k = 0; k < 3000; ++k) {
        const auto u = both(circle(k), seen(k));
        CHECK(u.x.plain() == x(circle(k).x, seen(k).x));
        CHECK(u.y.plain() == y(circle(k).y, seen(k).y));
    }
}

TEST_CASE(
    "xy_control in lanes: the same commands as alone, to rounding, through settle, track, retune and shift") {
    auto one = both_axes<alone>();
    auto two = both_axes<together>();
    bool limited = false;
    for (int k = 0; k < 6000; ++k) {
        CAPTURE(k);
        const auto ahead = circle(k + 1);
        if (k % 2000 == 700) {
            const alone::commands hold{.x = on_x(0.3_V), .y = on_y(-0.2_V)};
            one.settle(seen(k), hold), two.settle(seen(k), hold);
            REQUIRE(volts_apart(one.command_now(), two.command_now()) <= rounding);
        } else if (k % 2000 > 1000 && k % 2000 < 1050) {
            one.track(circle(k), ahead, seen(k), {}), two.track(circle(k), ahead, seen(k), {});
        } else if (k == 3500) {
            one.retune(both_axes<alone>(0.7), ahead), two.retune(both_axes<together>(0.7), ahead);
        } else if (k == 4200) {
            const alone::positions by{.x = on_x(1_um), .y = on_y(-2_um)};
            one.shift(by), two.shift(by);
        } else if (k == 5000) {
            one.reset(), two.reset();
        }
        REQUIRE(volts_apart(one(circle(k), ahead, seen(k)), two(circle(k), ahead, seen(k))) <= rounding);
        REQUIRE(one.limited_x() == two.limited_x());
        REQUIRE(one.limited_y() == two.limited_y());
        REQUIRE(one.faulted() == two.faulted());
        limited = limited || one.limited();
    }
    CHECK(limited); // both happened
    std::map<std::pair<char, std::string>, double> wires;
    one.each_wire([&](char axis, const char* name, const char*, double v) { wires[{axis, name}] = v; });
    std::size_t count = 0;
    two.each_wire([&](char axis, const char* name, const char*, double v) {
        CAPTURE(std::string(name));
        CHECK(std::abs(v - wires.at({axis, name})) <= rounding);
        ++count;
    });
    CHECK(count == wires.size());
    CHECK(count == 2 * milling_axis<boxes>::taps().size());
}

TEST_CASE_TEMPLATE("xy_control: an input of one axis that is no sensible number holds both, and no state moves",
                   C, alone, together) {
    auto hit = both_axes<C>(), twin = hit;
    for (int k = 0; k < 500; ++k) hit(circle(k), seen(k)), twin(circle(k), seen(k));
    const auto last = hit.command_now();
    int refused = 0;
    for (const double bad : {no_number, 1e300, -std::numeric_limits<double>::infinity(), 9e59})
        for (int where = 0; where < 4; ++where) {
            auto r = circle(500);
            auto y = seen(500);
            if (where == 0) r.x.position = bad * 1_m;
            if (where == 1) r.y.acceleration = bad * 1_mps2;
            if (where == 2) y = {.x = y.x, .y = on_y(bad * 1_m)};
            auto ahead = r;
            if (where == 3) ahead.x.velocity = bad * 1_mps;
            const auto u = hit(r, ahead, y);
            CHECK(volts_apart(u, last) == 0);
            CHECK(hit.faulted());
            ++refused;
        }
    CHECK(refused == 16);
    for (int k = 500; k < 600; ++k) CHECK(volts_apart(hit(circle(k), seen(k)), twin(circle(k), seen(k))) == 0);
    CHECK(hit.faulted()); // is reported until reset or settle
    hit.settle(seen(600));
    CHECK_FALSE(hit.faulted());
    hit.settle({.x = on_x(no_number * 1_m), .y = on_y(0_m)});
    CHECK(hit.faulted());
}

TEST_CASE(
    "xy_control in lanes: a number that overflows inside reaches no command, and the loop holds until settle") {
    auto p = axis_of(1);
    p.velocity_gain = 1e300_V / 1_mps;
    p.velocity_integral = {};
    p.limit = std::numeric_limits<double>::infinity() * 1_V;
    together control({p, axis_of(1.3)}, T);
    control.settle({});
    const auto good = control({}, {});
    CHECK_FALSE(control.faulted());
    const auto u = control({.x = {1e20_m, {}, {}}, .y = {}}, {});
    CHECK(control.faulted());
    CHECK(volts_apart(u, good) == 0);
    for (int k = 0; k < 5; ++k) CHECK(volts_apart(control({}, {}), good) == 0);
    control.reset();
    CHECK_FALSE(control.faulted());
    CHECK(std::isfinite(control({}, {}).x.plain().value()));
}

TEST_CASE("xy_control in lanes: what is no number has to be the same on both axes") {
    auto y = axis_of(1.3);
    y.memory.ahead = 6;
    CHECK_THROWS_WITH_AS(together({axis_of(1), y}, T), doctest::Contains("in_lanes.ahead"), invalid_parameter);
}

namespace {
using slide = table_axis_boxes<linear_motor<maxwell_slip<4>>>;
using table = xy_table<slide, slide>;
slide::parameters machine(double heavier) {
    linear_motor<maxwell_slip<4>>::parameters m{
        .mass = heavier * 320_kg, .force_constant = 1450_N / 1_V, .friction = {}, .delay = 0.4_ms};
    m.friction.curve = {heavier * 122_N, heavier * 177_N, 2.2_mmps, 800_N / 1_mps};
    m.friction.forces = {65_N, 55_N, 26_N, 6.5_N};
    m.friction.stiffness = {61.8e6_N / 1_m, 9.852e6_N / 1_m, 4.49e6_N / 1_m, 0.325e6_N / 1_m};
    m.friction.attraction = 450_N / 1_s;
    return {.motor = m, .encoder_step = 250_nm};
}
/// Radial error of the second turn and later in the cut, um rms.
template <class Boxes> double radial_error(bool compensated) {
    auto x = axis_of(1), y = axis_of(1.3);
    for (auto* p : {&x, &y})
        if (compensated) { // a memory that is sure not to grow: Q W below 0.9, one tap of L
            p->memory.weights = {1, 0};
            p->memory.learning = {0.5};
        } else {
            p->friction.curve = {1e-9_V, 1e-9_V, 2.2_mmps, {}};
            p->friction.forces = {1e-10_V, 1e-10_V, 1e-10_V, 1e-10_V};
            p->disturbance.corner = 0.01_Hz;
            p->memory.weights = {0, 0};
        }
    namespace cut = milling_harmonics;
    xy_loop<Boxes, Boxes, table, cutting_force<15>> loop(
        {.control = {x, y},
         .table = {.x = machine(1), .y = machine(1.3)},
         .process_x = {cut::fundamental, 1.38 * cut::scale, cut::x},
         .process_y = {cut::fundamental, 1.38 * cut::scale, cut::y}},
        T);
    const int turn = int(2 * std::numbers::pi * 0.03 / 0.1 / T.value());
    double squares = 0;
    for (int k = 0; k < 2 * turn; ++k) {
        auto r = circle(k);
        const double start = 1 - std::exp(-k / 400.0); // the axes do not jump to 0.1 m/s
        if (k < 4000) r.y.velocity *= start;
        loop(r);
        REQUIRE_FALSE(loop.faulted());
        const double at_x = 0.03 + loop.table().x().wire.place.value(),
                     at_y = loop.table().y().wire.place.value();
        const double error = 1e6 * (std::hypot(at_x, at_y) - 0.03);
        if (k >= turn) squares += error * error;
    }
    return std::sqrt(squares / turn);
}
} // namespace

TEST_CASE("xy_loop: in the cut, with every compensation on, the radial error is below 4.5 um rms, half of that "
          "without") {
    const double without = radial_error<boxes>(false), with = radial_error<boxes>(true),
                 in_the_lanes = radial_error<in_lanes<boxes>>(true);
    MESSAGE("um rms: without " << without << ", with " << with << ", in lanes " << in_the_lanes);
    CHECK(with < 4.5);
    CHECK(with < without / 2);
    CHECK(std::abs(with - in_the_lanes) < 0.05 * with); // an encoder turns a last digit into a count
}

TEST_CASE("xy_loop: settles where it is told, shows every wire of both axes, and a bad reference stops the "
          "controllers") {
    xy_loop<boxes, boxes, table> loop(
        {.control = {axis_of(1), axis_of(1.3)}, .table = {machine(1), machine(1.3)}}, T);
    const decltype(loop)::positions at{.x = on_x(10_mm), .y = on_y(-5_mm)};
    loop.settle(at);
    const decltype(loop)::motions rest{.x = {10_mm, {}, {}}, .y = {-5_mm, {}, {}}};
    for (int k = 0; k < 1000; ++k) loop(rest);
    CHECK(std::abs((loop.table().reading().x.plain() - 10_mm).value()) < 1e-6);
    std::map<std::pair<char, std::string>, double> wires;
    loop.each_wire([&](char axis, const char* name, const char*, double v) { wires[{axis, name}] = v; });
    CHECK(wires.at({'x', "reference"}) == 0.01);
    CHECK(wires.at({'y', "rigid"}) == doctest::Approx(-0.005).epsilon(1e-3));
    const auto before = loop.control().command_now();
    loop({.x = {no_number * 1_m, {}, {}}, .y = {}});
    CHECK(loop.faulted());
    CHECK(loop.control().command_now().x.plain() == before.x.plain());
    loop.reset();
    CHECK_FALSE(loop.faulted());
}
