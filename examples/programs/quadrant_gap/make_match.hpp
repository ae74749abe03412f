// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/diagnosis/check_physics.hpp>
#include <quadrant/diagnosis/log/at_period.hpp>
#include <quadrant/diagnosis/match.hpp>

#include <fmt/format.h>

namespace quadrant_gap {

/// What a diagnosis needs of its files before it begins: log and hold-out log are of this machine (else
/// bad_input), axes that the machine file does not describe are left out, the hold-out log is brought to the
/// machine's period, and a note says where log and machine file disagree on where the command was taken.
inline void make_match(const quadrant::diagnosis::machine_description& machine,
                       quadrant::diagnosis::machine_log& log, quadrant::diagnosis::machine_log* holdout) {
    using namespace quadrant::diagnosis;
    keep_described(machine, log);
    check_match(machine, log);
    check_loops(machine, log);
    check_physics(machine, log);
    if (holdout) {
        keep_described(machine, *holdout);
        if (!has_period_of(machine, *holdout)) *holdout = at_period(*holdout, log.sample_period_s);
        check_match(machine, *holdout);
        check_loops(machine, *holdout);
        check_physics(machine, *holdout);
    }
    for (const auto& axis : machine.axes)
        for (const auto& logged : log.axes)
            if (logged.name == axis.name && logged.command_is != axis.actuator.command_is &&
                logged.command_is == command_origin::measured && !axis.drive.closes())
                log.notes.push_back(fmt::format(
                    "axis {}: its column says that the command was measured behind the amplifier; the machine "
                    "file does not (actuator.command_is): amplifier effects are then suspects too.",
                    axis.name));
}

} // namespace quadrant_gap
