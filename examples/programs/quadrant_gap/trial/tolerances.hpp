// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "machine.hpp"
#include "random.hpp"

#include <algorithm>
#include <vector>

/// How well the file of a drawn machine knows its numbers.
namespace quadrant_gap::trial {

struct tolerances {
    double mass = 0.02, force_constant = 0.01, viscous = 0.1, coulomb = 0.05, at_rest = 0.05;
};

/// Of a joint's gravity and of the growth of its friction with the load.
inline constexpr double tolerance_of_gravity = 0.03, tolerance_of_load = 0.1;

/// Of a drive's own numbers.
inline constexpr double tolerance_of_gains = 0.01, tolerance_of_supply = 0.02, tolerance_of_delay = 0.05;

namespace detail {

/// A number of a machine that its file knows no better than to this share.
struct loose_number {
    double* value;
    double share;
};
inline std::vector<loose_number> loose_numbers(axis_truth& a, const tolerances& t) {
    std::vector<loose_number> out{{&a.mechanics.mass, t.mass}};
    if (a.drive.kind == drive_truth::drive_kind::current || a.drive.supply > 0 || a.drive.shows_current())
        out.push_back({&a.actuator.force_constant, t.force_constant});
    out.insert(out.end(), {{&a.friction.viscous, t.viscous},
                           {&a.friction.coulomb, t.coulomb},
                           {&a.friction.level_at_rest, t.at_rest},
                           {&a.friction.stribeck_velocity, 0.05}});
    if (a.turns)
        out.insert(out.end(),
                   {{&a.mechanics.gravity, tolerance_of_gravity}, {&a.friction.load, tolerance_of_load}});
    drive_truth& d = a.drive;
    if (!d.closes()) return out;
    for (double* gain :
         {&d.velocity_per_V, &d.velocity_gain, &d.velocity_integral, &d.position_gain, &d.duty_gain})
        out.push_back({gain, tolerance_of_gains});
    out.insert(out.end(), {{&d.supply, tolerance_of_supply}, {&d.delay, tolerance_of_delay}});
    return out;
}
inline void move_inside(axis_truth& a, const tolerances& t, dice& random) {
    for (const loose_number& n : loose_numbers(a, t)) *n.value *= 1 + random.uniform(-n.share, n.share);
    keep_level_at_rest(a.friction);
    if (a.drive.closes()) return;
    const double delay = std::min(2e-5, 0.05 * a.actuator.delay);
    a.actuator.delay += random.uniform(-delay, delay);
}

} // namespace detail

} // namespace quadrant_gap::trial
