// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/select.hpp"

#include <cmath>
#include <numbers>

namespace quadrant::inline v0::detail {

/// A damped spring and mass over h while nothing pushes it: the matrix exponential of
///   q'' + 2 zeta w q' + w^2 q = 0,   q(h) = stay q + onward q',   q'(h) = back q + keep q'
/// with w = 2 pi centre. What pushes it for all of h moves the place about which it rings. The one place of
/// this law: `flexible_modes` and `sprung_mass` ask it.
template <class Number> struct oscillator {
    Number stay{1}, onward{0}, back{0}, keep{1};
    Number stiffness{0}; ///< w^2 [1/s^2]

    oscillator() = default;
    oscillator(Number centre_Hz, Number zeta, Number h) {
        using std::cos, std::exp, std::sin, std::sqrt;
        const Number w = Number(2 * std::numbers::pi) * centre_Hz;
        const Number decay = zeta * w, ringing = w * sqrt(Number(1) - zeta * zeta);
        const Number e = exp(-decay * h), angle = ringing * h;
        Number c, s;
        if constexpr (multi_lane<Number>) { // lanes bring their own; see lanes/turns.hpp
            const Number turns = angle * Number(0.5 / std::numbers::pi);
            const auto at = circle_of_turns(turns - floor(turns));
            c = at.cosine;
            s = at.sine;
        } else {
            c = cos(angle);
            s = sin(angle);
        }
        c = e * c;
        s = e * s / ringing;
        stiffness = w * w;
        stay = c + decay * s;
        onward = s;
        back = -stiffness * s;
        keep = c - decay * s;
    }
};

} // namespace quadrant::inline v0::detail
