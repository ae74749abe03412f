// SPDX-License-Identifier: BSL-1.0
// Long: main() loads one component after the other and checks its pins.
// The HAL components without LinuxCNC: on the stub beside this file, called period by period.
#include "claims.hpp"
#include "linuxcnc/component.hpp"
#include "linuxcnc/quadrant_axis.hpp"
#include "linuxcnc/quadrant_plant.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

static volatile double& real(const char* name) { return *stub::reals.at(name); }
static bool bit(const char* name) { return *stub::bits.at(name); }
static void run(long period = 1000000) {
    for (const char* name : {"quadrant-axis.0", "quadrant-plant.0"}) {
        const auto& f = stub::functions.at(name);
        real_time = true;
        f.call(f.self, period);
        real_time = false;
        if (*name == 'q' && name[9] == 'a') real("quadrant-plant.0.command") = real("quadrant-axis.0.output");
    }
    real("quadrant-axis.0.feedback") = real("quadrant-plant.0.position");
}
static double t = 0, largest_step = 0;
static void sine(int periods) { // 10 mm, 1 Hz: 63 mm/s
    for (int k = 0; k < periods; ++k, t += 1e-3) {
        real("quadrant-axis.0.command") = 10 * (1 - std::cos(2 * std::numbers::pi * t));
        const double before = real("quadrant-axis.0.output");
        run();
        largest_step = std::max(largest_step, std::abs(real("quadrant-axis.0.output") - before));
    }
}
static double largest_step_of(int periods) {
    largest_step = 0;
    sine(periods);
    return largest_step;
}
int main() {
    hal::instance<hal::hal_axis> axis(1, 0);
    hal::instance<hal::hal_plant> plant(1, 0);
    claim(axis.error() == 0 && plant.error() == 0, "all pins are made, no name is too long or there twice");
    bool all = true;
    for (const auto& tap : hal::hal_axis::taps())
        all = all && stub::reals.count(hal::pin_name("quadrant-axis.0.wire", tap.name)) == 1;
    claim(all, "every wire is a pin");

    const std::pair<const char*, double> settings[] = {{"axis.0.velocity-gain", 50},
                                                       {"axis.0.velocity-integral", 450},
                                                       {"axis.0.plant-gain", 4.1},
                                                       {"axis.0.plant-pole", 2.5},
                                                       {"axis.0.friction-coulomb", 0.07},
                                                       {"axis.0.friction-static", 0.1},
                                                       {"axis.0.observer-corner", 20},
                                                       {"axis.0.observer-on", 1},
                                                       {"plant.0.mass", 340},
                                                       {"plant.0.force-constant", 1450},
                                                       {"plant.0.friction-viscous", 850},
                                                       {"plant.0.friction-coulomb", 122},
                                                       {"plant.0.friction-static", 177},
                                                       {"plant.0.delay", 4e-4}};
    for (const auto& [name, value] : settings) real((std::string("quadrant-") + name).c_str()) = value;
    run();
    // look() is what the component's thread does: here at a moment of our choice.
    claim(bit("quadrant-axis.0.fault") && real("quadrant-axis.0.output") == 0,
          "before the first block: 0 and a fault");
    axis.look(), plant.look();
    *stub::bits.at("quadrant-axis.0.enable") = true;
    sine(2000);
    claim(!bit("quadrant-axis.0.fault"), "then none");
    claim(std::abs(real("quadrant-axis.0.wire.position-error")) < 1e-5,
          "and the axis follows to 10 um at rest");

    sine(240);
    const double usual = largest_step_of(20); // around full speed, 63 mm/s
    sine(740);
    double swapped = 0;
    bool bounded = true;
    const auto wire = [](const char* name) {
        return real((std::string("quadrant-axis.0.wire.") + name).c_str());
    };
    const auto beside = [&] { // what the PI's part is added to
        return wire("inertia") + wire("drag") - wire("disturbance") + wire("friction");
    };
    const auto next_step = [&](double error, double others) { // docs/integrator.md, with the gains of now
        return real("quadrant-axis.0.velocity-gain") * std::abs(wire("velocity-error") - error) +
               real("quadrant-axis.0.velocity-integral") * 1e-3 * std::abs(wire("velocity-error")) +
               std::abs(beside() - others) + 1e-12;
    };
    const auto at_full_speed = [&](const char* name, double value) {
        sine(250);
        const double before = largest_step_of(1), error = wire("velocity-error"), others = beside();
        real((std::string("quadrant-axis.0.") + name).c_str()) = value;
        axis.look();
        claim(bit("quadrant-axis.0.pending"), name);
        const double first = largest_step_of(1);
        claim(!bit("quadrant-axis.0.pending"), "in use from the next period on");
        if (std::strncmp(name, "velocity-", 9) == 0) bounded = bounded && first <= next_step(error, others);
        const double after = largest_step_of(9);
        std::printf("steps of the command [mV]: %.3f before, %.3f at once, %.3f after\n", 1e3 * before,
                    1e3 * first, 1e3 * after);
        swapped = std::max({swapped, first, after});
        sine(740);
    };
    at_full_speed("velocity-gain", 40);
    at_full_speed("velocity-integral", 300);
    at_full_speed("observer-corner", 15);
    at_full_speed("observer-on", 0);
    at_full_speed("velocity-gain", 45); // the PI holds against the friction now
    at_full_speed("observer-on", 1);
    at_full_speed("estimator-corner", 120);
    at_full_speed("notch-centre", 300);
    at_full_speed("position-gain", 110);
    at_full_speed("friction-coulomb", 0.05);
    at_full_speed("plant-gain", 4.4);
    at_full_speed("plant-pole", 2);
    at_full_speed("memory-weight", 1);
    sine(3000); // it has learnt
    at_full_speed("memory-weight", 0);
    std::printf("undisturbed: %.3f\n", 1e3 * usual);
    claim(swapped < 1.1 * usual, "no change of a parameter at full speed is seen in the command");
    claim(bounded, "other gains of the PI: its next step is what they would have made of it anyway");

    sine(250); // off for 30 ms at full speed, while the planner goes on
    *stub::bits.at("quadrant-axis.0.enable") = false;
    sine(30);
    const double error = wire("velocity-error"), others = beside();
    *stub::bits.at("quadrant-axis.0.enable") = true;
    const double first = largest_step_of(1);
    std::printf("%.3f mm behind: %.3f mV\n", 1e3 * wire("position-error"), 1e3 * first);
    claim(first <= next_step(error, others) && first < 0.1, "enabled on the move: the command begins at 0");
    sine(970);

    *stub::bits.at("quadrant-axis.0.apply") = false;
    real("quadrant-axis.0.velocity-gain") = 30;
    axis.look();
    claim(!bit("quadrant-axis.0.pending"), "apply FALSE: changes are collected");
    *stub::bits.at("quadrant-axis.0.apply") = true;
    axis.look();
    claim(bit("quadrant-axis.0.pending"), "apply TRUE: taken together");
    sine(100);

    const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
    for (const double bad : {nan, infinity, -1e300}) {
        const double held = real("quadrant-axis.0.output");
        const double good = real("quadrant-axis.0.command");
        real("quadrant-axis.0.command") = bad;
        run();
        claim(real("quadrant-axis.0.output") == held && bit("quadrant-axis.0.fault"),
              "bad command: held, fault");
        real("quadrant-axis.0.command") = good;
        real("quadrant-axis.0.feedback") = bad;
        const auto& f = stub::functions.at("quadrant-axis.0");
        f.call(f.self, 1000000);
        claim(real("quadrant-axis.0.output") == held && bit("quadrant-axis.0.fault"), "bad feedback: the same");
        run();
        claim(bit("quadrant-axis.0.fault"), "the fault stays");
        *stub::bits.at("quadrant-axis.0.enable") = false;
        run();
        claim(real("quadrant-axis.0.output") == 0 && !bit("quadrant-axis.0.fault"),
              "until enable falls: output 0");
        *stub::bits.at("quadrant-axis.0.enable") = true;
        sine(1000);
        claim(!bit("quadrant-axis.0.fault"), "enabled again: no fault");
    }
    sine(250);
    real("quadrant-axis.0.feedback") = nan; // one reading lost at 63 mm/s, the planner goes on
    sine(1);
    // The path of two periods taken for that of one would be 63 m/s^2, which is 15 V; what is left is one
    // period of the sine's 0.4 m/s^2.
    claim(largest_step_of(10) < 0.4, "after a lost reading the command goes on without a kick");
    const double x = real("quadrant-plant.0.position");
    real("quadrant-plant.0.external") = nan;
    run();
    claim(real("quadrant-plant.0.position") == x && bit("quadrant-plant.0.fault"), "plant: held, fault");
    real("quadrant-plant.0.external") = 0;

    real("quadrant-axis.0.velocity-gain") = nan;
    axis.look();
    claim(bit("quadrant-axis.0.refused") &&
              stub::said == "quadrant-axis.0: velocity-gain = nan: must be finite\n",
          stub::said.c_str());
    real("quadrant-axis.0.velocity-gain") = 50;
    real("quadrant-axis.0.notch-centre") = 501;
    axis.look();
    claim(bit("quadrant-axis.0.refused"), stub::said.c_str());
    sine(10);
    real("quadrant-axis.0.notch-centre") = 330;
    axis.look();
    claim(!bit("quadrant-axis.0.refused"), "refused until it is right, the old parameters in use");
    for (const auto& [pin, wrong] : {std::pair{"quadrant-axis.0.plant-gain", 1e-300},
                                     {"quadrant-axis.0.plant-gain", 1e300},
                                     {"quadrant-axis.0.dac-step", 1e300}}) {
        const double right = real(pin);
        sine(10); // the thread takes what is pending
        real(pin) = wrong;
        axis.look();
        claim(bit("quadrant-axis.0.refused"), pin);
        real(pin) = right;
        axis.look();
        claim(!bit("quadrant-axis.0.refused"), pin);
    }

    *stub::bits.at("quadrant-axis.0.enable") = false;
    run(), run();
    *stub::bits.at("quadrant-axis.0.enable") = true;
    sine(100);
    const double held = real("quadrant-axis.0.output");
    run(500000);
    claim(real("quadrant-axis.0.output") == held && bit("quadrant-axis.0.fault"),
          "another period: held, fault");
    axis.look(), plant.look();
    run(500000);
    claim(!bit("quadrant-axis.0.fault"), "until a block for it is built");

    // Anything on any pin: nothing but finite numbers comes out.
    std::mt19937 random(1);
    std::uniform_real_distribution<double> exponent(-320, 309);
    bool finite = true;
    for (int k = 0; k < 5000; ++k) {
        auto pin = std::next(stub::reals.begin(), static_cast<long>(random() % stub::reals.size()));
        const std::string& name = pin->first;
        const bool theirs = name.find("wire") != std::string::npos || name == "quadrant-axis.0.output" ||
                            name == "quadrant-plant.0.position";
        if (!theirs && name != "quadrant-axis.0.memory-weight") // its filter takes seconds to design
            *pin->second = random() % 8 == 0 ? nan : (random() % 2 ? 1 : -1) * std::pow(10, exponent(random));
        *stub::bits.at("quadrant-axis.0.enable") = random() % 16 != 0;
        axis.look(), plant.look();
        run(random() % 64 ? 500000 : 1000000);
        finite = finite && std::isfinite(real("quadrant-axis.0.output"));
        for (const auto& each : stub::reals)
            if (each.first.find("wire") != std::string::npos) finite = finite && std::isfinite(*each.second);
    }
    claim(finite, "whatever 5000 random pins say, the output is a number");
    claim(allocations == 0, "the real-time functions allocate nothing");
    return failures == 0 ? 0 : 1;
}
