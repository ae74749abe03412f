// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "plant_model.hpp"

namespace quadrant::diagnosis {

/// What the plant remembers between two steps.
struct plant_state {
    double x = 0, v = 0;      ///< of the motor [m], [m/s]
    double load = 0;          ///< where the encoder is, behind the play [m]
    double load_velocity = 0; ///< 0 while the play is crossed
    double lagged = 0;        ///< command behind the current loop [V]
    double q = 0, w = 0;      ///< of the second mass against the first [m], [m/s]
    std::array<double, friction_contact::most> deflection{}; ///< of the contact's elements [m]
    std::array<bool, friction_contact::most> slipping{};
    own_forces::memories remembered{}; ///< by the own forces

    void shift(double dx, double dv) { // an observer's correction moves the whole axis
        x += dx;
        load += dx;
        v += dv;
    }
    static plant_state at(double position, double velocity = 0) {
        return {.x = position, .v = velocity, .load = position, .load_velocity = velocity};
    }
};

/// What acts on the plant from outside during a step.
struct surroundings {
    double time = 0;               ///< at the step's start, from the first row of the log [s]
    double other_acceleration = 0; ///< of the other axis [m/s^2]
};

/// Advances the plant by steps of one length h under a constant command. Friction is taken implicitly, as in
/// friction/stick_slip.hpp, but a contact at rest gives way like springs until it breaks away: every real stick does, by
/// a micrometre or so, and a model without it sees a gap in each reversal. The second mass is advanced exactly under the
/// first one's acceleration, with the momentum of both kept. What does not change between steps is worked out once: a
/// diagnosis runs millions of them.
class stepper {
public:
    stepper(const plant_model& plant, double h)
        : plant_(plant), h_(h), ripple_(plant.ripple.trimmed()), cogging_(plant.cogging.trimmed()),
          cutting_(plant.cutting.trimmed()), along_(plant.friction.along.trimmed()) {
        const auto& f = plant.friction;
        const auto& m = plant.mode;
        if (plant.lag > 0) {
            lag_left_ = std::exp(-h / plant.lag);
            lag_mean_ = plant.lag / h * (1 - lag_left_);
        }
        inertia_ = plant.mass;
        if (m.mass > 0) {
            const double w0 = 2 * std::numbers::pi * m.frequency_Hz, d = std::min(m.damping, 0.999);
            const double decay = std::exp(-d * w0 * h), wd = w0 * std::sqrt(1 - d * d);
            const double c = std::cos(wd * h), s = std::sin(wd * h) / wd;
            qq_ = decay * (c + d * w0 * s);
            qw_ = decay * s;
            wq_ = -w0 * w0 * qw_;
            ww_ = decay * (c - d * w0 * s);
            q_at_rest_ = -1 / (w0 * w0);
            inertia_ -= m.mass * q_at_rest_ * wq_ / h;
        }
        for (int i = 0; i < 2; ++i) {
            const double direction = i == 0 ? -1 : 1;
            side_[static_cast<std::size_t>(i)] = {f.coulomb * (1 + f.coulomb_asymmetry * direction),
                                                  inertia_ + h * f.viscous_slope *
                                                                 (1 + f.viscous_asymmetry * direction)};
        }
        const auto lengths = f.contact.lengths();
        for (std::size_t i = 0; i < f.contact.elements; ++i)
            stiffness_[i] = f.contact.weights[i] / lengths[i]; // times the level
        for (side& d : side_) d = with_contact(d);
        one_element_ = f.contact.elements == 1 && f.contact.weights[0] == 1;
        level_varies_ = along_.count > 0 || f.drift != 0;
        actuator_ = plant.dead_zone > 0 || plant.lag > 0 || ripple_.count > 0;
        forces_ = cogging_.count + cutting_.count > 0 || plant.cutting_mean != 0 || plant.coupling != 0;
        inverse_stribeck_ = 1 / f.stribeck_velocity;
        inverse_drift_ = 1 / f.drift_time;
    }

    void operator()(plant_state& s, double command, const surroundings& now = {}) const {
        const double x = s.x + 0.5 * h_ * s.v, time = now.time + 0.5 * h_; // in the middle of the step
        double drive = motor(s, command, x) + plant_.constant_force - plant_.spring * x;
        if (forces_)
            drive = drive + cogging_.at(x) + cutting_.at(time + plant_.cutting_start) + plant_.cutting_mean +
                    plant_.mass * plant_.coupling * now.other_acceleration;
        if (!plant_.own.empty()) drive += plant_.own.at({x, s.v, command, time, h_}, s.remembered);
        double push = inertia_ * s.v + h_ * drive; // momentum before friction
        if (plant_.mode.mass > 0) push -= plant_.mode.mass * (wq_ * s.q + (ww_ - 1) * s.w);
        const double v = one_element_ ? behind_one(s, push, time) : behind_friction(s, push, time);
        if (plant_.mode.mass > 0) {
            const double rest = q_at_rest_ * (v - s.v) / h_, q = s.q - rest;
            s.q = rest + qq_ * q + qw_ * s.w;
            s.w = wq_ * q + ww_ * s.w;
        }
        s.x += 0.5 * h_ * (s.v + v);
        s.v = v;
        const double half_play = 0.5 * plant_.backlash, before = s.load;
        s.load = std::clamp(s.load, s.x - half_play, s.x + half_play);
        s.load_velocity = half_play == 0 || s.load != before ? v : 0;
    }

private:
    struct side { // of one direction of motion
        double level, inertia;
        double stiffness = 0, stuck_inertia = 0; // of a contact of one element, and with it
    };

