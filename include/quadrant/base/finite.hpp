// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "finite_bits.hpp"
#include "select.hpp"

#include <limits>
#include <type_traits>

/// One policy for NaN and infinities in every block: hold the last output, keep the state, raise a flag that
/// only `reset` or `settle` clears.
namespace quadrant::inline v0 {

namespace detail {
template <carries_partials Dual> constexpr bool is_finite(const Dual& x) noexcept {
    bool all = is_finite(x.value);
    for (const auto& p : x.partial) all = all && is_finite(p);
    return all;
}
template <multi_lane Lanes> auto is_finite(const Lanes& x) noexcept {
    return finite_lanes(x);
} // by its type's namespace
template <class Quantity> inline constexpr bool holds_never = false;
template <steps_together Real> inline constexpr bool holds_never<Real> = true;
template <class Unit, steps_together Real> inline constexpr bool holds_never<quantity<Unit, Real>> = true;
template <class Real> constexpr const Real& bare(const Real& x) noexcept { return x; }
template <class Unit, class Real>
constexpr const Real& bare(const boost::units::quantity<Unit, Real>& x) noexcept {
    return x.value();
}
} // namespace detail

/// True when every argument is finite: their sum is NaN or infinite as soon as one of them is. (A sum of finite
/// values above 1e308 counts as infinite; no machine has one.) For lanes: a mask, lane by lane.
template <class... Values> constexpr auto finite(const Values&... values) noexcept {
    return detail::is_finite((detail::bare(values) + ...));
}

/// What a block passes on to a block inside it: x where it is good, NaN in the other lanes, where the inner
/// block then holds. For a number without lanes, which has returned by then: x.
template <class Value>
constexpr Value only_where([[maybe_unused]] const mask_of<Value>& good, const Value& x) noexcept {
    if constexpr (std::is_same_v<mask_of<Value>, bool>)
        return x;
    else
        return select(good, x, Value::from_value(std::numeric_limits<double>::quiet_NaN()));
}

/// x: lanes in step are good.
template <class Value> constexpr const Value& only_where(in_every_lane<true>, const Value& x) noexcept {
    return x;
}

/// The last good output of a block and its fault flag; for lanes, one of each in every lane. `Asked`: the block
/// itself asks for the last output. One that does not, and whose lanes step together and so never hold, keeps
/// none.
template <class Quantity, bool Asked = true> class held_output {
    static constexpr bool keeps = Asked || !detail::holds_never<Quantity>;

public:
    using mask = mask_of<Quantity>; ///< bool, but for lanes

    constexpr Quantity keep(Quantity y) noexcept {
        if constexpr (keeps) last_ = y;
        return y;
    }
    /// Keeps the lanes of y that are good; the others hold their last output and raise their fault.
    constexpr Quantity keep(const mask& good, Quantity y) noexcept {
        if constexpr (std::is_same_v<mask, bool>) {
            return good ? keep(y) : hold();
        } else {
            if (all(good)) return keep(y);
            fault_ |= !good;
            set_where(good, last_, y);
            return last_;
        }
    }
    constexpr Quantity keep(in_every_lane<true>, Quantity y) noexcept { return keep(y); }
    constexpr Quantity hold() noexcept {
        fault_ = mask(true);
        return last_;
    }
    /// The last output is higher by so much, in the good lanes; the others raise their fault.
    constexpr void shift(const auto& good, Quantity by) noexcept {
        if constexpr (keeps) keep(good, last_ + by);
    }
    constexpr void raise() noexcept { fault_ = mask(true); }
    /// Raises the fault where `bad` is true.
    constexpr void raise(const mask& bad) noexcept { fault_ = either(fault_, bad); }
    constexpr void raise(in_every_lane<false>) noexcept {}
    constexpr void reset(Quantity y = Quantity()) noexcept {
        last_ = y;
        fault_ = mask(false);
    }
    /// Sets the output and clears the fault in the good lanes; the others keep theirs and raise their fault.
    constexpr void settle(const mask& good, Quantity y) noexcept {
        set_where(good, last_, y);
        fault_ = !good;
    }
    constexpr void settle(in_every_lane<true>, Quantity y) noexcept { reset(y); }
    /// True when some lane has a fault.
    constexpr bool faulted() const noexcept { return any(fault_); }
    /// Which lanes have a fault; a bool for a number without lanes.
    constexpr const mask& faulted_lanes() const noexcept { return fault_; }
    constexpr const Quantity& last() const noexcept requires keeps { return last_; }

private:
    Quantity last_{};
    mask fault_{};
};

} // namespace quadrant::inline v0
