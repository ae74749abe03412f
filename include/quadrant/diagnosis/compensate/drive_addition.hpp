// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../model/plant_model.hpp"
#include "../text/axis_words.hpp"
#include "../text/key_value.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What is added to one input of a drive that closes loops of its own, from the reference r alone:
///   velocity r' + acceleration r'' + force S(r, r')
/// S is the force that the axis needs beside mass and viscous friction [N]: dry friction in the direction of
/// r', and what its weight, a spring, a constant force and cogging pull at r. r' and r'' are differences of the
/// last two and three rows. At rest friction is left out: what still pushes there makes a stopped axis creep
/// on.
struct reference_sum {
    double velocity = 0, acceleration = 0, force = 0;
    double overcome = 0; ///< of the dry friction the drive pays this much by itself [N]
    bool dry = true;     ///< with the dry friction

    bool any() const { return velocity != 0 || acceleration != 0 || force != 0; }

    std::vector<double> of(const plant_model& p, const std::vector<double>& reference, double period) const {
        std::vector<double> out(reference.size());
        double last = 0; // velocity of the row before
        for (std::size_t k = 0; k < reference.size(); ++k) {
            const double r = reference[k], v = k > 0 ? (r - reference[k - 1]) / period : 0;
            const double a = k > 1 ? (v - last) / period : 0;
            out[k] = velocity * v + acceleration * a + force * needed(p, r, v);
            last = v;
        }
        return out;
    }
    /// The numbers to type, each behind its prefix; what is 0 is left out.
    std::vector<key_value> settings(const plant_model& p, std::string_view prefix, axis_kind kind) const {
        const bool of_force = prefix == "added";
        const auto named = [&](std::string_view stem, std::string_view as_force, std::string_view as_length) {
            return key_of(std::string(prefix) + "_" + std::string(stem) +
                              std::string(of_force ? as_force : as_length),
                          kind);
        };
        std::vector<key_value> out;
        const auto put = [&](std::string key, double value) {
            if (value != 0) out.push_back({std::move(key), {value}});
        };
        const auto& f = p.friction;
        put(of_force ? named("viscous", "_N_s_per_m", "") : named("velocity", "", "_s"), velocity);
        put(of_force ? named("mass", "_kg", "") : named("acceleration", "", "_s2"), acceleration);
        if (dry) {
            put(named("coulomb", "_N", "_m"), force * std::max(0.0, f.coulomb - overcome));
            if (f.excess > 0) {
                put(named("static", "_N", "_m"), force * std::max(0.0, f.coulomb + f.excess - overcome));
                put(key_of("stribeck_velocity_m_per_s", kind), f.stribeck_velocity);
            }
        }
        put(named("constant", "_N", "_m"), -force * p.constant_force);
        put(named("spring", "_N_per_m", "_per_m"), force * p.spring);
        put(named("gravity", "_N", "_m"), force * p.weight());
        if (force * p.weight() != 0) put("gravity_phase_rad", p.gravity.phase);
        if (force != 0 && p.cogging.count > 0) {
            put(key_of("cogging_period_m", kind), p.cogging.period);
            key_value size{named("cogging", "_N", "_m"), {}}, phase{"cogging_phase_rad", {}};
            for (std::size_t i = 0; i < p.cogging.count; ++i) {
                size.values.push_back(-force * std::hypot(p.cogging.sine[i], p.cogging.cosine[i]));
                phase.values.push_back(std::atan2(p.cogging.cosine[i], p.cogging.sine[i]));
            }
            out.push_back(std::move(size));
            out.push_back(std::move(phase));
        }
        return out;
    }

private:
    double needed(const plant_model& p, double r, double v) const {
        const auto& f = p.friction;
        double level = 0;
        if (dry && v != 0) {
            const double share = std::pow(std::abs(v) / f.stribeck_velocity, f.stribeck_exponent);
            level = std::max(0.0, f.coulomb + std::max(0.0, f.excess) * std::exp(-share) - overcome);
        }
        return (v < 0 ? -level : level) - p.static_force(r) - p.cogging.at(r);
    }
};

/// What a drive is told beside its command: a shift of its set-points [m] and a force that it adds to what its
/// velocity loop gives [N] (torque offset, 0x60B2 of CiA 402).
struct drive_addition {
    reference_sum set_point, force;
};

namespace detail {

/// How late a drive uses what it is given: its delay, and what holding a set-point or drawing a line through
/// the last ones takes [s].
inline double lateness(const drive_model& d, double period) {
    const double every = d.set_point_period > 0 ? d.set_point_period : period;
    const double line = d.between == interpolation::hold ? 0.5 : d.between == interpolation::linear ? 1 : 2;
    return d.delay + line * every;
}

/// velocity r' + acceleration r'' asked for `late` earlier, to the second derivative, and the differences of
/// the reference, which are half a row and a row late.
inline void ahead(reference_sum& s, double late, double period) {
    const double velocity = s.velocity, acceleration = s.acceleration;
    s.velocity = velocity + late;
    s.acceleration = acceleration + late * velocity + late * late / 2 + s.velocity * period / 2;
}

/// The loop of a drive that takes positions, read backwards: the set-points with which the axis moves as the
/// reference r does. With F = M r'' + B r' + S:
///   P inside:   set-point = r + ((1 - feedforward) r' + F / gain) / position_gain
///   PI inside:  set-point = r + ((1 - feedforward) r' + (B / integral) r'') / position_gain;
///               the integral holds S
///   servo:      set-point = r + F / (duty_gain supply force_constant)
/// and all of it so much earlier as the drive uses it late. `pushed`: the drive is told the force beside it.
inline reference_sum shifted_set_point(const plant_model& p, double period, bool pushed) {
    const drive_model& d = p.drive;
    const double viscous = p.friction.viscous_slope, mass = p.moving_mass();
    reference_sum out;
    if (d.kind == drive_kind::position_servo) {
        const double stiffness = d.duty_gain * d.supply * p.force_constant;
        out.velocity = viscous / stiffness;
        out.acceleration = mass / stiffness;
        out.force = 1 / stiffness;
        out.overcome = d.minimum_duty * d.supply * p.force_constant;
    } else {
        const double fed = d.velocity_feedforward;
        out.velocity = (1 - fed) / d.position_gain;
        if (!pushed && d.velocity_integral > 0)
            out.acceleration = viscous / d.velocity_integral / d.position_gain;
        if (!pushed && d.velocity_integral == 0) {
            const double by_force = 1 / (d.velocity_gain * d.position_gain);
            out.velocity += viscous * by_force;
            out.acceleration = mass * by_force;
            out.force = by_force;
        }
        out.acceleration -= fed * out.velocity / d.position_gain;
    }
    ahead(out, lateness(d, period), period);
    return out;
}

/// The force that the axis needs, told to the drive; it is held over a row and acts with the drive's delay.
inline reference_sum pushed_force(const plant_model& p, double period) {
    const double viscous = p.friction.viscous_slope;
    return {
        .velocity = viscous, .acceleration = p.moving_mass() + viscous * (p.drive.delay + period), .force = 1};
}

} // namespace detail
} // namespace quadrant::inline v0::diagnosis