    /// Force of the motor: what the actuator makes of a command.
    double motor(plant_state& s, double command, double x) const {
        if (!actuator_)
            return plant_.force_constant * std::clamp(command, -plant_.drive_limit, plant_.drive_limit);
        if (plant_.dead_zone > 0)
            command = command > 0 ? std::max(0.0, command - plant_.dead_zone)
                                  : std::min(0.0, command + plant_.dead_zone);
        command = std::clamp(command, -plant_.drive_limit, plant_.drive_limit);
        if (plant_.lag > 0) {
            const double from = s.lagged - command;
            s.lagged = command + from * lag_left_;
            command += from * lag_mean_;
        }
        return plant_.force_constant * (1 + ripple_.at(x)) * command;
    }

    double level_now(const side& d, const plant_state& s, double time) const {
        double level = d.level;
        if (along_.count > 0) level *= std::max(0.0, 1 + along_.at(s.x));
        if (const double drift = plant_.friction.drift; drift != 0)
            level *= std::max(0.0, 1 + drift * (1 - std::exp(-time * inverse_drift_)));
        return level;
    }
    double slip_level(double level, double v) const {
        const double excess = plant_.friction.excess;
        return excess != 0 ? level + excess * std::exp(-std::abs(v) * inverse_stribeck_) : level;
    }

    /// behind_friction() for a contact of one element, which most models have: the same numbers in a third of the time.
    double behind_one(plant_state& s, double push, double time) const {
        side d = side_[(s.v != 0 ? s.v : push) > 0 ? 1 : 0];
        if (level_varies_) d = with_contact({level_now(d, s, time), d.inertia});
        const double breakaway = d.level + plant_.friction.excess;
        if (breakaway <= 0) return push / d.inertia;
        double& z = s.deflection[0];
        const double pull = d.stiffness * z, stuck = (push - h_ * pull) / d.stuck_inertia, to = z + h_ * stuck;
        const double force = std::abs(d.stiffness * to);
        const bool slides = s.slipping[0] && to * s.v > 0;
        double slip = slides ? slip_level(d.level, s.v) : breakaway;
        s.slipping[0] = !(force <= slip);
        if (!s.slipping[0]) {
            z = to;
            return stuck;
        }
        if (!slides) slip = slip_level(d.level, s.v);
        const double held = to > 0 ? slip : -slip;
        z = held / d.stiffness;
        return (push - h_ * (pull + (held - pull))) / d.inertia;
    }
    /// A direction's level and inertia, with what follows from them.
    side with_contact(side d) const {
        d.stiffness = stiffness_[0] * (d.level + plant_.friction.excess);
        d.stuck_inertia = d.inertia + h_ * (h_ + plant_.friction.contact.damping) * d.stiffness;
        return d;
    }

    /// Velocity at the end of the step. An element that would leave its share of the level slips, and the others are
    /// solved again: the sum is a rising function of the velocity, so at most one round an element.
    double behind_friction(plant_state& s, double push, double time) const {
        const auto& f = plant_.friction;
        const side& d = side_[(s.v != 0 ? s.v : push) > 0 ? 1 : 0];
        const double level = level_now(d, s, time), breakaway = level + f.excess;
        if (breakaway <= 0) return push / d.inertia;
        const double slip = slip_level(level, s.v);

        const std::size_t n = f.contact.elements;
        std::array<double, friction_contact::most> held{}; // force of the elements that slip in this step
        std::array<bool, friction_contact::most> slips{};
        double v = 0, stiffness = 0, pull = 0;
        for (std::size_t i = 0; i < n; ++i) {
            stiffness += stiffness_[i] * breakaway;
            pull += stiffness_[i] * breakaway * s.deflection[i];
        }
        for (bool again = true; again;) {
            again = false;
            v = (push - h_ * pull) / (d.inertia + h_ * (h_ + f.contact.damping) * stiffness);
            for (std::size_t i = 0; i < n; ++i) {
                if (slips[i]) continue;
                const double k = stiffness_[i] * breakaway, to = s.deflection[i] + h_ * v;
                const double most = f.contact.weights[i] * (s.slipping[i] && to * s.v > 0 ? slip : breakaway);
                if (std::abs(k * to) <= most) continue;
                slips[i] = again = true;
                held[i] = f.contact.weights[i] * (to > 0 ? slip : -slip);
                stiffness -= k;
                pull += held[i] - k * s.deflection[i];
            }
            stiffness = std::max(0.0, stiffness);
        }
        for (std::size_t i = 0; i < n; ++i) {
            s.deflection[i] = slips[i] ? held[i] / (stiffness_[i] * breakaway) : s.deflection[i] + h_ * v;
            s.slipping[i] = slips[i];
        }
        return v;
    }

    const plant_model& plant_;
    bool one_element_ = false, level_varies_ = false, actuator_ = false, forces_ = false;
    double h_, inverse_stribeck_ = 0, inverse_drift_ = 0;
    double inertia_ = 0, lag_left_ = 0, lag_mean_ = 0;
    double qq_ = 1, qw_ = 0, wq_ = 0, ww_ = 1, q_at_rest_ = 0;
    harmonics ripple_, cogging_, cutting_, along_; // of the plant, up to the last that has a size
    std::array<double, friction_contact::most> stiffness_{};
    std::array<side, 2> side_{};
};

} // namespace quadrant::diagnosis
