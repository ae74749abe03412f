// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// What a loop is simulated with beside its plant, some rows of a log.
struct simulated_rows {
    loop_columns log;
    double began; ///< in the log [s]
    std::span<const double> position, other_acceleration, sensor_noise, added;
};

inline void simulate_rows(const controller_description& c, const axis_description& axis,
                          const plant_model& plant, double period, int substeps, const simulated_rows& rows,
                          std::span<double> position, std::span<double> command) {
    const std::size_t n = position.size();
    const auto& added = rows.added;
    const loop_inputs in(rows.log, period);
    const auto controller =
        begun(*made(c, axis.actuator, period), in, rows.log.command[0] - (added.empty() ? 0 : added[0]));
    const std::size_t ahead = controller->lead();
    const auto whole = static_cast<std::size_t>(std::max(0.0, plant.delay) / period);
    const double first = std::max(0.0, plant.delay) - static_cast<double>(whole) * period;
    const auto boxes = axis_parameters(plant);
    const plant_axis older(boxes, (first > 0 ? first : period) / substeps),
        newer(boxes, (period - first) / substeps);
    auto s = plant_axis::state::at(newer.position_of(rows.position[0]),
                                   (rows.position[1] - rows.position[0]) / period);
    std::mt19937_64 random(20080901);
    std::vector<double> applied(n);
    const double q = axis.encoder.resolution_m;
    const double limit = axis.actuator.limit_V.value_or(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < n; ++k) {
        const double reading = newer.reading(s) + (rows.sensor_noise.empty() ? 0 : rows.sensor_noise[k]);
        position[k] = q > 0 ? std::round(reading / q) * q : reading;
        // A tachometer where the log has one; else the velocity follows from what the encoder reads.
        const double velocity = !rows.log.velocity.empty() ? newer.seen_velocity(s)
                                : k == 0                   ? 0
                                                           : (position[k] - position[k - 1]) / period;
        command[k] = k == 0
                         ? rows.log.command[0]
                         : controller->step(in.asked(static_cast<std::ptrdiff_t>(std::min(k + ahead, n - 1))),
                                            {in_si(position[k]), in_si(velocity)});
        if (!added.empty() && k > 0) command[k] = std::clamp(command[k] + added[k], -limit, limit);
        const bool lost = plant.loss > 0 && k > 0 && static_cast<double>(random() >> 11) * 0x1p-53 < plant.loss;
        applied[k] = lost ? applied[k - 1] : command[k];
        const auto past = [&](std::size_t back) { return applied[k >= back ? k - back : 0]; };
        plant_axis::surroundings now{.time = rows.began + static_cast<double>(k) * period,
                                     .other_acceleration =
                                         rows.other_acceleration.empty() ? 0 : rows.other_acceleration[k]};
        for (int i = 0; i < substeps && first > 0; ++i, now.time += first / substeps)
            older.advance(s, past(whole + 1), now);
        for (int i = 0; i < substeps; ++i, now.time += (period - first) / substeps)
            newer.advance(s, past(whole), now);
    }
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL void put_as_logged(closed_loop_run& run, const axis_log& log) {
    for (std::size_t k = 0; k < log.left_out.size(); ++k)
        if (log.left_out[k]) {
            run.position[k] = log.position[k];
            run.command[k] = log.command[k];
        }
}

QUADRANT_DIAGNOSIS_DECL closed_loop_run simulate_closed_loop(
    const controller_description& c, const axis_description& axis, const plant_model& plant, double period,
    const axis_log& log, std::span<const double> sensor_noise, int substeps, std::span<const double> added) {
    closed_loop_run out{log.position, log.command};
    const loop_columns columns = loop_columns::of(log);
    for (const auto& [first, last] : stretches(log.left_out, log.reference.size())) {
        const std::size_t begin = first, rows = last - first;
        const auto part = [&](std::span<const double> x) { return x.empty() ? x : x.subspan(begin, rows); };
        detail::simulate_rows(
            c, axis, plant, period, substeps,
            {columns.part(begin, rows), static_cast<double>(begin) * period, part(log.position),
             part(log.other_acceleration), part(sensor_noise), part(added)},
            std::span(out.position).subspan(begin, rows), std::span(out.command).subspan(begin, rows));
    }
    put_as_logged(out, log);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
