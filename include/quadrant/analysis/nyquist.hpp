// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "margins.hpp"

#include <cmath>
#include <complex>
#include <cstddef>

namespace quadrant::inline v0::analysis {

/// How many poles of the loop closed over L lie right of the axis (outside the circle, for a sampled L): 0 is
/// stable.
/// What margins assume, this counts: the turns of 1 + L around zero from the band's first line to its last
/// (Nyquist).
/// Known beforehand, and stated by the caller: L has no poles there itself, `integrators` poles at s = 0, below
/// the band it goes on to its integrators without another turn, above it |L| stays below one (a sampled band
/// ends near Nyquist). Of loops within loops give it the whole return difference less one, with the integrators
/// of all.
/// Throws when the band does not show it: |L| not above one at its start (with an integrator) or not below one
/// at its end, a
/// turn of more than 90 degrees from line to line, a negative L, or a count below 0: then L has unstable poles
/// of its own.
template <frequency_response Loop> int unstable_poles(const Loop& loop, const band& b, int integrators) {
    require(integrators >= 0 && integrators <= 4, "unstable_poles.integrators", double(integrators),
            "must lie between 0 and 4");
    const double start = std::abs(complex(loop(b.from))), end = std::abs(complex(loop(b.to)));
    require(integrators == 0 || start > 1, "unstable_poles, |L| at band.from", start,
            "must be above 1: begin lower");
    require(end < 1, "unstable_poles, |L| at band.to", end, "must be below 1: go on further up");
    const auto all = detail::sample([&](frequency f) { return 1.0 + complex(loop(f)); }, b);
    const double from = -90.0 * integrators;
    double angle = detail::degrees(std::arg(all.front().value));
    angle += 360 * std::round((from - angle) / 360);
    require(std::abs(angle - from) < 150, "unstable_poles, phase of 1 + L at band.from",
            quadrant::detail::in_unit(angle, " degrees"),
            "must lie near that of the integrators (" +
                quadrant::detail::shortest(quadrant::detail::in_unit(from, " degrees")) +
                "): turn the sign or begin lower");
    for (std::size_t i = 1; i < all.size(); ++i) {
        const double turn = detail::degrees(std::arg(all[i].value * std::conj(all[i - 1].value)));
        require(std::abs(turn) < 90, "unstable_poles, turn of 1 + L",
                quadrant::detail::in_unit(turn, " degrees"),
                "must be below 90 degrees from line to line (at " +
                    quadrant::detail::shortest(all[i].f.value()) + " Hz)");
        angle += turn;
    }
    const double rest = detail::degrees(std::arg(all.back().value));
    const int count = -int(std::lround((angle - rest) / 180));
    require(count >= 0, "unstable_poles", double(count),
            "must not be below 0: L has unstable poles, or more integrators");
    return count;
}

} // namespace quadrant::inline v0::analysis
