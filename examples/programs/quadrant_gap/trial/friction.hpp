// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

/// Friction of the trial's machines: four laws of contact, none of them the diagnosis'.
namespace quadrant_gap::trial {

inline double at(const wave& w, double x) {
    double sum = 0;
    for (std::size_t i = 0; i < w.size.size(); ++i)
        sum +=
            w.size[i] * std::sin(2 * std::numbers::pi * static_cast<double>(i + 1) * x / w.period + w.phase[i]);
    return sum;
}

/// Way at which Maxwell-slip elements carry 63 % of the level, loaded for the first time.
inline double way_to_63_percent(const std::vector<double>& weights, const std::vector<double>& ways) {
    double low = 0, high = *std::max_element(ways.begin(), ways.end());
    for (int i = 0; i < 60; ++i) {
        const double x = (low + high) / 2;
        double carried = 0;
        for (std::size_t k = 0; k < ways.size(); ++k) carried += weights[k] * std::min(1.0, x / ways[k]);
        (carried < 1 - std::exp(-1.0) ? low : high) = x;
    }
    return (low + high) / 2;
}

/// The part of friction with memory. `level` is what it slips at now, `stiff_level` what its stiffness belongs
/// to: that of the largest `load` [N or N m], which the friction grows with.
class contact {
public:
    contact(const friction_truth& f, double mass, double load = 0)
        : f_(f), stiff_level_(std::max(f.coulomb, f.level_at_rest) + f.load * load),
          damping_(2 * f.damping * std::sqrt(std::max(0.0, stiff_level_ / f.length) * mass)) {
        if (f.law == contact_law::maxwell_slip) {
            scale_ = f.length / way_to_63_percent(f.weights, f.ways);
            elements_.resize(f.weights.size());
        }
    }
    /// Force against the motion after a displacement of v h.
    double operator()(double v, double h, double level) {
        if (stiff_level_ <= 0) return 0;
        const double before = force_;
        force_ = moved(v * h, level);
        const double creep =
            (force_ - before) / h * f_.length / stiff_level_; // velocity of the contact's deflection
        return force_ + damping_ * std::clamp(creep, -std::abs(v), std::abs(v));
    }

private:
    double moved(double way, double level) {
        const double side = way > 0 ? 1 : -1;
        switch (f_.law) {
        case contact_law::lugre: { // exact for a constant velocity: the bristle's rate follows the level
            const double stiffness = stiff_level_ / f_.length;
            return side * level + (force_ - side * level) * std::exp(-stiffness * std::abs(way) / level);
        }
        case contact_law::dahl: { // dF/dx = stiffness (1 - F sign / level)^exponent, in closed form
            const double left = 1 - force_ * side / level, e = 1 - f_.exponent;
            if (left <= 0) return side * level;
            if (std::abs(e) < 1e-9) return side * level * (1 - left * std::exp(-std::abs(way) / f_.length));
            const double pace = (1 - std::exp(-e)) / e; // 63 % at `length`
            const double power = std::pow(left, e) - e * pace * std::abs(way) / f_.length;
            return side * level * (1 - (power <= 0 ? 0 : std::pow(power, 1 / e)));
        }
        case contact_law::maxwell_slip: {
            double sum = 0;
            for (std::size_t k = 0; k < elements_.size(); ++k) {
                const double slips = f_.weights[k] * level;
                elements_[k] = std::clamp(
                    elements_[k] + f_.weights[k] * stiff_level_ / (f_.ways[k] * scale_) * way, -slips, slips);
                sum += elements_[k];
            }
            return sum;
        }
        case contact_law::tanh_spring:
        default: {
            constexpr double reach = 1.5, whole = 0.9051483; // tanh(reach)
            constexpr double at_63_percent = 0.65073;        // tanh of it is (1 - 1/e) whole
            const double unit = f_.length / at_63_percent;
            deflection_ = std::clamp(deflection_ + way / unit, -reach, reach);
            return level * std::tanh(deflection_) / whole;
        }
        }
    }

    const friction_truth& f_;
    double stiff_level_, damping_, scale_ = 1, force_ = 0, deflection_ = 0;
    std::vector<double> elements_;
};

/// What the contact slips at: Coulomb level along the travel and over time, by direction, and the Stribeck
/// excess.
inline double slip_level(const friction_truth& f, double x, double v, double t) {
    double level = f.coulomb * (1 + at(f.along, x));
    if (f.drift != 0) level *= 1 + f.drift * (1 - std::exp(-t / f.drift_time));
    if (f.level_at_rest > f.coulomb) {
        const double s = std::abs(v) / f.stribeck_velocity;
        const double part = f.shape == stribeck_shape::exponential ? std::exp(-s)
                            : f.shape == stribeck_shape::gaussian  ? std::exp(-s * s)
                                                                   : 1 / (1 + s * s);
        level += (f.level_at_rest - f.coulomb) * part;
    }
    level *= 1 + f.coulomb_asymmetry * (v > 0 ? 1 : v < 0 ? -1 : 0);
    return std::max(level, 1e-9);
}

inline double viscous_force(const friction_truth& f, double v) {
    return f.viscous * (1 + f.viscous_asymmetry * (v > 0 ? 1 : -1)) * v;
}

} // namespace quadrant_gap::trial
