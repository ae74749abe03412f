// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <cmath>

namespace quadrant::inline v0 {

/// Exact step over h of dv/dt = u - A v, dx/dt = v with u held (zero-order hold), to all digits for every A >=
/// 0.
///   v' = kept v + gained u,   x' = x + gained v + way u
/// Source: [Franklin1998] zero-order hold. Bare numbers: v and x in any unit, A in 1/s, h in s.
template <class Number = double> struct viscous_step {
    Number kept;   ///< e^{-A h}
    Number gained; ///< (1 - e^{-A h}) / A; [s]
    Number way;    ///< (h - gained) / A; [s^2]

    viscous_step(Number damping, Number h) {
        const Number x = damping * h, second = integral(x), first = Number(1) - x * second;
        kept = Number(1) - x * first;
        gained = h * first;
        way = h * h * second;
    }

private:
    /// (x - 1 + e^{-x}) / x^2; by its series where the difference would lose digits.
    static Number integral(Number x) {
        using std::exp;
        if (x > Number(0.5)) return (x - Number(1) + exp(-x)) / (x * x);
        Number sum = 0, term = 0.5;
        for (int n = 3; n < 16; ++n) {
            sum += term;
            term *= -x / Number(n);
        }
        return sum;
    }
};

} // namespace quadrant::inline v0
