// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/how_far/closed_loop.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <quadrant/diagnosis/text/text.hpp>
#include <quadrant/diagnosis/where/controller_mismatch.hpp>

#include <cmath>
#include <numbers>
#include <vector>

/// One machine with an axis for each kind of controller, and what its axes do.
namespace controllers_workshop {

using namespace quadrant::diagnosis;

inline const machine_description& machine() {
    static const machine_description all =
        read_machine(std::filesystem::path(QUADRANT_SOURCE_DIR "/tests/controllers/machines.json"));
    return all;
}
inline const axis_description& axis_of(std::string_view kind) {
    for (const axis_description& a : machine().axes)
        if (a.name == kind) return a;
    throw std::out_of_range(std::string(kind));
}
inline double dac(const axis_description& a) {
    return *a.actuator.dac_range_V / std::exp2(*a.actuator.dac_bits);
}

/// Two tones of displacement that begin and end smoothly, and rests between; rounded as in a file.
inline axis_log asked(double seconds) {
    axis_log log;
    log.name = "x";
    const double T = machine().sample_period_s;
    for (int k = 0; k < static_cast<int>(seconds / T); ++k) {
        const double t = std::max(0.0, k * T - 0.02), in = std::fmod(t, 1.1); // it begins at rest
        const double window = in < 1.0 ? std::pow(std::sin(std::numbers::pi * in), 2) : 0;
        const double x = window * (0.02 * std::sin(2 * std::numbers::pi * 1.7 * in) +
                                   0.002 * std::sin(2 * std::numbers::pi * 9.0 * in) +
                                   0.0002 * std::sin(2 * std::numbers::pi * 31.0 * in));
        log.reference.push_back(std::round(x * 1e12) / 1e12);
    }
    log.position = log.reference;
    log.command.assign(log.reference.size(), 0.0);
    log.reference_step = 1e-12;
    log.position_step = 1e-12;
    return log;
}

/// The log of an axis under a controller.
inline axis_log logged(const axis_description& axis, const controller_description& c, double seconds = 2.2) {
    axis_log log = asked(seconds);
    const auto run = simulate_closed_loop(c, axis, plant_model(axis, 2e-7), machine().sample_period_s, log);
    log.position = run.position;
    for (double& y : log.position) y = std::round(y * 1e12) / 1e12;
    log.command = run.command;
    return log;
}

/// Its rows from one on.
inline axis_log cropped(const axis_log& log, std::size_t from) {
    axis_log out = log;
    for (auto* column : {&out.reference, &out.position, &out.command})
        column->erase(column->begin(), column->begin() + static_cast<std::ptrdiff_t>(from));
    return out;
}

inline controller_finding judged(const axis_description& axis, const controller_description& c,
                                 const axis_log& log) {
    const double period = machine().sample_period_s, count = axis.encoder.resolution_m;
    return judge_controller(c, axis.actuator, log,
                            prepare(log, period, count, scales_of(axis.plant, log, period, count)), count);
}

} // namespace controllers_workshop
