// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "log_writer.hpp"
#include "run_result.hpp"

#include <functional>

/// Runs a part program through the virtual machine.
namespace quadrant_cnc {

/// How far a run is, reported a few times a second.
struct progress {
    double share = 0, time = 0;         ///< of the file, 0 ... 1; simulated [s]
    double wall_time = 0, cpu_time = 0; ///< since the start [s]
    std::size_t line = 0;
};

/// What the outcome of a run is for: what a page draws (signals, contour_plot, worst) is a tenth of the work.
enum class kept_for { figures, pages };

/// With a log unless `log` is null. Throws bad_input, bad_program.
run_outcome simulate(const cnc_description& cnc, const std::string& path_file, log_writer* log,
                     const std::function<void(const progress&)>& tell, kept_for what = kept_for::pages);

/// The first line of the log of this machine.
std::string log_header(const cnc_description& cnc);

} // namespace quadrant_cnc
