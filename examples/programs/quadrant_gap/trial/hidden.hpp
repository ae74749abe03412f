// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drawn_machine.hpp"

/// Effects that no log can show: they are not drawn.
namespace quadrant_gap::trial::detail {

/// Whether other numbers of the drive, inside their tolerances, make exactly the motion that this effect makes
/// under the same set-points: no log without the drive's current can hold it. An integral that began elsewhere,
/// which no file can know, is a constant force. A gain larger by what viscous friction has grown by, with a
/// velocity per volt smaller in the same ratio, moves the axis as that friction does:
/// gain (velocity_per_V u - v) = m a + viscous v.
inline bool hidden_by_the_loop(const drawn_machine& m, std::string_view effect) {
    const drive_truth& d = m.described[0].drive;
    if (d.shows_current()) return false;
    if (effect == "constant_force") return d.velocity_integral > 0;
    if (effect != "viscous_friction" || d.kind != drive_truth::drive_kind::velocity || d.velocity_integral > 0)
        return false;
    const double grown = m.truth[0].friction.viscous - m.described[0].friction.viscous;
    return std::abs(grown) < tolerance_of_gains * d.velocity_gain;
}

} // namespace quadrant_gap::trial::detail
