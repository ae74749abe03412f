// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive.hpp"
#include "plant.hpp"

#include <deque>

/// Controller, encoder and the closed loop of the trial's machines.
namespace quadrant_gap::trial {

/// Kind cascade_p_pi of docs/formats.md.
class cascade {
public:
    cascade(const controller_truth& c, double period) : c_(c), T_(period) {
        if (c.notch_Hz > 0) {
            const double w = 2 * std::numbers::pi * c.notch_Hz, k = w / std::tan(w * T_ / 2);
            const double a0 = k * k + c.notch_damping * w * k + w * w;
            b0_ = (k * k + w * w) / a0;
            b1_ = 2 * (w * w - k * k) / a0;
            a2_ = (k * k - c.notch_damping * w * k + w * w) / a0;
        }
    }
    /// Begins with this much in the integral: what holds the axis where it rests.
    void hold(double u) { integral_ = std::clamp(u, -c_.limit, c_.limit); }
    double operator()(double r, double y) {
        const double v_ref = (r - r1_) / T_, a_ref = (v_ref - v_ref1_) / T_;
        double v = 0;
        if (c_.two_sample_mean) {
            v = (y - y2_) / (2 * T_);
        } else {
            const double w = 2 * std::numbers::pi * c_.filter_Hz;
            v = filtered_ = ((2 - w * T_) * filtered_ + 2 * w * (y - y1_)) / (2 + w * T_);
        }
        y2_ = y1_, y1_ = y, r1_ = r, v_ref1_ = v_ref;
        const double e = c_.position_gain * (r - y) + c_.velocity_feedforward * v_ref - v;
        integral_ = std::clamp(integral_ + c_.integral * T_ * e, -c_.limit, c_.limit);
        double u = c_.velocity_gain * e + integral_;
        if (c_.notch_Hz > 0) {
            const double out = b0_ * u + b1_ * u1_ + b0_ * u2_ - b1_ * n1_ - a2_ * n2_;
            u2_ = u1_, u1_ = u, n2_ = n1_, n1_ = out;
            u = out;
        }
        u += c_.acceleration_feedforward * a_ref + c_.viscous_feedforward * v_ref +
             c_.coulomb_feedforward * (v_ref > 0   ? 1
                                       : v_ref < 0 ? -1
                                                   : 0);
        u = std::clamp(u, -c_.limit, c_.limit);
        if (c_.dac_bits == 0) return u;
        const double step = c_.dac_range / static_cast<double>(std::uint64_t{1} << c_.dac_bits);
        return std::round(u / step) * step;
    }

private:
    controller_truth c_;
    double T_, b0_ = 1, b1_ = 0, a2_ = 0;
    double r1_ = 0, v_ref1_ = 0, y1_ = 0, y2_ = 0, filtered_ = 0, integral_ = 0, u1_ = 0, u2_ = 0, n1_ = 0,
           n2_ = 0;
};

/// Count, white and coloured noise, cyclic error.
class encoder {
public:
    encoder(const encoder_truth& e, dice random) : e_(e), random_(random) {}
    double operator()(double x) {
        double y = x + at(e_.cyclic, x);
        if (e_.noise > 0) {
            colour_ =
                e_.noise_colour * colour_ + std::sqrt(1 - e_.noise_colour * e_.noise_colour) * random_.normal();
            y += e_.noise * std::sqrt(0.5) * (colour_ + random_.normal());
        }
        return e_.resolution > 0 ? std::round(y / e_.resolution) * e_.resolution : y;
    }

private:
    const encoder_truth& e_;
    dice random_;
    double colour_ = 0;
};

/// The laws of effects that this simulator has no law of its own for, each at its joint.
class laws_of_effects {
public:
    using joint = quadrant::diagnosis::joint;
    explicit laws_of_effects(const std::vector<law_truth>& all) {
        for (const law_truth& l : all) laws_.of(*l.law) = l.values;
    }
    double operator()(joint where, const mechanics& body, double acting, double t, double h) {
        if (laws_.empty()) return 0;
        const double x = body.position() + h / 2 * body.velocity();
        return laws_.sum(where, {x, body.velocity(), acting, t + h / 2, h}, remembered_);
    }

private:
    quadrant::diagnosis::own_laws laws_;
    quadrant::diagnosis::own_laws::memories remembered_{};
};

struct axis_record {
    std::vector<double> reference, position, command;
    std::vector<double> acting{}; ///< mean command behind the amplifier, over the period that follows the row
    /// Of a drive with loops of its own: mean force over each row; duty as a row begins; current as it is
    /// measured.
    std::vector<double> force, duty{}, current{};
};

/// Log without rounding and noise: what the equations alone make of a motion.
inline axis_truth ideal(axis_truth a) {
    a.encoder.resolution = a.encoder.noise = 0;
    a.controller.dac_bits = 0;
    return a;
}

namespace detail {

/// What a drive with loops of its own gets in row k: the reference, or for a velocity drive the volts of a P
/// loop with velocity feedforward.
inline double set_point(const axis_truth& a, const std::vector<double>& reference, std::size_t k, double y,
                        double period) {
    if (a.drive.kind != drive_truth::drive_kind::velocity) return reference[k];
    const double speed = (reference[std::min(k + 1, reference.size() - 1)] - reference[k]) / period;
    const double volts = (a.controller.position_gain * (reference[k] - y) + speed) / a.drive.velocity_per_V;
    return std::clamp(volts, -10.0, 10.0);
}

/// One axis that runs, in its parts.
class running_axis {
public:
    running_axis(const axis_truth& a, std::size_t i, std::size_t samples, double period, std::uint64_t seed)
        : truth_(a), control_(a.controller, period), drive_(a.actuator, period, dice(seed, 2 * i)),
          body_(a, static_cast<double>(samples) * period), scale_(a.encoder, dice(seed, 2 * i + 1)),
          laws_(a.laws), inner_(a.drive, period, dice(seed, 100 + i)) {
        if (const auto& m = a.mechanics; a.turns)
            control_.hold(-m.weight() * std::sin(m.gravity_phase) / a.actuator.force_constant);
    }
    double acceleration() const { return body_.acceleration(); }

