// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../log/log.hpp"
#include "../log/sensor_box.hpp"
#include "../log/signals.hpp"
#include "../machine/machine.hpp"

namespace quadrant::inline v0::diagnosis {

/// What is long, fast and strong on one axis, measured from its record. Every threshold, start value and bound
/// of the diagnosis is a multiple of one of these or has no dimension, so that the answer does not depend on
/// the size of the machine, on its speed or on the unit of its command (docs/diagnosis.md, Scales).
struct record_scales {
    double travel = 0;     ///< distance between the ends of the position [m]
    double speed = 0;      ///< largest velocity, smoothed to `corner_Hz` [m/s]
    double command = 0;    ///< largest command [V]
    double count = 0;      ///< step of the reading [m]
    double least_give = 0; ///< of give(), see axis_log::least_give [m]
    double corner_Hz = 0;  ///< frequency at which the record resolves a hundredth of its force, see scales_of()

    static constexpr double most_cycles_a_row = 0.06; ///< of the corner: 17 rows in a cycle

    /// Time constant of the corner [s].
    double response() const { return 1 / (2 * std::numbers::pi * corner_Hz); }
    /// Sixty cycles of the corner: a motion that is proposed takes some of these [s].
    double unit() const { return 60 / corner_Hz; }
    /// Length of a block: innovations further apart than this are independent [s].
    double block() const { return 3 / corner_Hz; }
    /// Upper limit of the residual force's band.
    double bandwidth_Hz() const { return 5.0 / 3 * corner_Hz; }
    /// Displacement by which every sticking contact gives way: no record shows less than half a count, and a
    /// millionth of the travel matters to nobody [m].
    double give() const { return std::max({0.5 * count, 1e-6 * travel, least_give}); }
};

namespace detail {

/// White noise of the position, its rounding included: robust rms of its third difference, which no smooth
/// motion is in.
inline double reading_noise(std::span<const double> position, double resolution) {
    constexpr std::size_t rows = 64;
    std::vector<double> ms;
    for (std::size_t first = 0; first + rows + 3 <= position.size(); first += rows) {
        double sum = 0;
        for (std::size_t k = first; k < first + rows; ++k) {
            const double d = position[k + 3] - position[k] + 3 * (position[k + 1] - position[k + 2]);
            sum += d * d;
        }
        ms.push_back(sum / rows);
    }
    return std::max(std::sqrt(quantile(ms, 0.3) / 20), resolution / std::sqrt(12.0)); // 1 + 9 + 9 + 1 = 20
}
/// The same of what a servo gives otherwise than measured, in duty. The column is rounded to steps, and the
/// replayed law reads a position that is rounded to counts: neither shows where the axis stands.
inline double duty_noise(std::span<const double> beside, double step, double gain, double count) {
    return reading_noise(beside, std::max(step, gain * count));
}

} // namespace detail

/// The scales of one axis. The time scale is the frequency at which a hundredth of the commanded force (its rms
/// about the mean, F) displaces the mass M by the standard deviation s of the reading's noise:
///   M (2 pi corner)^2 s = F / 100
/// At higher frequencies the noise hides such a force, at lower ones the record shows it. Neither the sample
/// rate nor a controller is in it. It stays where the record can show it: 17 rows in a cycle at least, 30
/// cycles in the record.
inline record_scales scales_of(const plant_description& plant, const axis_log& log, double period,
                               double resolution) {
    record_scales out;
    const auto n = static_cast<double>(log.position.size());
    const auto [low, high] = std::minmax_element(log.position.begin(), log.position.end());
    out.travel = *high - *low;
    out.least_give = log.least_give;
    // A number of 64 bits resolves no more of the travel than this.
    out.count = std::max({resolution, log.position_step, 1e-12 * out.travel});
    double mean = 0, variance = 0;
    for (double u : log.command) mean += u / n;
    for (double u : log.command) {
        out.command = std::max(out.command, std::abs(u));
        variance += (u - mean) * (u - mean) / n;
    }
    const double acceleration = plant.force_constant_N_per_V * std::sqrt(variance) / plant.mass_kg;
    const double noise = detail::reading_noise(log.position, out.count);
    const double resolved = std::sqrt(0.01 * acceleration / noise) / (2 * std::numbers::pi);
    const double most = record_scales::most_cycles_a_row / period, least = std::min(30 / (n * period), most);
    out.corner_Hz = std::clamp(resolved, least, most);
    for (double v : derivative(zero_phase(log.position, out.corner_Hz, period), period))
        out.speed = std::max(out.speed, std::abs(v));
    return out;
}

/// How many rows of a record may become one before the rows limit its time scale; 1: none.
inline std::size_t rows_in_one(double corner_Hz, double period) {
    const double n = std::floor(record_scales::most_cycles_a_row / (corner_Hz * period) * (1 + 1e-9));
    return n > 1 ? static_cast<std::size_t>(n) : 1;
}

/// Band of the residual force of an axis in this log.
inline double bandwidth_of(const axis_description& axis, const axis_log& log, double period) {
    const double count = observed_count(log.position, log.position_step);
    return scales_of(axis.plant, log, period, std::max(axis.encoder.resolution_m, count)).bandwidth_Hz();
}

} // namespace quadrant::inline v0::diagnosis
