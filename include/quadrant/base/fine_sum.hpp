// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "standstill.hpp"

#include <concepts>
#include <type_traits>

namespace quadrant::inline v0 {

namespace detail {
/// x, rounded: what follows may not be worked out together with what made x. Only -ffast-math would.
template <class Value> [[gnu::always_inline]] inline Value rounded_here(Value x) noexcept {
#if defined(__FAST_MATH__) && defined(__GNUC__)
    asm("" : "+m"(x));
#endif
    return x;
}
/// Beside a sum that a state holds as one number: what rounding left over of it, where it is a fine one.
template <class Value, bool Fine> struct rest_of_sum {
    Value rest{}; ///< sum minus the number
};
template <class Value> struct rest_of_sum<Value, false> {};
} // namespace detail

/// What a slow filter adds up: a sum of many parts that are far smaller than it. Fine: it is held in two
/// numbers, `high` and what rounding left over, `low`, so that a part below the last digit of the sum is not
/// lost; else in one.
///   s = low + part;   high' = high + s, rounded;   low' = s - (high' - high)
/// Source: [Kahan1965]. Of any number type, with a unit or without. Derivation:
/// docs/derivations/second_order.md.
/// Cost: 3 additions more than one number.
template <class Value, bool Fine = true> struct fine_sum {
    Value high{}; ///< the sum, rounded
    Value low{};  ///< sum minus high

    fine_sum plus(const Value& part) const noexcept {
        const Value s = low + part;
        const Value sum = detail::rounded_here<Value>(high + s);
        return {sum, s - detail::rounded_here<Value>(sum - high)};
    }
    /// The same, without a rest that has died out.
    fine_sum rested() const noexcept { return {high, unless_died_out(low)}; }
    /// x minus the sum: exact where both are close.
    Value below(const Value& x) const noexcept { return detail::rounded_here<Value>(x - high) - low; }
    /// The sum plus a part of its own size or smaller, rounded once.
    Value with(const Value& part) const noexcept { return high + (low + part); }

    template <class Mask>
    requires(!std::same_as<Mask, bool>) friend void set_where(const Mask& where, fine_sum& to,
                                                              const fine_sum& from) noexcept {
        set_where(where, to.high, from.high);
        set_where(where, to.low, from.low);
    }
};

/// The same in one number: what double needs no more of.
template <class Value> struct fine_sum<Value, false> {
    Value high{}; ///< the sum

    fine_sum plus(const Value& part) const noexcept { return {high + part}; }
    const fine_sum& rested() const noexcept { return *this; }
    Value below(const Value& x) const noexcept { return x - high; }
    Value with(const Value& part) const noexcept { return high + part; }

    template <class Mask>
    requires(!std::same_as<Mask, bool>) friend void set_where(const Mask& where, fine_sum& to,
                                                              const fine_sum& from) noexcept {
        set_where(where, to.high, from.high);
    }
};

} // namespace quadrant::inline v0
