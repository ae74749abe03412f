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
    std::vector<double> force, duty; ///< of a drive with loops of its own: mean over each row; as a row begins
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

} // namespace detail

/// The axes of a machine under their references, at least 20 fine steps a period and none above 25 us. A run
/// that leaves the travel has a NaN as its last position.
inline std::vector<axis_record> run(const std::vector<axis_truth>& axes,
                                    const std::vector<std::vector<double>>& references, double period,
                                    std::uint64_t seed) {
    using quadrant::diagnosis::joint;
    constexpr double coarsest = 2.5e-5, farthest = 5;
    const auto fine = static_cast<std::size_t>(std::max(20.0, std::ceil(period / coarsest)));
    const double h = period / static_cast<double>(fine);
    const std::size_t samples = references.front().size();
    struct one {
        cascade control;
        actuator drive;
        mechanics body;
        encoder scale;
        laws_of_effects laws;
        inner_loops inner;
        double displaced = 0; ///< of the reading, by laws of the transmission and of the reading
    };
    std::deque<one> all;
    std::vector<axis_record> out(axes.size());
    for (std::size_t i = 0; i < axes.size(); ++i) {
        all.push_back({cascade(axes[i].controller, period),
                       actuator(axes[i].actuator, period, dice(seed, 2 * i)),
                       mechanics(axes[i], static_cast<double>(samples) * period),
                       encoder(axes[i].encoder, dice(seed, 2 * i + 1)), laws_of_effects(axes[i].laws),
                       inner_loops(axes[i].drive, period, dice(seed, 100 + i))});
        if (const auto& m = axes[i].mechanics; axes[i].turns)
            all.back().control.hold(-m.weight() * std::sin(m.gravity_phase) / axes[i].actuator.force_constant);
        out[i].reference = references[i];
    }
    for (std::size_t k = 0; k < samples; ++k) {
        for (std::size_t i = 0; i < axes.size(); ++i) {
            const double y = all[i].scale(all[i].body.seen() + all[i].displaced);
            const drive_truth& d = axes[i].drive;
            const double u = d.closes() ? detail::set_point(axes[i], references[i], k, y, period)
                                        : all[i].control(references[i][k], y);
            if (d.closes())
                all[i].inner.set_point(u);
            else
                all[i].drive.command(u);
            out[i].position.push_back(y);
            out[i].command.push_back(u);
            out[i].acting.push_back(0);
            if (d.closes()) out[i].force.push_back(0);
            if (!(std::abs(y) < farthest)) {
                out[i].position.back() = std::nan("");
                return out;
            }
        }
        for (std::size_t f = 0; f < fine; ++f) {
            const double t = (static_cast<double>(k * fine + f)) * h;
            for (std::size_t i = 0; i < axes.size(); ++i) {
                const double other = axes.size() > 1 ? all[1 - i].body.acceleration() : 0;
                one& a = all[i];
                if (axes[i].drive.closes()) {
                    // The law of the file format knows no clock of the drive: its force over a step is that of
                    // the middle of the step.
                    const double v = a.body.velocity() + h / 2 * a.body.acceleration();
                    double push = a.inner.force(t, h, a.body.position() + h / 2 * a.body.velocity(), v);
                    if (axes[i].drive.supply > 0) {
                        if (f == 0) out[i].duty.push_back(a.inner.duty());
                        push = a.drive.force(axes[i].drive.supply * push, a.body.position());
                    }
                    out[i].force.back() += push / static_cast<double>(fine);
                    const auto law = [&](joint where) { return a.laws(where, a.body, push, t, h); };
                    a.body.step(push * (1 + law(joint::motor_gain)) + law(joint::force), t, h, other,
                                law(joint::friction));
                    continue;
                }
                double acting = a.drive.acting(t, h);
                out[i].acting.back() += acting / static_cast<double>(fine);
                const auto law = [&](joint where) { return a.laws(where, a.body, acting, t, h); };
                acting += law(joint::command);
                const double motor =
                    a.drive.force(acting, a.body.position()) * (1 + law(joint::motor_gain)) + law(joint::force);
                const double more_friction = law(joint::friction);
                a.displaced = law(joint::transmission) + law(joint::reading);
                a.body.step(motor, t, h, other, more_friction);
            }
        }
    }
    return out;
}

} // namespace quadrant_gap::trial
