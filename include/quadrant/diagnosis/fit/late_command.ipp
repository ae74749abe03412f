// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

namespace detail {

/// Whether a regression is of what the command does. What a loop answers to forces that no regression knows has
/// not the mass's share of the acceleration, or is as the law of the loop has it, which drives on what slows
/// down.
inline bool is_of_the_plant(const axis_regression& r, const plant_description& plant) {
    const double of_mass = plant.mass_kg / plant.force_constant_N_per_V;
    return r.acceleration.sure() && r.acceleration.value > of_mass / 3 && r.acceleration.value < of_mass * 3 &&
           r.speed.value > -2 * r.speed.spread;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL command_timing timing_of_command(const axis_log& log, double period,
                                                         const plant_description& plant) {
    constexpr int most_turns = 8;
    constexpr double near = 0.02, most = 10; // rows
    const axis_regression moves = regress(log, period, and_lateness::of_motion);
    const regressed of_motion = moves.lateness;
    const command_timing unknown{.within_rows = moves.band_Hz >= detail::widest_band(period)};
    // A row's command is its mean until the next row, half a period behind the reading of that row.
    const double as_described = -0.5 * period - plant.delay_s;
    const double left_as_described =
        regress(read_earlier(log, as_described, period), period, and_lateness::up_to_noise).left_in_time;
    double late = of_motion.sure() ? of_motion.value : 0;
    for (int turn = 0; turn < most_turns; ++turn) { // each takes off nine tenths
        if (std::abs(late) > most * period) return unknown;
        const axis_regression r = regress(read_earlier(log, late, period), period, and_lateness::up_to_noise);
        if (!std::isfinite(r.lateness.spread)) return unknown;
        late += r.lateness.value;
        if (std::abs(r.lateness.value) < near * period)
            // Forces that no regression knows may look like a lateness that takes off less than they are.
            return {.later = late - as_described,
                    .acts_after = -0.5 * period - late,
                    .spread = r.lateness.spread,
                    .of_plant = detail::is_of_the_plant(r, plant),
                    .outweighs = r.left < 0.5 * left_as_described,
                    .within_rows = unknown.within_rows};
    }
    return unknown;
}

QUADRANT_DIAGNOSIS_DECL double lateness_of_command(const axis_log& log, double period,
                                                   const plant_description& plant, command_origin command) {
    const command_timing t = timing_of_command(log, period, plant);
    const double half = period / 2;
    if (!t.sure() && command == command_origin::measured && t.goes_in_a_line(half)) return half;
    if (!t.sure() || (command == command_origin::asked && t.acts_after > -4 * t.spread)) return 0;
    return t.later;
}

QUADRANT_DIAGNOSIS_DECL axis_log read_earlier(axis_log log, double seconds, double period) {
    if (seconds == 0 || log.command.size() < 2) return log;
    const std::vector<double> as_read = log.command;
    const auto last = static_cast<double>(as_read.size() - 1);
    for (std::size_t k = 0; k < as_read.size(); ++k) {
        const double at = std::clamp(static_cast<double>(k) + seconds / period, 0.0, last);
        const auto before = std::min(static_cast<std::size_t>(at), as_read.size() - 2);
        log.command[k] =
            as_read[before] + (at - static_cast<double>(before)) * (as_read[before + 1] - as_read[before]);
    }
    return log;
}

namespace detail {

/// Whether these numbers are of a low-pass: neither of a delay nor of a mode, which has a curvature without a
/// lateness. doubt: standard deviation of c2.
inline bool is_low_pass(const low_pass_undone& by, double doubt, double period) {
    const double c1 = by.of_slope, of_delay = c1 * c1 / 2;
    return c1 > 0 && by.of_curvature + 4 * doubt < of_delay && by.of_curvature < of_delay / 2 &&
           by.of_curvature > -of_delay - c1 * period / 2;
}

} // namespace detail

QUADRANT_DIAGNOSIS_DECL std::optional<low_pass_undone> low_pass_of_command(const axis_log& log, double period,
                                                                           const plant_description& plant) {
    const double as_described = -0.5 * period - plant.delay_s;
    const axis_regression r = regress(read_earlier(log, as_described, period), period,
                                      and_lateness::with_curvature, white_noise_in(log.command, log.position));
    const low_pass_undone by{.of_slope = r.lateness.value, .of_curvature = -r.curvature.value};
    if (!r.lateness.sure() || !detail::is_of_the_plant(r, plant) || !(r.left < 0.5 * r.left_in_time) ||
        !detail::is_low_pass(by, r.curvature.spread, period))
        return {};
    const double late = lateness_of_command(log, period, plant, command_origin::measured);
    const axis_regression of_late =
        regress(read_earlier(log, as_described + late, period), period, and_lateness::up_to_noise);
    return r.left < of_late.left_in_time ? std::optional(by) : std::nullopt;
}

QUADRANT_DIAGNOSIS_DECL axis_log read_before_low_pass(axis_log log, const low_pass_undone& by, double period) {
    const std::vector<double> y = log.command;
    const auto whole = [&](std::size_t k) { // nothing is missing two rows each way
        for (std::size_t j = k < 2 ? 0 : k - 2; j < std::min(k + 3, log.left_out.size()); ++j)
            if (log.left_out[j]) return false;
        return true;
    };
    for (std::size_t k = 1; k + 1 < y.size(); ++k)
        if (whole(k))
            log.command[k] += by.of_slope * (y[k + 1] - y[k - 1]) / (2 * period) +
                              by.of_curvature * (y[k + 1] - 2 * y[k] + y[k - 1]) / (period * period);
    return log;
}

} // namespace quadrant::inline v0::diagnosis
