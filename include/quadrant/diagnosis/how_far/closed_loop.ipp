// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL closed_loop_run simulate_closed_loop(
    const controller_description& c, const axis_description& axis, const plant_model& plant, double period,
    const axis_log& log, std::span<const double> sensor_noise, int substeps, std::span<const double> added) {
    closed_loop_run out;
    const std::size_t n = log.reference.size();
    out.position.resize(n);
    out.command.resize(n);
    const loop_inputs in(loop_columns::of(log), period);
    const auto controller =
        begun(*made(c, axis.actuator, period), in, log.command[0] - (added.empty() ? 0 : added[0]));
    const std::size_t ahead = controller->lead();
    const auto whole = static_cast<std::size_t>(std::max(0.0, plant.delay) / period);
    const double first = std::max(0.0, plant.delay) - static_cast<double>(whole) * period;
    const auto boxes = axis_parameters(plant);
    const plant_axis older(boxes, (first > 0 ? first : period) / substeps),
        newer(boxes, (period - first) / substeps);
    auto s =
        plant_axis::state::at(newer.position_of(log.position[0]), (log.position[1] - log.position[0]) / period);
    std::mt19937_64 random(20080901);
    std::vector<double> applied(n);
    const double q = axis.encoder.resolution_m;
    const double limit = axis.actuator.limit_V.value_or(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < n; ++k) {
        const double reading = newer.reading(s) + (sensor_noise.empty() ? 0 : sensor_noise[k]);
        out.position[k] = q > 0 ? std::round(reading / q) * q : reading;
        // A tachometer where the log has one; else the velocity follows from what the encoder reads.
        const double velocity = !log.velocity.empty() ? newer.seen_velocity(s)
                                : k == 0              ? 0
                                                      : (out.position[k] - out.position[k - 1]) / period;
        out.command[k] =
            k == 0 ? log.command[0]
                   : controller->step(in.asked(static_cast<std::ptrdiff_t>(std::min(k + ahead, n - 1))),
                                      {in_si(out.position[k]), in_si(velocity)});
        if (!added.empty() && k > 0) out.command[k] = std::clamp(out.command[k] + added[k], -limit, limit);
        const bool lost = plant.loss > 0 && k > 0 && static_cast<double>(random() >> 11) * 0x1p-53 < plant.loss;
        applied[k] = lost ? applied[k - 1] : out.command[k];
        const auto past = [&](std::size_t back) { return applied[k >= back ? k - back : 0]; };
        plant_axis::surroundings now{.time = static_cast<double>(k) * period,
                                     .other_acceleration =
                                         log.other_acceleration.empty() ? 0 : log.other_acceleration[k]};
        for (int i = 0; i < substeps && first > 0; ++i, now.time += first / substeps)
            older.advance(s, past(whole + 1), now);
        for (int i = 0; i < substeps; ++i, now.time += (period - first) / substeps)
            newer.advance(s, past(whole), now);
    }
    return out;
}

} // namespace quadrant::inline v0::diagnosis
