// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <quadrant/analysis/frf.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace quadrant_cnc {

/// The least coherence of a line that is used.
inline constexpr double least_coherence = 0.5;

/// A frequency response that a user measured: position over command, in metres per volt.
struct frf_file {
    std::string file;
    quadrant::analysis::measured_frf frf;
    bool coherence = false; ///< whether the file says it
    std::vector<std::string> notes{};

    double from_Hz() const { return frf.lines.front().f.value(); }
    double to_Hz() const { return frf.lines.back().f.value(); }
};

/// Reads a table (CSV) of frequency_Hz with magnitude_m_per_V and phase_deg, or with real_m_per_V and
/// imag_m_per_V, and perhaps coherence. Throws bad_input with file, line and column for what cannot be used:
/// among others frequencies that do not rise, or reach half the servo rate.
frf_file read_frf(const std::filesystem::path& path, double servo_period);

} // namespace quadrant_cnc
