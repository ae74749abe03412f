// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "finite.hpp"
#include "units.hpp"

namespace quadrant::inline v0 {

/// A bare number, in SI, at the border to code without units; becomes whatever quantity stands on the other
/// side:
///   const double u = step_in_si(axis, r, y);                                             // one line per axis
///   notch<signal::force> resonance({.centre = in_si(330), .width = 0.4}, in_si(500e-6));
/// Nothing checks its unit: write it as far outside as you can, and quantities within.
template <class Number> struct in_si {
    Number value;

    constexpr explicit in_si(Number number) noexcept : value(number) {}
    template <class Unit, class Real> constexpr operator quantity<Unit, Real>() const noexcept {
        return quantity<Unit, Real>::from_value(Real(value));
    }
};

/// One sample of a box or a loop, numbers in and number out, SI: metres in and volts out for an axis. No copy,
/// no cost.
template <class Box, class... Numbers> constexpr auto step_in_si(Box& box, Numbers... x) noexcept {
    return detail::bare(box(in_si(x)...));
}

} // namespace quadrant::inline v0
