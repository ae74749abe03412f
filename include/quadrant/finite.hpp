// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <bit>
#include <boost/units/quantity.hpp>
#include <cstdint>

/// One policy for NaN and infinities in every block: hold the last output, keep the state, raise a flag that only
/// `reset` or `settle` clears.
namespace quadrant {

namespace detail {
// By bits, not by std::isfinite: stays true to its word under -ffast-math.
constexpr bool is_finite(double x) noexcept {
    constexpr std::uint64_t exponent = 0x7ff0'0000'0000'0000;
    return (std::bit_cast<std::uint64_t>(x) & exponent) != exponent;
}
constexpr bool is_finite(float x) noexcept {
    constexpr std::uint32_t exponent = 0x7f80'0000;
    return (std::bit_cast<std::uint32_t>(x) & exponent) != exponent;
}
template <class Dual>
requires requires(const Dual& d) {
    d.value;
    d.partial;
}
constexpr bool is_finite(const Dual& x) noexcept {
    auto sum = x.value;
    for (const auto& p : x.partial) sum += p - p; // NaN when p is not finite
    return is_finite(sum);
}
template <class Real> constexpr const Real& bare(const Real& x) noexcept { return x; }
template <class Unit, class Real>
constexpr const Real& bare(const boost::units::quantity<Unit, Real>& x) noexcept {
    return x.value();
}
} // namespace detail

/// True when every argument is finite: their sum is NaN or infinite as soon as one of them is. (A sum of finite
/// values above 1e308 counts as infinite; no machine has one.)
template <class... Values> constexpr bool finite(const Values&... values) noexcept {
    return detail::is_finite((detail::bare(values) + ...));
}

/// The last good output of a block and its fault flag.
template <class Quantity> class held_output {
public:
    constexpr Quantity keep(Quantity y) noexcept {
        last_ = y;
        return y;
    }
    constexpr Quantity hold() noexcept {
        fault_ = true;
        return last_;
    }
    constexpr void raise() noexcept { fault_ = true; }
    constexpr void reset(Quantity y = Quantity()) noexcept {
        last_ = y;
        fault_ = false;
    }
    constexpr bool faulted() const noexcept { return fault_; }
    constexpr const Quantity& last() const noexcept { return last_; }

private:
    Quantity last_{};
    bool fault_ = false;
};

} // namespace quadrant
