// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/signals.hpp"
#include "../which/causes.hpp"
#include "../which/linked_arm.hpp"
#include "../which/turning_inertia.hpp"

#include <cmath>
#include <span>

namespace quadrant::inline v0::diagnosis::detail {

/// Other axes of the log that one is read from.
struct other_axes {
    std::vector<const axis_log*> logs{};
    std::size_t rows_in_one = 1; ///< of theirs, to a sample of the axis
};

/// Of causes beside an inertia that turns with another axis' angle, those are suspects without which as little
/// stays: less than twice the energy that stays with all of them. They stood in for it. Whether there are such.
inline bool doubt_stand_ins(std::span<cause> causes, const axis_case& c, const other_axes& others,
                            const std::string& form) {
    const auto left = [&](const candidate& m) {
        const auto turning = inertia_by_angle(c, m, others.logs, others.rows_in_one);
        return square(turning ? turning->left : c.models.held_out_force(m));
    };
    const double of_all = left(c.best());
    bool any = false;
    for (cause& x : causes)
        for (const effect* e : c.best().effects)
            if (e->name == x.effect && left(c.models.without(c.best(), e)) < 2 * of_all) {
                to_suspects({&x, 1});
                x.better_form = form;
                any = true;
            }
    return any;
}

/// Whether an inertia that turns with another axis' angle is what is left, told in a note. Where it alone
/// leaves less than the names that were found, some of these stand in for it. Whether causes became suspects.
inline bool tell_turning_inertia(diagnosis_result& out, const axis_case& c, std::vector<cause>& causes,
                                 const other_axes& others) {
    if (c.at_floor() || c.within_its_laws()) return false;
    auto found = inertia_by_angle(c, c.path.front(), others.logs, others.rows_in_one);
    const bool instead = found && found->left < c.models.held_out_force(c.best());
    if (!instead) found = inertia_by_angle(c, c.best(), others.logs, others.rows_in_one);
    if (!found) return false;
    const std::string form = fmt::format("the angle of axis {} as an inertia does", found->other);
    const bool doubted = instead && doubt_stand_ins(causes, c, others, form);
    out.notes.push_back(fmt::format(
        "axis {}: its inertia depends on the angle of axis {}: {:.3g} kg m^2 more or less, most at {:.2g} rad. "
        "That takes {:.0f} % off what {}, and a machine file cannot describe it: the inertia in it is a mean. "
        "Move axis {} alone, with {} held, for its other numbers.",
        c.axis.name, found->other, found->swing(), std::atan2(found->sine, found->cosine), 100 * found->share,
        instead ? "the machine as calibrated leaves" : "the causes leave", c.axis.name, found->other));
    return doubted;
}

/// Whether the axis moves with another one as links of one arm do, told in a note: such a gap stays open
/// because a machine file describes each axis alone.
inline void tell_linked_arm(diagnosis_result& out, const axis_case& c, const other_axes& others) {
    if (c.at_floor() || c.within_its_laws()) return;
    const auto arm = arm_of(c, others.logs, others.rows_in_one);
    if (!arm) return;
    constexpr double of_five_folds = 2.8; // Student's factor
    const regressed& friction = arm->coulomb;
    const std::string size = friction.sure() ? fmt::format("{:.2g} N m ({:.2g} to {:.2g})", friction.value,
                                                           friction.value - of_five_folds * friction.spread,
                                                           friction.value + of_five_folds * friction.spread)
                                             : "not determined";
    out.notes.push_back(fmt::format(
        "axis {}: it moves as the {} link of an arm with axis {}. A regression of the torque on both motions "
        "leaves "
        "{:.2g} N m, on its own motion alone {:.2g} N m: the links move each other by {:.2g} kg m^2 times the "
        "cosine of the angle between them; the weight is {:.2g} N m by its own angle and {:.2g} N m by both "
        "angles "
        "together; Coulomb friction {}. A machine file describes each axis alone: values found for axis {} "
        "stand "
        "in for a part of that.",
        c.axis.name, arm->inner ? "inner" : "outer", arm->other, arm->left, arm->alone, arm->coupling,
        arm->own_weight, arm->both_weight, size, c.axis.name));
}

} // namespace quadrant::inline v0::diagnosis::detail
