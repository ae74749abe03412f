// SPDX-License-Identifier: BSL-1.0
// Long: main() drives one table through its states in their order.
// quadrant_xy without LinuxCNC, on the stub beside this file: it has to do what two quadrant_axis do, each of
// them on a plant of its own, and stop both axes where one of them is lost.
#include "claims.hpp"
#include "linuxcnc/component.hpp"
#include "linuxcnc/quadrant_axis.hpp"
#include "linuxcnc/quadrant_plant.hpp"
#include "linuxcnc/quadrant_xy.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

using text = std::string;
static volatile double& real(const text& name) { return *stub::reals.at(name); }
static volatile bool& bit(const text& name) { return *stub::bits.at(name); }
static void call(const text& name) {
    const auto& f = stub::functions.at(name);
    real_time = true;
    f.call(f.self, 1000000);
    real_time = false;
}
/// The pin of an axis of the table, and the same pin of the component of that axis.
static text of_table(int axis, const text& pin) { return text("quadrant-xy.0.") + "xy"[axis] + "." + pin; }
static text of_axis(int axis, const text& pin) { return "quadrant-axis." + std::to_string(axis) + "." + pin; }
static void set(int axis, const text& pin, double value) {
    real(of_table(axis, pin)) = value;
    real(of_axis(axis, pin)) = value;
}
static void enable(bool on) {
    for (int axis : {0, 1}) {
        bit(of_table(axis, "enable")) = on;
        bit(of_axis(axis, "enable")) = on;
    }
}

static double t = 0;
static bool equal = true;
static void period() {
    for (const char* name : {"quadrant-axis.0", "quadrant-axis.1", "quadrant-xy.0"}) call(name);
    for (int axis : {0, 1}) {
        equal = equal && real(of_table(axis, "output")) == real(of_axis(axis, "output"));
        for (const auto& tap : hal::hal_axis::taps()) {
            const text wire = hal::pin_name("wire", tap.name),
                       table = text("quadrant-xy.0.wire.") + "xy"[axis] + wire.substr(4);
            equal = equal && real(table) == real(of_axis(axis, wire));
        }
        const text of_axes = "quadrant-plant." + std::to_string(axis),
                   of_tables = "quadrant-plant." + std::to_string(axis + 2);
        real(of_axes + ".command") = real(of_axis(axis, "output"));
        real(of_tables + ".command") = real(of_table(axis, "output"));
        call(of_axes), call(of_tables);
        real(of_axis(axis, "feedback")) = real(of_axes + ".position");
        real(of_table(axis, "feedback")) = real(of_tables + ".position");
    }
}
static void circle(int periods) { // 30 mm, 63 mm/s
    for (int k = 0; k < periods; ++k, t += 1e-3) {
        set(0, "command", 30 * (std::cos(2.1 * t) - 1));
        set(1, "command", 30 * std::sin(2.1 * t));
        period();
    }
}

