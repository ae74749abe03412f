// SPDX-License-Identifier: BSL-1.0
// usage: gallery FOLDER
// Writes the pictures of docs/gallery.md, one an effect: an axis of the library's own plant that has the
// effect, in closed loop, beside a machine file that does not have it. Three panels: the residual force in
// time, over velocity and over position.
#include "block_pictures/svg_file.hpp"

#include <quadrant/diagnosis/how_far/closed_loop.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>

#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>

namespace {

using namespace quadrant::diagnosis;
using block_pictures::curve;

constexpr double period = 0.0005;

/// The axis of examples/data, in numbers that are easy to read.
constexpr const char* described = R"({"schema": "quadrant.machine/1", "sample_period_s": 0.0005, "axes": {"x": {
 "plant": {"mass_kg": 200, "force_constant_N_per_V": 1400, "viscous_N_s_per_m": 200, "delay_s": 0.0006, "coulomb_N": 60},
 "tolerance": {"mass": 0.02, "force_constant": 0.01, "viscous": 0.1, "delay": 0.05, "coulomb": 0.05},
 "encoder": {"resolution_m": 1e-7}, "actuator": {"limit_V": 10, "dac_bits": 16, "dac_range_V": 20},
 "controller": {"kind": "cascade_p_pi", "position_gain_per_s": 100, "velocity_gain_V_s_per_m": 40,
  "velocity_integral_V_per_m": 280, "velocity_filter_Hz": 220, "velocity_feedforward": 1,
  "acceleration_feedforward_V_s2_per_m": 0.143, "viscous_feedforward_V_s_per_m": 0.143}}}})";

struct sight {
    const char *name, *title;
    void (*change)(axis_description&); ///< what the machine has and the file has not; null: nothing
};

const sight sights[] = {
    {"good", "a machine as described", nullptr},
    {"friction", "Coulomb friction higher than described", [](auto& a) { a.plant.coulomb_N = 120; }},
    {"stick_slip", "Stribeck friction: the axis sticks and slips as it creeps",
     [](auto& a) {
         a.plant.static_N = 140;
         a.plant.stribeck_velocity_m_per_s = 0.004;
     }},
    {"cogging", "cogging",
     [](auto& a) {
         a.plant.cogging_period_m = 0.024;
         a.plant.cogging_N = {25};
         a.plant.cogging_phase_rad = {0.4};
     }},
    {"backlash", "backlash between the motor and the load that the scale reads",
     [](auto& a) { a.plant.backlash_m = 15e-6; }},
    {"resonance", "a structural resonance",
     [](auto& a) {
         a.plant.mode_mass_kg = 50;
         a.plant.mode_frequency_Hz = 45;
         a.plant.mode_damping = 0.03;
     }},
    {"saturation", "a drive that saturates below the controller's limit",
     [](auto& a) { a.actuator.drive_limit_V = 0.6; }},
    {"lost_set_points", "lost commands", [](auto& a) { a.actuator.loss_probability = 0.2; }},
    {"wrong_gain", "a force constant 15 % below the described one",
     [](auto& a) { a.plant.force_constant_N_per_V *= 0.85; }},
};

/// Position from rest to rest over `length`, its time from speed and acceleration.
void stroke(std::vector<double>& x, double length, double speed, double acceleration) {
    const double from = x.back(), distance = std::abs(length),
                 v = std::min(speed, std::sqrt(distance * acceleration)), ramp = v / acceleration,
                 whole = distance / v + ramp;
    for (double t = period; t < whole + period; t += period) {
        const double u = std::min(t, whole), end = whole - u;
        const double way = u < ramp     ? acceleration * u * u / 2
                           : end < ramp ? distance - acceleration * end * end / 2
                                        : v * (u - ramp / 2);
        x.push_back(from + (length > 0 ? way : -way));
    }
}
void rest(std::vector<double>& x, double time) {
    x.insert(x.end(), static_cast<std::size_t>(time / period), x.back());
}

std::vector<double> motion() {
    std::vector<double> x{0};
    rest(x, 0.2);
    for (const double length : {0.12, -0.12}) stroke(x, length, 0.25, 4);
    rest(x, 0.15);
    for (const double length : {0.006, -0.006}) stroke(x, length, 0.006, 0.5);
    for (int k = 0; k < 3; ++k)
        for (const double length : {0.01, -0.01}) stroke(x, length, 0.12, 4);
    for (const double length : {0.12, -0.12}) stroke(x, length, 0.06, 2);
    rest(x, 0.2);
    return x;
}

