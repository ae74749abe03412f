// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL bool can_close(const axis_description& axis, const axis_log& log) {
    if (axis.drive.takes_position()) return log.drive != nullptr;
    return axis.controller && log.has_reference;
}

QUADRANT_DIAGNOSIS_DECL closed_loop_run simulate_driven(const axis_description& axis, const plant_model& plant,
                                                        double period, const axis_log& log,
                                                        std::span<const double> sensor_noise,
                                                        std::vector<double>* set_points) {
    const driven_motion& motion = *log.drive;
    const std::size_t n = log.position.size();
    std::unique_ptr<loop_inputs> in;
    std::unique_ptr<running_controller> controller;
    plant_model driven = plant;
    if (axis.controller && plant.drive.kind == drive_kind::velocity) {
        in = std::make_unique<loop_inputs>(loop_columns::of(log), period);
        controller = begun(*made(*axis.controller, axis.actuator, period), *in, motion.set_point[0]);
        driven.drive.set_point_period =
            std::max(period, plant.drive.set_point_period); // it commands once a row
    }
    const double count = axis.encoder.resolution_m;
    closed_loop_run out{std::vector<double>(n), {}};
    out.command = run_closed(
        driven, motion, period, (log.position[1] - log.position[0]) / period, log.other_acceleration,
        [&](std::size_t k, double reading, std::vector<double>& set_point) {
            if (!sensor_noise.empty()) reading += sensor_noise[k];
            out.position[k] = count > 0 ? std::round(reading / count) * count : reading;
            if (controller && k > 0) {
                const std::size_t ahead = std::min(k + controller->lead(), n - 1);
                set_point[k] = controller->step(
                    in->asked(static_cast<std::ptrdiff_t>(ahead)),
                    {in_si(out.position[k]), in_si((out.position[k] - out.position[k - 1]) / period)});
            }
            if (set_points) (*set_points)[k] = set_point[k];
        });
    put_as_logged(out, log);
    return out;
}

} // namespace quadrant::inline v0::diagnosis
