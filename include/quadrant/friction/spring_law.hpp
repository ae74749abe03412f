// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/select.hpp"

namespace quadrant::inline v0::detail {

/// What one spring of a Maxwell-slip friction holds at the end of a step, counted along the motion:
///   it slips on:     share + (along - share) kept
///   it breaks away:  share + max(0, along - share) kept
///   else it sticks:  along + stiffness times the displacement, as long as that is below its share
/// `share`: its part w_i s(v) of the level. `kept` = exp(-C h / s): what is left after h of the distance to the
/// share; 0 without the attraction C's delay. The one place of this law; `maxwell_slip`, alone and in lanes,
/// and `slip_contact` ask it.
/// Derivation: docs/derivations/maxwell_slip.md.
template <class Force, class Real> struct spring_law {
    Force share;
    Real kept;

    Force slips_on(Force along) const noexcept { return at(along - share); }
    Force breaks_away(Force along) const noexcept {
        const Force beyond = along - share;
        return at(select(greater(beyond, Force()), beyond, Force()));
    }
    /// Either, in lanes: where it slipped on the way that it goes, and where it breaks away.
    template <class Mask> Force slips(Force along, const Mask& slipped) const noexcept {
        const Force beyond = along - share;
        return at(select(slipped | greater(beyond, Force()), beyond, Force()));
    }
    auto sticks(Force reached) const noexcept { return less(reached, share); }
    auto gives_way(Force reached) const noexcept { return less_equal(share, reached); } ///< does not stick

private:
    Force at(const Force& beyond) const noexcept { return share + beyond * kept; }
};

} // namespace quadrant::inline v0::detail
