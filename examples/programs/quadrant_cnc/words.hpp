// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "run_result.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

/// A run in words, rows and JSON.
namespace quadrant_cnc {

/// Four digits without an exponent where that is readable: 12.34, 0.05, 1234.
inline std::string number(double value) {
    if (!std::isfinite(value)) return "none";
    const double size = std::abs(value);
    if (size == 0) return "0";
    if (size >= 1e6 || size < 1e-3) return fmt::format("{:.3g}", value);
    return fmt::format("{:.{}f}", value, std::max(0, 2 - int(std::floor(std::log10(size)))));
}

/// One row for each axis: what the summary prints, what the page shows.
struct outcome_row {
    std::string axis, error_max, error_rms, where, speed, acceleration, jerk, effort_max, effort_rms,
        effort_limit, limited;
};
inline outcome_row row_of(const axis_outcome& a, const run_outcome& r) {
    return {.axis = a.name,
            .error_max = number(1e6 * a.error.most),
            .error_rms = number(1e6 * a.error.rms(r.samples)),
            .where = fmt::format("{} s, line {}", number(a.error.time), a.error.line),
            .speed = number(1e3 * a.velocity.most),
            .acceleration = number(a.acceleration.most),
            .jerk = number(a.jerk.most),
            .effort_max = number(a.effort.most),
            .effort_rms = number(a.effort.rms(r.samples)),
            .effort_limit = number(a.effort_limit),
            .limited = fmt::format("{}", a.limited)};
}

inline std::string sentence(const run_outcome& r) {
    return fmt::format("The table leaves the path by {} µm at most ({} µm rms).", number(1e6 * r.contour.most),
                       number(1e6 * r.contour.rms(r.samples)));
}

inline std::string summary(const run_outcome& r) {
    std::string out =
        fmt::format("{} on {}: {} moves, {} m in {} s, {} samples of {} ms\n", r.path_file, r.cnc_file, r.moves,
                    number(r.path_length), number(r.duration), r.samples, number(1e3 * r.period));
    out += fmt::format("{} At {} s, line {}: x {} y {} z {} mm.\n", sentence(r), number(r.contour.time),
                       r.contour.line, number(1e3 * r.worst_place.x), number(1e3 * r.worst_place.y),
                       number(1e3 * r.worst_place.z));
    for (const axis_outcome& a : r.axes) {
        const outcome_row w = row_of(a, r);
        out +=
            fmt::format("Axis {}: tracking error {} µm at most, {} µm rms; {} {} {} at most, {} rms, limit {}",
                        w.axis, w.error_max, w.error_rms, a.effort_unit == "A" ? "current" : "command",
                        w.effort_max, a.effort_unit, w.effort_rms, w.effort_limit);
        out += a.limited > 0 ? fmt::format("; at a limit for {} periods\n", a.limited) : "\n";
    }
    for (const std::string& note : r.notes) out += fmt::format("Note: {}\n", note);
    out += fmt::format("{} s of CPU time, {} times faster than real time\n", number(r.cpu_time),
                       number(r.faster_than_real_time()));
    return out;
}

inline nlohmann::ordered_json to_json(const run_outcome& r) {
    using json = nlohmann::ordered_json;
    json axes = json::object();
    for (const axis_outcome& a : r.axes) {
        json one = {{"error_max_m", a.error.most},
                    {"error_max_line", a.error.line},
                    {"error_rms_m", a.error.rms(r.samples)},
                    {"velocity_max_m_per_s", a.velocity.most},
                    {"acceleration_max_m_per_s2", a.acceleration.most},
                    {"jerk_max_m_per_s3", a.jerk.most}};
        const std::string effort = a.effort_unit == "A" ? "current" : "command";
        one[effort + "_max_" + a.effort_unit] = a.effort.most;
        one[effort + "_rms_" + a.effort_unit] = a.effort.rms(r.samples);
        if (std::isfinite(a.effort_limit)) one[effort + "_limit_" + a.effort_unit] = a.effort_limit;
        one["limited_periods"] = a.limited;
        axes[a.name] = one;
    }
    return {{"schema", "quadrant.cnc_run/1"},
            {"cnc", r.cnc_file},
            {"path", r.path_file},
            {"servo_period_s", r.period},
            {"duration_s", r.duration},
            {"samples", r.samples},
            {"moves", r.moves},
            {"path_length_m", r.path_length},
            {"contour_error_max_m", r.contour.most},
            {"contour_error_max_line", r.contour.line},
            {"contour_error_rms_m", r.contour.rms(r.samples)},
            {"axes", axes},
            {"notes", r.notes},
            {"wall_time_s", r.wall_time},
            {"cpu_time_s", r.cpu_time}};
}

} // namespace quadrant_cnc
