// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fit/for_machine.hpp"
#include "fit/neighbour.hpp"
#include "fit/with_drives.hpp"
#include "how_far/how_far.hpp"
#include "match.hpp"
#include "text/bad_input.hpp"
#include "where/columns_in_time.hpp"

namespace quadrant::inline v0::diagnosis {

namespace detail {

inline simulated_axis simulate_axis(const axis_description& axis, const axis_log& log, double period,
                                    force_places where) {
    const double resolution = std::max(
        {axis.encoder.resolution_m, log.position_step, observed_count(log.position, log.position_step)});
    const axis_record record =
        for_machine(prepare(log, period, resolution, scales_of(axis.plant, log, period, resolution)), axis);
    const plant_model plant = restarted(plant_model(axis, record.scale.give()), record);
    const std::vector<double> all(record.segments, 1.0);
    const auto scored_rms = [&](const std::vector<double>& x) {
        return segment_energy(x, record.segment, record.segments, record.score.skip).rms(all);
    };
    simulated_axis out;
    out.name = axis.name;
    out.command_unit = axis.command_unit;
    out.kind = axis.kind;
    std::vector<double> innovation, acceleration;
    record.observer.run(plant, innovation, &acceleration);
    out.force = residual_of(record, plant, acceleration);
    out.gap.force_rms_N = scored_rms(out.force);
    out.gap.noise_floor_force_rms_N =
        force_floor(record, plant.moving_mass(), position_noise(innovation, record.score, resolution));
    out.gap.bandwidth_Hz = record.bandwidth_Hz;
    if (where == force_places::told) out.where = regimes(out.force, record);
    for (place& p : out.where) p.finding = text_of(p.finding, axis.kind);
    for (std::size_t k = 0; k < log.position.size(); ++k) out.t.push_back(static_cast<double>(k) * period);
    const bool driven = axis.drive.closes();
    if (driven ? !can_close(axis, log) : !axis.controller || !log.has_reference) return out;

    out.closed_loop = true;
    auto loop = driven ? simulate_driven(axis, plant, period, log)
                       : simulate_closed_loop(*axis.controller, axis, plant, period, log);
    std::vector<double> of_position(log.position.size()), of_command(log.position.size());
    for (std::size_t k = 0; k < log.position.size(); ++k) {
        of_position[k] = loop.position[k] - log.position[k];
        of_command[k] = loop.command[k] - log.command[k];
        if (k >= record.score.skip)
            out.gap.position_peak_m = std::max(out.gap.position_peak_m, std::abs(of_position[k]));
    }
    out.gap.position_rms_m = scored_rms(of_position);
    out.gap.command_rms_V = scored_rms(of_command);
    out.position = std::move(loop.position);
    out.command = std::move(loop.command);
    return out;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL simulation_result simulate(const machine_description& machine,
                                                   const machine_log& as_read, log_columns how,
                                                   force_places where) {
    refuse_positions_only(machine, "a simulation");
    const machine_log log = with_drives(machine, as_read);
    constexpr double shortest_s = 0.5;
    const double seconds = static_cast<double>(log.samples) * machine.sample_period_s;
    if (seconds < shortest_s)
        throw bad_input(log.file, fmt::format("{} samples are {:.3g} s: a simulation needs at least {} s",
                                              log.samples, seconds, shortest_s));
    simulation_result out;
    out.machine_file = machine.file;
    out.log_file = log.file;
    out.notes = machine.notes;
    out.notes.insert(out.notes.end(), log.notes.begin(), log.notes.end());
    for (const axis_description& axis : machine.axes)
        for (const axis_log& logged : log.axes) {
            if (logged.name != axis.name || logged.still || axis.positions_only) continue;
            axis_log in_time = detail::with_neighbour(log, logged, machine.sample_period_s,
                                                      bandwidth_of(axis, logged, machine.sample_period_s));
            const axis_description known = as_logged(axis, logged);
            std::optional<axis_log> none;
            if (how == log_columns::in_time)
                put_columns_in_time(known, machine.sample_period_s, in_time, none, out.notes);
            out.axes.push_back(detail::simulate_axis(known, in_time, machine.sample_period_s, where));
        }
    return out;
}

QUADRANT_DIAGNOSIS_DECL machine_log with_columns_in_time(const machine_description& machine, machine_log log) {
    for (const axis_description& axis : machine.axes)
        for (axis_log& logged : log.axes) {
            if (logged.name != axis.name || logged.still || axis.positions_only) continue;
            std::optional<axis_log> none;
            std::vector<std::string> notes;
            put_columns_in_time(as_logged(axis, logged), machine.sample_period_s, logged, none, notes);
        }
    return log;
}

} // namespace quadrant::inline v0::diagnosis