block_pictures::picture drawn(const sight& s) {
    const machine_description file = read_machine(described, "gallery");
    machine_description machine = file;
    if (s.change) s.change(machine.axes[0]);
    machine_log log;
    log.file = "gallery";
    log.sample_period_s = period;
    axis_log axis;
    axis.name = "x";
    axis.reference = motion();
    log.samples = axis.reference.size();
    axis.position.assign(log.samples, 0);
    axis.command.assign(log.samples, 0);
    axis.position_step = 5e-10;
    axis.command_step = 5e-7;
    std::mt19937_64 random(7);
    std::vector<double> noise(log.samples);
    for (double& v : noise) v = 1e-7 * (static_cast<double>(random() >> 11) * 0x1p-53 - 0.5);
    constexpr double give = 5e-8;
    auto run = simulate_closed_loop(*machine.axes[0].controller, machine.axes[0],
                                    plant_model(machine.axes[0], give), period, axis, noise);
    axis.position = std::move(run.position);
    axis.command = std::move(run.command);
    log.axes.push_back(axis);
    const auto found = simulate(file, log).axes.at(0);
    const auto velocity = derivative(zero_phase(axis.position, 60, period), period);

    const auto& force = found.force;
    constexpr std::size_t ends = 200, buckets = 320, dots = 100; // the observer settles; per panel
    const auto bucket = [&](std::size_t i, std::size_t of) {
        const std::size_t rows = log.samples - 2 * ends, from = ends + rows * i / of;
        return std::pair{from, ends + rows * (i + 1) / of};
    };
    curve in_time(""), over_velocity("", block_pictures::points), over_position("", block_pictures::points);
    for (std::size_t i = 0; i < buckets; ++i) { // no peak is lost
        const auto [from, to] = bucket(i, buckets);
        const auto at = force.begin();
        const auto [least, most] =
            std::minmax_element(at + static_cast<std::ptrdiff_t>(from), at + static_cast<std::ptrdiff_t>(to));
        for (const auto one : {std::min(least, most), std::max(least, most)})
            in_time.add(static_cast<double>(one - at) * period, *one);
    }
    for (std::size_t i = 0; i < dots; ++i) { // of every piece of time one row and the row of the largest force
        const auto [from, to] = bucket(i, dots);
        std::size_t largest = from;
        for (std::size_t k = from; k < to; ++k)
            if (std::abs(force[k]) > std::abs(force[largest])) largest = k;
        for (const std::size_t k : {(from + to) / 2, largest}) {
            over_velocity.add(1e3 * velocity[k], force[k]);
            over_position.add(1e3 * axis.position[k], force[k]);
        }
    }
    std::vector<double> sizes;
    for (std::size_t k = ends; k + ends < log.samples; ++k) sizes.push_back(std::abs(force[k]));
    double most = 20; // one tick above and one below zero
    for (const double round : {50.0, 100.0, 200.0, 500.0, 1000.0})
        if (most < quantile(sizes, 0.998)) most = round;
    const auto panel = [&](const char* below, curve c, double low, double high) {
        auto p = block_pictures::between(block_pictures::over(below, "force [N]", {std::move(c)}), -1.05 * most,
                                         1.05 * most);
        p.x_range = std::pair{low, high};
        return p;
    };
    return block_pictures::of(std::string("Residual force of ") + s.title,
                              {panel("time [s]", in_time, 0, static_cast<double>(log.samples) * period),
                               panel("velocity [mm/s]", over_velocity, -270, 270),
                               panel("position [mm]", over_position, -5, 125)});
}

} // namespace

int main(int count, char** words) {
    if (count != 2) {
        std::cerr << "usage: gallery FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = words[1];
    std::filesystem::create_directories(folder);
    for (const sight& s : sights) {
        std::ofstream file(folder / (std::string(s.name) + ".svg"), std::ios::binary);
        file << block_pictures::svg_file(drawn(s)).text();
        if (!file.flush()) {
            std::cerr << "cannot write into " << folder.string() << '\n';
            return 1;
        }
    }
    return 0;
}
