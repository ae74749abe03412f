// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compensation.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis::detail {

/// What a velocity drive has to be asked for, beside the controller's feedback, so that its motor moves as the
/// reference r does: the drive's loop read backwards, to the second derivative. With F = M r'' + B r' -
/// constant force,
///   P:   asked = r' + F / gain
///   PI:  asked = r' + (B / integral) r''        the integral holds the rest
/// and what is asked acts one period (difference and hold) and the drive's delay late: r'' times that is added.
/// Units of the command a [m/s], [m/s^2], and of the command.
struct velocity_drive_feedforward {
    double velocity = 1, acceleration = 0, bias = 0;

    /// `pushed`: the drive is told the force beside it.
    velocity_drive_feedforward(const plant_model& p, double period, bool in_volts, bool pushed = false) {
        const drive_model& d = p.drive;
        const double viscous = p.friction.viscous_slope, late = d.delay + period;
        if (pushed) {
            acceleration = late;
        } else if (d.has_integral()) {
            acceleration = viscous / d.velocity_integral + late;
        } else {
            velocity += viscous / d.velocity_gain;
            acceleration = p.mass / d.velocity_gain + late;
            bias = -p.constant_force / d.velocity_gain;
        }
        if (!in_volts) return;
        for (double* x : {&velocity, &acceleration, &bias}) *x /= d.velocity_per_V;
    }
};

/// The keys of the controller in front of a velocity drive; none where its kind has no such keys.
inline std::vector<key_value> keys_of(const velocity_drive_feedforward& f, const controller_description& c) {
    const controller_kind& kind = kind_of(c);
    std::vector<key_value> out;
    const auto put = [&](const feedforward_key& key, double amount) {
        const auto keys = fed(kind, c, key, amount);
        out.insert(out.end(), keys.begin(), keys.end());
    };
    put(kind.viscous, f.velocity);
    put(kind.acceleration, f.acceleration);
    if (f.bias != 0) put(kind.constant, f.bias);
    return out;
}

/// What can be told to a velocity drive beside the controller's feedback: the keys of the controller, and the
/// same with a force that the drive adds. Friction that turns with the direction is in the force alone: no key
/// of such a controller pays it.
inline std::vector<compensation> for_velocity_drive(const plant_model& p, const axis_description& axis,
                                                    double period, bool in_volts,
                                                    const std::vector<std::string>& causes) {
    const controller_description& c = *axis.controller;
    std::vector<compensation> out;
    const auto add = [&](const char* name, bool pushed) {
        compensation way{.name = name, .effects = causes};
        way.keys = keys_of(velocity_drive_feedforward(p, period, in_volts, pushed), c);
        if (pushed) {
            way.drive.force = pushed_force(p, period);
            way.settings = way.drive.force.settings(p, "added", axis.kind);
        }
        if (!way.keys.empty() || pushed) out.push_back(std::move(way));
    };
    add("velocity feedforward", false);
    add("velocity and added force", true);
    return out;
}

/// What can be told to a drive that takes positions: set-points that are shifted, and where it has a velocity
/// loop the same with a force that it adds.
inline std::vector<compensation> for_position_drive(const plant_model& p, const axis_description& axis,
                                                    double period, const std::vector<std::string>& causes) {
    std::vector<compensation> out;
    const auto add = [&](const char* name, bool pushed) {
        compensation way{.name = name, .effects = causes};
        way.drive.set_point = shifted_set_point(p, period, pushed);
        way.settings = way.drive.set_point.settings(p, "set_point", axis.kind);
        if (pushed) {
            way.drive.force = pushed_force(p, period);
            for (key_value& k : way.drive.force.settings(p, "added", axis.kind))
                way.settings.push_back(std::move(k));
        }
        out.push_back(std::move(way));
    };
    add("shifted set-points", false);
    if (p.drive.kind == drive_kind::position) add("set-points and added force", true);
    return out;
}

/// Whether what is told to a drive pays this effect: its numbers are those of the drive's loop read backwards.
inline bool paid_by_drive(std::string_view effect) {
    constexpr std::array<std::string_view, 14> all{
        "coulomb_friction", "viscous_friction", "stribeck_friction", "mass",         "payload_mass",
        "arm_length",       "constant_force",   "position_spring",   "gravity",      "cogging",
        "force_constant",   "supply_voltage",   "drive_gain",        "command_delay"};
    return std::find(all.begin(), all.end(), effect) != all.end();
}

} // namespace quadrant::inline v0::diagnosis::detail
