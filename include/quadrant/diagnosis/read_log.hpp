// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "log/log.hpp"
#include "text/bad_input.hpp"

#include <filesystem>
#include <istream>
#include <string_view>

namespace quadrant::inline v0::diagnosis {

/// Reads a log (docs/formats.md) or throws bad_input. Missing rows, single wrong readings and rows with the
/// drive off are filled in and marked (axis_log::left_out); stamps that jitter by up to half a period are
/// resampled; notes say so.
QUADRANT_DIAGNOSIS_DECL machine_log read_log(const std::filesystem::path& path);
QUADRANT_DIAGNOSIS_DECL machine_log read_log(std::istream& in, std::string_view name);
/// The same of a log that was read already; messages call it by this name.
QUADRANT_DIAGNOSIS_DECL machine_log read_log_text(std::string_view text, std::string_view name);

/// Reads the references of a planned motion (t_s, x_ref_m, ...; other columns of the format are left alone) or
/// throws bad_input. Positions are the reference, commands 0.
QUADRANT_DIAGNOSIS_DECL machine_log read_motion(const std::filesystem::path& path);
QUADRANT_DIAGNOSIS_DECL machine_log read_motion_text(std::string_view text, std::string_view name);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "read_log.ipp"
#endif
