// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "limits.hpp"

#include <cmath>

namespace quadrant::inline v0::trajectory {

/// The S-curve move of the precision stage: a logistic curve, slow at both ends, very fast in the middle.
///   x(t) = L (g(a (t/T - 1/2)) - g(-a/2)) / (1 - 2 g(-a/2)),  g(y) = 1 / (1 + exp(-y))
/// Source: read from the peak speed of [LowKeck2003] (1.127 m/s for 0.30 m in 1 s: steepness a = 15 gives
/// 1.126).
/// Peaks: speed k a/(4 T), acceleration k a^2/(6 sqrt(3) T^2), jerk k a^3/(8 T^3), k = L / (1 - 2 g(-a/2)).
/// At both ends it jumps, by k a/T g(-a/2) (1 - g(-a/2)) in speed: 2.5 mm/s of 1.13 m/s with a = 15. A
/// `profile` does not.
/// Range: duration > 0, steepness > 0; length of either sign, finite. t is held to 0 ... T; beyond the ends it
/// stands still. Throws "s_curve.duration = ...: must be finite and above 0".
/// Cost: one exponential and one division a time.
class s_curve {
public:
    /// A move: its length, its time, and how sharp its S is.
    struct parameters {
        quantity<si::length> length; ///< of the move, with its sign
        quadrant::duration duration; ///< of the move, > 0
        double steepness = 15;       ///< > 0
    };

    s_curve(const parameters& p) : given_(p) {
        require_finite("s_curve.length", p.length);
        require_positive("s_curve.duration", p.duration);
        require_positive("s_curve.steepness", p.steepness);
        rate_ = p.steepness / p.duration.value();
        low_ = 1 / (1 + std::exp(0.5 * p.steepness));
        scale_ = p.length.value() / (1 - 2 * low_);
    }

    motion operator()(quadrant::duration at) const noexcept {
        const double T = given_.duration.value(), t = at.value();
        motion m;
        if (!(t >= 0)) return m;
        if (t > T) {
            m.position = given_.length;
            return m;
        }
        const double g = 1 / (1 + std::exp(-(rate_ * t - 0.5 * given_.steepness))), slope = g * (1 - g);
        m.position = quantity_of<signal::position>::from_value(scale_ * (g - low_));
        m.velocity = quantity_of<signal::velocity>::from_value(scale_ * rate_ * slope);
        m.acceleration =
            quantity_of<signal::acceleration>::from_value(scale_ * rate_ * rate_ * slope * (1 - 2 * g));
        m.jerk = jerk::from_value(scale_ * rate_ * rate_ * rate_ * slope * (1 - 6 * slope));
        return m;
    }
    quadrant::duration lasts() const noexcept { return given_.duration; }
    motion_limits peaks() const noexcept { ///< of speed, acceleration and jerk, all positive
        const double k = std::abs(scale_);
        return {quantity<si::velocity>::from_value(k * rate_ / 4),
                quantity<si::acceleration>::from_value(k * rate_ * rate_ / (6 * std::sqrt(3.0))),
                jerk::from_value(k * rate_ * rate_ * rate_ / 8)};
    }
    const parameters& given() const noexcept { return given_; }

private:
    parameters given_;
    double rate_ = 0, low_ = 0, scale_ = 0;
};

} // namespace quadrant::inline v0::trajectory
