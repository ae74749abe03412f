// SPDX-License-Identifier: BSL-1.0
// Long: a function for each picture.
// usage: gallery FOLDER
// Writes the pictures of docs/gallery.md, one an effect: an axis of the library's own plant that has the
// effect, in closed loop, beside a machine file that does not have it. Three panels: the residual force in
// time, over velocity and over position, each with that of a machine as described behind it. And motion.svg:
// what all of them do.
#include "block_pictures/svg_file.hpp"

#include <quadrant/diagnosis/how_far/closed_loop.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/simulate.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
    double fastest = 270;              ///< of the panel over velocity [mm/s]
};

const sight sights[] = {
    {"good", "a machine as described", nullptr},
    {"friction", "Coulomb friction higher than described", [](auto& a) { a.plant.coulomb_N = 120; }},
    {"stick_slip", "Stribeck friction: the axis sticks and slips as it creeps",
     [](auto& a) {
         a.plant.static_N = 140;
         a.plant.stribeck_velocity_m_per_s = 0.004;
     },
     30},
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

/// What a machine with this effect does, and the residual force beside the file that does not have it.
struct record {
    std::vector<double> position, velocity, force; ///< [mm], [mm/s], [N]
};
record recorded(const sight& s) {
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
    record r{axis.position, derivative(zero_phase(axis.position, 60, period), period),
             simulate(file, log).axes.at(0).force};
    for (auto* in_metres : {&r.position, &r.velocity})
        for (double& v : *in_metres) v *= 1e3;
    return r;
}

constexpr std::size_t ends = 200; // rows: the observer settles
constexpr double least_position = -5, most_position = 125;

/// The smallest and the largest force of each piece of time: no peak is lost.
curve in_time(const std::string& name, const record& r, std::size_t pieces) {
    curve c(name);
    const std::size_t rows = r.force.size() - 2 * ends;
    for (std::size_t i = 0; i < pieces; ++i) {
        const auto at = r.force.begin();
        const auto [least, most] =
            std::minmax_element(at + static_cast<std::ptrdiff_t>(ends + rows * i / pieces),
                                at + static_cast<std::ptrdiff_t>(ends + rows * (i + 1) / pieces));
        for (const auto one : {std::min(least, most), std::max(least, most)})
            c.add(static_cast<double>(one - at) * period, *one);
    }
    return c;
}

/// Of every step of x some rows, evenly over those that are in it, and the one of the largest force: slow and
/// fast motion, short and long, have as many.
curve dots_over(const std::string& name, const record& r, const std::vector<double>& x, double low, double high,
                std::size_t each) {
    constexpr std::size_t steps = 60;
    std::vector<std::vector<std::size_t>> rows(steps);
    for (std::size_t k = ends; k + ends < x.size(); ++k)
        if (x[k] > low && x[k] < high)
            rows[static_cast<std::size_t>(static_cast<double>(steps) * (x[k] - low) / (high - low))].push_back(
                k);
    curve c(name, block_pictures::points);
    const auto size = [&](std::size_t k) { return std::abs(r.force[k]); };
    for (const auto& in : rows) {
        if (in.empty()) continue;
        std::vector<std::size_t> some{*std::max_element(
            in.begin(), in.end(), [&](std::size_t a, std::size_t b) { return size(a) < size(b); })};
        for (std::size_t i = 0; i < each; ++i) some.push_back(in[(2 * i + 1) * in.size() / (2 * each)]);
        std::sort(some.begin(), some.end());
        some.erase(std::unique(some.begin(), some.end()), some.end());
        for (const std::size_t k : some) c.add(x[k], r.force[k]);
    }
    return c;
}

block_pictures::picture drawn(const sight& s, const record& good) {
    const record bad = s.change ? recorded(s) : good;
    double largest = 0;
    for (std::size_t k = ends; k + ends < bad.force.size(); ++k)
        largest = std::max(largest, std::abs(bad.force[k]));
    const double most = std::max(1.08 * largest, 20.0);
    const auto panel = [&](const char* below, std::vector<block_pictures::line> lines, double low,
                           double high) {
        auto p =
            block_pictures::between(block_pictures::over(below, "force [N]", std::move(lines)), -most, most);
        p.x_range = std::pair{low, high};
        return p;
    };
    const auto both = [&](const auto& draw) {
        std::vector<block_pictures::line> lines{draw(s.change ? s.title : "", bad, 3)};
        if (s.change) lines.push_back(draw("a machine as described", good, 1));
        return lines;
    };
    const auto over = [&](std::vector<double> record::*x, double low, double high) {
        return both([=](const std::string& name, const record& r, std::size_t each) {
            return dots_over(name, r, r.*x, low, high, each);
        });
    };
    return block_pictures::of(
        std::string("Residual force of ") + s.title,
        {panel("time [s]", both([](const std::string& name, const record& r, std::size_t each) {
                   return in_time(name, r, 80 + 80 * each);
               }),
               0, static_cast<double>(good.force.size()) * period),
         panel("velocity [mm/s]", over(&record::velocity, -s.fastest, s.fastest), -s.fastest, s.fastest),
         panel("position [mm]", over(&record::position, least_position, most_position), least_position,
               most_position)});
}

block_pictures::picture motion_of(const record& r) {
    curve velocity(""), position("");
    for (std::size_t k = 0; k < r.position.size(); k += 8) {
        velocity.add(static_cast<double>(k) * period, r.velocity[k]);
        position.add(static_cast<double>(k) * period, r.position[k]);
    }
    auto first = block_pictures::over("", "velocity [mm/s]", {velocity}),
         second = block_pictures::over("time [s]", "position [mm]", {position});
    for (auto* p : {&first, &second})
        p->x_range = std::pair{0.0, static_cast<double>(r.position.size()) * period};
    return block_pictures::of("The motion of all pictures of the gallery", {first, second});
}

bool write(const std::filesystem::path& path, const block_pictures::picture& p) {
    std::ofstream file(path, std::ios::binary);
    file << block_pictures::svg_file(p).text();
    if (file.flush()) return true;
    std::cerr << "cannot write " << path.string() << '\n';
    return false;
}

} // namespace

int main(int count, char** words) {
    if (count != 2) {
        std::cerr << "usage: gallery FOLDER\n";
        return 2;
    }
    const std::filesystem::path folder = words[1];
    std::filesystem::create_directories(folder);
    const record good = recorded(sights[0]);
    if (!write(folder / "motion.svg", motion_of(good))) return 1;
    for (const sight& s : sights)
        if (!write(folder / (std::string(s.name) + ".svg"), drawn(s, good))) return 1;
    return 0;
}
