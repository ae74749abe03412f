// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "drive_simulator.hpp"

#include <nlohmann/json.hpp>
#include <quadrant/diagnosis/diagnose.hpp>
#include <quadrant/diagnosis/read_log.hpp>
#include <quadrant/diagnosis/read_machine.hpp>
#include <sstream>

/// Machines of the simulator as position drives: their files, their logs, and what is found.
namespace position_drive {

/// One axis of the machine file that describes this machine, without tolerances.
inline nlohmann::json axis_of(const drive_simulator::machine& m, double period) {
    nlohmann::json q;
    q["plant"] = {{"mass_kg", m.mass}, {"viscous_N_s_per_m", m.viscous}, {"coulomb_N", m.coulomb}};
    if (m.force_of_current > 0) q["plant"]["force_constant_N_per_A"] = m.force_of_current;
    q["encoder"] = {{"resolution_m", m.count}};
    q["drive"] = {{"kind", "position"},
                  {"interpolation", "linear"},
                  {"velocity_gain_N_s_per_m", m.gain},
                  {"position_gain_per_s", m.position_gain},
                  {"command_delay_s", m.delay},
                  {"set_point_period_s", m.rows_of_a_set_point * period}};
    if (m.integral > 0) q["drive"]["velocity_integral_N_per_m"] = m.integral;
    if (m.velocity_feedforward > 0) q["drive"]["velocity_feedforward"] = m.velocity_feedforward;
    return q;
}
inline quadrant::diagnosis::machine_description file_of(const nlohmann::json& axis, double period) {
    const nlohmann::json file{
        {"schema", "quadrant.machine/1"}, {"sample_period_s", period}, {"axes", {{"q", axis}}}};
    return quadrant::diagnosis::read_machine(file.dump(), "machine.json");
}
inline quadrant::diagnosis::machine_log recorded(const drive_simulator::machine& m, double period, double pace,
                                                 unsigned seed) {
    std::istringstream text(
        drive_simulator::log(drive_simulator::takes::set_points, m, period, pace, seed, "m"));
    return quadrant::diagnosis::read_log(text, "log.csv");
}
inline quadrant::diagnosis::diagnosis_result diagnosed(const quadrant::diagnosis::machine_description& machine,
                                                       const quadrant::diagnosis::machine_log& log,
                                                       const quadrant::diagnosis::machine_log& holdout) {
    quadrant::diagnosis::rules one;
    one.threads = 1;
    return quadrant::diagnosis::diagnose(
        machine, log, &holdout, [](const std::string&) {}, one);
}

/// The same of two logs, at two paces, of machines beside the file of `described` with these tolerances.
inline quadrant::diagnosis::diagnosis_result diagnosed(const drive_simulator::machine& described,
                                                       const nlohmann::json& tolerance, double period,
                                                       const drive_simulator::machine& real,
                                                       const drive_simulator::machine& in_holdout) {
    auto axis = axis_of(described, period);
    axis["tolerance"] = tolerance;
    return diagnosed(file_of(axis, period), recorded(real, period, 1, 1), recorded(in_holdout, period, 0.8, 2));
}

} // namespace position_drive
