// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../base/version.hpp"
#include "log/log.hpp"
#include "machine/machine.hpp"
#include "result/result.hpp"

namespace quadrant::inline v0::diagnosis {

/// One axis of a log as its machine file predicts it.
struct simulated_axis {
    std::string name, command_unit;
    axis_kind kind = axis_kind::linear;
    bool closed_loop = false;     ///< a controller is described: position and command gaps are there too
    gap_numbers gap;              ///< what remains between simulation and log
    std::vector<place> where;     ///< in which regimes the residual force is
    std::vector<double> t;        ///< [s]
    std::vector<double> force;    ///< residual force [N], one entry a sample
    std::vector<double> position; ///< simulated closed loop [m]; empty without a controller
    std::vector<double> command;  ///< the same, in command_unit
};

/// A log as its machine file predicts it, axis by axis.
struct simulation_result {
    std::string machine_file, log_file;
    std::string machine_sha256, log_sha256; ///< of the files' bytes; empty: not read from files
    std::vector<simulated_axis> axes;
    std::vector<std::string> notes;
};

/// How the columns of a log are taken: one that was sampled later or earlier than the position is read as it
/// acted, as diagnose() does, or every row as it stands, which is right for a log that was simulated.
enum class log_columns { in_time, as_they_stand };
/// Whether simulate() says where in the motion the residual force lies: a sixth of its time.
enum class force_places { told, left_out };

/// Predicts a log of a machine and says what remains between the two, in the numbers that a diagnosis
/// forecasts: residual force behind the logged command, and position and command of the closed loop from the
/// logged reference. Where in its cycle a process begins is found from the log; drift begins with its first
/// row. Machine and log match (match.hpp); a log below 0.5 s is refused (bad_input). Costs a few passes over
/// the log, and as many again to read its columns in time.
QUADRANT_DIAGNOSIS_DECL simulation_result simulate(const machine_description& machine, const machine_log& log,
                                                   log_columns how = log_columns::in_time,
                                                   force_places where = force_places::told);

/// A log whose columns are read in time already: for one that is simulated again and again, with
/// `log_columns::as_they_stand`. What was found of its columns is that of this machine.
QUADRANT_DIAGNOSIS_DECL machine_log with_columns_in_time(const machine_description& machine, machine_log log);

} // namespace quadrant::inline v0::diagnosis

#ifndef QUADRANT_DIAGNOSIS_SEPARATE_COMPILATION
#    include "simulate.ipp"
#endif
