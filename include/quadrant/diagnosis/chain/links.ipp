// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis::chain {

QUADRANT_DIAGNOSIS_DECL double slope(std::span<const double> x, std::span<const double> y) {
    double mx = 0, my = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        mx += x[k] / static_cast<double>(x.size());
        my += y[k] / static_cast<double>(x.size());
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
        xx += (x[k] - mx) * (x[k] - mx);
        xy += (x[k] - mx) * (y[k] - my);
    }
    return xx > 0 ? xy / xx : 0;
}

QUADRANT_DIAGNOSIS_DECL link_model described_gears(const axis_description& axis) {
    const transmission_description& t = axis.transmission;
    link_model m;
    m.play = t.backlash_m.value_or(axis.plant.backlash_m.value_or(axis.plant.backlash_behind_m.value_or(0)));
    m.compliance = t.stiffness_N_per_m ? 1 / *t.stiffness_N_per_m : 0;
    m.motor_coulomb = t.motor_coulomb_N.value_or(0);
    m.pitch_period = t.pitch_period_m.value_or(t.travel_per_turn_m.value_or(0));
    m.pitch = t.pitch_error_m;
    m.pitch_phase = t.pitch_phase_rad;
    if (!t.travel_error_m.empty() && t.travel_error_from_m && t.travel_error_to_m) {
        m.smooth = t.travel_error_m;
        m.smooth_from = *t.travel_error_from_m;
        m.smooth_to = *t.travel_error_to_m;
    }
    return m;
}

QUADRANT_DIAGNOSIS_DECL double motor_to_load(const axis_description& axis, const axis_log& log,
                                             const std::string& file) {
    const transmission_description& t = axis.transmission;
    const double measured = slope(log.motor, log.position);
    const std::string m = key_of("m", axis.kind);
    const std::optional<double> described = t.to_load(log.motor_unit);
    const double turn = measured * 2 * std::numbers::pi;
    if (!described)
        throw bad_input(file,
                        fmt::format("axis {0}: axes.{0}.transmission.travel_per_turn_{1} is missing; the scale "
                                    "moves {2:.4g} {1} a turn of the motor's encoder",
                                    axis.name, m, turn));
    const double ratio = measured / *described;
    if (std::abs(ratio - 1) <= tolerance_description::unstated) return *described;
    if (log.turn)
        throw bad_input(file, fmt::format("axis {0}: end {2} moves {1:.4g} times as far as end {3}: {4}",
                                          axis.name, ratio, log.turn->second, log.turn->first,
                                          std::abs(std::abs(ratio) - 1) <= tolerance_description::unstated
                                              ? fmt::format("turn the sign of one of them")
                                              : fmt::format("scale {}_pos_{} by {:.5g}", log.turn->second, m,
                                                            1 / std::abs(ratio))));
    const std::string what =
        log.motor_unit == "rad"
            ? fmt::format("travel_per_turn_{} {:.4g}, not {:.5g}", m, std::abs(turn), *t.travel_per_turn_m)
            : fmt::format("{}_motor_pos_{} times {:.5g}", axis.name, m, std::abs(measured));
    throw bad_input(file,
                    fmt::format("axis {}: the scale moves {:.4g} times as far as the motor's encoder says{}: "
                                "{}",
                                axis.name, ratio, ratio < 0 ? " (in the other direction)" : "",
                                std::abs(std::abs(ratio) - 1) <= tolerance_description::unstated
                                    ? fmt::format("turn the sign of one of them")
                                    : fmt::format("it would fit {}", what)));
}

QUADRANT_DIAGNOSIS_DECL std::vector<double> scaled(std::span<const double> x, double by) {
    std::vector<double> out(x.begin(), x.end());
    for (double& v : out) v *= by;
    return out;
}

