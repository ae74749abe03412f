// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "init/request.hpp"
#include "log/log.hpp"
#include "text/bad_input.hpp"

namespace quadrant::inline v0::diagnosis {

/// Begins a machine file. Sample period, axes, unit of the command, resolution and, where the command stops
/// there, its limit come from the log when there is one; mass and force constant must fit its motion within a
/// factor of three (or a note says that they do not, `unchecked`). With `from_log` the log's regression gives
/// mass, friction and gravity where nobody does. What it returns passes read_machine. Throws bad_input.
QUADRANT_DIAGNOSIS_DECL initialised_machine init_machine(const init_request& request,
                                                         const machine_log* log = nullptr);

/// The description that a log gives of its own machine, where there is no machine file: mass, friction and
/// gravity by regression. Where the command is no force, one newton a unit of it is taken: masses and forces
/// are then in units of the command. Throws bad_input where the log is not sure of the mass.
QUADRANT_DIAGNOSIS_DECL initialised_machine machine_from_log(const machine_log& log);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "init.ipp"
#endif
