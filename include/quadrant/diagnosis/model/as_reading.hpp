// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_model.hpp"

#include <vector>

namespace quadrant::inline v0::diagnosis {

/// What a drive with a velocity loop gives otherwise than measured, `force` [N], as the error y of the position
/// reading that would make its law give just that:
///   velocity drive   f = K y' + I y
///   position drive   f = K z + I (integral of z),  z = y' + k y
/// with its velocity gain K, integral I and position gain k. The noise of the reading is white in y, whatever
/// the gains are; in the force it grows with the gain and with the frequency, and a fit makes the gain too
/// small.
/// `pole`: the integrals forget by it a row, so that a force that stays is no drift.
inline std::vector<double> as_reading(const drive_model& d, std::vector<double> force, double period,
                                      double pole) {
    const double gain = d.velocity_gain / period, follow = gain + d.velocity_integral;
    const bool outer = d.kind == drive_kind::position;
    double inner = 0, y = 0;
    for (double& f : force) {
        const double before = pole * inner;
        inner = (f + gain * before) / follow;
        y = outer ? (inner - before + y) / (1 + period * d.position_gain) : inner;
        f = y;
    }
    return force;
}

} // namespace quadrant::inline v0::diagnosis
