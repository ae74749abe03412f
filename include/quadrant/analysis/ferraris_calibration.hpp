// SPDX-License-Identifier: BSL-1.0
#pragma once
#include "../error.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace quadrant::analysis {

/// What a record says of an acceleration sensor: acceleration = gain m + offset, m its voltage.
struct ferraris_calibration {
    gain_of<signal::acceleration, signal::voltage> gain{};
    quantity_of<signal::acceleration> offset{};
    quantity_of<signal::velocity> start_velocity{}; ///< of the record
    quantity_of<signal::position> start_position{};
    quantity_of<signal::position> residual{};   ///< rms of what the fit leaves
    quantity_of<signal::position> excitation{}; ///< rms of the motion that no offset could imitate
    gain_of<signal::acceleration, signal::voltage>
        gain_deviation{}; ///< standard deviation, for a white residual
    quantity_of<signal::acceleration> offset_deviation{};

    /// The gain is told from the offset: the motion beyond a parabola stands ten times above what is unexplained.
    bool determined() const noexcept { return excitation.value() > 10 * residual.value(); }
    quantity_of<signal::acceleration> acceleration(quantity_of<signal::voltage> m) const noexcept {
        return gain * m + offset;
    }
};

/// Calibrates an acceleration sensor against the encoder while the axis moves (not at constant speed or acceleration).
///   position = G double-integral(m) + Z t^2/2 + v0 t + p0, by least squares; the integral for m straight between samples
/// Source: [Jamaludin2008] Appendix B. Allocates; for after a run, not for a loop.
/// Range: at least 8 samples; 1e-4 of the gain up to 1/200 of the sampling rate (the straight line between samples leaves (w T)^2/12).
/// If !determined(), record a motion with more acceleration in it: a sine or chirp of some hertz, as large as the axis allows.
/// Throws "calibrate_ferraris.<field> = ...: must ..." for period, samples, position, sensor.
inline ferraris_calibration calibrate_ferraris(std::span<const quantity_of<signal::position>> position,
                                               std::span<const quantity_of<signal::voltage>> sensor,
                                               duration period) {
    require_positive("calibrate_ferraris.period", period);
    const std::size_t n = position.size();
    require(n >= 8, "calibrate_ferraris.samples", double(n), "must be at least 8");
    require(sensor.size() == n, "calibrate_ferraris.samples", double(sensor.size()),
            "must be as many for the sensor as for the position (" + quadrant::detail::shortest(double(n)) +
                ")");
    const double T = period.value(), end = T * double(n - 1);
    // Columns 1, t, t^2/2 in units of the record's length, and the double integral: orthogonalized in this order.
    constexpr std::size_t columns = 4;
    std::array<std::vector<double>, columns> q;
    for (auto& column : q) column.resize(n);
    std::vector<double> rest(n);
    double speed = 0, way = 0;
    for (std::size_t k = 0; k < n; ++k) {
        require_finite("calibrate_ferraris.position", position[k]);
        require_finite("calibrate_ferraris.sensor", sensor[k]);
        if (k > 0) {
            const double before = sensor[k - 1].value(), now = sensor[k].value();
            way += T * speed + T * T * (before / 3 + now / 6);
            speed += T * (before + now) / 2;
        }
        const double t = double(k) / double(n - 1);
        q[0][k] = 1, q[1][k] = t, q[2][k] = t * t / 2, q[3][k] = way;
        rest[k] = position[k].value();
    }
    const auto dot = [n](const std::vector<double>& a, const std::vector<double>& b) {
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k) sum += a[k] * b[k];
        return sum;
    };
    const auto subtract = [n](std::vector<double>& a, double factor, const std::vector<double>& b) {
        for (std::size_t k = 0; k < n; ++k) a[k] -= factor * b[k];
    };
    std::array<std::array<double, columns>, columns> r{}; // columns = q r
    std::array<double, columns> x{};
    const double as_recorded = std::sqrt(dot(q[3], q[3]));
    for (std::size_t j = 0; j < columns; ++j) {
        for (int twice = 0; twice < 2; ++twice) // the second time removes the rounding of the first
            for (std::size_t i = 0; i < j; ++i) {
                const double c = dot(q[i], q[j]);
                r[i][j] += c;
                subtract(q[j], c, q[i]);
            }
        r[j][j] = std::sqrt(dot(q[j], q[j]));
        if (j == 3 && !(r[j][j] > 1e-10 * as_recorded)) r[j][j] = 0; // a parabola, to rounding
        for (double& each : q[j]) each = r[j][j] > 0 ? each / r[j][j] : 0;
        x[j] = dot(q[j], rest);
        subtract(rest, x[j], q[j]);
    }
    const double variance = dot(rest, rest) / double(n - columns), share = x[3];
    for (std::size_t i = columns; i-- > 0;) {
        for (std::size_t j = i + 1; j < columns; ++j) x[i] -= r[i][j] * x[j];
        x[i] = r[i][i] > 0 ? x[i] / r[i][i] : 0;
    }
    ferraris_calibration c;
    using boost::units::si::meter;
    c.gain = decltype(c.gain)::from_value(x[3]);
    c.offset = decltype(c.offset)::from_value(x[2] / (end * end));
    c.start_velocity = decltype(c.start_velocity)::from_value(x[1] / end);
    c.start_position = x[0] * meter;
    c.residual = std::sqrt(variance) * meter;
    c.excitation = std::abs(share) / std::sqrt(double(n)) * meter;
    if (r[3][3] > 0) {
        const double deviation = std::sqrt(variance) / r[3][3], across = r[2][3] / r[2][2] * deviation,
                     alone = std::sqrt(variance) / r[2][2];
        c.gain_deviation = decltype(c.gain)::from_value(deviation);
        c.offset_deviation = decltype(c.offset)::from_value(std::hypot(alone, across) / (end * end));
    }
    return c;
}

} // namespace quadrant::analysis
