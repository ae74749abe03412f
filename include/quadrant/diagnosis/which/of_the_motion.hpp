// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../fit/record.hpp"
#include "../result/result.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>

namespace quadrant::inline v0::diagnosis::detail {

/// Whether a force that repeats in time does so near a frequency at which the axis itself moves, with a tenth
/// of the energy of its velocity or more: then it may be any force of the motion.
inline bool repeats_with_the_motion(const axis_record& r, const cause& named) {
    for (const parameter_estimate& p : named.parameters)
        if (p.key == "process.fundamental_Hz") {
            const estimate& f = p.values.front();
            const auto below = [&](double Hz) { return zero_phase(r.velocity, Hz, r.period); };
            auto there = below(1.4 * f.high);
            if (f.low > 0) {
                const auto slower = below(0.7 * f.low);
                for (std::size_t k = 0; k < there.size(); ++k) there[k] -= slower[k];
            }
            return square(rms(there)) > 0.1 * square(rms(r.velocity));
        }
    return false;
}

/// Whether one harmonic of a process is larger than any force of the drive in the record: a loop that swings
/// across a play makes such a force. A real one that the mass alone carries is not told from it.
inline bool outdoes_the_drive(const axis_record& r, const plant_model& found, const cause& named) {
    if (named.effect != "cutting_force" || found.drive.closes()) return false;
    double command = 0, process = 0;
    for (const double u : r.command) command = std::max(command, std::abs(u));
    for (const double size : found.cutting.sizes()) process = std::max(process, size);
    return process > std::abs(found.force_constant) * command;
}

/// Whether a mode rings for longer than the record lasts: its ring falls to 1/e after the end of the record.
/// Then it is a force at one frequency, such as a harmonic of the motion, which friction that is not linear in
/// speed makes too. A mode beside which nothing else is left is not such a harmonic.
inline bool rings_beyond(const axis_record& r, const cause& named) {
    double frequency = 0, damping = 0;
    for (const parameter_estimate& p : named.parameters) {
        if (p.key == "mode_frequency_Hz") frequency = p.values.front().value;
        if (p.key == "mode_damping") damping = p.values.front().value;
    }
    const double lasts = static_cast<double>(r.position.size()) * r.period;
    return frequency > 0 && 2 * std::numbers::pi * frequency * damping * lasts < 1;
}

/// Whether the strongest harmonic of a wave along the travel has less than two periods there: any curve looks
/// like that, the bend of a rail or of a cable chain among them.
inline bool repeats_too_seldom(const axis_record& r, const plant_model& found, std::string_view effect) {
    const harmonics* wave = effect == "cogging"                       ? &found.cogging
                            : effect == "force_ripple"                ? &found.ripple
                            : effect == "position_dependent_friction" ? &found.friction.along
                                                                      : nullptr;
    if (!wave || wave->count == 0) return false;
    const auto sizes = wave->sizes();
    const auto strongest = std::max_element(sizes.begin(), sizes.end()) - sizes.begin() + 1;
    return 2 * wave->period / static_cast<double>(strongest) > r.scale.travel;
}

} // namespace quadrant::inline v0::diagnosis::detail
