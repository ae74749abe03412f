// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "frf_file.hpp"

#include <string>

namespace quadrant_cnc {

/// The frequency response of an axis from a log of it in closed loop while a chirp, or noise, ran through its
/// reference (the format of quadrant-gap): reference to position over reference to command, so that noise does
/// not bias it. Where the reference rests, command to position, with a note: the chirp was then added to the
/// command. Lines that the excitation did not reach, or whose coherence is below one half, are left out.
/// Throws bad_input for another sampling period than the machine's, a short log, and one that shows no line.
frf_file frf_of_log(const std::string& path, const std::string& axis, double servo_period);

/// The response as a table that --frf reads.
std::string frf_table(const frf_file& of);

} // namespace quadrant_cnc
