// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "friction.hpp"
#include "random.hpp"

/// Actuator and mechanics of the trial's machines, stepped much finer than the servo period.
namespace quadrant_gap::trial {

/// From commands to force: loss, delay, hold, dead zone, limits and lag. Events act at their own instant, also
/// between two fine steps.
class actuator {
public:
    actuator(const actuator_truth& a, double period, dice random) : a_(a), period_(period), random_(random) {}
    /// The next row's command; the first one is given at t = 0.
    void command(double u) {
        if (!(a_.loss > 0 && !told_.empty() && random_.chance(a_.loss))) kept_ = u;
        told_.push_back(kept_);
    }
    /// Mean acting command over [t, t + h].
    double acting(double t, double h) {
        const double from = t - a_.delay, to = from + h;
        const double now = shaped(told_at(from)), next = shaped(told_at(to));
        const double border = std::floor(to / period_ + 1e-9) * period_;
        double mean = now;
        if (next != now) mean = now + (next - now) * std::clamp((to - border) / h, 0.0, 1.0);
        if (a_.slew > 0) {
            slewed_ += std::clamp(mean - slewed_, -a_.slew * h, a_.slew * h);
            mean = slewed_;
        }
        if (a_.lag <= 0) return mean;
        const double decay = std::exp(-h / a_.lag), before = lagged_;
        lagged_ = mean + (lagged_ - mean) * decay;
        return mean + (before - mean) * (1 - decay) * a_.lag / h;
    }
    double force(double acting, double x) const {
        const double gain = a_.soft_limit > 0 ? 1 / (1 + std::pow(acting / a_.soft_limit, 2)) : 1;
        return a_.force_constant * gain * (1 + at(a_.ripple, x)) * acting;
    }

private:
    double told_at(double t) const {
        if (t < -1e-12 || told_.empty()) return 0;
        return told_[std::min(told_.size() - 1, static_cast<std::size_t>(t / period_ + 1e-9))];
    }
    double shaped(double u) const {
        const double over = u > 0 ? std::max(0.0, u - a_.dead_zone) : std::min(0.0, u + a_.dead_zone);
        return std::clamp(over, -a_.drive_limit, a_.drive_limit);
    }
    const actuator_truth& a_;
    double period_;
    dice random_;
    std::vector<double> told_;
    double kept_ = 0, slewed_ = 0, lagged_ = 0;
};

/// Forces that no effect of the list makes.
class unknown_force {
public:
    unknown_force(const stranger& s, double seconds) : s_(s) {
        dice random(s.seed);
        if (s.what == stranger::kind::bursts) {
            for (double t = random.uniform(0.1, 0.5); t < seconds; t += random.uniform(0.3, 1.5))
                bursts_.push_back({t, random.uniform(0.01, 0.06), random.sign() * random.uniform(0.5, 1.5)});
        } else if (s.what == stranger::kind::wander) {
            constexpr double step = 0.05;
            double level = 0;
            for (double t = 0; t < seconds + 2 * step; t += step)
                wander_.push_back(level = level * 0.96 + 0.28 * random.normal());
        }
    }
    double operator()(double x, double t) const {
        using enum stranger::kind;
        switch (s_.what) {
        case ramp:
            return s_.size * t / s_.scale;
        case bump: { // a detent: pulls into one place of the travel
            const double d = (x - s_.begin) / s_.scale;
            return -s_.size * d * std::exp(0.5 * (1 - d * d));
        }
        case quadratic_spring:
            return s_.size * x * x / (s_.scale * s_.scale);
        case step:
            return t > s_.begin ? s_.size : 0;
        case bursts:
            for (const burst& b : bursts_)
                if (t > b.begin && t < b.begin + b.length)
                    return s_.size * b.size * std::sin(std::numbers::pi * (t - b.begin) / b.length);
            return 0;
        case wander: {
            const double place = t / 0.05;
            const auto k = std::min(static_cast<std::size_t>(place), wander_.size() - 2);
            return s_.size * (wander_[k] + (wander_[k + 1] - wander_[k]) * (place - static_cast<double>(k)));
        }
        default:
            return 0;
        }
    }

private:
    struct burst {
        double begin, length, size;
    };
    stranger s_;
    std::vector<burst> bursts_;
    std::vector<double> wander_;
};

/// The moving mass: half a step of motion, the forces there, half a step of motion. Second order, and keeps the
/// energy of a mode.
class mechanics {
public:
    mechanics(const axis_truth& a, double seconds)
        : a_(a), friction_(a.friction, a.mechanics.mass, a.mechanics.weight()), unknown_(a.unknown, seconds) {}
    /// One fine step under a motor force; the other axis' acceleration couples in. Laws of effects may change
    /// the friction level, relatively.
    void step(double motor, double t, double h, double other_acceleration, double more_friction = 0) {
        const auto& m = a_.mechanics;
        const double carrier = m.moving() - m.mode_mass;
        x_ += h / 2 * v_;
        second_ += h / 2 * second_v_;
        const double load = m.constant_force - m.spring * x_ - m.weight() * std::sin(x_ - m.gravity_phase);
        double force = motor + load + at(m.cogging, x_) + unknown_(x_, t) +
                       carrier * m.coupling * other_acceleration - viscous_force(a_.friction, v_) -
                       friction_(v_, h,
                                 (1 + more_friction) * slip_level(a_.friction, x_, v_, t) +
                                     a_.friction.load * std::abs(motor - load));
        if (a_.process.fundamental > 0) {
            force += a_.process.mean;
            for (std::size_t i = 0; i < a_.process.size.size(); ++i)
                force += a_.process.size[i] * std::sin(2 * std::numbers::pi * static_cast<double>(i + 1) *
                                                           a_.process.fundamental * t +
                                                       a_.process.phase[i]);
        }
        if (m.mode_mass > 0) {
            const double w = 2 * std::numbers::pi * m.mode_frequency;
            const double pull =
                m.mode_mass * (w * w * (second_ - x_) + 2 * m.mode_damping * w * (second_v_ - v_));
            force += pull;
            second_v_ += h * (m.coupling * other_acceleration - pull / m.mode_mass);
            second_ += h / 2 * second_v_;
        }
        acceleration_ = force / carrier;
        v_ += h * acceleration_;
        x_ += h / 2 * v_;
        load_ = std::clamp(load_, x_ - m.backlash / 2, x_ + m.backlash / 2);
    }
    double position() const { return x_; }
    double seen() const { return a_.mechanics.backlash > 0 ? load_ : x_; } ///< what carries the encoder
    double velocity() const { return v_; }
    double acceleration() const { return acceleration_; }
    double second_mass() const { return second_; }
    void place(double x, double v) { x_ = load_ = second_ = x, v_ = second_v_ = v; }

private:
    const axis_truth& a_;
    contact friction_;
    unknown_force unknown_;
    double x_ = 0, v_ = 0, acceleration_ = 0, load_ = 0, second_ = 0, second_v_ = 0;
};

} // namespace quadrant_gap::trial