    /// A row of the log; false where the axis has left its travel.
    bool begin_row(const std::vector<double>& reference, std::size_t k, double period, axis_record& out) {
        constexpr double farthest = 5;
        const double y = scale_(body_.seen() + displaced_);
        const drive_truth& d = truth_.drive;
        const double u = d.closes() ? set_point(truth_, reference, k, y, period) : control_(reference[k], y);
        if (d.closes())
            inner_.set_point(u);
        else
            drive_.command(u);
        out.position.push_back(y);
        out.command.push_back(u);
        out.acting.push_back(0);
        if (d.closes()) out.force.push_back(0);
        if (std::abs(y) < farthest) return true;
        out.position.back() = std::nan("");
        return false;
    }
    /// Fine step f of `fine` in a row, at time t. other: acceleration of the other axis.
    void step(double t, double h, std::size_t f, std::size_t fine, double other, axis_record& out) {
        using quadrant::diagnosis::joint;
        if (truth_.drive.closes()) return step_driven(t, h, f, fine, other, out);
        double acting = drive_.acting(t, h);
        out.acting.back() += acting / static_cast<double>(fine);
        const auto law = [&](joint where) { return laws_(where, body_, acting, t, h); };
        acting += law(joint::command);
        const double motor =
            drive_.force(acting, body_.position()) * (1 + law(joint::motor_gain)) + law(joint::force);
        const double more_friction = law(joint::friction);
        displaced_ = law(joint::transmission) + law(joint::reading);
        body_.step(motor, t, h, other, more_friction);
    }

private:
    /// Behind a drive with loops of its own.
    void step_driven(double t, double h, std::size_t f, std::size_t fine, double other, axis_record& out) {
        using quadrant::diagnosis::joint;
        // The law of the file format knows no clock of the drive: its force over a step is that of the middle
        // of the step.
        const double v = body_.velocity() + h / 2 * body_.acceleration();
        double push = inner_.force(t, h, body_.position() + h / 2 * body_.velocity(), v);
        if (truth_.drive.supply > 0) {
            if (f == 0) out.duty.push_back(inner_.duty());
            push = drive_.force(truth_.drive.supply * push, body_.position());
        }
        if (truth_.drive.shows_current()) {
            const double current = push / truth_.actuator.force_constant;
            // As a row begins: between the middles of the steps before and behind it.
            if (f == 0) out.current.push_back(truth_.drive.tap_is_mean ? 0 : (current_ + current) / 2);
            if (truth_.drive.tap_is_mean) out.current.back() += current / static_cast<double>(fine);
            current_ = current;
        }
        out.force.back() += push / static_cast<double>(fine);
        const auto law = [&](joint where) { return laws_(where, body_, push, t, h); };
        body_.step(push * (1 + law(joint::motor_gain)) + law(joint::force), t, h, other, law(joint::friction));
    }

    const axis_truth& truth_;
    cascade control_;
    actuator drive_;
    mechanics body_;
    encoder scale_;
    laws_of_effects laws_;
    inner_loops inner_;
    double displaced_ = 0; ///< of the reading, by laws of the transmission and of the reading
    double current_ = 0;   ///< of a drive in the step before [A]
};

} // namespace detail

/// The axes of a machine under their references, at least 20 fine steps a period and none above 25 us. A run
/// that leaves the travel has a NaN as its last position.
inline std::vector<axis_record> run(const std::vector<axis_truth>& axes,
                                    const std::vector<std::vector<double>>& references, double period,
                                    std::uint64_t seed) {
    constexpr double coarsest = 2.5e-5;
    const auto fine = static_cast<std::size_t>(std::max(20.0, std::ceil(period / coarsest)));
    const double h = period / static_cast<double>(fine);
    const std::size_t samples = references.front().size();
    std::deque<detail::running_axis> all;
    std::vector<axis_record> out(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
        all.emplace_back(axes[i], i, samples, period, seed);
        out[i].reference = references[i];
    }
    for (std::size_t k = 0; k < samples; ++k) {
        for (std::size_t i = 0; i < axes.size(); ++i)
            if (!all[i].begin_row(references[i], k, period, out[i])) return out;
        for (std::size_t f = 0; f < fine; ++f) {
            const double t = (static_cast<double>(k * fine + f)) * h;
            for (std::size_t i = 0; i < axes.size(); ++i)
                all[i].step(t, h, f, fine, axes.size() > 1 ? all[1 - i].acceleration() : 0, out[i]);
        }
    }
    return out;
}

} // namespace quadrant_gap::trial
