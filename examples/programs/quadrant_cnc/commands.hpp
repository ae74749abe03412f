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
    double step_m = 0;       ///< 0: what takes half of the command's limit
    bool quiet = false;
};
void analyse(const analyse_options& o);

} // namespace quadrant_cnc
