// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/error.hpp"
#include "../base/finite.hpp"

namespace quadrant::inline v0 {

namespace detail {
/// What x has beyond a dead band of this half width. The one place of this law; `dead_band` and `servo_axis`
/// ask it.
template <class Value> constexpr Value beyond(const Value& x, const Value& half) noexcept {
    return select(greater(x, half), x - half, select(less(x, -half), x + half, Value()));
}
} // namespace detail

/// Ignores small values and shifts the rest towards zero: a command that has to overcome a dead zone, or an
/// error that shall not hunt around one encoder count.
///   y = x - half_width for x > half_width, x + half_width for x < -half_width, else 0
/// Source: docs/formats.md (actuator_dead_zone: the dead zone shifts the command); LinuxCNC deadzone, whose
/// threshold is the whole width.
/// Ports: one scalar in, one scalar out, the same signal; sign kept, odd and continuous.
/// State: none; `reset` and `settle` set the held output and clear the fault.
/// `retune(next)`: another width from the next step on, jump <= |half_width' - half_width|.
/// Range: half_width >= 0; 0 passes everything.
/// NaN and infinities: holds the last output, raises faulted().
/// Throws "dead_band.half_width = ...: must be finite and not below 0".
/// Cost: 2 comparisons, 1 addition. For steps over the whole range: `quantizer`.
template <signal_tag Signal, class Real = double> class dead_band {
public:
    using input = Signal;
    using output = Signal;
    using argument = quantity_of<Signal, Real>;
    using value = quantity_of<Signal, Real>;
    using number = parameter_real<Real>; ///< of parameters

    /// How far from zero the input may be before it counts, in its own unit.
    struct parameters {
        quantity_of<Signal, number> half_width; ///< >= 0
    };
    struct state {};

    dead_band(const parameters& p, duration period) : given_(p), half_width_(in_real<Real>(p.half_width)) {
        require_positive<Real>("dead_band.period", period);
        require_not_negative<Real>("dead_band.half_width", p.half_width);
    }

    value operator()(value x) noexcept { return out_.keep(finite(x), shifted(x)); }
    void reset() noexcept { out_.reset(); }
    void settle(value x) noexcept { out_.settle(finite(x), shifted(x)); }

    void retune(const dead_band& next) noexcept {
        half_width_ = next.half_width_;
        given_ = next.given_;
    }

    bool faulted() const noexcept { return out_.faulted(); }
    mask_of<Real> faulted_lanes() const noexcept { return out_.faulted_lanes(); }
    const parameters& given() const noexcept { return given_; }
    state now() const noexcept { return {}; }

private:
    value shifted(value x) const noexcept { return detail::beyond(x, half_width_); }

    parameters given_;
    value half_width_;
    held_output<value> out_;
};

} // namespace quadrant::inline v0