QUADRANT_DIAGNOSIS_DECL described_link motor_to_scale(const axis_description& axis, const axis_log& log,
                                                      double period, const std::string& file) {
    described_link out{.readings = {.period = period, .left_out = log.left_out},
                       .described = described_gears(axis)};
    auto& l = out.readings;
    out.from = "the motor's encoder";
    out.to = "the scale";
    if (log.turn) {
        out.from = "end " + log.turn->first;
        out.to = "end " + log.turn->second;
    }
    out.motor_turns = log.motor_unit == "rad";
    out.to_load = motor_to_load(axis, log, file);
    l.first = scaled(log.motor, out.to_load);
    l.last = log.position;
    const double described =
        log.turn ? axis.encoder.resolution_m
                 : axis.motor_encoder.resolution_m.value_or(
                       out.motor_turns ? axis.motor_encoder.resolution_rad.value_or(0) * out.to_load : 0);
    l.first_count = std::max(described, out.to_load * observed_count(log.motor, log.motor_step));
    l.last_count = std::max(axis.encoder.resolution_m, observed_count(log.position, log.position_step));
    l.turn = axis.transmission.travel_per_turn_m.value_or(0);
    return out;
}

QUADRANT_DIAGNOSIS_DECL described_link asked_to(const axis_description& axis, const axis_log& log,
                                                double period, const std::vector<double>& reached, double count,
                                                bool geared) {
    described_link out{.readings = {.period = period, .left_out = log.left_out}, .described = {}};
    auto& l = out.readings;
    if (geared) out.described = described_gears(axis);
    out.from = "what was asked";
    out.to = geared ? "the scale" : "the motor's encoder";
    out.to_load = *axis.transmission.to_load("m");
    l.asked = true;
    l.geared = geared;
    l.first = scaled(log.reference, geared ? out.to_load : 1);
    l.last = reached;
    l.first_count = observed_count(log.reference, log.reference_step);
    l.last_count = count;
    l.turn = axis.transmission.travel_per_turn_m.value_or(0);
    out.described.rate = axis.drive.setpoint_rate_limit_m_per_s.value_or(0) * out.set_point_to_load();
    if (const auto& gain = axis.drive.position_gain_per_s) out.described.lag = 1 / *gain;
    out.described.delay = axis.drive.command_delay_s.value_or(0);
    return out;
}

QUADRANT_DIAGNOSIS_DECL void give_force(described_link& d, const axis_description& axis, const axis_log& log) {
    auto& l = d.readings;
    if (log.command.size() != l.rows() || !(axis.plant.mass_kg > 0)) return;
    l.force_band_Hz =
        scales_of(axis.plant, log, l.period, std::max(axis.encoder.resolution_m, l.last_count)).bandwidth_Hz();
    // The command of a row acts from its delay on, for one period.
    const double late = log.drive ? 0 : axis.plant.delay_s + l.period / 2;
    const auto acting = zero_phase(held_later(log.command, l.period, late), l.force_band_Hz, l.period);
    const auto smooth = zero_phase(l.first, l.force_band_Hz, l.period);
    const auto velocity = derivative(smooth, l.period), acceleration = derivative(velocity, l.period);
    const double mass = l.motor_mass = axis.transmission.motor_mass_kg.value_or(0);
    l.compliance = d.described.compliance;
    l.force_doubt = std::hypot(axis.drive.has_velocity_loop() ? axis.tolerance.of("velocity_gain")
                                                              : axis.tolerance.of("force_constant"),
                               mass > 0 ? axis.tolerance.of("mass") : 0);
    std::vector<double> sign(l.rows());
    l.force.resize(l.rows());
    for (std::size_t k = 0; k < l.rows(); ++k) {
        l.force[k] = axis.plant.force_constant_N_per_V * acting[k] - mass * acceleration[k];
        sign[k] = velocity[k] > 0 ? 1 : velocity[k] < 0 ? -1 : 0;
    }
    l.motor_direction = zero_phase(sign, l.force_band_Hz, l.period);
}

} // namespace quadrant::inline v0::diagnosis::chain
