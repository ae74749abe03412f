// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "compensation.hpp"

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

    velocity_drive_feedforward(const plant_model& p, double period, bool in_volts) {
        const drive_model& d = p.drive;
        const double viscous = p.friction.viscous_slope, late = d.delay + period;
        if (d.has_integral()) {
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

/// The keys of the controller in front of a velocity drive, as one compensation; none where its kind has no
/// such keys. Friction that turns with the direction is left to the drive's loop and to the controller's
/// feedback: no key of such a controller pays it.
inline std::vector<compensation> for_velocity_drive(const plant_model& p, const controller_description& c,
                                                    double period, bool in_volts,
                                                    std::vector<std::string> causes) {
    const controller_kind& kind = kind_of(c);
    const velocity_drive_feedforward f(p, period, in_volts);
    compensation out{.name = "velocity feedforward", .effects = std::move(causes)};
    for (const auto& keys :
         {fed(kind, c, kind.viscous, f.velocity), fed(kind, c, kind.acceleration, f.acceleration)})
        out.keys.insert(out.keys.end(), keys.begin(), keys.end());
    const bool biased = std::any_of(kind.keys.begin(), kind.keys.end(),
                                    [](const controller_key& k) { return k.name == "bias"; });
    if (biased && f.bias != 0) out.keys.push_back({"bias", {f.bias}});
    return out.keys.empty() ? std::vector<compensation>{} : std::vector{std::move(out)};
}

} // namespace quadrant::inline v0::diagnosis::detail
