// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "import_log.hpp"
#include "physics.hpp"

namespace quadrant::diagnosis {

/// What the owner knows of an axis, to check its units by: mass [kg] (or inertia [kg m^2]) and force constant [N per unit
/// of the command] (or torque constant). 0: not known.
struct known_axis {
    double mass = 0, force_constant = 0;
};

/// Checks the units of an imported log by physics; notes what it found, and throws bad_input where a unit or a sign cannot
/// be: the position moves otherwise than the reference, the command drives against the acceleration, the mass that the
/// command moves is not the one that is known (by a factor of three), speeds that no axis has.
inline void check_physics(imported_log& in, const import_map& map, const known_axis& known = {}) {
    for (std::size_t i = 0; i < in.log.axes.size(); ++i) {
        const axis_log& a = in.log.axes[i];
        const std::string si = map.axes[i].position.si, force = si == "rad" ? "Nm" : "N";
        const auto refuse = [&](const std::string& message) {
            throw bad_input(in.log.file, fmt::format("axis {}: {}", a.name, message));
        };
        const unit_check c = check_units(a, in.log.sample_period_s);
        if (!(c.travel > 0)) {
            in.notes.push_back(fmt::format("axis {}: does not move: its units cannot be checked", a.name));
            continue;
        }
        const double ratio = c.position_per_reference;
        if (!(ratio > 0.5 && ratio < 2))
            refuse(fmt::format(
                "the position moves {:.3g} times as far as the reference: are both in the unit that the "
                "map says?",
                ratio));
        if (c.peak_speed > (si == "rad" ? 1e5 : 100))
            refuse(fmt::format(
                "a peak speed of {:.3g} {}/s: is the position in the unit that the map says, and the time?",
                c.peak_speed, si));
        if (c.sign_is_known() && c.command_per_acceleration < 0)
            refuse(fmt::format(
                "the command drives against the acceleration ({:.3g} {} per {}/s^2): give one of them a "
                "negative scale",
                c.command_per_acceleration, a.command_unit, si));
        in.notes.push_back(fmt::format(
            "axis {}: travel {:.4g} {}, peak {:.3g} {}/s and {:.3g} {}/s^2, sample period {:.6g} "
            "s",
            a.name, c.travel, si, c.peak_speed, si, c.peak_acceleration, si, in.log.sample_period_s));
        if (!c.sign_is_known()) {
            in.notes.push_back(fmt::format(
                "axis {}: the motion is too slow to check the command by the acceleration", a.name));
            continue;
        }
        const double constant = known.force_constant > 0  ? known.force_constant
                                : a.command_unit == force ? 1
                                                          : 0;
        in.notes.push_back(
            fmt::format("axis {}: the command grows by {:.3g} {} per {}/s^2{}", a.name,
                        c.command_per_acceleration, a.command_unit, si,
                        constant > 0 ? fmt::format(": a moving {} of {:.3g}", si == "rad" ? "inertia" : "mass",
                                                   c.command_per_acceleration * constant)
                                     : ""));
        if (constant > 0 && known.mass > 0) {
            const double times = c.command_per_acceleration * constant / known.mass;
            if (times > 3 || times < 1.0 / 3)
                refuse(fmt::format("the command moves {:.3g} times the {} of {:g}: check the units of command, "
                                   "position and time",
                                   times, text_of("mass", a.kind), known.mass));
        }
    }
}

} // namespace quadrant::diagnosis
