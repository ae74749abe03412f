// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "signal.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <string>

namespace quadrant {

/// A parameter that no machine could have. what() reads "notch.centre = 1200: must lie between 0 and half the
/// sampling rate (1000)"; values in SI. Thrown by constructors only, never by a step.
struct invalid_parameter : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

namespace detail {
inline std::string shortest(double value) {
    std::array<char, 40> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}
constexpr double plain(double x) noexcept { return x; }
template <class Dual>
requires requires(const Dual& d) {
    d.value;
    d.partial;
}
constexpr double plain(const Dual& x) noexcept { return static_cast<double>(x.value); }
template <class Unit, class Real> constexpr double plain(const boost::units::quantity<Unit, Real>& x) noexcept {
    return plain(x.value());
}
} // namespace detail

/// Refuses `value` unless `holds`, naming block, field, value and rule.
template <class Value>
void require(bool holds, const char* field, const Value& value, const std::string& rule) {
    if (!holds)
        throw invalid_parameter(std::string(field) + " = " + detail::shortest(detail::plain(value)) + ": " +
                                rule);
}

/// The rules that come up everywhere.
template <class Value> void require_finite(const char* field, const Value& value) {
    require(std::isfinite(detail::plain(value)), field, value, "must be finite");
}
template <class Value> void require_positive(const char* field, const Value& value) {
    require(std::isfinite(detail::plain(value)) && detail::plain(value) > 0, field, value,
            "must be finite and above 0");
}
template <class Value> void require_not_negative(const char* field, const Value& value) {
    require(std::isfinite(detail::plain(value)) && detail::plain(value) >= 0, field, value,
            "must be finite and not below 0");
}
/// A corner or centre frequency of a block that runs every `period`.
template <class Value> void require_below_nyquist(const char* field, const Value& value, duration period) {
    const double nyquist = 0.5 / period.value(), f = detail::plain(value);
    require(f > 0 && f < nyquist, field, value,
            "must lie between 0 and half the sampling rate (" + detail::shortest(nyquist) + ")");
}

} // namespace quadrant
