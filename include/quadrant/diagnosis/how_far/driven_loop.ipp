// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::diagnosis {

QUADRANT_DIAGNOSIS_DECL int steps_of_drive(const plant_model& plant, double period) {
    const drive_model& d = plant.drive;
    const double mass = plant.moving_mass();
    const double stiffness = d.kind == drive_kind::position_servo
                                 ? d.duty_gain * d.supply * plant.force_constant
                                 : d.velocity_integral + d.velocity_gain * d.position_gain;
    double rate = std::max(d.velocity_gain / mass, std::sqrt(stiffness / mass));
    if (std::isfinite(d.velocity_filter_Hz)) rate = std::max(rate, 2 * std::numbers::pi * d.velocity_filter_Hz);
    return static_cast<int>(std::clamp(std::ceil(20 * period * rate), 8.0, 200.0));
}

QUADRANT_DIAGNOSIS_DECL bool can_close(const axis_description& axis, const axis_log& log) {
    if (axis.drive.takes_position()) return log.drive != nullptr;
    return axis.controller && log.has_reference;
}

QUADRANT_DIAGNOSIS_DECL closed_loop_run simulate_driven(const axis_description& axis, const plant_model& plant,
                                                        double period, const axis_log& log) {
    const driven_motion& motion = *log.drive;
    const drive_model& d = plant.drive;
    const std::size_t n = log.position.size();
    const int steps = steps_of_drive(plant, period);
    const double h = period / steps;
    const plant_axis mechanics(axis_parameters(plant), h);
    auto s = plant_axis::state::at(mechanics.position_of(log.position[0]),
                                   (log.position[1] - log.position[0]) / period);

    std::vector<double> set_point = motion.set_point;
    std::unique_ptr<loop_inputs> in;
    std::unique_ptr<running_controller> controller;
    if (axis.controller && d.kind == drive_kind::velocity) {
        in = std::make_unique<loop_inputs>(loop_columns::of(log), period);
        controller = begun(*made(*axis.controller, axis.actuator, period), *in, set_point[0]);
    }
    set_point_clock clock(d, set_point, period);
    const position_loop<> outer(d.position_loop_numbers(), h, already_checked());
    const velocity_loop<> inner(d.position_loop_numbers().velocity, h, already_checked());
    const position_servo<> servo(d.servo_numbers(), h, already_checked());
    auto loop = velocity_loop<>::state::at(s.v, d.start_force);
    auto follower = position_servo<>::state::at(set_point[0]);
    const double count = axis.encoder.resolution_m, scale = motion.in_volts ? d.velocity_per_V : 1;

    closed_loop_run out{std::vector<double>(n), std::vector<double>(n)};
    for (std::size_t k = 0; k < n; ++k) {
        const double reading = mechanics.reading(s);
        out.position[k] = count > 0 ? std::round(reading / count) * count : reading;
        if (controller && k > 0) {
            const std::size_t ahead = std::min(k + controller->lead(), n - 1);
            set_point[k] = controller->step(
                in->asked(static_cast<std::ptrdiff_t>(ahead)),
                {in_si(out.position[k]), in_si((out.position[k] - out.position[k - 1]) / period)});
        }
        plant_axis::surroundings now{.time = static_cast<double>(k) * period,
                                     .other_acceleration =
                                         log.other_acceleration.empty() ? 0 : log.other_acceleration[k]};
        for (int i = 0; i < steps; ++i, now.time += h) {
            const double begin = static_cast<double>(k) + static_cast<double>(i) / steps;
            const auto r = clock.between(begin, begin + 1.0 / steps);
            double u = 0;
            if (motion.is_off(k) || !d.is_on(now.time)) {
                loop = velocity_loop<>::state::at(s.v);
                follower = position_servo<>::state::at(s.x);
            } else if (d.kind == drive_kind::position_servo) {
                u = d.supply * servo(follower, r.value, s.x);
            } else {
                u = (d.kind == drive_kind::velocity ? inner(loop, scale * r.value, s.v)
                                                    : outer(loop, r.value, r.velocity / period, s.x, s.v)) /
                    motion.constant;
            }
            out.command[k] += u / steps;
            mechanics.advance(s, u, now);
        }
    }
    return out;
}

} // namespace quadrant::diagnosis
