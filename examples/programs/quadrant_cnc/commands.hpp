// SPDX-License-Identifier: BSL-1.0
#pragma once
#include <string>

/// The subcommands of quadrant-cnc, one file each; their options are read in main.cpp. A command throws
/// bad_input or bad_program when it cannot do what it was asked for.
namespace quadrant_cnc {

struct run_options {
    std::string cnc, path, report, log, machine; ///< files; empty: none
    std::string json;                            ///< the same; "-": standard output
    bool quiet = false;
};
void run(const run_options& o);

struct analyse_options {
    std::string cnc, report; ///< files; empty: none
    std::string json;        ///< the same; "-": standard output
    std::string axis;        ///< empty: all
    std::string frf;         ///< a measured response in place of the drive; empty: none
    std::string chirp;       ///< a log to make it from; empty: none
    std::string write_frf;   ///< where that goes; empty: nowhere
    double step_m = 0;       ///< 0: what takes half of the command's limit
    bool quiet = false;
};
void analyse(const analyse_options& o);

struct tune_options {
    std::string cnc, out, report; ///< files; empty: none
    std::string json;             ///< the same; "-": standard output
    std::string axis;             ///< empty: all
    double distance_m = 0.1, speed_m_per_s = 0.2, threshold_Hz = 50;
    int trials = 50;
    bool quiet = false;
};
void tune(const tune_options& o);

} // namespace quadrant_cnc
