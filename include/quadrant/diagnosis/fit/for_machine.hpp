// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../../base/version.hpp"
#include "record.hpp"
#include "regression.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace quadrant::inline v0::diagnosis {

/// The record with its observer stepping as finely as the described machine needs.
/// `known`: models near what the machine does, for what is evaluated on its path (the nearest alone) or led
/// along its motion; none: the described machine, and no floor but that of the reading.
QUADRANT_DIAGNOSIS_DECL axis_record for_machine(axis_record r, const axis_description& a,
                                                held_by how = held_by::readings,
                                                std::span<const plant_model> known = {});

/// The described machine with the mass, friction, constant force and gravity that a regression of the command
/// on the record's motion has; nothing where it is not sure of a mass.
QUADRANT_DIAGNOSIS_DECL std::optional<plant_model>
as_regressed_on_motion(const axis_record& r, axis_kind kind, const plant_model& described);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "for_machine.ipp"
#endif
