// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "import_log.hpp"
#include "machine/machine.hpp"
#include "text/bad_input.hpp"

namespace quadrant::inline v0::diagnosis {

/// What the owner knows of an axis, to check its units by: mass [kg] (or inertia [kg m^2]) and force constant
/// [N per unit of the command] (or torque constant). 0: not known. Loops inside its drive follow the command,
/// which is then a velocity or a position: no force, so that it says nothing of the mass.
struct known_axis {
    double mass = 0, force_constant = 0;
    drive_kind drive = drive_kind::current;
};

/// Checks the units of an imported log by physics; notes what it found, and throws bad_input where a unit or a
/// sign cannot be: the position moves far otherwise than the reference, the command drives against the
/// acceleration, the mass that the command moves is another one than the known by the factor of a unit.
QUADRANT_DIAGNOSIS_DECL void check_physics(imported_log& in, const known_axis& known = {});

/// The same of a log and the machine that it is of, before anything is computed with them: bad_input, or
/// nothing.
QUADRANT_DIAGNOSIS_DECL void check_physics(const machine_description& machine, const machine_log& log);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "check_physics.ipp"
#endif
