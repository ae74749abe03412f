// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "fit.hpp"
#include "log.hpp"
#include "signals.hpp"

namespace quadrant::diagnosis {

/// One axis of one log, made ready for the fits: motion segments, score, smoothed motion.
struct axis_record {
    double period = 0;
    std::span<const double> reference{}, position{}, command{};
    std::vector<double> velocity{}, acceleration{}; ///< zero-phase, at `smooth_Hz` [m/s], [m/s^2]
    std::vector<std::size_t> segment{};             ///< motion segment of every row
    std::size_t segments = 0;
    double bandwidth_Hz = 0; ///< of the residual force
    double resolution = 0;   ///< step of the position, at least the rounding of its column [m]
    double volt = 1;         ///< what a volt is for a command in volts: a tenth of the largest, in other units
    /// Times that travel and speed exceed 1 m and 1 m/s, or 1: a motor's angle is hundreds of radians, and so much larger are
    /// the lengths and speeds that are tried.
    double reach = 1, pace = 1;
    predictor observer;
    scoring score{};
};

/// Rows where one motion ends and the next begins: the velocity of the reference changes sign, starts or stops.
/// Segments are at least 0.25 s long and at most 1.5 s; they, not samples, are left out and resampled, because the
/// samples inside one motion say the same thing again and again.
inline std::vector<std::size_t> motion_segments(std::span<const double> motion, double period) {
    const auto shortest = std::max<std::size_t>(1, static_cast<std::size_t>(0.25 / period));
    const auto longest = static_cast<std::size_t>(1.5 / period);
    const auto v = derivative(zero_phase(motion, 20, period), period);
    double peak = 0;
    for (double x : v) peak = std::max(peak, std::abs(x));
    const auto sense = [&](double x) { return x > 1e-4 * peak ? 1 : x < -1e-4 * peak ? -1 : 0; };
    std::vector<std::size_t> out(motion.size());
    std::size_t current = 0, begun = 0;
    for (std::size_t k = 1; k < motion.size(); ++k) {
        const bool cut =
            sense(v[k]) != sense(v[k - 1]) && k - begun >= shortest && motion.size() - k >= shortest;
        if (cut || (k - begun >= longest && motion.size() - k >= shortest)) {
            ++current;
            begun = k;
        }
        out[k] = current;
    }
    return out;
}

/// Residual force M (a_model - a_measured): what the model pushes and the machine did not follow [N], both
/// accelerations through the identical zero-phase filter. The measured one is the second difference of the position;
/// the model's is averaged over the same two periods, so that a right model leaves the encoder's rounding only.
inline std::vector<double> residual_force(const plant_model& plant, std::span<const double> position,
                                          std::span<const double> model_acceleration, double period,
                                          double bandwidth_Hz) {
    const std::size_t n = position.size();
    std::vector<double> raw(n, 0.0);
    const auto at = [&](std::size_t k) { return position[k] - plant.cyclic.at(position[k]); };
    for (std::size_t k = 1; k + 1 < n; ++k)
        raw[k] = plant.mass * (0.5 * (model_acceleration[k - 1] + model_acceleration[k]) -
                               (at(k + 1) - 2 * at(k) + at(k - 1)) / (period * period));
    return zero_phase(raw, bandwidth_Hz, period);
}

inline double residual_bandwidth_Hz(double period) { return std::min(100.0, 0.15 / period); }

/// rms of residual_force() when the position carries white noise of `sigma` and nothing else is wrong.
inline double residual_force_floor(double mass, double sigma, double period, double bandwidth_Hz) {
    std::vector<double> impulse(4001, 0.0);
    impulse[1999] = impulse[2001] = mass / (period * period);
    impulse[2000] = -2 * impulse[2001];
    double sum = 0;
    for (double h : zero_phase(impulse, bandwidth_Hz, period)) sum += h * h;
    return sigma * std::sqrt(sum);
}

/// White noise of the position in the innovations of a model, robust against what the model does not explain; not below the
/// rounding of `resolution` [m].
inline double position_noise(const std::vector<double>& innovation, const scoring& s, double resolution) {
    std::vector<double> half_difference(innovation.size());
    for (std::size_t k = 1; k < half_difference.size(); ++k)
        half_difference[k] = (innovation[k] - innovation[k - 1]) * std::numbers::sqrt2 / 2;
    const auto ms = detail::block_ms(half_difference, s.skip, s.block);
    return std::sqrt(std::max(quantile(ms, 0.3), resolution * resolution / 12));
}

inline axis_record prepare(const axis_log& log, double period, double resolution) {
    axis_record r{.period = period,
                  .reference = log.reference,
                  .position = log.position,
                  .command = log.command,
                  .observer = {.period = period,
                               .position = log.position,
                               .command = log.command,
                               .other_acceleration = log.other_acceleration,
                               .resolution = std::max(resolution, log.position_step)}};
    const auto smooth = zero_phase(log.position, 60, period);
    r.velocity = derivative(smooth, period);
    r.acceleration = derivative(r.velocity, period);
    const auto [low, high] = std::minmax_element(smooth.begin(), smooth.end());
    r.reach = std::max(1.0, *high - *low);
    for (double v : r.velocity) r.pace = std::max(r.pace, std::abs(v));
    r.segment = motion_segments(log.reference, period);
    r.segments = r.segment.empty() ? 0 : r.segment.back() + 1;
    r.bandwidth_Hz = residual_bandwidth_Hz(period);

    r.resolution = std::max({resolution, log.position_step, 1e-12});
    double largest = 0;
    for (double u : log.command) largest = std::max(largest, std::abs(u));
    if (log.command_unit != "V" && largest > 0) r.volt = largest / 10;
    auto& s = r.score;
    s.mean = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(0.01 / period)));
    s.block = 5 * s.mean;
    s.skip = s.block;
    s.floor = 0.4 * r.resolution;
    s.floor_mean = 0.2 * r.resolution;
    for (std::size_t k = s.skip; k + s.block <= log.position.size(); k += s.block)
        s.segment_of_block.push_back(r.segment[k + s.block / 2]);
    s.segments = r.segments;
    return r;
}

} // namespace quadrant::diagnosis
