// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "cnc_file.hpp"

#include <array>
#include <numbers>
#include <utility>

/// What a control law may be told by the drive that it controls.
namespace quadrant_cnc {

/// How far the table goes for a radian of the screw [m].
inline double pitch_per_radian(const ball_screw_description& d) { return d.pitch_m / (2 * std::numbers::pi); }

/// Acceleration per volt [m/(s^2 V)] and damping [1/s] of the drive, friction left out, by the keys of a law.
inline std::array<std::pair<const char*, double>, 2> plant_keys_of(const axis_description& a) {
    double gain = 0, damping = 0;
    if (const auto* d = std::get_if<ball_screw_description>(&a.drive)) {
        gain = d->amplifier_A_per_V * d->torque_constant_Nm_per_A * pitch_per_radian(*d) / d->inertia_kg_m2;
        damping = d->viscous_Nm_s_per_rad / d->inertia_kg_m2;
    } else {
        const auto& m = std::get<linear_motor_description>(a.drive);
        gain = m.force_constant_N_per_V / m.mass_kg;
        damping = m.viscous_N_s_per_m / m.mass_kg;
    }
    return {{{"plant_gain_m_per_s2_V", gain}, {"plant_damping_per_s", damping}}};
}

/// Puts the drive's dry friction into its law, in volts. The viscous part stays out: laws that know the plant
/// drive it already, those that do not meet it in their integral.
inline void feed_friction_forward(axis_description& a, const friction_feedforward_description& f) {
    auto& values = a.law.values;
    if (const auto* d = std::get_if<ball_screw_description>(&a.drive)) {
        const double per_Nm = 1 / (d->amplifier_A_per_V * d->torque_constant_Nm_per_A),
                     way = pitch_per_radian(*d);
        const friction_side &to = d->forward, &fro = d->backward;
        values["friction.static_V"] = {per_Nm * to.static_Nm, per_Nm * fro.static_Nm};
        values["friction.coulomb_V"] = {per_Nm * to.coulomb_Nm, per_Nm * fro.coulomb_Nm};
        values["friction.fall_m_per_s"] = {way * to.fall_rad_per_s, way * fro.fall_rad_per_s};
        values["friction.rise_m_per_s"] = {way * to.rise_rad_per_s, way * fro.rise_rad_per_s};
    } else {
        const auto& m = std::get<linear_motor_description>(a.drive);
        const double fall = m.stribeck_velocity_m_per_s.value_or(1), per_N = 1 / m.force_constant_N_per_V;
        const auto both = [](double x) { return std::vector<double>{x, x}; };
        values["friction.static_V"] = both(per_N * m.static_N.value_or(m.coulomb_N));
        values["friction.coulomb_V"] = both(per_N * m.coulomb_N);
        values["friction.fall_m_per_s"] = both(fall);
        values["friction.rise_m_per_s"] = both(fall);
    }
    a.law.set("friction.width_m_per_s", f.width_m_per_s);
    a.law.set("friction.scale", f.scale);
}

} // namespace quadrant_cnc
