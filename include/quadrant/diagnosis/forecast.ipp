// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "apply.hpp"
#include "fit/neighbour.hpp"
#include "fit/record.hpp"
#include "fit/with_drives.hpp"
#include "how_far/closed_loop.hpp"
#include "how_far/driven_loop.hpp"
#include "match.hpp"
#include "simulate.hpp"
#include "write_diagnosis.hpp"

#include <random>

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// A motion as the corrected machine would record it: its closed loop on the reference, the position with the
/// white noise and the count that the diagnosis found. One step a period: that is the model whose values were
/// fitted.
inline axis_log recorded(const axis_description& axis, const axis_log& motion, double period, double noise) {
    axis_log out = motion;
    std::mt19937_64 random(20081121);
    std::normal_distribution<double> white(0, noise);
    std::vector<double> errors(motion.reference.size());
    if (noise > 0)
        for (double& e : errors) e = white(random);
    const auto [low, high] = std::minmax_element(motion.reference.begin(), motion.reference.end());
    const record_scales scale{.travel = *high - *low, .count = axis.encoder.resolution_m};
    const plant_model plant(axis, scale.give());
    const auto run = simulate_closed_loop(*axis.controller, axis, plant, period, motion, errors, 1);
    out.position = run.position;
    out.command = run.command;
    return out;
}

/// The same of an axis whose drive closes loops of its own: from its set-points, or for a velocity drive under
/// its controller. Its columns are those that such a machine records.
inline axis_log recorded_driven(const axis_description& axis, const axis_log& motion, double period) {
    axis_log out = motion;
    out.position = motion.reference;
    const bool velocity = axis.drive.kind == drive_kind::velocity;
    if (velocity) {
        const double speed = (motion.reference[1] - motion.reference[0]) / period;
        out.command_unit = axis.drive.velocity_per_V ? "V" : key_of("m_per_s", axis.kind);
        out.command.assign(motion.reference.size(), speed / axis.drive.velocity_per_V.value_or(1));
    } else {
        out.command_unit.clear();
        out.command.clear();
    }
    const auto [low, high] = std::minmax_element(motion.reference.begin(), motion.reference.end());
    const record_scales scale{.travel = *high - *low, .count = axis.encoder.resolution_m};
    std::vector<double> set_points(motion.reference.size());
    auto run = simulate_driven(axis, plant_model(axis, scale.give()), period, with_drive(axis, out, period), {},
                               &set_points);
    out.position = std::move(run.position);
    if (velocity) out.command = std::move(set_points);
    return out;
}

/// White noise of an axis' position beside its rounding, from the floor that the diagnosis says. In the floor
/// of a measured command stands that command's noise, too: then the rounding alone.
inline double noise_beside_rounding(const axis_description& axis, const axis_result& found, double period) {
    if (axis.actuator.command_is == command_origin::measured) return 0;
    const double floor = residual_force_floor(axis.plant.mass_kg, 1, period, found.gap.bandwidth_Hz);
    const double all = found.gap.noise_floor_force_rms_N / floor, count = axis.encoder.resolution_m;
    return std::sqrt(std::max(0.0, all * all - count * count / 12));
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL forecast_result forecast(const machine_description& machine,
                                                 const diagnosis_result& found, const machine_log& motion,
                                                 double at_least) {
    refuse_positions_only(machine, "a forecast");
    const machine_description corrected = apply(machine, found, at_least);
    forecast_result out;
    out.machine_file = machine.file;
    out.motion_file = motion.file;
    machine_log expected = motion;
    for (axis_log& planned : expected.axes)
        if (const auto axis = detail::named(corrected.axes, planned.name);
            axis && !axis->controller && !axis->drive.takes_position()) {
            out.notes.push_back(
                fmt::format("axis {}: without a controller its motion cannot be forecast.", planned.name));
            planned.still = true;
        }
    for (int round = 0; round < 2; ++round) { // in the second, coupled axes see each other as they really move
        const machine_log before = expected;
        for (axis_log& planned : expected.axes) {
            const auto axis = detail::named(corrected.axes, planned.name);
            const auto was = detail::named(found.axes, planned.name);
            if (!axis || !was || planned.still) continue;
            axis_log motion_of = *detail::named(motion.axes, planned.name);
            if (axis->drive.closes()) { // one round is enough: no neighbour acts on it
                if (round == 0) planned = detail::recorded_driven(*axis, motion_of, machine.sample_period_s);
                continue;
            }
            motion_of =
                detail::with_neighbour(before, motion_of, machine.sample_period_s, was->gap_after.bandwidth_Hz);
            planned = detail::recorded(*axis, motion_of, machine.sample_period_s,
                                       detail::noise_beside_rounding(*axis, *was, machine.sample_period_s));
        }
    }
    const auto before = simulate(machine, expected, log_columns::as_they_stand),
               after = simulate(corrected, expected, log_columns::as_they_stand);
    for (std::size_t i = 0; i < after.axes.size(); ++i) {
        forecast_axis a{before.axes[i].name, before.axes[i].gap, after.axes[i].gap, 0, after.axes[i].kind};
        const gap_numbers& left = detail::named(found.axes, a.name)->gap_after;
        const double rest =
            std::sqrt(std::max(0.0, left.force_rms_N * left.force_rms_N -
                                        left.noise_floor_force_rms_N * left.noise_floor_force_rms_N));
        a.before.force_rms_N = std::hypot(a.before.force_rms_N, rest);
        a.after.force_rms_N = std::hypot(a.after.force_rms_N, rest);
        if (a.before.force_rms_N > 0) a.shrink = 1 - a.after.force_rms_N / a.before.force_rms_N;
        out.axes.push_back(a);
    }
    return out;
}

QUADRANT_DIAGNOSIS_DECL nlohmann::ordered_json to_json(const forecast_result& f) {
    nlohmann::ordered_json axes = nlohmann::ordered_json::object();
    for (const forecast_axis& a : f.axes)
        axes[a.name] = {{"kind", name_of(a.kind)},
                        {"gap_before", detail::gap_json(a.before, a.kind)},
                        {"gap_after", detail::gap_json(a.after, a.kind)},
                        {"shrink", a.shrink}};
    return {{"schema", "quadrant.forecast/1"}, {"axes", axes}, {"notes", f.notes}};
}

} // namespace quadrant::inline v0::diagnosis
