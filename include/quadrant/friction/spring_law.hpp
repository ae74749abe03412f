// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/select.hpp"

namespace quadrant::inline v0::detail {

/// What one spring of a Maxwell-slip friction holds at the end of a step, counted along the motion:
///   it slips on:     share + (along - share) kept
///   it breaks away:  share + max(0, along - share) kept
///   else it sticks:  along + stiffness times the displacement, as long as that is below its share
/// `share`: its part w_i s(v) of the level. `kept` = exp(-C h / s): what is left after h of the distance to the
/// share; 0 without the attraction C's delay. The one place of this law; `maxwell_slip` and `slip_contact` ask
/// it.
/// Derivation: docs/derivations/maxwell_slip.md.
template <class Force, class Real> struct spring_law {
    Force share;
    Real kept;

    Force slips_on(Force along) const noexcept { return share + (along - share) * kept; }
    Force breaks_away(Force along) const noexcept {
        const Force beyond = along - share;
        return share + select(greater(beyond, Force()), beyond, Force()) * kept;
    }
    auto sticks(Force reached) const noexcept { return less(reached, share); }
};

} // namespace quadrant::inline v0::detail
