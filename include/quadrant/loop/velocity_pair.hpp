// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/lanes.hpp"
#include "../base/lanes/wide.hpp"
#include "../block/maps.hpp"
#include "../filter/filtered_derivative.hpp"
#include "../filter/notch.hpp"

#include <cstddef>

namespace quadrant::inline v0 {

/// The velocities of reference and measured position of a `milling_axis` in lanes, each by the same filtered
/// derivative and notch: both in one number that is twice as wide.
///   (v_ref, v) = notch(derivative((r, y)))
/// Ports: both positions in, both velocities out, W lanes each.
/// State: that of both blocks. `reset`, `settle(x)` (reference and axis at rest at x), `retune`, `shift`: as
/// they.
/// NaN and infinities: as lanes in step; the loop around it holds.
/// Throws what the blocks throw, in their names.
/// Cost: that of one derivative and one notch in 2 W lanes.
template <steps_together Real> class velocity_pair {
    using wide = typename Real::template times<2>;
    using derivative = filtered_derivative<signal::position, signal::velocity, wide>;
    using resonance = notch<signal::velocity, wide>;

public:
    using position = quantity_of<signal::position, Real>;
    using velocity = quantity_of<signal::velocity, Real>;

    /// Those of one derivative and one notch for each lane; reference and measurement have the same.
    struct parameters {
        typename filtered_derivative<signal::position, signal::velocity, Real>::parameters derivative;
        typename quadrant::notch<signal::velocity, Real>::parameters notch;
    };
    /// Both velocities.
    struct outcome {
        velocity reference, measured;
    };

    velocity_pair(const parameters& p, duration period)
        : derivative_({twice(p.derivative.corner)}, period),
          notch_({twice(p.notch.centre), twice(p.notch.width)}, period) {}

    [[gnu::always_inline]] outcome operator()(const position& reference, const position& measured) noexcept {
        return apart(notch_(derivative_(
            quantity_of<signal::position, wide>::from_value(joined(reference.value(), measured.value())))));
    }
    void reset() noexcept {
        derivative_.reset();
        notch_.reset();
    }
    outcome settle(const position& x) noexcept { ///< returns what the next step at x gives
        return apart(detail::settled(notch_, detail::settled(derivative_, twice(x))));
    }
    void retune(const velocity_pair& next) noexcept {
        derivative_.retune(next.derivative_);
        notch_.retune(next.notch_);
    }
    void shift(const position& by) noexcept { derivative_.shift(twice(by)); }
    bool faulted() const noexcept { return derivative_.faulted() || notch_.faulted(); }

private:
    static wide twice(const Real& x) noexcept { return joined(x, x); }
    template <class Unit> static quantity<Unit, wide> twice(const quantity<Unit, Real>& x) noexcept {
        return quantity<Unit, wide>::from_value(joined(x.value(), x.value()));
    }
    static outcome apart(const quantity_of<signal::velocity, wide>& v) noexcept {
        constexpr std::size_t W = lane_count<Real>;
        return {velocity::from_value(part<W>(v.value(), 0)), velocity::from_value(part<W>(v.value(), 1))};
    }

    derivative derivative_;
    resonance notch_;
};

} // namespace quadrant::inline v0
