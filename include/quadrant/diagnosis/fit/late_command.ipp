// SPDX-License-Identifier: BSL-1.0
#pragma once

namespace quadrant::inline v0::diagnosis {

QUADRANT_DIAGNOSIS_DECL double lateness_of_command(const axis_log& log, double period) {
    constexpr int turns = 4; // each takes off nine tenths
    double late = 0;
    for (int turn = 0; turn < turns; ++turn) {
        const axis_regression r = regress(read_earlier(log, late, period), period, true);
        const regressed more = r.lateness;
        // A loop answers late to forces that no regression knows: its command is explained by the motion in
        // part only, at any lateness; or as the law of the loop has it, which drives on what slows down.
        if (r.left > 0.1 || (turn == 0 && r.left > 0.5 * r.left_in_time)) return 0;
        if (!(r.acceleration.value > 4 * r.acceleration.spread) || r.speed.value < -2 * r.speed.spread)
            return 0;
        if (!std::isfinite(more.spread) || std::abs(more.value) > 10 * period) return 0;
        late += more.value;
        if (!(late > 4 * more.spread)) return 0;
    }
    // A row's command is its mean until the next row, half a period behind the reading of that row.
    late += 0.5 * period;
    return late > period ? late : 0;
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

} // namespace quadrant::inline v0::diagnosis
