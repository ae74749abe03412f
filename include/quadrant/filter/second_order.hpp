// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "slowest.hpp"

#include <cmath>
#include <complex>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <type_traits>

/// What notch and Butterworth low-pass share: a second-order section as two integrators in a ring, by the
/// trapezoidal rule. Its
/// coefficients are small where the section is slow, so that they keep all their digits, and at rest both
/// integrators stand still: the gain at standstill is one to the last bit, at any corner and in any number
/// type. A direct form subtracts numbers close to one instead and loses (f T)^2 of its digits. Per sample, x
/// in, `ahead` = x minus the slow part:
///   half = thrust (ahead - brake band),  middle = band + half,  slow' = slow + 2 g middle,  band' = middle + half
/// Derivation: docs/derivations/second_order.md.
namespace quadrant::inline v0 {

/// For hertz into rad/s: w = 2 pi f.
inline constexpr double pi = std::numbers::pi;

/// H(s) = w^2 / (s^2 + damping w s + w^2), the slow part, and H(s) = w s / (...), the band, of one section;
/// bilinear, exact at w.
template <class Real> struct second_order_coefficients {
    Real g{};       ///< tan(w T/2)
    Real damping{}; ///< twice the damping ratio
    Real brake{};   ///< g + damping
    Real thrust{};  ///< g / (1 + g (g + damping))
};

/// The coefficients of a section; refuses a corner that is too slow for the number type, or so close to half
/// the sampling rate that rounding, which grows there as tan^2(w T/2), would take more than a tenth.
template <class Real, class Number>
second_order_coefficients<Real> second_order(const detail::field_name& field,
                                             const quantity<hertz_unit, Number>& corner, const Number& damping,
                                             duration period) {
    using std::tan;
    require_held<Real>(field, corner, period, damping);
    using plain = std::conditional_t<std::same_as<Real, float>, float, double>;
    const double most = 0.5 - std::sqrt(10 * double(std::numeric_limits<plain>::epsilon())) / pi;
    for (std::size_t i = 0; i < lane_count<Real>; ++i)
        require(detail::plain(lane(corner, i)) * period.value() <= most, field, lane(corner, i),
                "must be at most " + detail::shortest(most) + " of the sampling rate in this number type (" +
                    detail::shortest(detail::in_unit(most / period.value(), " Hz")) + ")");
    const Number t = tan(Number(pi * period.value()) * corner.value());
    return {.g = Real(t),
            .damping = Real(damping),
            .brake = Real(t + damping),
            .thrust = Real(t / (1 + t * (t + damping)))};
}

/// Other coefficients in the next step: what the band has to be, so that the last input, were it to come again,
/// would give the same output. Nothing changes for a constant input; else the next output is off by (b0' -
/// b0)(x[k] - x[k-1]) from what it would have
/// been, b0: what an impulse gives at once. `weight`: by which the band enters the output, damping or g.
template <class Real, class Value>
Value retuned_band(const second_order_coefficients<Real>& c, const second_order_coefficients<Real>& next,
                   const Real& weight, const Real& next_weight, const Value& ahead,
                   const Value& band) noexcept {
    const auto middle = [&](const second_order_coefficients<Real>& with) -> Value {
        return band + with.thrust * (ahead - with.brake * band);
    };
    const Value wanted = (weight / next_weight) * middle(c);
    return band + (next.g / next.thrust) * (wanted - middle(next)); // 1 - thrust brake = thrust / g
}

/// Response of the section at f, as it runs with this period: of the slow part, and of the band.
struct second_order_response {
    std::complex<double> slow, band;
};
/// Both at f.
template <class Real>
second_order_response response(const second_order_coefficients<Real>& c, frequency f, duration period) {
    const double angle = pi * f.value() * period.value();
    const std::complex<double> s(0, std::tan(angle) / detail::plain(c.g)); // in units of w
    const auto under = 1.0 + s * (detail::plain(c.damping) + s);
    return {1.0 / under, s / under};
}

} // namespace quadrant::inline v0
