// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <quadrant/diagnosis/machine/machine.hpp>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

/// The machine as quadrant-gap knows machines: mass, force per volt, friction along the axis.
namespace quadrant_cnc {

namespace gap {

using quadrant::diagnosis::plant_description;

/// Stribeck velocity in one direction, by least squares over the range in which the screw's curve changes.
inline double stribeck_velocity(const friction_side& s) {
    const double fastest = 5 * std::max(s.fall_rad_per_s, s.rise_rad_per_s);
    double best = HUGE_VAL, out = s.fall_rad_per_s;
    for (int i = 1; i <= 400; ++i) {
        const double velocity = fastest * i / 400;
        double squares = 0;
        for (int k = 0; k <= 200; ++k) {
            const double w = fastest * k / 200;
            const double screw = s.static_Nm * std::exp(-w / s.fall_rad_per_s) +
                                 s.coulomb_Nm * (1 - std::exp(-w / s.rise_rad_per_s));
            const double off = s.coulomb_Nm + (s.static_Nm - s.coulomb_Nm) * std::exp(-w / velocity) - screw;
            squares += off * off;
        }
        if (squares < best) best = squares, out = velocity;
    }
    return out;
}

/// The Stribeck law nearest to the screw's, by direction: levels at rest and at speed as they are.
inline void add_friction(plant_description& p, const ball_screw_description& d, double way) {
    const auto& f = d.forward;
    const auto& b = d.backward;
    const auto asymmetry = [](double to, double fro) -> std::optional<double> {
        return to == fro ? std::nullopt : std::optional((to - fro) / (to + fro));
    };
    const double coulomb = 0.5 * (f.coulomb_Nm + b.coulomb_Nm) / way,
                 at_rest = 0.5 * (f.static_Nm + b.static_Nm) / way;
    if (coulomb == 0 && at_rest == 0) return;
    p.coulomb_N = coulomb;
    p.coulomb_asymmetry = asymmetry(f.coulomb_Nm, b.coulomb_Nm);
    if (!(at_rest > coulomb)) return;
    p.static_N = at_rest;
    p.static_asymmetry = asymmetry(f.static_Nm, b.static_Nm);
    const double to = stribeck_velocity(f), fro = stribeck_velocity(b);
    p.stribeck_velocity_m_per_s = 0.5 * (to + fro) * way;
    p.stribeck_velocity_asymmetry = asymmetry(to, fro);
}

} // namespace gap

/// `notes` gets what a machine file has no words for.
inline quadrant::diagnosis::machine_description gap_machine(const cnc_description& cnc,
                                                            std::vector<std::string>& notes) {
    quadrant::diagnosis::machine_description out;
    out.sample_period_s = cnc.servo_period_s;
    for (const axis_description& a : cnc.axes) {
        quadrant::diagnosis::axis_description g;
        g.name = a.name();
        const auto note = [&](std::string_view text) {
            notes.push_back(fmt::format("axis {}: {}.", a.name(), text));
        };
        if (const auto* d = std::get_if<ball_screw_description>(&a.drive)) {
            const double way = d->pitch_m / (2 * std::numbers::pi);
            g.plant.mass_kg = d->inertia_kg_m2 / (way * way);
            g.plant.force_constant_N_per_V = d->amplifier_A_per_V * d->torque_constant_Nm_per_A / way;
            g.plant.viscous_N_s_per_m = d->viscous_Nm_s_per_rad / (way * way);
            gap::add_friction(g.plant, *d, way);
            if (d->backlash_m > 0 && !a.sensor.on_motor) g.plant.backlash_m = d->backlash_m;
            if (d->current_limit_A) g.actuator.drive_limit_V = *d->current_limit_A / d->amplifier_A_per_V;
            if (d->lead_error != 0 || d->compliance_m_per_N > 0)
                note("lead error and compliance of the screw are not in the exported machine file");
        } else {
            const auto& m = std::get<linear_motor_description>(a.drive);
            g.plant.mass_kg = m.mass_kg;
            g.plant.force_constant_N_per_V = m.force_constant_N_per_V;
            g.plant.viscous_N_s_per_m = m.viscous_N_s_per_m;
            g.plant.delay_s = m.delay_s;
            if (m.coulomb_N > 0 || m.static_N) g.plant.coulomb_N = m.coulomb_N;
            g.plant.static_N = m.static_N;
            g.plant.stribeck_velocity_m_per_s = m.stribeck_velocity_m_per_s;
            g.actuator.drive_limit_V = m.drive_limit_V;
        }
        // What a machine file wants to be told of how well it is known: of a real one the user says better.
        for (const char* value : {"mass", "force_constant", "viscous", "coulomb", "static", "stribeck_velocity",
                                  "coulomb_asymmetry", "delay"})
            g.tolerance.given[value] = quadrant::diagnosis::tolerance_description::unstated;
        g.encoder.resolution_m = a.sensor.resolution_m;
        g.actuator.limit_V = a.command.limit_V;
        g.actuator.dac_bits = a.command.dac_bits;
        g.actuator.dac_range_V = a.command.dac_range_V;
        if (a.acceleration)
            note("a machine file has no law with an accelerometer, so the exported one has no controller");
        else
            g.controller = a.law;
        if (a.load) note("the cutting load is not in the exported machine file: to the diagnosis it is a gap");
        out.axes.push_back(std::move(g));
    }
    return out;
}

} // namespace quadrant_cnc