int main() {
    hal::instance<hal::hal_axis> axis_x(1, 0), axis_y(1, 1);
    hal::instance<hal::hal_xy> table(1, 0);
    hal::instance<hal::hal_plant> plants[] = {{1, 0}, {1, 1}, {1, 2}, {1, 3}};
    claim(table.error() == 0, "all pins are made, no name is too long or there twice");
    bool all = true;
    for (char axis : {'x', 'y'})
        for (const auto& tap : hal::hal_axis::taps())
            all = all && stub::reals.count(hal::pin_name(text("quadrant-xy.0.wire.") + axis, tap.name)) == 1;
    claim(all, "every wire of both axes is a pin");

    const std::pair<const char*, std::array<double, 2>> settings[] = {
        {"velocity-gain", {50, 25}},        {"velocity-integral", {450, 250}},
        {"plant-gain", {4.1, 8.6}},         {"plant-pole", {2.5, 1.21}},
        {"friction-coulomb", {0.07, 0.06}}, {"friction-static", {0.1, 0.09}},
        {"observer-corner", {20, 15}},      {"observer-on", {1, 1}},
        {"notch-centre", {330, 294}},       {"notch-width", {0.0606, 0.17}},
        {"dac-step", {0.0003, 0.0003}}};
    for (const auto& [name, values] : settings)
        for (int axis : {0, 1}) set(axis, name, values[std::size_t(axis)]);
    const std::pair<const char*, std::array<double, 2>> machine[] = {{"mass", {340, 165}},
                                                                     {"force-constant", {1450, 1470}},
                                                                     {"friction-viscous", {850, 200}},
                                                                     {"friction-coulomb", {122, 105}},
                                                                     {"friction-static", {177, 165}},
                                                                     {"delay", {4e-4, 4e-4}},
                                                                     {"encoder-step", {2.5e-7, 2.5e-7}}};
    for (const auto& [name, values] : machine)
        for (int plant : {0, 1, 2, 3})
            real("quadrant-plant." + std::to_string(plant) + "." + name) = values[std::size_t(plant % 2)];
    period();
    // look() is what the component's thread does: here at a moment of our choice.
    const auto look = [&] {
        axis_x.look(), axis_y.look(), table.look();
        for (auto& each : plants) each.look();
    };
    claim(bit("quadrant-xy.0.fault"), "before the first loop: a fault");
    look();
    period();
    enable(true);
    circle(4000);
    claim(!bit("quadrant-xy.0.fault"), "then none");
    const double late = std::max(std::abs(real("quadrant-xy.0.wire.x.position-error")),
                                 std::abs(real("quadrant-xy.0.wire.y.position-error")));
    claim(late < 20e-6, "both axes follow a circle");
    claim(equal, "outputs and wires are those of two quadrant_axis, bit by bit");

    // Both axes change at once: taking a new set works on the whole table.
    for (const auto& [of_x, x, of_y, y] : {std::tuple{"velocity-gain", 40.0, "velocity-gain", 30.0},
                                           {"notch-centre", 300.0, "notch-centre", 310.0},
                                           {"observer-on", 0.0, "friction-coulomb", 0.05},
                                           {"memory-weight", 1.0, "velocity-integral", 200.0},
                                           {"memory-weight", 0.0, "memory-weight", 1.0},
                                           {"plant-gain", 4.4, "memory-weight", 0.0}}) {
        set(0, of_x, x), set(1, of_y, y);
        look();
        circle(700);
    }
    claim(equal && !bit("quadrant-xy.0.fault"), "the same through changes of parameters in motion");
    enable(false);
    circle(30);
    claim(real(of_table(0, "output")) == 0 && real(of_table(1, "output")) == 0, "off: 0");
    enable(true);
    circle(700);
    claim(equal, "the same when it is enabled on the move");

    bit(of_table(1, "enable")) = false;
    circle(1);
    claim(real(of_table(0, "output")) == 0 && real(of_table(1, "output")) == 0,
          "one axis is not enabled: both are off");
    bit(of_table(1, "enable")) = true;
    circle(1000);
    claim(!bit("quadrant-xy.0.fault") && real(of_table(0, "output")) != 0, "enabled again");

    for (const char* pin : {"feedback", "command"})
        for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity(), 1e300}) {
            const double held_x = real(of_table(0, "output")), held_y = real(of_table(1, "output"));
            const double good = real(of_table(1, pin));
            real(of_table(1, pin)) = bad;
            call("quadrant-xy.0");
            real(of_table(1, pin)) = good;
            claim(bit("quadrant-xy.0.fault") && real(of_table(0, "output")) == held_x &&
                      real(of_table(1, "output")) == held_y,
                  "y is lost: both outputs are held, fault");
            circle(1);
            claim(bit("quadrant-xy.0.fault"), "the fault stays");
            enable(false);
            circle(1);
            enable(true);
            circle(500);
            claim(!bit("quadrant-xy.0.fault"), "until both were off");
        }

    real(of_table(1, "notch-centre")) = 501;
    table.look();
    claim(bit("quadrant-xy.0.refused") && stub::said.starts_with("quadrant-xy.0: y: notch.centre = 501 Hz: "),
          stub::said.c_str());
    real(of_table(1, "notch-centre")) = std::nan("");
    table.look();
    claim(bit("quadrant-xy.0.refused") && stub::said == "quadrant-xy.0: y.notch-centre = nan: must be finite\n",
          stub::said.c_str());
    real(of_table(1, "notch-centre")) = 294;
    table.look();
    claim(!bit("quadrant-xy.0.refused"), "refused until it is right");
    claim(allocations == 0, "the real-time functions allocate nothing");
    return failures == 0 ? 0 : 1;
}
